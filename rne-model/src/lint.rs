//! Lints: values that are allowed and yet are probably not what was meant.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Range, RangeInclusive};

use crate::angle::nearest_right_angle;
use crate::decode::Context;
use crate::diagnostic::Diagnostic;
use crate::document::Node;
use crate::inertia::TOLERANCE;
use crate::source::{quoted, rounded};
use crate::{Angle, JointKind, Limits, Link};

/// How near a right angle an angle must lie to be taken for a rounded one, rad.
const NEARLY: f64 = 2e-4;
/// No arm has a longer link, m.
const LONGEST: f64 = 20.0;
/// No arm has a heavier link, kg.
const HEAVIEST: f64 = 2000.0;
/// What the acceleration of gravity measures on Earth, generously, m/s².
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
            format!("the angle {shown} is {} rad off the right angle `{spelling}`", rounded((value - right).abs()));
        cx.report(Diagnostic::lint(node.span.clone(), message).label("rounded?").help(format!(
            "write `{spelling}` if that is meant: its sine and cosine are exactly 0 and ±1, and the code gets shorter"
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

/// Gravity of another size than on Earth, or upwards.
pub(crate) fn gravity(cx: &Context, node: &Node, [x, y, z]: [f64; 3]) {
    let size = libm::sqrt(x * x + y * y + z * z);
    if size != 0.0 && !GRAVITY.contains(&size) {
        let message = format!("gravity accelerates by {} m/s²; on Earth it is 9.81 m/s²", rounded(size));
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
    } else if x == 0.0 && y == 0.0 && z > 0.0 {
        let message = format!("gravity {} points along the positive z axis of frame 0", quoted(cx.raw(node)));
        cx.report(Diagnostic::lint(node.span.clone(), message).label("upwards?").help(format!(
            "the acceleration of gravity points down: is `[0, 0, {}]` meant? if z of frame 0 points down, as where the \
             arm hangs from the ceiling, it is right as it stands",
            rounded(-z)
        )));
    }
}

/// Millimetres taken for metres.
pub(crate) fn length(cx: &Context, node: &Node, value: f64) {
    if value.abs() > LONGEST {
        let message = format!("the length {} m is over {LONGEST} m", cx.shown(node, value));
        cx.report(Diagnostic::lint(node.span.clone(), message).label("millimetres?").help("lengths are in metres"));
    }
}

/// Grams taken for kilograms.
pub(crate) fn mass(cx: &Context, node: &Node, value: f64) {
    if value > HEAVIEST {
        let message = format!("the mass {} kg is over {HEAVIEST} kg", cx.shown(node, value));
        cx.report(Diagnostic::lint(node.span.clone(), message).label("grams?").help("masses are in kilograms"));
    }
}

/// Principal moments, ascending, that no distribution of mass has.
pub(crate) fn triangle_inequality(cx: &Context, place: Range<usize>, [a, b, c]: [f64; 3]) {
    if c - (a + b) > TOLERANCE * c {
        let message = format!(
            "no body has this inertia: of its principal moments {}, {} and {} kg m² the largest exceeds the sum of the \
             other two",
            rounded(a),
            rounded(b),
            rounded(c)
        );
        cx.report(Diagnostic::lint(place, message).label("violates the triangle inequality").help(
            "published tables do have such tensors, and dynamics works with them; if the numbers are your own, \
             check them",
        ));
    }
}

/// A negative principal moment in a file that knows it.
pub(crate) fn unphysical(cx: &Context, place: Range<usize>, [smallest, ..]: [f64; 3]) {
    let message = format!(
        "the inertia is not positive semidefinite, as `physical: false` says: its smallest eigenvalue about the centre \
         of mass is {} kg m²",
        rounded(smallest)
    );
    cx.report(Diagnostic::lint(place, message).label("not the inertia of a body").help(
        "inverse dynamics works with it; the mass matrix may not be positive definite, and then there is no forward \
         dynamics",
    ));
}

/// A last link that resists nothing.
pub(crate) fn massless_last_link(cx: &Context, joint: &Node, link: &Link) {
    if link.mass == 0.0 {
        let place = joint.get("link").unwrap_or(joint);
        let place = place.get("mass").unwrap_or(place).head();
        cx.report(
            Diagnostic::lint(place, "the last link has no mass: its joint may move without any torque or force")
                .label("massless")
                .help("give the last link the mass of flange and tool; without inertia the mass matrix is singular"),
        );
    }
}

/// Degrees in the position limits of a revolute joint.
pub(crate) fn position_limits(cx: &Context, position: &Node, kind: JointKind, limits: &Limits) {
    let Some((lower, upper)) = limits.position.filter(|_| kind == JointKind::Revolute) else { return };
    if lower.abs().max(upper.abs()) > WIDEST {
        let message = format!("the position limits {} rad are more than four turns", quoted(cx.raw(position)));
        cx.report(Diagnostic::lint(position.span.clone(), message).label("degrees?").help(format!(
            "if these are degrees, write `[deg({}), deg({})]`",
            rounded(lower),
            rounded(upper)
        )));
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
