//! Warnings about single values that are allowed but are probably not what the author meant.
//!
//! A warning is for a probable mistake, so a build repeats it until the author reacts. Values that published tables
//! have cause a note only: `rne check` shows it, a build does not.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::RangeInclusive;

use crate::angle::nearest_right_angle;
use crate::text::decode::Context;
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::source::{is_invisible, quoted, six_digits};
use crate::{Angle, JointKind, Limits, Transform};

/// Largest distance from a right angle at which an angle is taken for a rounded right angle, rad.
const NEARLY: f64 = 2e-4;
/// Length above which a link is longer than that of any arm, m.
pub(crate) const LONGEST: f64 = 20.0;
/// Distance of a centre of mass along an axis of the link frame above which no link has it, m.
pub(crate) const FARTHEST: f64 = 5.0;
/// Mass above which a link is heavier than that of any arm, kg.
const HEAVIEST: f64 = 2000.0;
/// The label of a warning about a length that is probably in millimetres.
pub(crate) const MILLIMETRES: &str = "millimetres?";
/// The range of the acceleration of gravity on Earth, generously, m/s².
const GRAVITY: RangeInclusive<f64> = 8.0..=11.0;
/// Four turns, rad: larger position limits of a revolute joint are taken for degrees.
const WIDEST: f64 = 8.0 * PI;

/// Warns of degrees written as radians, and of right angles that are rounded and so are not exact.
pub(crate) fn angle(cx: &Context, node: &Node, value: f64) {
    let shown = cx.shown(node, value);
    let raw = cx.raw(node);
    let literal = raw.parse::<f64>().is_ok();
    // A full turn that was rounded, such as 6.2832, causes no warning.
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

/// Returns a multiple of a right angle as an expression of a robot file: `0`, `pi/2`, `-pi`, `3*pi/2`.
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

/// Warns of invisible characters in a text of the file: with them, two names that look alike are not equal.
pub(crate) fn invisible(cx: &Context, node: &Node, text: &str) {
    let Some(hidden) = text.chars().find(|&c| is_invisible(c)) else { return };
    // a character written as an escape in quotes is not in the text of the file itself
    let at = cx.text.get(node.span.clone()).and_then(|raw| raw.find(hidden)).map(|at| node.span.start + at);
    let span = at.map_or(node.span.clone(), |at| at..at + hidden.len_utf8());
    // the character may be far from the beginning of a long text, so only its surroundings are shown
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

/// Warns of a gravity whose size differs from that on Earth.
pub(crate) fn gravity(cx: &Context, node: &Node, [x, y, z]: [f64; 3]) {
    // nothing overflows: `hypot` squares no large number, and `min` keeps the number finite for the message
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

/// Warns of gravity that points up in frame 0 and in the world, which is a wrong sign unless the arm hangs.
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

/// Warns of a centre of mass that is probably in millimetres.
pub(crate) fn com(cx: &Context, node: &Node, value: f64) {
    if value.abs() > FARTHEST {
        let shown = cx.shown(node, value);
        let message = format!("the centre of mass lies {shown} m from the origin of the link frame, over {FARTHEST} m");
        millimetres(cx, node, message);
    }
}

/// Warns of millimetres; if the number is a parameter, at the place where that parameter is defined.
fn millimetres(cx: &Context, node: &Node, message: String) {
    let place = cx.parameters.borrow().get(cx.raw(node)).map_or(node.span.clone(), |it| it.value.clone());
    let written = cx.text.get(place.clone()).filter(|text| text.parse::<f64>().is_ok());
    let help = written.map_or_else(String::new, |number| format!(": if it is in millimetres, write `mm({number})`"));
    cx.report(Diagnostic::lint(place, message).label(MILLIMETRES).help(format!("lengths are in metres{help}")));
}

/// Warns of a length that is probably in millimetres.
pub(crate) fn length(cx: &Context, node: &Node, value: f64) {
    if value.abs() > LONGEST {
        millimetres(cx, node, format!("the length {} m is over {LONGEST} m", cx.shown(node, value)));
    }
}

/// Warns of a mass that is probably in grams.
pub(crate) fn mass(cx: &Context, node: &Node, value: f64) {
    if value > HEAVIEST {
        let message = format!("the mass {} kg is over {HEAVIEST} kg", cx.shown(node, value));
        cx.report(Diagnostic::lint(node.span.clone(), message).label("grams?").help("masses are in kilograms"));
    }
}

/// Warns of position limits of a revolute joint that are probably in degrees.
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

/// Warns of a `coulomb_width` beside a `coulomb_displacement`: only the second is used.
pub(crate) fn width_beside_displacement(cx: &Context, width: &Node) {
    let message = "rne ignores `coulomb_width` because `coulomb_displacement` is given: the friction then changes its \
                   sign over the displacement, and not with the speed";
    cx.report(Diagnostic::lint(width.head(), message).label("not used").help("keep only one of the two keys"));
}

/// Warns of parameters that no number uses. Run-time parameters are skipped, because for them it is an error.
pub(crate) fn unused_parameters(cx: &Context) {
    for (name, parameter) in cx.parameters.borrow().iter().filter(|(_, parameter)| !parameter.used.get()) {
        if cx.run_time_index(name).is_some() {
            continue;
        }
        let message = format!("the parameter {} is never used", quoted(name));
        cx.report(Diagnostic::lint(parameter.span.clone(), message).label("unused").help("delete it, or use it"));
    }
}
