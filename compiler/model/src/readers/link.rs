//! Reads the key `link` of a joint: mass, centre of mass and inertia, and whether a physical body can have them.

use crate::readers::varying::{com_of_first_moment, entry, inertia_about_com, inertia_element};
use crate::text::decode::{Context, choice, list, not_negative, read_mapping};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::{Entry, Inertia, InertiaReference, Link, lints, lints::single_value, readers::matter};

/// Reads a link. Returns it with its inertia about the centre of mass, and the inertia as the file writes it.
pub(crate) fn link(cx: &Context, node: &Node, joint: usize) -> Option<(Link, (Inertia, InertiaReference))> {
    read_mapping!(cx, node, "a link", {
        mass: or(0.0) "mass" |cx, node| mass(cx, node, joint),
        com: or([0.0; 3]) "com" |cx, node| com(cx, node, joint),
        _moment: optional "first_moment" |_, _| Some(()),
        written: or(Inertia::default()) "inertia"
            |cx, node| matter::tensor(cx, node, |element| inertia_element(joint, element)),
        about: or(InertiaReference::Com) "inertia_about" inertia_reference,
        physical: or(true) "physical" matter::physical,
    });
    let (com, first_moment) = match (node.get("first_moment"), node.get("com")) {
        (None, _) => (com, [0.0; 3]),
        (Some(moment), None) if mass == 0.0 => ([0.0; 3], first_moment_alone(cx, moment, joint)?),
        (Some(moment), None) => (com_of_first_moment(cx, moment, joint, mass)?, [0.0; 3]),
        (Some(moment), Some(_)) => {
            let message =
                "the link has both `first_moment` and `com`; each defines the centre of mass, so delete one of them";
            return cx.refuse(Diagnostic::error(moment.head(), message).help("first_moment = mass * com"));
        }
    };
    let about = match (node.get("first_moment"), first_moment != [0.0; 3]) {
        (Some(moment), true) => no_body(cx, moment, (node.get("inertia_about"), about), physical)?,
        _ => about,
    };
    let place = matter::place_of_inertia(node);
    let inertia = inertia_about_com(cx, place.clone(), joint, (written, about), (mass, com))?;
    let link = Link { mass, com, inertia, first_moment };
    Some((matter::checked(cx, place, link, (written, about), physical)?, (written, about)))
}

/// Reads the first moment of a link without mass, about the origin of the link frame.
fn first_moment_alone(cx: &Context, node: &Node, joint: usize) -> Option<[f64; 3]> {
    list(cx, node, "[x, y, z] (kg m)", |cx, node, axis| entry(Entry::FirstMoment(joint, axis))(cx, node))
}

/// Checks a link that has a first moment and no mass. It is no physical body, so its file must say `physical: false`;
/// and it has no centre of mass, so its inertia refers to the origin of the link frame.
fn no_body(
    cx: &Context,
    moment: &Node,
    (reference, about): (Option<&Node>, InertiaReference),
    physical: bool,
) -> Option<InertiaReference> {
    if physical {
        let message = "the link has a first moment but no mass, although the first moment is the mass times the centre \
                       of mass";
        return cx.refuse(Diagnostic::error(moment.head(), message).label("the mass is 0").help(
            "give the link its `mass`; if its mass was moved to other links (regrouping), as in a set of base \
             parameters, write `physical: false` beside the first moment",
        ));
    }
    if let (Some(node), InertiaReference::Com) = (reference, about) {
        let message = "the inertia refers to the centre of mass, but a link with a first moment and no mass has no \
                       centre of mass";
        let help = "write `inertia_about: origin`, or delete the key: the inertia then refers to the origin of the \
                    link frame";
        return cx.refuse(Diagnostic::error(node.head(), message).help(help));
    }
    lints::inertia::first_moment_without_mass(cx, moment);
    Some(InertiaReference::Origin)
}

fn com(cx: &Context, node: &Node, joint: usize) -> Option<[f64; 3]> {
    list(cx, node, "[x, y, z] (m)", |cx, node, axis| {
        let value = entry(Entry::Com(joint, axis))(cx, node)?;
        single_value::com(cx, node, value);
        Some(value)
    })
}

fn mass(cx: &Context, node: &Node, joint: usize) -> Option<f64> {
    let mass = not_negative("mass", entry(Entry::Mass(joint)))(cx, node)?;
    single_value::mass(cx, node, mass);
    Some(mass)
}

pub(crate) fn inertia_reference(cx: &Context, node: &Node) -> Option<InertiaReference> {
    choice(cx, node, "point of reference", &[("com", InertiaReference::Com), ("origin", InertiaReference::Origin)])
}
