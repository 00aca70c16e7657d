//! What a robot can compute: one trait per capability, implemented by generated code and by [`Arm`](crate::Arm) alike.
//!
//! Joint arrays run from base to tip. Revolute joints: rad, rad/s, rad/s², N m. Prismatic joints: m, m/s, m/s², N.

use crate::{Scalar, Wrench};

/// Torques from motion: recursive Newton-Euler inverse dynamics, τ(q, q̇, q̈).
///
/// τ is what the actuators must deliver: τ = M(q) q̈ + C(q, q̇) q̇ + g(q). No friction, no rotor inertia.
#[diagnostic::on_unimplemented(
    note = "`InverseDynamics` belongs into the same `derive`, for a number of joints that the robot file decides: \
            `#[derive(InverseDynamics)]`, and with batches `#[derive(InverseDynamics, BatchInverseDynamics)]`"
)]
pub trait InverseDynamics<const DOF: usize> {
    /// Torques for positions `q`, velocities `qd` and accelerations `qdd` with a free tip.
    #[must_use]
    fn inverse_dynamics<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], qdd: &[T; DOF]) -> [T; DOF];

    /// Torques when the last link exerts `wrench` on its environment: τ = τ_free + Jᵀ w.
    #[must_use]
    fn inverse_dynamics_with_wrench<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        wrench: &Wrench<T>,
    ) -> [T; DOF];

    /// Torques for a caller who has the sines and cosines of the joint positions already, from a CORDIC or a kinematics pass:
    /// `sin[i]` and `cos[i]` are those of `q[i]` of a revolute joint, without the constant part of its angle; those of a
    /// prismatic joint are not used, as `q[i]` of a revolute joint is not.
    #[must_use]
    fn inverse_dynamics_sc<T: Scalar>(
        &self,
        sin: &[T; DOF],
        cos: &[T; DOF],
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
    ) -> [T; DOF];

    /// Torques that hold the arm still against gravity, τ(q, 0, 0).
    #[must_use]
    fn gravity_torques<T: Scalar>(&self, q: &[T; DOF]) -> [T; DOF];

    /// Coriolis, centrifugal and gravity torques, τ(q, q̇, 0).
    #[must_use]
    fn bias_torques<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [T; DOF];
}
