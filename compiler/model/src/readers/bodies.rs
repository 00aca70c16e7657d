//! Reads the list `bodies` of a robot file.

use crate::parts::body::overflow;
use crate::readers::link::inertia_reference;
use crate::readers::names::{at_most, carrier, joint_names, not_identifier};
use crate::readers::placement::fixed_transform;
use crate::readers::tree::items;
use crate::readers::varying::leave_out;
use crate::text::decode::{Context, read_mapping, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::source::quoted;
use crate::{Bodies, Body, Entry, FixedFrame, Inertia, InertiaReference, Joint, Transform, readers::matter};

/// Largest number of bodies in a file.
const MAX_BODIES: usize = 256;

/// Reads the list `bodies` of a file whose root is `root`. [`Bodies::add_to`] adds the bodies to their links later.
pub(crate) fn bodies(cx: &Context, root: &Node, format: u32, joints: &[Joint]) -> Option<Bodies> {
    let help = "begin each body with a dash, such as `- {name: camera, on: joint6, mass: 0.3}`";
    let items = items(cx, root, ("bodies", format), "bodies", help)?;
    at_most(cx, items, MAX_BODIES, ["body", "bodies"])?;
    let names = joint_names(root);
    let read: Vec<Option<Body>> = items.iter().map(|item| body(cx, item, &names)).collect();
    let mut valid = true;
    for (index, (item, body)) in items.iter().zip(&read).enumerate() {
        let Some(body) = body else { continue };
        let place = |key: &str| item.get(key).map_or(item.head(), |value| value.span.clone());
        let mistake = if read[..index].iter().flatten().any(|other| other.name == body.name) {
            let message = format!("{} is already the name of another body; names must differ", quoted(&body.name));
            Some(Diagnostic::error(place("name"), message).label("name taken"))
        } else {
            body.fixed.on.and_then(|on| unfit(cx, joints.get(on)?, on, &place("on")))
        };
        if let Some(mistake) = mistake {
            valid = false;
            cx.report(mistake);
        } else if body.fixed.on.is_none() && root.get("floating_base").is_none() {
            let message =
                format!("the body {} has no effect: it is on `base`, which does not move", quoted(&body.name));
            cx.report(Diagnostic::note(place("on"), message).label("on the base"));
        }
    }
    let list = read.into_iter().collect::<Option<Vec<_>>>()?;
    if valid && let Some((index, on)) = overflow(&list, joints) {
        let message = format!(
            "the link of {} with its bodies is too heavy: its mass or its inertia is more than a 64-bit number holds",
            quoted(&joints[on].name)
        );
        let place = items[index].get("mass").unwrap_or(&items[index]).span.clone();
        let help = "masses are in kg, lengths in m and inertias in kg m²; check the numbers of the bodies of this link";
        return cx.refuse(Diagnostic::error(place, message).label("too large with this body").help(help));
    }
    valid.then_some(Bodies { list, ..Bodies::default() })
}

/// Returns an error if a link cannot carry a body: it has a first moment without mass, or varies at run time.
fn unfit(cx: &Context, joint: &Joint, index: usize, place: &std::ops::Range<usize>) -> Option<Diagnostic> {
    if joint.row.link.has_first_moment() {
        let message =
            format!("the link of {} has a first moment without mass, so it can have no body", quoted(&joint.name));
        let help = "such a link is a set of base parameters; change its numbers instead";
        return Some(Diagnostic::error(place.clone(), message).label("not a body").help(help));
    }
    let run_time = cx.run_time.borrow();
    let (_, formula) = run_time.entries.iter().find(|(entry, _)| match entry {
        Entry::Mass(of) | Entry::Com(of, _) | Entry::Inertia(of, _) => *of == index,
        _ => false,
    })?;
    let parameter = (0..run_time.names.len()).find(|&parameter| formula.depends_on(parameter));
    let name = cx.parameter_name(parameter);
    let message = format!(
        "the link of {} depends on the run-time parameter {}, so it can have no body",
        quoted(&joint.name),
        quoted(&name)
    );
    Some(Diagnostic::error(place.clone(), message).label("this link varies at run time").help(leave_out(&name)))
}

fn body(cx: &Context, node: &Node, joints: &[String]) -> Option<Body> {
    read_mapping!(cx, node, "a body", {
        name: required "name" body_name,
        on: required "on" |cx, node| carrier(cx, node, joints, "on"),
        at: or(Transform::IDENTITY) "at" fixed_transform,
        mass: required "mass" matter::mass,
        com: or([0.0; 3]) "com" matter::com,
        written: or(Inertia::default()) "inertia" matter::fixed_tensor,
        about: or(InertiaReference::Com) "inertia_about" inertia_reference,
    });
    let matter = matter::link(cx, node, (mass, com), (written, about), true)?;
    Some(Body { name, fixed: FixedFrame { on, placement: at }, matter })
}

fn body_name(cx: &Context, node: &Node) -> Option<String> {
    let name = text(cx, node)?;
    let what = format!("the body name {}", quoted(&name));
    let Some(message) = not_identifier(&name, &what) else { return Some(name) };
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("choose another name"))
}
