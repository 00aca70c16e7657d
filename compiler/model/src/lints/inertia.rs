//! Warnings about masses and inertias: values that no physical body has, and joints that no inertia resists.

use std::ops::Range;

use crate::lints::resistance;
use crate::lints::resistance::Unresisted;
use crate::text::decode::Context;
use crate::text::diagnostic::{Diagnostic, Remedy, Severity};
use crate::text::document::Node;
use crate::text::expression::Names as _;
use crate::text::source::six_digits;
use crate::{Convention, Joint, JointKind, Link, QuarterTurns};

/// Largest plausible radius of gyration of a link, m.
const WIDEST_GYRATION: f64 = 2.0;

/// The part of the largest moment by which numbers of three digits may violate the rules for physical bodies, also
/// after an import has rotated the tensor.
const ROUNDED: f64 = 0.02;

/// Reports an inertia that violates the triangle inequality of principal moments: no distribution of mass has it.
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
            "is one number wrong by a power of ten, or are two exchanged? To use the numbers of a published table as \
             they are, write `physical: false`"
        } else {
            "rne computes with these numbers, as `physical: false` allows"
        };
        let lint = Diagnostic::lint(place, message).label("violates the triangle inequality").help(help);
        let lint = if is_known { lint } else { lint.remedy(Remedy::Repair) };
        cx.report(Diagnostic { severity, ..lint });
    }
}

/// Notes a first moment without mass in a file that declares it with `physical: false`.
pub(crate) fn first_moment_without_mass(cx: &Context, moment: &Node) {
    let message = "the link has a first moment but no mass, as `physical: false` allows: no real body is like this, \
                   but a set of base parameters can be";
    cx.report(Diagnostic::note(moment.head(), message).label("the mass is 0").help(
        "every function accepts this link; if mass was moved between links (regrouping), the torques and the mass \
         matrix are right, but the forces between links and the centre of mass are not those of the arm",
    ));
}

/// Reports a negative principal moment in a file that declares it with `physical: false`.
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
    // a small negative moment may be due to rounding, such as for a thin rod whose inertia has few digits
    let severity = if -smallest <= ROUNDED * largest { Severity::Note } else { Severity::Warning };
    cx.report(Diagnostic { severity, ..lint });
}

/// Warns of an inertia in grams or millimetres: its radius of gyration is larger than that of any link.
pub(crate) fn radius_of_gyration(cx: &Context, place: Range<usize>, mass: f64, [.., largest]: [f64; 3]) {
    if mass <= 0.0 || largest <= 0.0 {
        return;
    }
    let radius = libm::sqrt(largest / mass);
    if radius > WIDEST_GYRATION {
        let (mass, shown) = (six_digits(mass), six_digits(radius));
        let message = format!(
            "the inertia has a radius of gyration of {shown} m, as if all of the {mass} kg were {shown} m from the \
             centre of mass"
        );
        // numbers in g mm² make the radius sqrt(1e9) times too large, numbers in kg mm² sqrt(1e6) times
        let label = if radius > 1000.0 * WIDEST_GYRATION { "g mm²?" } else { "kg mm²?" };
        let help = "inertias are in kg m²: 1 kg mm² is 1e-6 kg m², 1 g mm² is 1e-9 kg m²";
        cx.report(Diagnostic::lint(place, message).label(label).help(help).remedy(Remedy::Repair));
    }
}

/// Checks the inertias of all joints together: joints that nothing resists, and masses whose inertia is forgotten.
///
/// The joints `of_loops` are not reported as unresisted: closed loops move other joints together with them, whose
/// inertia resists them.
pub(crate) fn inertias(cx: &Context, root: &Node, convention: Convention, joints: &[Joint], of_loops: &[usize]) {
    let items = root.list("joints");
    // a floating base always has a key for its mass
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
            // for a sliding joint this message asks for the missing mass, so it comes first
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

/// Warns of a floating base that no inertia resists: the links that its joints carry must resist it in every direction.
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

/// Reports a joint that moves without any torque or force, so that the mass matrix is singular.
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
        // real arms with light wrists are like this; with the inertia of its rotor the joint is no mistake
        let message = format!("no link's inertia resists joint {number}, only the rotor of its motor does");
        let help = format!("for results without rotors, give link {number} {missing}, {consequence}");
        cx.report(Diagnostic::note(place, message).label("resists nothing").help(help));
        return;
    }
    let help = format!("give link {number} {missing}, {consequence}");
    cx.report(Diagnostic::lint(place, message).label("resists nothing").help(help));
}

/// Warns of a link that has a centre of mass but no key `mass`, and returns whether it is so. An inertia without mass
/// causes no warning: published tables have it for light links.
fn centre_without_mass(cx: &Context, item: &Node, index: usize, joint: &Joint) -> bool {
    let is_centre = joint.row.link.com != [0.0; 3];
    let Some(link) = item.get("link").filter(|link| is_centre && link.get("mass").is_none()) else { return false };
    let Some(com) = link.get("com") else { return false };
    cx.report(
        Diagnostic::lint(com.head(), format!("link {} has a centre of mass but no mass", index + 1))
            .label("the mass is missing")
            .help("add the `mass` in kg; if the link is without mass, delete `com`"),
    );
    true
}

/// Warns of a link with a mass but without a key `inertia`.
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
