//! Reads the list `motors` of a robot file.

use crate::readers::names::{at_most, carrier, joint_names, ratios, taken};
use crate::readers::texts::text_of_one_line;
use crate::readers::tree::items;
use crate::readers::varying::fixed;
use crate::robot::parent;
use crate::text::decode::{Context, list, not_negative, read_mapping};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::source::quoted;
use crate::{Drive, Joint, Rotor};

/// Largest number of motors: a robot needs no more motors than joints.
const MAX_DRIVES: usize = crate::text::document::MAX_JOINTS;

/// Reads the list `motors` of a file whose root is `root`. `passive` are the dependent joints of closed loops, with
/// which no motor may turn.
pub(crate) fn drives(
    cx: &Context,
    root: &Node,
    format: u32,
    joints: &[Joint],
    passive: &[usize],
) -> Option<Vec<Drive>> {
    let help = "begin each motor with a dash, such as `- {turns: {joint2: 42, joint3: -25}}`";
    let items = items(cx, root, ("motors", format), "motors", help)?;
    at_most(cx, items, MAX_DRIVES, ["motor", "motors"])?;
    let names = joint_names(root);
    let drives: Vec<_> = items.iter().enumerate().map(|(index, item)| drive(cx, item, index, &names, joints)).collect();
    let drives = drives.into_iter().collect::<Option<Vec<_>>>()?;
    let mut valid = true;
    let mut refused = |mistake: Diagnostic| {
        valid = false;
        cx.report(mistake);
    };
    for (index, (item, drive)) in items.iter().zip(&drives).enumerate() {
        if let Some(first) = drives[..index].iter().position(|other| other.name == drive.name) {
            refused(taken(item, &drive.name, "motor", [index, first], "the names of motors"));
        }
        // the speed of such a motor would not be a linear function, with constant factors, of the speeds of the
        // coordinates
        let is_dependent = |joint: usize| {
            let coupling = joints[joint].coupling.as_ref();
            let mut followed = coupling.into_iter().flat_map(|coupling| &coupling.follows);
            passive.contains(&joint) || followed.any(|(followed, _)| passive.contains(followed))
        };
        if let Some(&(joint, _)) = drive.turns.iter().find(|(joint, _)| is_dependent(*joint)) {
            let message = format!(
                "the motor {} turns with the joint {}, which is dependent in a closed loop",
                quoted(&drive.name),
                quoted(&names[joint])
            );
            let help = "name joints that are not dependent in `turns`; the inertia of a rotor that turns with a \
                        dependent joint belongs into its link";
            let place = item.get("turns").map_or(item.head(), Node::head);
            refused(Diagnostic::error(place, message).label("a dependent joint").help(help));
        }
        for &(joint, _) in drive.turns.iter().filter(|_| drive.rotor.is_some()) {
            if let Some(inertia) = inertia_of_joint(root, joint) {
                let message = format!(
                    "the joint {} has a `motor` with `inertia`, but the motor {} has a rotor that turns with it",
                    quoted(&names[joint]),
                    quoted(&drive.name)
                );
                let help =
                    "delete this `inertia`, or delete `rotor` in the list `motors`: each inertia is counted once";
                refused(Diagnostic::error(inertia.span.clone(), message).label("a second rotor").help(help));
            }
        }
    }
    valid.then_some(drives)
}

/// Returns the value of `inertia` under `motor` of a joint, which is counted from 0.
fn inertia_of_joint(root: &Node, joint: usize) -> Option<&Node> {
    root.list("joints").get(joint)?.get("motor")?.get("inertia")
}

/// Reads the motor with this index, from 0.
fn drive(cx: &Context, node: &Node, index: usize, names: &[String], joints: &[Joint]) -> Option<Drive> {
    const EXAMPLE: &str = "write the joints with which it turns and its turns per turn of each, such as `turns: \
                           {joint2: 42, joint3: -25}`";
    read_mapping!(cx, node, "a motor", {
        name: or(format!("motor{}", index + 1)) "name" |cx, node| text_of_one_line(cx, node, "motor name"),
        turns: required "turns" |cx, node| ratios(cx, node, names, "turns", EXAMPLE),
        rotor: optional "rotor" |cx, node| rotor(cx, node, names),
    });
    let first = turns.first()?.0;
    let rotor =
        rotor.map(|(axis, on, inertia)| Rotor { axis, on: on.unwrap_or_else(|| parent(joints, first)), inertia });
    let mut turns = turns;
    turns.sort_by_key(|(joint, _)| *joint);
    // a joint whose own entry could not be read has no index in `joints`
    turns.iter().all(|(joint, _)| *joint < joints.len()).then_some(Drive { name, turns, rotor })
}

/// Reads a rotor: the axis, the link that carries it if the file names one, and the inertia.
#[allow(clippy::option_option, clippy::type_complexity)] // the inner `None` is no key, or the base
fn rotor(cx: &Context, node: &Node, names: &[String]) -> Option<([f64; 3], Option<Option<usize>>, f64)> {
    read_mapping!(cx, node, "`rotor`", {
        axis: required "axis" axis,
        on: optional "on" |cx, node| carrier(cx, node, names, "on"),
        inertia: required "inertia" not_negative("rotor inertia", fixed("the rotor inertia")),
    });
    Some((axis, on, inertia))
}

/// Reads a direction and returns it as a unit vector.
fn axis(cx: &Context, node: &Node) -> Option<[f64; 3]> {
    let axis = list(cx, node, "[x, y, z]", |cx, node, _| fixed("the axis")(cx, node))?;
    let largest = axis.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    if largest == 0.0 {
        let message = "the axis [0, 0, 0] has no direction; the rotor must turn about an axis";
        let help = "write the direction in the axes of the link that carries the rotor, such as `axis: [0, 0, 1]`";
        return cx.refuse(Diagnostic::error(node.span.clone(), message).label("no direction").help(help));
    }
    let scaled = axis.map(|x| x / largest);
    let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    // a unit vector keeps the digits that the file has
    let is_unit = (largest * length - 1.0).abs() < 4.0 * f64::EPSILON;
    Some(if is_unit { axis } else { scaled.map(|x| x / length) })
}
