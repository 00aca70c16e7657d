//! Mass, centre of mass and inertia that no run-time parameter changes: of a body, and of a floating base.

use crate::decode::{Context, list, not_negative, read_mapping};
use crate::diagnostic::Diagnostic;
use crate::document::Node;
use crate::source::six_digits;
use crate::varying::fixed;
use crate::{Inertia, InertiaReference, Link, inertia, lint};

/// The inertia of a file that gives none.
pub(crate) const NO_INERTIA: Inertia = Inertia { xx: 0.0, yy: 0.0, zz: 0.0, xy: 0.0, xz: 0.0, yz: 0.0 };
/// The point that an inertia refers to where the file does not say.
pub(crate) const ABOUT_COM: InertiaReference = InertiaReference::Com;

pub(crate) use crate::link::inertia_reference as reference;

pub(crate) fn mass(cx: &Context, node: &Node) -> Option<f64> {
    let mass = not_negative("mass", fixed("the mass"))(cx, node)?;
    lint::mass(cx, node, mass);
    Some(mass)
}

pub(crate) fn com(cx: &Context, node: &Node) -> Option<[f64; 3]> {
    list(cx, node, "[x, y, z] (m)", |cx, node, _| {
        let value = fixed("the centre of mass")(cx, node)?;
        lint::centre_of_mass(cx, node, value);
        Some(value)
    })
}

pub(crate) fn tensor(cx: &Context, node: &Node) -> Option<Inertia> {
    let element = |cx: &Context<'_>, node: &Node| fixed("the inertia")(cx, node);
    read_mapping!(cx, node, "an inertia", {
        xx: or(0.0) "xx" element,
        yy: or(0.0) "yy" element,
        zz: or(0.0) "zz" element,
        xy: or(0.0) "xy" element,
        xz: or(0.0) "xz" element,
        yz: or(0.0) "yz" element,
    });
    Some(Inertia { xx, yy, zz, xy, xz, yz })
}

/// The body of `node` with its inertia about the centre of mass, if its numbers are those of a body.
pub(crate) fn link(
    cx: &Context,
    node: &Node,
    (mass, com): (f64, [f64; 3]),
    (written, about): (Inertia, InertiaReference),
) -> Option<Link> {
    let place = ["inertia", "inertia_about"].iter().find_map(|key| node.get(key)).unwrap_or(node).head();
    let inertia = match about {
        InertiaReference::Com => written,
        InertiaReference::Origin => inertia::about_com(written, &mass, com),
    };
    let Some(moments) = inertia::principal_moments(&inertia) else {
        let message = "the inertia about the centre of mass is not finite; mass, com and inertia are too large";
        return cx.refuse(Diagnostic::error(place, message));
    };
    if moments[0] < -inertia::TOLERANCE * inertia::largest_magnitude(&written, mass, com) {
        let message = format!(
            "the inertia is not positive semidefinite: its smallest eigenvalue about the centre of mass is {} kg \
             m²; it must be zero or positive",
            six_digits(moments[0])
        );
        let help = "check the signs and the order of the products of inertia, and the point that the tensor \
                    refers to";
        return cx.refuse(Diagnostic::error(place, message).label("not the inertia of a body").help(help));
    }
    lint::triangle_inequality(cx, place.clone(), &inertia);
    lint::radius_of_gyration(cx, place, mass, moments);
    Some(Link { mass, com, inertia, first_moment: [0.0; 3] })
}
