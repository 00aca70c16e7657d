//! Rollouts of an arm over numpy's arrays.

use std::ffi::{CStr, CString};

use numpy::Element;
use pyo3::exceptions::{PyTypeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyTuple};
use rne::compiled::{CompiledArm, FrictionWidth, Number, Rollout, RolloutLimits};
use rne_codegen::Function;
use rne_model::Robot;

use crate::arm::Arm;
use crate::arrays::{self, Axes, Given, Value, are_single, shape_in_words};
use crate::errors::of_evaluation;
use crate::functions::{computed, warn_of_loss};

#[pymethods]
impl Arm {
    /// States of N samples after each of T steps under torques, by semi-implicit Euler. A floating base does not move.
    ///
    /// For predictive control by sampling, such as MPPI. A step takes q, qd and a torque to the next state. It does
    /// this, in this order:
    ///
    /// 1. limits: the torque is brought between -effort and +effort.
    /// 2. friction: the friction at the velocity before the step is subtracted from the torque.
    /// 3. qdd = forward_dynamics(q, qd, torque), from the state before the step.
    /// 4. qd += step * qdd. limits: qd is brought between -velocity and +velocity.
    /// 5. q += step * qd, with the new qd.
    /// 6. limits: a joint beyond an end of its positions stops: q is that end, and qd is zero.
    ///
    /// Parameters
    /// ----------
    /// q, qd : array of shape (n,) or (N, n)
    ///     The state in which each sample begins, rad and rad/s, or m and m/s.
    /// tau : array of shape (T, n) or (N, T, n)
    ///     The torques of the actuators in each step, N m or N. The first of three axes is always that of the samples.
    ///     If q, qd, payload and out have no axis N, nothing shows that torques are in the order (T, N, n) instead.
    /// step : float
    ///     The duration of a step, s; above zero.
    /// friction : bool or float
    ///     A number w > 0 (rad/s or m/s) adds the friction of the robot file's motors, G² B qd + |G| (½ (Tc⁺ - Tc⁻) s +
    ///     ½ (Tc⁺ + Tc⁻) s²) with s = qd / √(qd² + w²). True takes the key `coulomb_width` of each joint as w. A
    ///     joint of the inertia m needs step < 2 m / (G² B + |G| Tc / w); a longer step makes it swing about zero
    ///     velocity.
    /// limits : bool or sequence of "effort", "velocity", "position"
    ///     Which limits of the robot file hold; True: all. A joint without a limit in the file has none.
    /// payload : array of shape (10,) or (N, 10), optional
    ///     What the tip carries; `rne.payload` makes one. A point mass has the first four numbers alone.
    /// out : array of shape (2, T, n) or (2, N, T, n), optional
    ///     Memory for the positions and the velocities.
    ///
    /// Returns
    /// -------
    /// q, qd : arrays of shape (T, n) or (N, T, n)
    ///     The states after each step; the initial state is not among them. An argument without the axis N is that of
    ///     all samples. NaN stays in its sample.
    ///
    /// Warns
    /// -----
    /// UserWarning
    ///     When a state is not finite although all arguments are, which a step that is too long for the friction
    ///     causes: which sample and which step is first, and what to change.
    #[pyo3(signature = (q, qd, tau, step, *, friction=None, limits=None, payload=None, parameters=None, out=None))]
    fn rollout<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        step: f64,
        friction: Option<&Bound<'py, PyAny>>,
        limits: Option<&Bound<'py, PyAny>>,
        payload: Option<&Bound<'py, PyAny>>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let dof = self.arm.dof();
        let mut given = vec![self.of_joints("q", q)?, self.of_joints("qd", qd)?, self.of_joints("tau", tau)?];
        given.extend(payload.map(|payload| self.payload(payload)));
        given.extend(self.given_parameters(parameters)?);
        // arrays alone decide on the precision; lists follow them
        let is_single = are_single(&given);
        let shapes = [shape_of(&given[0])?, shape_of(&given[1])?];
        let (steps, samples) = steps_of(&mut given[2], dof)?;
        for (name, shape) in ["q", "qd"].into_iter().zip(shapes) {
            agree(name, &shape.unwrap_or_default(), samples, steps, dof)?;
        }
        let friction = friction.map(width).transpose()?.flatten();
        let limits = limits.map(which).transpose()?.unwrap_or_default();
        let rollout = Rollout { friction, limits, ..Rollout::new(steps, step) };
        warn_of_nothing(py, self.robot(), &rollout)?;
        if is_single {
            warn_of_loss(py, &self.arm, Function::ForwardDynamics)?;
            roll_out::<f32>(py, &self.arm, &rollout, &given, out)
        } else {
            roll_out::<f64>(py, &self.arm, &rollout, &given, out)
        }
    }
}

/// Returns the number of steps, and the number of samples if the torques have an axis for them.
fn steps_of(tau: &mut Given<'_>, dof: usize) -> PyResult<(usize, Option<usize>)> {
    let Some(shape) = shape_of(tau)? else {
        return Err(PyTypeError::new_err("`tau` is not an array of real numbers"));
    };
    let (steps, samples) = match shape[..] {
        [steps, joints] if joints == dof => (steps, None),
        [samples, steps, joints] if joints == dof => (steps, Some(samples)),
        _ => {
            return Err(PyValueError::new_err(format!(
                "`tau` has the shape {}; it is (T, {dof}) for one sample or (N, T, {dof}) for many",
                shape_in_words(&shape)
            )));
        }
    };
    (tau.elements, tau.axes) = (steps * dof, Axes::Rows(dof));
    Ok((steps, samples))
}

/// Returns the shape of an argument; `None` if it is not an array of real numbers, for which an error follows later.
fn shape_of(given: &Given<'_>) -> PyResult<Option<Vec<usize>>> {
    match &given.value {
        Value::Of(value) => arrays::shape_of(value),
        Value::Own(numbers) => Ok(Some(vec![numbers.len()])),
    }
}

/// Returns an error if the torques and a state have different numbers of samples: the axes of the torques may be in the
/// wrong order.
fn agree(name: &str, shape: &[usize], samples: Option<usize>, steps: usize, dof: usize) -> PyResult<()> {
    match (shape, samples) {
        (&[states, joints], Some(samples)) if joints == dof && states > 1 && states != samples => {
            Err(PyValueError::new_err(format!(
                "`tau` has the shape ({samples}, {steps}, {dof}), but `{name}` has the shape ({states}, {dof}): the \
                 axes of `tau` are samples, steps, joints, (N, T, {dof}), and N is {states} here"
            )))
        }
        _ => Ok(()),
    }
}

/// Warns if limits or friction are requested but no joint has any.
fn warn_of_nothing(py: Python<'_>, robot: &Robot, rollout: &Rollout) -> PyResult<()> {
    let RolloutLimits { effort, velocity, position } = rollout.limits;
    let has_limit = robot.coordinate_limits().iter().any(|limits| {
        effort && limits.effort.is_some()
            || velocity && limits.velocity.is_some()
            || position && limits.position.is_some()
    });
    let is_friction = |value: &f64| value.abs() > 0.0;
    let mut motors = robot.joints.iter().filter_map(|joint| joint.motor.as_ref());
    let has_friction = motors.any(|motor| is_friction(&motor.viscous) || motor.coulomb.iter().any(is_friction));
    let warn = |text: &CStr| PyErr::warn(py, &py.get_type::<PyUserWarning>(), text, 1);
    if rollout.limits != RolloutLimits::NONE && !has_limit {
        warn(c"no joint of the robot file has a limit that `limits` asks for: the samples are not limited")?;
    }
    if rollout.friction.is_some() && !has_friction {
        warn(c"no joint of the robot file has friction in `motor`: the samples have no friction")?;
    }
    Ok(())
}

fn is_finite<T: Number>(number: T) -> bool {
    let number: f64 = number.into();
    number.is_finite()
}

/// The first sample whose state is no longer finite.
struct Diverged {
    sample: usize,
    /// The step after which it is not finite; the first is 0.
    step: usize,
    /// The number of samples whose state is not finite.
    samples: usize,
}

impl Diverged {
    /// Finds the sample that is not finite after the fewest steps, in states of T steps of n joints. `None` if all
    /// states are finite.
    fn of<T: Number>(positions: &[T], velocities: &[T], [steps, dof]: [usize; 2]) -> Option<Self> {
        let length = (steps * dof).max(1);
        let states = positions.chunks_exact(length).zip(velocities.chunks_exact(length)).enumerate();
        let mut diverged = states.filter_map(|(sample, (q, qd))| {
            let place = q.iter().zip(qd).position(|(&q, &qd)| !is_finite(q) || !is_finite(qd))?;
            Some((place / dof.max(1), sample))
        });
        let first = diverged.next()?;
        let (first, samples) = diverged.fold((first, 1), |(first, count), other| (first.min(other), count + 1));
        Some(Self { sample: first.1, step: first.0, samples })
    }

    /// Warns with the number of the sample and of the step, and with a remedy.
    fn warn(&self, py: Python<'_>, rollout: &Rollout) -> PyResult<()> {
        let Self { sample, step, samples } = self;
        let others = if *samples > 1 { format!("; {samples} samples are not finite") } else { String::new() };
        let remedy = if rollout.friction.is_some() {
            "; a joint of the inertia m needs step < 2 m / (G² B + |G| Tc / w): take a shorter `step`, or a larger w \
             (`friction=w`, `coulomb_width` in the robot file)"
        } else {
            "; take a shorter `step`, or smaller torques"
        };
        let text = format!(
            "the state of sample {sample} is not finite after step {step} (both counted from 0), with `step` = {} s\
             {others}{remedy}",
            rollout.step
        );
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(text)?, 1)
    }
}

/// Returns the width of Coulomb friction that the keyword `friction` requests; `None` without friction.
fn width(value: &Bound<'_, PyAny>) -> PyResult<Option<FrictionWidth>> {
    if let Ok(is_there) = value.cast::<PyBool>() {
        return Ok(is_there.is_true().then_some(FrictionWidth::OfFile));
    }
    let width = value.extract().map_err(|_| {
        PyTypeError::new_err(
            "`friction` is True or a number: True takes the width of Coulomb friction from the robot file \
             (`coulomb_width`), a number is the width for all joints, rad/s or m/s",
        )
    })?;
    Ok(Some(FrictionWidth::Of(width)))
}

/// Returns the limits that the keyword `limits` selects.
fn which(value: &Bound<'_, PyAny>) -> PyResult<RolloutLimits> {
    if let Ok(hold) = value.cast::<PyBool>() {
        return Ok(if hold.is_true() { RolloutLimits::ALL } else { RolloutLimits::NONE });
    }
    let wrong = "`limits` is True, False or a list with some of \"effort\", \"velocity\" and \"position\"";
    let names: Vec<String> = match value.extract::<String>() {
        Ok(name) => vec![name],
        Err(_) => value
            .try_iter()
            .and_then(|names| names.map(|name| name?.extract()).collect())
            .map_err(|_| PyTypeError::new_err(wrong))?,
    };
    let mut limits = RolloutLimits::NONE;
    for name in names {
        match name.as_str() {
            "effort" => limits.effort = true,
            "velocity" => limits.velocity = true,
            "position" => limits.position = true,
            _ => return Err(PyValueError::new_err(format!("`{name}` is not a limit: {wrong}"))),
        }
    }
    Ok(limits)
}

fn roll_out<'py, T: Element + Number>(
    py: Python<'py>,
    arm: &CompiledArm,
    rollout: &Rollout,
    given: &[Given<'py>],
    out: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyTuple>> {
    let of_sample = [rollout.steps, arm.dof()];
    let (result, _) = computed::<T>(py, given, out, [&[2], &of_sample], |held, samples, arguments, numbers| {
        let (positions, velocities) = numbers.split_at_mut(numbers.len() / 2);
        py.detach(|| arm.rollout(rollout, samples, arguments, positions, velocities))
            .map_err(|error| of_evaluation(&error))?;
        let inputs_are_finite = || held.iter().all(|held| held.all(is_finite));
        if let Some(diverged) = Diverged::of(positions, velocities, of_sample)
            && inputs_are_finite()
        {
            diverged.warn(py, rollout)?;
        }
        Ok(())
    })?;
    PyTuple::new(py, [result.get_item(0)?, result.get_item(1)?])
}
