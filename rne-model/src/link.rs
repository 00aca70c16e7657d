//! The link of a robot file: its mass, centre of mass and inertia, and whether they are those of a body.

use crate::decode::{Context, choice, list, not_negative, read_mapping};
use crate::diagnostic::Diagnostic;
use crate::document::Node;
use crate::source::six_digits;
use crate::varying::{com_of_first_moment, entry, inertia_about_com, inertia_element};
use crate::{Entry, Inertia, InertiaElement, InertiaReference, Link, inertia, lint};

/// The link with its inertia about the centre of mass, and the inertia as written.
pub(crate) fn link(cx: &Context, node: &Node, joint: usize) -> Option<(Link, (Inertia, InertiaReference))> {
    read_mapping!(cx, node, "a link", {
        mass: or(0.0) "mass" |cx, node| mass(cx, node, joint),
        com: or([0.0; 3]) "com" |cx, node| centre_of_mass(cx, node, joint),
        _moment: optional "first_moment" |_, _| Some(()),
        written: or(Inertia::default()) "inertia" |cx, node| tensor(cx, node, joint),
        about: or(InertiaReference::Com) "inertia_about" inertia_reference,
        physical: or(true) "physical" |cx, node| choice(cx, node, "answer", &[("true", true), ("false", false)]),
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
    let place = ["inertia", "inertia_about"].iter().find_map(|key| node.get(key)).unwrap_or(node).head();
    let inertia = inertia_about_com(cx, place.clone(), joint, (written, about), (mass, com))?;
    let Some(moments) = inertia::principal_moments(&inertia) else {
        let message = "the inertia about the centre of mass is not finite; mass, com and inertia are too large";
        return cx.refuse(Diagnostic::error(place, message));
    };
    let magnitude = inertia::largest_magnitude(&written, mass, com);
    let is_body = moments[0] >= -inertia::TOLERANCE * magnitude;
    let link = Link { mass, com, inertia, first_moment };
    if first_moment != [0.0; 3] {
        // that it is no body is said already
        return Some((link, (written, about)));
    }
    if !is_body && !physical {
        lint::unphysical(cx, place, moments);
        return Some((link, (written, about)));
    }
    if !is_body {
        let message = format!(
            "the inertia is not positive semidefinite: its smallest eigenvalue about the centre of mass is {} kg m²; \
             it must be zero or positive",
            six_digits(moments[0])
        );
        return cx.refuse(Diagnostic::error(place, message).label("not the inertia of a body").help(match about {
            InertiaReference::Com => {
                "check the signs and the order of the products of inertia; a tensor about the origin of the link frame \
                 needs `inertia_about: origin`"
            }
            InertiaReference::Origin => {
                "check mass and com; if the tensor already refers to the centre of mass, write `inertia_about: com`"
            }
        }));
    }
    lint::triangle_inequality(cx, place.clone(), &link.inertia);
    lint::radius_of_gyration(cx, place, mass, moments);
    Some((link, (written, about)))
}

/// The first moment of a link without mass, about the origin of its frame.
fn first_moment_alone(cx: &Context, node: &Node, joint: usize) -> Option<[f64; 3]> {
    list(cx, node, "[x, y, z] (kg m)", |cx, node, axis| entry(Entry::FirstMoment(joint, axis))(cx, node))
}

/// A link with a first moment and without mass is no body, which its file must know, and has no centre of mass: the
/// point that its inertia refers to is the origin of its frame.
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
    lint::first_moment_without_mass(cx, moment);
    Some(InertiaReference::Origin)
}

fn centre_of_mass(cx: &Context, node: &Node, joint: usize) -> Option<[f64; 3]> {
    list(cx, node, "[x, y, z] (m)", |cx, node, axis| {
        let value = entry(Entry::Com(joint, axis))(cx, node)?;
        lint::centre_of_mass(cx, node, value);
        Some(value)
    })
}

fn mass(cx: &Context, node: &Node, joint: usize) -> Option<f64> {
    let mass = not_negative("mass", entry(Entry::Mass(joint)))(cx, node)?;
    lint::mass(cx, node, mass);
    Some(mass)
}

fn tensor(cx: &Context, node: &Node, joint: usize) -> Option<Inertia> {
    let element = |element| inertia_element(joint, element);
    read_mapping!(cx, node, "an inertia", {
        xx: or(0.0) "xx" element(InertiaElement::Xx),
        yy: or(0.0) "yy" element(InertiaElement::Yy),
        zz: or(0.0) "zz" element(InertiaElement::Zz),
        xy: or(0.0) "xy" element(InertiaElement::Xy),
        xz: or(0.0) "xz" element(InertiaElement::Xz),
        yz: or(0.0) "yz" element(InertiaElement::Yz),
    });
    Some(Inertia { xx, yy, zz, xy, xz, yz })
}

pub(crate) fn inertia_reference(cx: &Context, node: &Node) -> Option<InertiaReference> {
    choice(cx, node, "point of reference", &[("com", InertiaReference::Com), ("origin", InertiaReference::Origin)])
}
