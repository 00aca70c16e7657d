//! The step of the classical Runge-Kutta method, and its derivatives with respect to the state and the torques, for
//! every robot that has the accelerations and their derivatives. They allocate nothing, and no branch depends on a
//! number.

use core::convert::Infallible;

#[cfg(all(feature = "arm", feature = "std"))]
use crate::seven_steps::at_tip::AtTip;
use crate::{
    ForwardDynamics, ForwardDynamicsDerivatives, NextState, NextStateDerivatives, Scalar, StepDerivatives, integrators,
};

/// A step of the classical Runge-Kutta method under torques that do not change during the step. Every type with
/// [`ForwardDynamics`] has it.
///
/// `step` is the duration h, s. The tip is free, and joints have no friction and no limits. A singular mass matrix (a
/// joint that moves nothing) gives numbers that are not finite.
///
/// ```
/// use rne_runtime::{ForwardDynamics, RungeKuttaStep, Scalar};
///
/// /// A mass of 2 kg on a slide.
/// struct Slide;
/// impl ForwardDynamics<1> for Slide {
///     fn forward_dynamics<T: Scalar>(&self, _: &[T; 1], _: &[T; 1], &[force]: &[T; 1]) -> [T; 1] {
///         [force / T::from_f64(2.0)]
///     }
/// }
///
/// // from rest under 4 N for 0.5 s: x = ½ a t² = 0.25 m
/// let next = Slide.runge_kutta_step(&[0.0], &[0.0], &[4.0], 0.5);
/// assert_eq!((next.q, next.qd), ([0.25], [1.0]));
/// ```
pub trait RungeKuttaStep<const DOF: usize>: ForwardDynamics<DOF> {
    /// A step of the classical Runge-Kutta method, which computes the accelerations at four states. The error of a
    /// motion is of order h⁴.
    ///
    /// The velocities at the four states follow from the accelerations before. With the accelerations q̈₁ to q̈₄ at
    /// these states, q̇' = q̇ + h (q̈₁ + 2 q̈₂ + 2 q̈₃ + q̈₄) / 6 and q' = q + h (q̇ + h (q̈₁ + q̈₂ + q̈₃) / 6).
    #[must_use]
    fn runge_kutta_step<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], tau: &[T; DOF], step: T) -> NextState<DOF, T> {
        let accelerations = |q: &_, qd: &_| Ok::<_, Infallible>(self.forward_dynamics(q, qd, tau));
        let Ok([q, qd]) = integrators::runge_kutta_step(accelerations, [q, qd], |_| step);
        NextState { q, qd }
    }
}

impl<const DOF: usize, R: ForwardDynamics<DOF>> RungeKuttaStep<DOF> for R {}

/// Derivatives of the step of [`RungeKuttaStep`], for optimisers. Every type with [`ForwardDynamics`] and
/// [`ForwardDynamicsDerivatives`] has them.
///
/// They are exact up to rounding: the chain rule over the four states at which the step has the accelerations.
pub trait RungeKuttaStepDerivatives<const DOF: usize>: ForwardDynamics<DOF> + ForwardDynamicsDerivatives<DOF> {
    /// The derivatives of [`runge_kutta_step`](RungeKuttaStep::runge_kutta_step) with respect to q, q̇ and τ, from
    /// those of the accelerations at its four states, and five products of matrices of `DOF` rows and 3 `DOF` columns.
    #[must_use]
    fn runge_kutta_step_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        step: T,
    ) -> NextStateDerivatives<DOF, T> {
        let accelerations = |q: &_, qd: &_| Ok::<_, Infallible>(self.forward_dynamics(q, qd, tau));
        let derivatives = |q: &_, qd: &_| {
            let found = self.forward_dynamics_derivatives(q, qd, tau);
            Ok([found.dq, found.dqd, found.dtau])
        };
        let Ok(found) = integrators::runge_kutta_step_derivatives(accelerations, derivatives, [q, qd], step);
        let [q, qd] = found.map(|[dq, dqd, dtau]| StepDerivatives { dq, dqd, dtau });
        NextStateDerivatives { q, qd }
    }
}

impl<const DOF: usize, R> RungeKuttaStepDerivatives<DOF> for R where
    R: ForwardDynamics<DOF> + ForwardDynamicsDerivatives<DOF>
{
}

capability! { @counted definition
    /// As [`RungeKuttaStep::runge_kutta_step`].
    fn runge_kutta_step(q: joints, qd: joints, tau: joints, step: duration) -> NextState<DOF> = |robot| {
        let accelerations =
            |q: &Vec<T>, qd: &Vec<T>| Ok::<_, Infallible>(robot.forward_dynamics([q, qd, tau], AtTip::Nothing));
        let Ok([q, qd]) = integrators::runge_kutta_step(accelerations, [&q.to_vec(), &qd.to_vec()], |_| step);
        (q, qd)
    };
    /// As [`RungeKuttaStepDerivatives::runge_kutta_step_derivatives`].
    fn runge_kutta_step_derivatives(q: joints, qd: joints, tau: joints, step: duration)
        -> NextStateDerivatives<DOF> = |robot| {
        let accelerations =
            |q: &Vec<T>, qd: &Vec<T>| Ok::<_, Infallible>(robot.forward_dynamics([q, qd, tau], AtTip::Nothing));
        let derivatives = |q: &Vec<T>, qd: &Vec<T>| {
            let (dq, dqd, dtau) = robot.acceleration_derivatives([q, qd, tau], AtTip::Nothing, AtTip::Nothing);
            Ok([dq, dqd, dtau])
        };
        let state = [&q.to_vec(), &qd.to_vec()];
        let Ok(found) = integrators::runge_kutta_step_derivatives(accelerations, derivatives, state, step);
        let [q, qd] = found.map(|[dq, dqd, dtau]| (dq, dqd, dtau).into());
        (q, qd)
    };
}
