//! The report on a payload that `rne identify --payload --json` and Python return; docs/control/identify.md lists its
//! keys.

use rne_model::{Joint, Robot};
use serde::Serialize;

use crate::fit::payload::{Payload, PayloadNumber};
use crate::replies::prediction::JointError;
use crate::replies::reply::{JudgedPart, finite};

/// The report on a payload, which serde can write in any format. Numbers that the log does not determine are null.
#[derive(Debug, Serialize)]
pub struct PayloadReply {
    robot: String,
    logs: Vec<String>,
    states: u64,
    duration: f64,
    cutoff: f64,
    payload: OfPayload,
    joints: Vec<OfJoint>,
    delay: f64,
}

#[derive(Debug, Serialize)]
struct OfPayload {
    found: bool,
    /// The frame in which the numbers are given: the tip.
    frame: &'static str,
    mass: Number,
    com: [Number; 3],
    /// Inertia about the centre of mass: xx, yy, zz, xy, xz, yz.
    inertia: [Number; 6],
    /// Mass, centre of mass and inertia as functions of an arm take them; zeros if there is no payload; null if the
    /// mass is not known or negative.
    numbers: Option<[f64; 10]>,
}

/// A number with its standard deviation; null where the log does not determine it.
#[derive(Debug, Serialize)]
struct Number {
    value: Option<f64>,
    deviation: Option<f64>,
    unit: &'static str,
    excited: bool,
}

impl Number {
    fn of(number: &PayloadNumber, unit: &'static str) -> Self {
        let known = |value: f64| finite(value).filter(|_| number.is_excited);
        Self { value: known(number.value), deviation: known(number.deviation), unit, excited: number.is_excited }
    }
}

#[derive(Debug, Serialize)]
struct OfJoint {
    joint: usize,
    name: String,
    error: Option<f64>,
    error_with_payload: Option<f64>,
}

impl PayloadReply {
    /// Makes the report on a payload of a robot, with the errors of its joints without the payload and with it.
    #[must_use]
    pub fn of(
        robot: &Robot,
        payload: &Payload,
        errors: [Option<&[JointError]>; 2],
        logs: Vec<String>,
        cutoff: f64,
        part: JudgedPart,
    ) -> Self {
        let joint = |(at, joint): (usize, &Joint)| {
            let [error, error_with_payload] = errors.map(|errors| finite(errors?.get(at)?.error));
            OfJoint { joint: at + 1, name: joint.name.clone(), error, error_with_payload }
        };
        Self {
            robot: robot.name.clone(),
            logs,
            states: part.states,
            duration: part.duration,
            cutoff,
            payload: OfPayload {
                found: payload.is_there(),
                frame: "tip",
                mass: Number::of(&payload.mass, "kg"),
                com: payload.com.each_ref().map(|number| Number::of(number, "m")),
                inertia: payload.inertia.each_ref().map(|number| Number::of(number, "kg m²")),
                numbers: if payload.is_there() {
                    Some(payload.body().to_array()).filter(|_| payload.mass.value > 0.0)
                } else {
                    Some([0.0; 10]).filter(|_| payload.mass.is_excited)
                },
            },
            joints: robot.independent_joints().enumerate().map(joint).collect(),
            delay: payload.delay,
        }
    }
}
