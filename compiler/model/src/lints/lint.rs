//! Lints: values that are allowed and yet are probably not what was meant.
//!
//! A warning is probably a mistake, so that a build repeats it until it is dealt with. What published tables have is a
//! note: `rne check` shows it, a build does not.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Range, RangeInclusive};

use crate::angle::nearest_right_angle;
use crate::lints::resistance::{self, Unresisted};
use crate::loops::mobility::Remarks;
use crate::loops::{listed, short};
use crate::parts::inertia::principal_moments;
use crate::text::decode::Context;
use crate::text::diagnostic::{Diagnostic, Severity};
use crate::text::document::{Content, Node};
use crate::text::expression::Names as _;
use crate::text::source::{is_invisible, quoted, six_digits};
use crate::{Angle, ClosedLoop, Convention, Joint, JointKind, Limits, Link, QuarterTurns, Transform};

/// How near a right angle an angle must lie to be taken for a rounded one, rad.
const NEARLY: f64 = 2e-4;
/// No arm has a longer link, m.
const LONGEST: f64 = 20.0;
/// No link has its centre of mass farther along an axis of its frame, m.
const FARTHEST: f64 = 5.0;
/// No link has its mass farther from its centre of mass, in the mean, m.
const WIDEST_GYRATION: f64 = 2.0;
/// No arm has a heavier link, kg.
const HEAVIEST: f64 = 2000.0;
/// The sine of the angle between two axes below which their common normal may be far away.
const NEARLY_PARALLEL: f64 = 0.05;
/// Beside a length that is probably in millimetres.
const MILLIMETRES: &str = "millimetres?";
/// The range of the acceleration of gravity on Earth, generously, m/s².
const GRAVITY: RangeInclusive<f64> = 8.0..=11.0;
/// Four turns; more in a revolute joint's limits are degrees.
const WIDEST: f64 = 8.0 * PI;

/// Degrees taken for radians, and right angles that lost their exactness to rounding.
pub(crate) fn angle(cx: &Context, node: &Node, value: f64) {
    let shown = cx.shown(node, value);
    let raw = cx.raw(node);
    let literal = raw.parse::<f64>().is_ok();
    // Rounding in 2*pi itself is no reason to warn.
    if value.abs() > TAU + NEARLY {
        cx.report(
            Diagnostic::lint(node.span.clone(), format!("the angle {shown} rad is more than a full turn"))
                .label("degrees?")
                .help(format!("if these are degrees, write `deg({})`", if literal { raw } else { "…" })),
        );
        return;
    }
    let right = nearest_right_angle(value);
    if (value - right).abs() <= NEARLY && Angle::new(value).right.is_none() {
        let spelling = right_angle_spelling(right);
        let message =
            format!("the angle {shown} is {} rad off the right angle `{spelling}`", six_digits((value - right).abs()));
        cx.report(Diagnostic::lint(node.span.clone(), message).label("rounded?").help(format!(
            "write `{spelling}` if you mean this angle: its sine and cosine are exactly 0 and ±1, and the code gets \
             shorter"
        )));
    }
}

/// A multiple of a right angle as the expression one would write: `0`, `pi/2`, `-pi`, `3*pi/2`.
fn right_angle_spelling(radians: f64) -> String {
    let quarters = libm::round(radians / FRAC_PI_2);
    let sign = if quarters < 0.0 { "-" } else { "" };
    match quarters.abs() {
        0.0 => "0".to_owned(),
        1.0 => format!("{sign}pi/2"),
        2.0 => format!("{sign}pi"),
        n if n % 2.0 == 0.0 => format!("{sign}{}*pi", n / 2.0),
        n => format!("{sign}{n}*pi/2"),
    }
}

/// Characters that nobody sees, in a text of the file: two names that look alike are not the same then.
pub(crate) fn invisible(cx: &Context, node: &Node, text: &str) {
    let Some(hidden) = text.chars().find(|&c| is_invisible(c)) else { return };
    // an escape in quotes has no such character in the file
    let at = cx.text.get(node.span.clone()).and_then(|raw| raw.find(hidden)).map(|at| node.span.start + at);
    let span = at.map_or(node.span.clone(), |at| at..at + hidden.len_utf8());
    // a long text may have it far behind
    let (before, behind) = text.split_once(hidden).unwrap_or_default();
    let start = before.char_indices().rev().nth(9).map_or(0, |(start, _)| start);
    let near = before.chars().skip(before.get(..start).map_or(0, |left| left.chars().count()));
    let near: String = near.chain([hidden]).chain(behind.chars().take(10)).collect();
    let code = u32::from(hidden);
    cx.report(
        Diagnostic::lint(span, format!("the invisible character U+{code:04X} is in {}", quoted(&near)))
            .label("here, unseen")
            .help("delete this character: type the word again instead of pasting it"),
    );
}

/// Gravity of another size than on Earth.
pub(crate) fn gravity(cx: &Context, node: &Node, [x, y, z]: [f64; 3]) {
    // neither a square nor the sum of two numbers overflows in what is shown
    let size = libm::hypot(libm::hypot(x, y), z).min(f64::MAX);
    if size != 0.0 && !GRAVITY.contains(&size) {
        let message = format!("gravity accelerates by {} m/s²; on Earth it is 9.81 m/s²", six_digits(size));
        let label = if GRAVITY.contains(&(size / 1000.0)) {
            "millimetres?"
        } else if GRAVITY.contains(&(size * 9.81)) {
            "in multiples of g?"
        } else {
            "another planet?"
        };
        cx.report(
            Diagnostic::lint(node.span.clone(), message)
                .label(label)
                .help("gravity is an acceleration in m/s², such as `[0, 0, -9.81]`; without gravity write `[0, 0, 0]`"),
        );
    }
}

/// Gravity that points up, in frame 0 and in the world: a sign, unless the arm hangs.
pub(crate) fn gravity_upwards(cx: &Context, node: &Node, [x, y, z]: [f64; 3], base: &Transform) {
    let [roll, pitch, _] = base.rpy;
    let up = -pitch.sin * x + pitch.cos * (roll.sin * y + roll.cos * z);
    if x == 0.0 && y == 0.0 && z > 0.0 && up > 0.0 {
        let message = format!("gravity {} points along the positive z axis of frame 0", quoted(cx.raw(node)));
        cx.report(Diagnostic::lint(node.span.clone(), message).label("upwards?").help(format!(
            "the acceleration of gravity points down: do you mean `[0, 0, {}]`? If z of frame 0 points down, as in an \
             arm that hangs from the ceiling, write `base: {{rpy: [pi, 0, 0]}}`",
            six_digits(-z)
        )));
    }
}

/// Millimetres taken for metres, in a centre of mass.
pub(crate) fn com(cx: &Context, node: &Node, value: f64) {
    if value.abs() > FARTHEST {
        let shown = cx.shown(node, value);
        let message = format!("the centre of mass lies {shown} m from the origin of the link frame, over {FARTHEST} m");
        millimetres(cx, node, message);
    }
}

/// Warns of millimetres, where the parameter is defined if the number is one.
fn millimetres(cx: &Context, node: &Node, message: String) {
    let place = cx.parameters.borrow().get(cx.raw(node)).map_or(node.span.clone(), |it| it.value.clone());
    let written = cx.text.get(place.clone()).filter(|text| text.parse::<f64>().is_ok());
    let help = written.map_or_else(String::new, |number| format!(": if it is in millimetres, write `mm({number})`"));
    cx.report(Diagnostic::lint(place, message).label(MILLIMETRES).help(format!("lengths are in metres{help}")));
}

/// Millimetres taken for metres.
pub(crate) fn length(cx: &Context, node: &Node, value: f64) {
    if value.abs() > LONGEST {
        millimetres(cx, node, format!("the length {} m is over {LONGEST} m", cx.shown(node, value)));
    }
}

/// Frames that are far away because axes are nearly parallel, and not because lengths are in millimetres: then common
/// normals are short.
pub(crate) fn nearly_parallel(cx: &Context, joints: &[Joint]) {
    let is_tilted = |joint: &Joint| (1e-15..NEARLY_PARALLEL).contains(&joint.row.dh.alpha.sin.abs());
    if !joints.iter().any(is_tilted) || joints.iter().any(|joint| joint.row.dh.a.abs() > LONGEST) {
        return;
    }
    let far = joints.iter().enumerate().filter_map(|(index, joint)| {
        let [x, y, z] = joint.row.link.com;
        let distance = libm::hypot(libm::hypot(x, y), z);
        (distance > FARTHEST)
            .then(|| format!(" The centre of mass of link {} is {} m away.", index + 1, short(distance)))
    });
    let help = format!(
        "axes are nearly parallel, so that their common normal is far from the arm.{} Such frames lose digits in \
         single precision (f32), most of all in code of the form `seven_steps`. The key `at` (format 2) places a \
         joint where it is, without a common normal",
        far.collect::<String>()
    );
    cx.problems.relabel(MILLIMETRES, "far from the arm", &help);
}

/// Grams taken for kilograms.
pub(crate) fn mass(cx: &Context, node: &Node, value: f64) {
    if value > HEAVIEST {
        let message = format!("the mass {} kg is over {HEAVIEST} kg", cx.shown(node, value));
        cx.report(Diagnostic::lint(node.span.clone(), message).label("grams?").help("masses are in kilograms"));
    }
}

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
    let Some(Content::Sequence(items)) = root.get("joints").map(|node| &node.content) else { return };
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

/// Links at least, and a part of those with mass, that are alike where an exporter wrote placeholders.
const ALIKE: usize = 3;
const PART_ALIKE: usize = 2;

/// Masses and moments that differ by a smaller part of themselves are the same.
const SAME: f64 = 1e-6;

/// Links with the same mass and the same ball for an inertia: what exporters write where CAD knows no material.
pub(crate) fn placeholders(cx: &Context, root: &Node, joints: &[Joint]) {
    let Some(Content::Sequence(items)) = root.get("joints").map(|node| &node.content) else { return };
    let is_same = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
    let ball = |joint: &Joint| {
        let [least, _, most] = principal_moments(&joint.row.link.inertia)?;
        (joint.row.link.mass > 0.0 && most > 0.0 && is_same(least, most)).then_some((joint.row.link.mass, most))
    };
    let balls: Vec<Option<(f64, f64)>> = joints.iter().map(ball).collect();
    let with_mass = joints.iter().filter(|joint| joint.row.link.mass > 0.0).count();
    cx.count(joints.len() * joints.len());
    for (first, of) in balls.iter().enumerate() {
        let Some((mass, moment)) = *of else { continue };
        let is_like =
            |other: &&Option<(f64, f64)>| other.is_some_and(|of| is_same(of.0, mass) && is_same(of.1, moment));
        let alike = balls.iter().filter(is_like).count();
        if alike < ALIKE || PART_ALIKE * alike < with_mass {
            continue;
        }
        let place = items.get(first).and_then(|item| item.get("link")).unwrap_or(root).head();
        let message = format!(
            "{alike} of {with_mass} links with mass have {} kg and {} kg m² about every axis",
            six_digits(mass),
            six_digits(moment)
        );
        cx.report(Diagnostic::lint(place, message).label("are these placeholders of an exporter?").help(
            "real links differ, and with placeholders the torques are not those of the arm; take masses, centres of \
             mass and inertias from the manufacturer, or identify them from a log",
        ));
        return;
    }
}

/// Joints with friction at least, beside which one without friction was probably forgotten.
const WITH_FRICTION: usize = 2;

/// One joint without a key of friction where all others have one. Joints that follow others or share motors have their
/// friction elsewhere.
pub(crate) fn missing_friction(cx: &Context, root: &Node) {
    let Some(Content::Sequence(items)) = root.get("joints").map(|node| &node.content) else { return };
    if ["couplings", "motors", "loops"].iter().any(|key| root.has_entries(key)) {
        return;
    }
    let has_friction = |item: &Node| {
        item.get("motor").is_some_and(|motor| ["viscous", "coulomb"].iter().any(|key| motor.get(key).is_some()))
    };
    let mut without = items.iter().enumerate().filter(|(_, item)| !has_friction(item));
    let (Some((index, item)), None) = (without.next(), without.next()) else { return };
    if items.len() <= WITH_FRICTION {
        return;
    }
    let message = format!("joint {} has no friction, but all other joints have", index + 1);
    cx.report(
        Diagnostic::note(item.get("motor").unwrap_or(item).head(), message).label("forgotten?").help(
            "add `viscous` and `coulomb` to its `motor`; if the joint has no friction, write `motor: {viscous: 0}`",
        ),
    );
}

/// Numbers of joints of arms that are built in similar proportions. Textbooks have shorter arms of any mass, and longer
/// ones are slender.
const PROPORTIONATE: RangeInclusive<usize> = 4..=7;

/// Mass of an arm per cube of its reach, kg/m³, below which masses are probably missing: half of what the lightest
/// shipped arm has. Arms of similar proportions weigh in proportion to the cube of their reach. The shipped arms have
/// 2.9 (KUKA KR 5) to 22 kg/m³; a URDF of the KUKA KR 120, which weighs a tonne, has 0.5: 2 kg for each link.
const LIGHTEST: f64 = 1.25;

/// A sum of masses that is small for the reach: the longest way along the links, and along the axes of sliding joints.
pub(crate) fn light_for_reach(cx: &Context, root: &Node, joints: &[Joint]) {
    // mass that was moved to other links says nothing about the arm
    if !PROPORTIONATE.contains(&joints.len()) || joints.iter().any(|joint| joint.row.link.has_first_moment()) {
        return;
    }
    let reach = |joint: &Joint| {
        let travel = joint.limits.position.filter(|_| joint.row.kind == JointKind::Prismatic);
        let travel = travel.map_or(0.0, |(lower, upper)| lower.abs().max(upper.abs()));
        libm::hypot(joint.row.dh.a, joint.row.dh.d) + travel
    };
    // such a length is in millimetres, and a lint says so
    if joints.iter().any(|joint| joint.row.dh.a.abs().max(joint.row.dh.d.abs()) > LONGEST) {
        return;
    }
    let (mass, reach) =
        joints.iter().fold((0.0, 0.0), |(mass, length), joint| (mass + joint.row.link.mass, length + reach(joint)));
    if mass <= 0.0 || !reach.is_finite() || mass >= LIGHTEST * reach * reach * reach {
        return;
    }
    let place = root.get("joints").unwrap_or(root).head();
    let rounded = |x: f64, per: f64| six_digits(libm::round(x * per) / per);
    let message = format!(
        "all links together have {} kg, which is little for an arm with a reach of {} m",
        six_digits(mass),
        rounded(reach, 100.0)
    );
    let expected = rounded(LIGHTEST * reach * reach * reach, 10.0);
    cx.report(Diagnostic::lint(place, message).label("are masses missing?").help(format!(
        "real arms of this reach have more than {expected} kg ({LIGHTEST} kg per cubic metre of reach); take the \
         masses from the manufacturer, or identify the links from a log; if the arm is really so light, ignore this"
    )));
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

/// Degrees in the position limits of a revolute joint.
pub(crate) fn position_limits(cx: &Context, position: &Node, kind: JointKind, limits: &Limits) {
    let Some((lower, upper)) = limits.position.filter(|_| kind == JointKind::Revolute) else { return };
    if lower.abs().max(upper.abs()) > WIDEST {
        let message = format!("the position limits {} rad are more than four turns", quoted(cx.raw(position)));
        cx.report(Diagnostic::lint(position.span.clone(), message).label("degrees?").help(format!(
            "if these are degrees, write `[deg({}), deg({})]`",
            six_digits(lower),
            six_digits(upper)
        )));
    }
}

/// A speed about which friction changes its sign, beside a displacement over which it does.
pub(crate) fn width_beside_displacement(cx: &Context, width: &Node) {
    let message = "rne ignores `coulomb_width` because `coulomb_displacement` is given: the friction then changes its \
                   sign over the displacement, and not with the speed";
    cx.report(Diagnostic::lint(width.head(), message).label("not used").help("keep only one of the two keys"));
}

/// Closed loops that were found closed in few configurations, and singular ones within the limits.
pub(crate) fn closed_loops(cx: &Context, item: &Node, joints: &[Joint], loops: &[ClosedLoop], remarks: &Remarks) {
    let place = item.get("dependent").unwrap_or(item).head();
    if let Some((found, wanted)) = remarks.few {
        let message = format!("{found} of {wanted} configurations that close the loops were found");
        let help = "if position limits leave the loops more room than this, check the lengths";
        cx.report(Diagnostic::note(place.clone(), message).label("few configurations").help(help));
    }
    for closed in remarks.rigid.iter().filter_map(|&index| loops.get(index)) {
        let message = format!("the loop {} cannot move: all joints that move it are dependent", quoted(&closed.name));
        let help = "if it should move, check its lengths and axes; if it is a rigid frame, weld its links to one";
        cx.report(Diagnostic::lint(place.clone(), message).label("rigid").help(help));
    }
    if remarks.beyond {
        let message = "no configuration within the position limits was found that closes the loops";
        let help = "check the position limits of the joints of the loops, and the lengths";
        cx.report(Diagnostic::lint(place.clone(), message).label("beyond the limits").help(help));
    }
    // what rounding leaves of a zero
    let rounded = |position: f64| short(if position.abs() < 1e-9 { 0.0 } else { position });
    let at = |positions: &[f64]| {
        let shown = remarks.joints.iter().take(8);
        let shown = shown.map(|&joint| format!("{} = {}", joints[joint].name, rounded(positions[joint])));
        shown.collect::<Vec<_>>().join(", ")
    };
    if let Some((ratio, positions)) = &remarks.singular {
        let message = format!(
            "near {}, the other joints hardly determine {}: the smallest singular value of the equations is {} of the \
             largest there",
            at(positions),
            listed(joints, &remarks.undetermined),
            short(*ratio)
        );
        let help =
            "narrow the position limits so that the robot keeps away from there, or choose other dependent joints";
        cx.report(Diagnostic::note(place, message).label("a singular configuration").help(help));
    } else if let Some((ratio, positions)) = &remarks.pivot {
        let message = format!(
            "a pivot of the equations of the loops is {} of their largest singular value near {}: the order of \
             elimination is fixed",
            short(*ratio),
            at(positions)
        );
        let help = "narrow the position limits so that the robot keeps away from there";
        cx.report(Diagnostic::note(place, message).label("a small pivot").help(help));
    }
}

/// Parameters that no number uses; of a run-time parameter that is an error.
pub(crate) fn unused_parameters(cx: &Context) {
    for (name, parameter) in cx.parameters.borrow().iter().filter(|(_, parameter)| !parameter.used.get()) {
        if cx.run_time_index(name).is_some() {
            continue;
        }
        let message = format!("the parameter {} is never used", quoted(name));
        cx.report(Diagnostic::lint(parameter.span.clone(), message).label("unused").help("delete it, or use it"));
    }
}
