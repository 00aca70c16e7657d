//! The step of the semi-implicit Euler method, and its derivatives by the state and by the torques.

use core::array::from_fn;

use crate::Scalar;
#[cfg(feature = "arm")]
use crate::{Arm, Constant, ForwardDynamics, ForwardDynamicsDerivatives};

/// The state of a robot after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NextState<const DOF: usize, T> {
    /// Positions, rad or m.
    pub q: [T; DOF],
    /// Velocities, rad/s or m/s.
    pub qd: [T; DOF],
}

/// The derivatives of `DOF` positions or velocities after a step. Row i belongs to position or velocity i of the next
/// state, column j to joint j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepDerivatives<const DOF: usize, T> {
    /// By the positions, per rad or m.
    pub dq: [[T; DOF]; DOF],
    /// By the velocities, per rad/s or m/s.
    pub dqd: [[T; DOF]; DOF],
    /// By the torques, per N m or N.
    pub dtau: [[T; DOF]; DOF],
}

/// The linear model of a step: with the state x = (q, q̇), the changes δx' = A δx + B δτ. The rows of A are `dq` beside
/// `dqd`, those of B are `dtau`, of the positions above the velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NextStateDerivatives<const DOF: usize, T> {
    /// Derivatives of the next positions.
    pub q: StepDerivatives<DOF, T>,
    /// Derivatives of the next velocities.
    pub qd: StepDerivatives<DOF, T>,
}

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
impl<const DOF: usize, S: Constant> EulerStep<DOF> for Arm<DOF, S> {
    fn euler_step<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], tau: &[T; DOF], step: T) -> NextState<DOF, T> {
        let next = moved(qd, &self.forward_dynamics(q, qd, tau), step);
        NextState { q: moved(q, &next, step), qd: next }
    }
}

#[cfg(feature = "arm")]
impl<const DOF: usize, S: Constant> EulerStepDerivatives<DOF> for Arm<DOF, S> {
    fn euler_step_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        step: T,
    ) -> NextStateDerivatives<DOF, T> {
        let found = self.forward_dynamics_derivatives(q, qd, tau);
        let rates = moved_by(RATE, &[found.dq, found.dqd, found.dtau], step);
        NextStateDerivatives { q: named(moved_by(POSITION, &rates, step)), qd: named(rates) }
    }
}

/// Derivatives by q, by q̇ and by τ, each by rows.
pub(crate) type Blocks<const DOF: usize, T> = [[[T; DOF]; DOF]; 3];

/// The places of the derivatives by q and by q̇ among them.
pub(crate) const POSITION: usize = 0;
pub(crate) const RATE: usize = 1;

/// x + h times what changes it.
pub(crate) fn moved<const DOF: usize, T: Scalar>(x: &[T; DOF], change: &[T; DOF], step: T) -> [T; DOF] {
    from_fn(|i| x[i] + step * change[i])
}

pub(crate) fn named<const DOF: usize, T>([dq, dqd, dtau]: Blocks<DOF, T>) -> StepDerivatives<DOF, T> {
    StepDerivatives { dq, dqd, dtau }
}

/// The derivatives of x + h times what changes it, where x is the argument of this place.
pub(crate) fn moved_by<const DOF: usize, T: Scalar>(place: usize, change: &Blocks<DOF, T>, step: T) -> Blocks<DOF, T> {
    let mut found = change.map(|block| block.map(|row| row.map(|x| step * x)));
    for (joint, row) in found[place].iter_mut().enumerate() {
        row[joint] += T::one();
    }
    found
}
