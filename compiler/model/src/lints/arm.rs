//! Warnings that need all joints of an arm together.

use std::ops::RangeInclusive;

use crate::lints::single_value::{FARTHEST, LONGEST, MILLIMETRES};
use crate::parts::inertia::principal_moments;
use crate::readers::loops::short;
use crate::text::decode::Context;
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::expression::Names as _;
use crate::text::source::six_digits;
use crate::{Convention, Joint, JointKind};

/// Sine of the angle between two joint axes below which their common normal may be far away.
const NEARLY_PARALLEL: f64 = 0.05;

/// Offset, m, from which on the common normal of nearly parallel axes is noted.
const FAR: f64 = 2.0;

/// Changes the warning about millimetres where frames are far away because joint axes are nearly parallel. Lengths in
/// millimetres are not the reason then, because the common normals are short.
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

/// Notes two rows with long offsets `d` of opposite signs, which meet at a far common normal of nearly parallel axes.
/// Offsets above [`LONGEST`] have a warning already.
pub(crate) fn far_normals(cx: &Context, root: &Node, convention: Convention, joints: &[Joint]) {
    let items = root.list("joints");
    for (row, pair) in joints.windows(2).enumerate() {
        let [d, next] = [&pair[0], &pair[1]].map(|joint| joint.row.dh.d);
        let between = match convention {
            Convention::Standard => &pair[0],
            Convention::Modified => &pair[1],
        };
        let is_far = |d: f64| (FAR..=LONGEST).contains(&d.abs());
        let turn = pair.iter().all(|joint| joint.row.kind == JointKind::Revolute);
        let is_tilted = (1e-15..NEARLY_PARALLEL).contains(&between.row.dh.alpha.sin.abs());
        let Some(place) = items.get(row + 1).and_then(|item| item.get("dh")?.get("d")) else { continue };
        if !(is_far(d) && is_far(next) && d * next < 0.0 && turn && is_tilted) {
            continue;
        }
        let message = format!(
            "the common normal of the axes of joints {} and {} is {} m away, because these axes are nearly parallel",
            row + 1,
            row + 2,
            short(d.abs())
        );
        cx.report(Diagnostic::note(place.head(), message).label("far from the arm").help(
            "if the axes are parallel, write `alpha: 0` and shorter offsets `d`; if the table is calibrated, the key \
             `at` (format 2) places a joint where it is, without a common normal",
        ));
    }
}

/// Number of links that must be alike for a warning about placeholders; they must also be at least 1 in `PART_ALIKE` of
/// the links with mass.
const ALIKE: usize = 3;

const PART_ALIKE: usize = 2;

/// Two masses or moments are the same if their relative difference is below this.
const SAME: f64 = 1e-6;

/// Warns of links that have the same mass and the same moment of inertia about every axis: exporters write such
/// placeholders where the CAD model has no material.
pub(crate) fn placeholders(cx: &Context, root: &Node, joints: &[Joint]) {
    let items = root.list("joints");
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

/// Number of joints with friction from which a single joint without friction was probably forgotten.
const WITH_FRICTION: usize = 2;

/// Notes a single joint without a key for friction where all other joints have one. Robots with couplings, motors or
/// loops are skipped: their joints may have their friction elsewhere.
pub(crate) fn missing_friction(cx: &Context, root: &Node) {
    let items = root.list("joints");
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

/// Numbers of joints of arms whose proportions are similar. Shorter arms of textbooks may have any mass, and longer
/// arms are slender.
const PROPORTIONATE: RangeInclusive<usize> = 4..=7;

/// Mass of an arm per cube of its reach, kg/m³, below which masses are probably missing: half of what the lightest
/// shipped arm has. Arms of similar proportions weigh in proportion to the cube of their reach. The shipped arms have
/// 2.9 (KUKA KR 5) to 22 kg/m³; a URDF of the KUKA KR 120, which weighs a tonne, has 0.5: 2 kg for each link.
const LIGHTEST: f64 = 1.25;

/// Warns if the sum of all masses is small for the reach of the arm: the sum of the link lengths, and of the travel of
/// sliding joints.
pub(crate) fn light_for_reach(cx: &Context, root: &Node, joints: &[Joint]) {
    // a file with first moments instead of masses has moved mass between links: their sum says nothing about the arm
    if !PROPORTIONATE.contains(&joints.len()) || joints.iter().any(|joint| joint.row.link.has_first_moment()) {
        return;
    }
    let reach = |joint: &Joint| {
        let travel = joint.limits.position.filter(|_| joint.row.kind == JointKind::Prismatic);
        let travel = travel.map_or(0.0, |(lower, upper)| lower.abs().max(upper.abs()));
        libm::hypot(joint.row.dh.a, joint.row.dh.d) + travel
    };
    // a longer length is in millimetres, and another lint reports it
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
