//! Finds a motion that excites an arm, for identification.

use std::time::{Duration, Instant};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rne_identify::{AskedLimits, BaseExcitation, ExcitationOptions, JointUse, MotionLimits, excite};
use rne_model::Joint;

use crate::arm::Arm;
use crate::interruption::check_signals;
use crate::log_errors::of_excitation;
use crate::logs::{robot_of, rows};

/// The largest number of samples of a motion.
const MOST: f64 = 500_000.0;

/// Time between two checks for signals.
const MOMENT: Duration = Duration::from_millis(100);

/// The options of a search, from the dict that the package makes of its keywords.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    seconds: f64,
    periods: u32,
    harmonics: usize,
    range: Option<Vec<f64>>,
    velocity: Option<Vec<f64>>,
    acceleration: Option<Vec<f64>>,
    friction: bool,
    rotors: bool,
    evaluations: u64,
    seed: u64,
    rate: f64,
}

impl Asked {
    fn check(&self) -> PyResult<()> {
        let refuse = |what: &str| Err(PyValueError::new_err(what.to_owned()));
        if !(1e-3..=86_400.0).contains(&self.seconds) {
            return refuse("`seconds` is a time from 0.001 to 86400");
        }
        if !(1..=1000).contains(&self.periods) {
            return refuse("`periods` is a number from 1 to 1000");
        }
        if !(2..=50).contains(&self.harmonics) {
            return refuse("`harmonics` is a number from 2 to 50; fewer than two cannot start and end at rest");
        }
        if self.evaluations == 0 {
            return refuse("`evaluations` is a number of 1 or more");
        }
        if !(1e-3..=1e6).contains(&self.rate) {
            return refuse("`rate` is a number of samples per second from 0.001 to 1000000");
        }
        if self.seconds * self.rate > MOST {
            return refuse(&format!(
                "{} s at {} Hz are more than {MOST} samples; use a lower `rate`",
                self.seconds, self.rate
            ));
        }
        Ok(())
    }
}

#[derive(IntoPyObject)]
struct OfJoint {
    joint: usize,
    name: String,
    start: f64,
    lower: f64,
    upper: f64,
    velocity: f64,
    acceleration: f64,
    effort: Option<f64>,
    unit: &'static str,
}

#[derive(IntoPyObject)]
struct OfBase {
    name: String,
    combination: String,
    unit: &'static str,
    deviation: f64,
    plausible: f64,
    excited: bool,
}

impl OfJoint {
    fn of((at, (joint, used)): (usize, (&Joint, &JointUse))) -> Self {
        Self {
            joint: at + 1,
            name: joint.name.clone(),
            start: used.start,
            lower: used.bounds.lower,
            upper: used.bounds.upper,
            velocity: used.bounds.velocity,
            acceleration: used.bounds.acceleration,
            effort: used.effort,
            unit: joint.row.kind.position_unit(),
        }
    }
}

impl OfBase {
    fn of(base: &BaseExcitation) -> Self {
        Self {
            name: base.name.clone(),
            combination: base.combination.clone(),
            unit: base.unit,
            deviation: base.deviation,
            plausible: base.plausible,
            excited: base.is_excited(),
        }
    }
}

/// A motion, sampled: what `rne excite` writes and prints.
#[pyfunction]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 1 to half a million
pub(crate) fn exciting<'py>(py: Python<'py>, arm: PyRef<'_, Arm>, asked: Asked) -> PyResult<Bound<'py, PyDict>> {
    asked.check()?;
    let robot = robot_of(&arm)?;
    let mut limits = AskedLimits::default();
    limits.range = asked.range;
    limits.velocity = asked.velocity;
    limits.acceleration = asked.acceleration;
    let limits = MotionLimits::of(&robot, &limits).map_err(|error| of_excitation(&error))?;
    let mut options = ExcitationOptions::default();
    options.period = asked.seconds / f64::from(asked.periods);
    options.harmonics = asked.harmonics;
    options.evaluations = asked.evaluations;
    options.seed = asked.seed;
    options.friction = asked.friction;
    options.rotors = asked.rotors;
    let found = py.detach(|| {
        let mut looked = Instant::now();
        excite(&robot, &limits, &options, &mut |_| {
            if looked.elapsed() < MOMENT {
                return true;
            }
            looked = Instant::now();
            // after Ctrl-C the search ends, and the best motion so far is returned
            check_signals().is_ok()
        })
    });
    let found = found.map_err(|error| of_excitation(&error))?;
    // a whole number of steps, none of them longer than the sampling rate asks for
    let steps = (asked.seconds * asked.rate * (1.0 - 1e-12)).ceil().max(1.0) as u32;
    let mut time = Vec::new();
    let mut states = [Vec::new(), Vec::new(), Vec::new()];
    for step in 0..=steps {
        let part = f64::from(step) / f64::from(steps);
        time.push(asked.seconds * part);
        for (all, numbers) in states.iter_mut().zip(found.motion.after(part * f64::from(asked.periods))) {
            all.extend(numbers);
        }
    }
    let reply = PyDict::new(py);
    reply.set_item("time", numpy::PyArray1::from_vec(py, time))?;
    for (name, numbers) in ["q", "qd", "qdd"].into_iter().zip(states) {
        reply.set_item(name, rows(py, numbers, robot.dof())?)?;
    }
    reply.set_item("condition", found.condition)?;
    reply.set_item("first_condition", found.first_condition)?;
    reply.set_item("evaluations", found.evaluations)?;
    reply.set_item(
        "joints",
        robot.independent_joints().zip(&found.joints).enumerate().map(OfJoint::of).collect::<Vec<_>>(),
    )?;
    reply.set_item("base_parameters", found.bases.iter().map(OfBase::of).collect::<Vec<_>>())?;
    Ok(reply)
}
