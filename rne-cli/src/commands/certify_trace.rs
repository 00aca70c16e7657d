//! The trace that the independent checker reads: the table of the arm, and the exact expressions of the constants.

use rne_codegen::{Derivation, ExactConstant, ExactStep, Program};
use rne_emit::{Precision, Prefix};
use rne_model::{Angle, InertiaReference, QuarterTurns, Robot};
use serde_json::{Value, json};

/// The trace of a function in C as JSON.
pub(crate) fn trace(
    robot: &Robot,
    program: &Program,
    derivation: &Derivation,
    prefix: &Prefix,
    precision: Precision,
) -> Value {
    let steps: Vec<Value> = derivation.steps.iter().map(step).collect();
    let constants: serde_json::Map<String, Value> = derivation
        .constants
        .iter()
        .map(|(name, exact)| {
            let exact = match exact {
                ExactConstant::Number(place) => json!(place),
                ExactConstant::Angle { sine, cosine } => json!({"sin": sine, "cos": cosine}),
            };
            (name.to_string(), exact)
        })
        .collect();
    json!({
        "prefix": prefix.to_string(),
        "function": format!("{prefix}_{}", program.function),
        "real": precision.c_type(),
        "steps": steps,
        "constants": constants,
        "table": table(robot),
    })
}

/// A step: its operator, and the places of its operands. Numbers are texts, which keep their digits.
fn step(step: &ExactStep) -> Value {
    match step {
        ExactStep::Decimal(value) => json!(["number", format!("{value:?}")]),
        ExactStep::Sine(angle) => json!(["sin", format!("{angle:?}")]),
        ExactStep::Cosine(angle) => json!(["cos", format!("{angle:?}")]),
        ExactStep::Negative(a) => json!(["-", a]),
        ExactStep::Sum(a, b) => json!(["+", a, b]),
        ExactStep::Product(a, b) => json!(["*", a, b]),
        ExactStep::Inverse(a) => json!(["/", a]),
        ExactStep::Root(a) => json!(["sqrt", a]),
    }
}

/// The Denavit-Hartenberg table with the links, in the numbers that the compiler reads.
fn table(robot: &Robot) -> Value {
    let text = |x: f64| format!("{x:?}");
    // an angle within some units in the last place of a right angle is this right angle
    let angle = |angle: &Angle| match angle.right {
        Some(QuarterTurns::Zero) => text(0.0),
        Some(QuarterTurns::One) => text(std::f64::consts::FRAC_PI_2),
        Some(QuarterTurns::Two) => text(std::f64::consts::PI),
        Some(QuarterTurns::Three) => text(-std::f64::consts::FRAC_PI_2),
        None => text(angle.radians),
    };
    let joints: Vec<Value> = robot
        .joints
        .iter()
        .map(|joint| {
            let (dh, link) = (&joint.row.dh, &joint.row.link);
            let (inertia, reference) = &joint.written_inertia;
            let inertia = [inertia.xx, inertia.yy, inertia.zz, inertia.xy, inertia.xz, inertia.yz];
            json!({
                "name": joint.name,
                "type": joint.row.kind.name(),
                "theta": angle(&dh.theta),
                "d": text(dh.d),
                "a": text(dh.a),
                "alpha": angle(&dh.alpha),
                "mass": text(link.mass),
                "com": link.com.map(text),
                "inertia": inertia.map(text),
                "inertia_about": if *reference == InertiaReference::Com { "com" } else { "origin" },
            })
        })
        .collect();
    json!({"convention": robot.convention.name(), "gravity": robot.gravity.map(text), "joints": joints})
}
