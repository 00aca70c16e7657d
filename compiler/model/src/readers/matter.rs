//! Reads mass, centre of mass and inertia of a body or of a floating base, which no run-time parameter changes; and
//! checks for any link whether a physical body can have them.

use std::ops::Range;

use crate::readers::varying::fixed;
use crate::text::decode::{Context, choice, list, not_negative, read_mapping};
use crate::text::diagnostic::{Diagnostic, Remedy};
use crate::text::document::Node;
use crate::text::source::six_digits;
use crate::{Inertia, InertiaElement, InertiaReference, Link, lints, lints::single_value, parts::inertia};

pub(crate) fn mass(cx: &Context, node: &Node) -> Option<f64> {
    let mass = not_negative("mass", fixed("the mass"))(cx, node)?;
    single_value::mass(cx, node, mass);
    Some(mass)
}

pub(crate) fn com(cx: &Context, node: &Node) -> Option<[f64; 3]> {
    list(cx, node, "[x, y, z] (m)", |cx, node, _| {
        let value = fixed("the centre of mass")(cx, node)?;
        single_value::com(cx, node, value);
        Some(value)
    })
}

pub(crate) fn fixed_tensor(cx: &Context, node: &Node) -> Option<Inertia> {
    tensor(cx, node, |_| fixed("the inertia"))
}

/// Reads an inertia tensor; `element` returns the reader of each element.
pub(crate) fn tensor<R: Fn(&Context, &Node) -> Option<f64>>(
    cx: &Context,
    node: &Node,
    element: impl Fn(InertiaElement) -> R,
) -> Option<Inertia> {
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

/// Reads the key `physical`: whether the numbers must be those of a physical body.
pub(crate) fn physical(cx: &Context, node: &Node) -> Option<bool> {
    choice(cx, node, "answer", &[("true", true), ("false", false)])
}

/// Returns the place of an inertia in the file.
pub(crate) fn place_of_inertia(node: &Node) -> Range<usize> {
    ["inertia", "inertia_about"].iter().find_map(|key| node.get(key)).unwrap_or(node).head()
}

/// Moves the inertia to the centre of mass and returns the link, if a physical body can have these numbers.
pub(crate) fn link(
    cx: &Context,
    node: &Node,
    (mass, com): (f64, [f64; 3]),
    (written, about): (Inertia, InertiaReference),
    physical: bool,
) -> Option<Link> {
    let inertia = match about {
        InertiaReference::Com => written,
        InertiaReference::Origin => inertia::about_com(written, &mass, com),
    };
    let link = Link { mass, com, inertia, first_moment: [0.0; 3] };
    checked(cx, place_of_inertia(node), link, (written, about), physical)
}

/// Returns the link if a physical body can have its numbers, or if `physical` is false, so that they need not be.
pub(crate) fn checked(
    cx: &Context,
    place: Range<usize>,
    link: Link,
    (written, about): (Inertia, InertiaReference),
    physical: bool,
) -> Option<Link> {
    let Some(moments) = inertia::principal_moments(&link.inertia) else {
        let message = "the inertia about the centre of mass is not finite; mass, com and inertia are too large";
        return cx.refuse(Diagnostic::error(place, message));
    };
    let is_body = link.is_physical(&written);
    if link.has_first_moment() {
        // the reader of the first moment has reported already that this is no body
        return Some(link);
    }
    if !is_body && !physical {
        lints::inertia::unphysical(cx, place, moments);
        return Some(link);
    }
    if !is_body {
        let message = format!(
            "no body can have this inertia: its smallest principal moment about the centre of mass is {} kg m²; it \
             must be zero or positive",
            six_digits(moments[0])
        );
        let refusal = Diagnostic::error(place, message).label("not the inertia of a body").remedy(Remedy::Repair);
        return cx.refuse(refusal.help(match about {
            InertiaReference::Com => {
                "check the signs and the order of the numbers; a tensor about the origin of the link frame needs \
                 `inertia_about: origin`"
            }
            InertiaReference::Origin => {
                "check mass and com; if the tensor already refers to the centre of mass, write `inertia_about: com`"
            }
        }));
    }
    lints::inertia::triangle_inequality(cx, place.clone(), link.impossible_moments(&written), physical);
    lints::inertia::radius_of_gyration(cx, place, link.mass, moments);
    Some(link)
}
