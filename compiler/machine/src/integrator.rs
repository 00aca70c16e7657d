//! Steps of the classical Runge-Kutta method, which call the accelerations and their derivatives.

use rne_runtime::integrators;

use crate::results::{NextState, NextStateDerivatives, StepDerivatives};
use crate::{CompiledArm, EvaluationError, Number, OutOfRange};

/// Refuses a duration that is not a finite number above zero.
fn check<T: Number>(step: T) -> Result<(), EvaluationError> {
    let wrong = |mistake| EvaluationError::OutOfRange { mistake, state: 1, states: 1 };
    OutOfRange::check("step", |_| Some(step.into())).map_err(wrong)
}

impl CompiledArm {
    /// Returns the state after a step of the classical Runge-Kutta method of the duration `step`, s, under torques that
    /// are constant during the step. It computes the accelerations at four states; the error of a motion is of order
    /// h⁴.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, when the step is not a finite number above zero, or when
    /// the function cannot be compiled for this robot.
    pub fn runge_kutta_step<T: Number>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        step: T,
    ) -> Result<NextState<T>, EvaluationError> {
        check(step)?;
        let accelerations = |q: &Vec<T>, qd: &Vec<T>| self.forward_dynamics(q, qd, tau);
        let [q, qd] = integrators::runge_kutta_step(accelerations, [&q.to_vec(), &qd.to_vec()], |_| step)?;
        Ok(NextState { q, qd })
    }

    /// Returns the derivatives of [`runge_kutta_step`](Self::runge_kutta_step) with respect to q, q̇ and τ, exact up to
    /// rounding. It computes the accelerations three times and their derivatives four times.
    ///
    /// # Errors
    /// When an argument does not have one element per joint, when the step is not a finite number above zero, or when
    /// a function cannot be compiled for this robot.
    pub fn runge_kutta_step_derivatives<T: Number>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        step: T,
    ) -> Result<NextStateDerivatives<T>, EvaluationError> {
        check(step)?;
        let accelerations = |q: &Vec<T>, qd: &Vec<T>| self.forward_dynamics(q, qd, tau);
        let derivatives =
            |q: &Vec<T>, qd: &Vec<T>| self.forward_dynamics_derivatives(q, qd, tau).map(|by| [by.dq, by.dqd, by.dtau]);
        let found =
            integrators::runge_kutta_step_derivatives(accelerations, derivatives, [&q.to_vec(), &qd.to_vec()], step)?;
        let [q, qd] = found.map(|[dq, dqd, dtau]| StepDerivatives { dq, dqd, dtau });
        Ok(NextStateDerivatives { q, qd })
    }
}
