//! Lints of one link or joint, with the rows next to it.

use std::ops::RangeInclusive;

use crate::parts::inertia::{about_com, principal_moments};
use crate::parts::pose::{axis_on_link, dot, link_behind_axis};
use crate::robot::parent;
use crate::text::decode::Context;
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::expression::Names as _;
use crate::text::source::six_digits;
use crate::{Convention, InertiaReference, Joint, JointKind, QuarterTurns};

/// A link is long if it has at least this part of the mean length of the rows. Short links, such as those of wrists,
/// have their centre of mass anywhere.
const LONG: f64 = 0.4;

/// How far a centre of mass is beyond the end where `com` is zero, in lengths of the link, if it was measured from the
/// other end or has a wrong sign. Of 440 long links of shipped robots and of published URDFs, only a gripper behind the
/// last roll axis is in this range.
const BEYOND: RangeInclusive<f64> = 0.25..=1.1;

/// Largest distance from the line through both ends, in lengths of the link: a body farther away is mounted beside it.
const BESIDE: f64 = 0.6;

/// Least distance of a centre of mass from the link frame, in lengths of the link, at which m c² is noticed.
const FAR: f64 = 0.35;

/// A radius of gyration shrinks to this part or less if m c² is subtracted from a tensor about the origin.
const SHRUNK: f64 = 0.65;

/// Speeds of a revolute joint that are taken for degrees per second, rad/s. The fastest shipped arm has 25.2 rad/s;
/// files without a known limit have 1000 and more.
const DEGREES: RangeInclusive<f64> = 30.0..=999.0;

/// Sine of the angle between two joint axes below which they count as parallel.
const PARALLEL: f64 = 0.1;

/// Reports what is probably wrong with single links and joints.
pub(crate) fn links(cx: &Context, root: &Node, convention: Convention, joints: &[Joint]) {
    #[allow(clippy::cast_precision_loss)] // few joints
    let mean = joints.iter().map(|it| libm::hypot(it.row.dh.a, it.row.dh.d)).sum::<f64>() / joints.len() as f64;
    let is_chain = joints.iter().all(|joint| joint.branch.is_none());
    // each link searches the joints that it carries
    cx.count(joints.len() * joints.len());
    for (index, (item, joint)) in root.list("joints").iter().zip(joints).enumerate() {
        small_gear_ratio(cx, item, joint);
        speed_and_effort(cx, item, joint, is_chain);
        let Some(link) = item.get("link") else { continue };
        massless_centre(cx, link, index, joint);
        // a link that is no body has mass of other links; a cut joint of a loop is one more end of a link
        if joint.row.link.mass == 0.0 || link.get("physical").is_some() || root.has_entries("loops") {
            continue;
        }
        let Some(along) = along(convention, joints, index) else { continue };
        let length = libm::sqrt(dot(along, along));
        if length > 0.0 && length >= LONG * mean {
            centre_beyond_end(cx, link, convention, (index, joint), (along, length));
            about_origin(cx, link, (index, joint), length);
        }
    }
    if is_chain {
        other_convention(cx, root, convention, joints);
    }
}

/// Returns the vector from the near end to the far end of a link, in link axes, if its joints determine both ends: the
/// frame of a prismatic joint may be anywhere, and that of the last or of a parallel axis anywhere along the axis.
fn along(convention: Convention, joints: &[Joint], link: usize) -> Option<[f64; 3]> {
    let carried: Vec<usize> = (0..joints.len()).filter(|&joint| parent(joints, joint) == Some(link)).collect();
    if carried.iter().chain([&link]).any(|&joint| joints[joint].row.kind == JointKind::Prismatic) {
        return None;
    }
    let (row, along) = match convention {
        Convention::Standard => {
            let end = link_behind_axis(joints, convention, link, 0.0);
            (link, [0, 1, 2].map(|axis| dot(end.axis(axis), end.translation)))
        }
        Convention::Modified => {
            let [joint] = carried[..] else { return None };
            let (d, start) = (joints[joint].row.dh.d, axis_on_link(joints, convention, joint));
            (joint, [0, 1, 2].map(|i| start.translation[i] + d * start.axis(2)[i]))
        }
    };
    let dh = &joints[row].row.dh;
    let is_bent = !carried.is_empty() && dh.alpha.sin.abs() > PARALLEL;
    (is_bent || 2.0 * dh.a * dh.a > dot(along, along)).then_some(along)
}

/// Warns of a centre of mass that lies beyond the end of its link, and would not with the other sign or from the other
/// end. Counterweights lie beyond the near end: this is a mistake only where `com` is measured from there.
fn centre_beyond_end(
    cx: &Context,
    link: &Node,
    convention: Convention,
    (index, joint): (usize, &Joint),
    (along, length): ([f64; 3], f64),
) {
    let com = joint.row.link.com;
    let part = dot(com, along) / (length * length);
    let (beyond, [end, other], away) = match convention {
        Convention::Standard => (part, ["far", "near"], -1.0),
        Convention::Modified => (-part, ["near", "far"], 1.0),
    };
    let minus = |by: f64| [0, 1, 2].map(|i| com[i] - by * along[i]);
    let beside = minus(part);
    let Some(place) = link.get("com").or_else(|| link.get("first_moment")) else { return };
    if !BEYOND.contains(&beyond) || dot(beside, beside) > (BESIDE * length) * (BESIDE * length) {
        return;
    }
    let message = format!(
        "the centre of mass of link {} lies {} m beyond the {end} end of the link, which is {} m long",
        index + 1,
        six_digits(beyond * length),
        six_digits(length)
    );
    // rounding errors are shown as 0
    let written = |com: [f64; 3]| {
        let shown = com.map(|x| if x.abs() < 1e-9 * length { "0".to_owned() } else { six_digits(x) });
        format!("`com: [{}]`", shown.join(", "))
    };
    let (mirrored, moved) = (written(minus(2.0 * part)), written(minus(-away)));
    let repair = if mirrored == moved {
        format!("if its sign is wrong, or if you measured from the {other} end, write {moved}")
    } else {
        format!("if its sign is wrong, write {mirrored}; if you measured from the {other} end, write {moved}")
    };
    cx.report(Diagnostic::lint(place.head(), message).label("beyond the end").help(format!(
        "in a `{}` table, `com` is measured from the {end} end of the link; {repair}; if the centre of mass is really \
         there, ignore this",
        convention.name()
    )));
}

/// Notes a tensor about the centre of mass that is large, and would be the tensor of a smaller body if it were about
/// the origin of the link frame.
fn about_origin(cx: &Context, link: &Node, (index, joint): (usize, &Joint), length: f64) {
    let own = &joint.row.link;
    let is_far = dot(own.com, own.com) >= (FAR * length) * (FAR * length);
    let Some(place) = link.get("inertia").filter(|_| is_far) else { return };
    let smaller = about_com(own.inertia, &own.mass, own.com);
    let (Some([.., most]), Some([a, b, c])) = (principal_moments(&own.inertia), principal_moments(&smaller)) else {
        return;
    };
    let is_body = a >= 0.0 && c <= a + b;
    if joint.written_inertia.1 != InertiaReference::Com || !is_body || c > SHRUNK * SHRUNK * most {
        return;
    }
    let radius = |moment: f64| six_digits(libm::sqrt(moment / own.mass));
    let message = format!(
        "the inertia of link {} has a radius of gyration of {} m; if it is about the origin of the link frame, this \
         radius is {} m",
        index + 1,
        radius(most),
        radius(c)
    );
    cx.report(Diagnostic::note(place.head(), message).label("about the origin?").help(
        "rne takes this inertia about the centre of mass; if the source gives it about the origin of the link frame, \
         write `inertia_about: origin`",
    ));
}

/// Notes a centre of mass of a link whose mass is written as 0.
fn massless_centre(cx: &Context, link: &Node, index: usize, joint: &Joint) {
    let own = &joint.row.link;
    let Some(com) = link.get("com").filter(|_| own.mass == 0.0 && own.com != [0.0; 3]) else { return };
    if link.get("mass").is_some() {
        let message = format!("link {} has the mass 0, so its centre of mass has no effect", index + 1);
        let help = "write the `mass` of the link in kg; if the link is without mass, delete `com`";
        cx.report(Diagnostic::note(com.head(), message).label("no effect").help(help));
    }
}

/// Warns of a motor with a rotor that turns slower than its joint.
fn small_gear_ratio(cx: &Context, item: &Node, joint: &Joint) {
    let Some(motor) = joint.motor.filter(|motor| motor.inertia > 0.0 && motor.gear_ratio.abs() < 1.0) else { return };
    let Some(node) = item.get("motor").and_then(|motor| motor.get("gear_ratio")) else { return };
    let ratio = cx.shown(node, motor.gear_ratio);
    let message = format!("the gear ratio {ratio} is below 1: the motor turns slower than the joint");
    cx.report(Diagnostic::lint(node.span.clone(), message).label("inverted?").help(format!(
        "`gear_ratio` is motor turns per joint turn, or rad/m for a prismatic joint; if this is joint turns per motor \
         turn, write `gear_ratio: {}`",
        six_digits(1.0 / motor.gear_ratio)
    )));
}

/// Warns of a velocity limit in degrees per second, and notes limits of 0.
fn speed_and_effort(cx: &Context, item: &Node, joint: &Joint, is_chain: bool) {
    let Some(limits) = item.get("limits") else { return };
    for (key, value) in [("velocity", joint.limits.velocity), ("effort", joint.limits.effort)] {
        let Some(node) = limits.get(key).filter(|_| value == Some(0.0)) else { continue };
        let label = if key == "velocity" { "no motion?" } else { "no torque?" };
        let help = format!("write the limit of the joint; if it is unknown, delete `{key}`");
        cx.report(Diagnostic::note(node.span.clone(), format!("the {key} limit is 0")).label(label).help(help));
    }
    let is_fast = |speed: &f64| is_chain && joint.row.kind == JointKind::Revolute && DEGREES.contains(speed);
    if let (Some(speed), Some(node)) = (joint.limits.velocity.filter(is_fast), limits.get("velocity")) {
        let message = format!("the velocity limit {} rad/s is over {} rad/s", cx.shown(node, speed), DEGREES.start());
        let raw = cx.raw(node);
        let degrees = if raw.parse::<f64>().is_ok() { raw } else { "…" };
        cx.report(
            Diagnostic::lint(node.span.clone(), message)
                .label("degrees per second?")
                .help(format!("if this is in degrees per second, write `deg({degrees})`")),
        );
    }
}

/// Notes a chain whose table seems to have the other convention: two revolute joints would turn about the same line.
fn other_convention(cx: &Context, root: &Node, convention: Convention, joints: &[Joint]) {
    let is_zero = |joint: &Joint| joint.row.dh.a == 0.0 && joint.row.dh.alpha.right == Some(QuarterTurns::Zero);
    let turns = |joint: &&Joint| joint.row.kind == JointKind::Revolute;
    let [first, .., last] = joints else { return };
    let (row, joint, (zero, other), name) = match convention {
        Convention::Standard => ("first", 1, (first, last), "modified"),
        Convention::Modified => ("last", joints.len() - 1, (last, first), "standard"),
    };
    let turn = joints.iter().filter(turns).count() >= 3 && joints[joint - 1..=joint].iter().all(|it| turns(&it));
    let Some(place) = root.get("convention").filter(|_| turn && is_zero(zero) && !is_zero(other)) else { return };
    let message = format!(
        "joints {joint} and {} turn about the same line, because the {row} row of this `{}` table has a = 0 and alpha \
         = 0",
        joint + 1,
        convention.name()
    );
    cx.report(Diagnostic::note(place.span.clone(), message).label(format!("a `{name}` table?")).help(format!(
        "in a `modified` table the first row usually has a = 0 and alpha = 0, in a `standard` table the last row; if \
         the source has rows of the other kind, write `convention: {name}`"
    )));
}
