//! Lints of masses and inertias: those that no body has, and joints that none resists.

use std::ops::Range;

use crate::lints::resistance;
use crate::lints::resistance::Unresisted;
use crate::text::decode::Context;
use crate::text::diagnostic::{Diagnostic, Severity};
use crate::text::document::Node;
use crate::text::expression::Names as _;
use crate::text::source::six_digits;
use crate::{Convention, Joint, JointKind, Link, QuarterTurns};

/// No link has its mass farther from its centre of mass, in the mean, m.
const WIDEST_GYRATION: f64 = 2.0;

/// The part of the largest moment by which numbers of three digits may violate what holds of bodies, after the import
/// has turned them, too.
const ROUNDED: f64 = 0.02;

/// An inertia that no distribution of mass has.
pub(crate) fn triangle_inequality(cx: &Context, place: Range<usize>, moments: Option<[f64; 3]>, physical: bool) {
    if let Some([a, b, c]) = moments {
        let message = format!(
            "no body can have this inertia: of the principal moments {}, {} and {} kg m², the largest is more than the \
             sum of the two others",
            six_digits(a),
            six_digits(b),
            six_digits(c)
        );
        let is_known = !physical || c - (a + b) <= ROUNDED * c;
        let severity = if is_known { Severity::Note } else { Severity::Warning };
        let help = if physical {
            "is one number wrong by a power of ten, or are two exchanged? Correct it; to keep the numbers of a \
             published \
             table, with which rne computes, write `physical: false`"
        } else {
            "rne computes with these numbers, as `physical: false` allows"
        };
        let lint = Diagnostic::lint(place, message).label("violates the triangle inequality").help(help);
        cx.report(Diagnostic { severity, ..lint });
    }
}

/// A first moment without mass in a file that knows it.
pub(crate) fn first_moment_without_mass(cx: &Context, moment: &Node) {
    let message = "the link has a first moment but no mass, as `physical: false` allows: no real body is like this, \
                   but a set of base parameters can be";
    cx.report(Diagnostic::note(moment.head(), message).label("the mass is 0").help(
        "every function accepts this link; if mass was moved between links (regrouping), the torques and the mass \
         matrix are right, but the forces between links and the centre of mass are not those of the arm",
    ));
}

/// A negative principal moment in a file that knows it.
pub(crate) fn unphysical(cx: &Context, place: Range<usize>, [smallest, _, largest]: [f64; 3]) {
    let message = format!(
        "the inertia is not positive semidefinite, as `physical: false` allows: its smallest eigenvalue about the \
         centre of mass is {} kg m²",
        six_digits(smallest)
    );
    let lint = Diagnostic::lint(place, message).label("not the inertia of a body").help(
        "inverse dynamics accepts this inertia; if the mass matrix is not positive definite, forward dynamics cannot \
         be computed",
    );
    // the inertia of a rod, say, of few digits
    let severity = if -smallest <= ROUNDED * largest { Severity::Note } else { Severity::Warning };
    cx.report(Diagnostic { severity, ..lint });
}

/// Grams or millimetres in an inertia: no link has its mass so far out.
pub(crate) fn radius_of_gyration(cx: &Context, place: Range<usize>, mass: f64, [.., largest]: [f64; 3]) {
    if mass <= 0.0 || largest <= 0.0 {
        return;
    }
    let radius = libm::sqrt(largest / mass);
    if radius > WIDEST_GYRATION {
        let (mass, shown) = (six_digits(mass), six_digits(radius));
        let message = format!(
            "the inertia has a radius of gyration of {shown} m: this is as if the {mass} kg of the link were this far \
             away from its centre of mass"
        );
        // sqrt(1e6) and sqrt(1e9): of the units that CAD programs have
        let label = if radius > 1000.0 * WIDEST_GYRATION { "g mm²?" } else { "kg mm²?" };
        let help = "inertias are in kg m²: 1 kg mm² is 1e-6 kg m², 1 g mm² is 1e-9 kg m²";
        cx.report(Diagnostic::lint(place, message).label(label).help(help));
    }
}

/// Checks the joints' inertias together: joints that nothing resists, and masses whose inertia is forgotten.
///
/// The joints `of_loops` are moved by closed loops, too, and inertia behind these resists them.
pub(crate) fn inertias(cx: &Context, root: &Node, convention: Convention, joints: &[Joint], of_loops: &[usize]) {
    let items = root.list("joints");
    // a base that floats has a mass
    let is_geometry = root.get("floating_base").is_none();
    if is_geometry
        && joints.iter().all(|joint| joint.row.link.is_empty() && joint.motor.is_none_or(|motor| motor.inertia == 0.0))
    {
        let place = root.get("joints").unwrap_or(root).head();
        cx.report(
            Diagnostic::lint(place, "no link has a mass or an inertia: the file has the geometry only")
                .label("links without mass")
                .help(
                    "kinematics need no masses; for torques, add `link: {mass: …, com: …, inertia: …}` to each joint, \
                     or identify the links from a log of the arm",
                ),
        );
        return;
    }
    cx.count(joints.len() * joints.len() * joints.len());
    let unresisted = resistance::unresisted(convention, joints);
    let mut turns = false;
    for (index, ((item, joint), unresisted)) in items.iter().zip(joints).zip(unresisted).enumerate() {
        turns |= joint.row.kind == JointKind::Revolute;
        let unresisted = unresisted.filter(|_| !of_loops.contains(&index));
        match unresisted {
            // which asks for the mass of a sliding joint
            Some(unresisted) if joint.row.kind == JointKind::Prismatic => {
                no_resistance(cx, item, convention, (index, joint), unresisted);
            }
            _ if centre_without_mass(cx, item, index, joint) => {}
            Some(unresisted) => no_resistance(cx, item, convention, (index, joint), unresisted),
            None if turns => mass_without_inertia(cx, item, index, joint),
            None => {}
        }
    }
}

/// A floating base that no inertia resists: what its joints carry must resist it in every direction.
pub(crate) fn floating_inertia(cx: &Context, root: &Node, base: &Link, convention: Convention, joints: &[Joint]) {
    // joints that follow others do not move freely
    if joints.iter().any(|joint| joint.coupling.is_some()) {
        return;
    }
    cx.count((joints.len() + 6).pow(3));
    if resistance::base_is_unresisted(convention, joints, base) {
        let place = root.get("floating_base").and_then(|node| node.get("link")).unwrap_or(root);
        let place = place.get("mass").unwrap_or(place).head();
        let message = "no inertia resists the floating base when the joints move against it: in some direction, the \
                       base then moves without any force or moment";
        let help = "give this link its mass and inertia, or accelerations (`floating_forward_dynamics`, \
                    `forward_dynamics_in_contact`) mean nothing";
        cx.report(Diagnostic::lint(place, message).label("resists nothing").help(help));
    }
}

/// A joint that moves without any torque or force: the mass matrix is singular.
fn no_resistance(
    cx: &Context,
    item: &Node,
    convention: Convention,
    (index, joint): (usize, &Joint),
    unresisted: Unresisted,
) {
    let number = index + 1;
    let (key, missing) = match (joint.row.kind, convention, joint.row.dh.alpha.right) {
        (JointKind::Prismatic, ..) => ("mass", format!("a mass: `link: {{mass: …}}` of joint {number}")),
        (_, Convention::Modified, _) | (_, _, Some(QuarterTurns::Zero | QuarterTurns::Two)) => {
            ("inertia", format!("inertia about the axis of joint {number}, its z axis: `inertia: {{zz: …}}`"))
        }
        (_, _, Some(QuarterTurns::One | QuarterTurns::Three)) => {
            ("inertia", format!("inertia about the axis of joint {number}, its y axis: `inertia: {{yy: …}}`"))
        }
        _ => ("inertia", format!("inertia about the axis of joint {number}")),
    };
    let place = item.get("link").unwrap_or(item);
    let place = [key, "mass"].iter().find_map(|key| place.get(key)).unwrap_or(place).head();
    let message = match unresisted {
        Unresisted::Alone => format!("no inertia resists joint {number}: it moves without any torque or force"),
        Unresisted::WithOthers => {
            format!(
                "no inertia resists joint {number} when the joints after it move against it: the joint then moves \
                 without any torque or force"
            )
        }
    };
    let consequence = "or accelerations (`forward_dynamics`) are not finite";
    if joint.motor.is_some_and(|motor| motor.inertia > 0.0) {
        // what real arms with light wrists have; with its rotor the joint is in order
        let message = format!("no link's inertia resists joint {number}, only the rotor of its motor does");
        let help = format!("for results without rotors, give link {number} {missing}, {consequence}");
        cx.report(Diagnostic::note(place, message).label("resists nothing").help(help));
        return;
    }
    let help = format!("give link {number} {missing}, {consequence}");
    cx.report(Diagnostic::lint(place, message).label("resists nothing").help(help));
}

/// A centre of mass of a link whose mass is not even said to be zero; whether there is one. An inertia without mass is
/// what published tables give of light links.
fn centre_without_mass(cx: &Context, item: &Node, index: usize, joint: &Joint) -> bool {
    let is_centre = joint.row.link.com != [0.0; 3];
    let Some(link) = item.get("link").filter(|link| is_centre && link.get("mass").is_none()) else { return false };
    let Some(com) = link.get("com") else { return false };
    cx.report(
        Diagnostic::lint(com.head(), format!("link {} has a centre of mass but no mass", index + 1))
            .label("the mass is missing")
            .help("add the `mass` in kg; if the link is without mass, write `mass: 0`"),
    );
    true
}

/// A mass whose inertia is not even said to be zero.
fn mass_without_inertia(cx: &Context, item: &Node, index: usize, joint: &Joint) {
    let Some(link) = item.get("link").filter(|link| link.get("inertia").is_none()) else { return };
    let Some(mass) = link.get("mass").filter(|_| joint.row.link.mass > 0.0) else { return };
    let message = format!("link {} has the mass {} kg and no inertia", index + 1, cx.shown(mass, joint.row.link.mass));
    cx.report(
        Diagnostic::lint(mass.head(), message)
            .label("a point mass?")
            .help("add the `inertia` about the centre of mass, kg m²; if a point mass is meant, write `inertia: {}`"),
    );
}
