//! Computed torque with an observer of contacts: what a controller computes in a tick.
//!
//! ```text
//! τ = ID(q, q̇, q̈_d + Kd (q̇_d - q̇) + Kp (q_d - q))              the error e obeys ë + Kd ė + Kp e = 0
//! ```
//!
//! After J. Y. S. Luh, M. W. Walker, R. P. C. Paul, "Resolved-acceleration control of mechanical manipulators", IEEE
//! Transactions on Automatic Control 25(3), 1980, in the space of the joints. Torques and observer need the same sines,
//! cosines and velocities: in one function, the compiler computes them once.

use core::array;

use crate::{InverseDynamics, MomentumObserver, ObserverState, Scalar};

/// Where the joints should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Desired<const DOF: usize, T> {
    /// Positions, rad or m.
    pub q: [T; DOF],
    /// Velocities, rad/s or m/s.
    pub qd: [T; DOF],
    /// Accelerations, rad/s² or m/s².
    pub qdd: [T; DOF],
}

/// A computed-torque controller that also observes external torques.
/// One call of [`tick`](Self::tick) for each period of the control loop returns the torques; afterwards
/// [`external_torques`](ObserverState::external_torques) of the observer are those of contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComputedTorque<const DOF: usize, T> {
    /// Kp of each joint, 1/s².
    pub stiffness: [T; DOF],
    /// Kd of each joint, 1/s. 2 √Kp is the least damping without overshoot.
    pub damping: [T; DOF],
    /// The observer, which has the external torques of the last tick.
    pub observer: ObserverState<DOF, T>,
}

impl<const DOF: usize, T: Scalar> ComputedTorque<DOF, T> {
    /// One tick: returns the torques of the actuators, N m or N, from measured positions and velocities (rad and rad/s,
    /// or m and m/s). `applied` are the torques that acted until now, in N m or N: those that the last tick returned,
    /// as the drives limited them. Friction is neither compensated nor observed.
    ///
    /// As [`ObserverState::update`], a tick has no branch that looks at its numbers.
    #[inline]
    pub fn tick<R: InverseDynamics<DOF> + MomentumObserver<DOF>>(
        &mut self,
        robot: &R,
        q: &[T; DOF],
        qd: &[T; DOF],
        desired: &Desired<DOF, T>,
        applied: &[T; DOF],
    ) -> [T; DOF] {
        self.observer.update(robot, q, qd, applied);
        let qdd = array::from_fn(|i| {
            let pulled = self.damping[i] * (desired.qd[i] - qd[i]) + self.stiffness[i] * (desired.q[i] - q[i]);
            desired.qdd[i] + pulled
        });
        robot.inverse_dynamics(q, qd, &qdd)
    }
}
