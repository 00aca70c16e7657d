//! The step of the semi-implicit Euler method, and its derivatives by the state and by the torques.

#[cfg(feature = "arm")]
use crate::{
    Arm, Constant,
    at_tip::AtTip,
    definition::definitions,
    steps::{POSITION, RATE, moved, moved_by},
};
use crate::{NextState, NextStateDerivatives, Scalar};

/// A step of the semi-implicit Euler method under torques that do not change during the step.
pub trait EulerStep<const DOF: usize> {
    /// Positions and velocities after a step of the duration `step`, s: q̇' = q̇ + h q̈ with the accelerations q̈ of q, q̇
    /// and τ ([`forward_dynamics`](crate::ForwardDynamics::forward_dynamics)), then q' = q + h q̇'. The error of a
    /// motion is of order h.
    ///
    /// The tip is free, and joints have no friction and no limits. A singular mass matrix (a joint that moves nothing)
    /// gives numbers that are not finite. Source: E. Hairer, C. Lubich, G. Wanner, "Geometric numerical integration",
    /// 2006, section I.1.2.
    #[must_use]
    fn euler_step<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], tau: &[T; DOF], step: T) -> NextState<DOF, T>;
}

/// Derivatives of a step of the semi-implicit Euler method, for optimisers.
pub trait EulerStepDerivatives<const DOF: usize> {
    /// The derivatives of [`euler_step`](EulerStep::euler_step) by q, q̇ and τ: those of the velocities are 1 + h times
    /// those of the accelerations, those of the positions are 1 + h times those of the next velocities.
    ///
    /// They are exact up to rounding. `step` is the duration h, s.
    #[must_use]
    fn euler_step_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        step: T,
    ) -> NextStateDerivatives<DOF, T>;
}

#[cfg(feature = "arm")]
definitions! { EulerStep<DOF> {
    /// As [`EulerStep::euler_step`].
    fn euler_step(q: joints, qd: joints, tau: joints, step: number) -> NextState<DOF> = |robot| {
        let [position, rate] = [q, qd].map(|x| robot.list(x));
        let next = moved(&rate, &robot.forward_dynamics([q, qd, tau], AtTip::Nothing), step);
        (moved(&position, &next, step), next)
    };
} }

#[cfg(feature = "arm")]
definitions! { EulerStepDerivatives<DOF> {
    /// As [`EulerStepDerivatives::euler_step_derivatives`].
    fn euler_step_derivatives(q: joints, qd: joints, tau: joints, step: number) -> NextStateDerivatives<DOF> = |robot| {
        let (dq, dqd, dtau) = robot.acceleration_derivatives([q, qd, tau], AtTip::Nothing, AtTip::Nothing);
        let rates = moved_by(RATE, &[dq, dqd, dtau], step);
        let [by_q, by_qd, by_tau] = moved_by(POSITION, &rates, step);
        let [dq, dqd, dtau] = rates;
        (From::from((by_q, by_qd, by_tau)), From::from((dq, dqd, dtau)))
    };
} }
