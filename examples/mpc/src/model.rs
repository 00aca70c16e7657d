//! The robot, and the linear model of one interval.

use rne::{
    AccelerationDerivatives, ForwardDynamics, ForwardDynamicsDerivatives, InverseDynamics, Kinematics,
    MomentumObserver, PayloadDynamics,
};

/// Joints.
pub const DOF: usize = 7;

/// One number for each joint.
pub type Joints = [f64; DOF];

/// The Panda of the robots that rne ships.
#[derive(
    InverseDynamics, ForwardDynamics, ForwardDynamicsDerivatives, Kinematics, MomentumObserver, PayloadDynamics,
)]
#[robot(path = "../../../robots/panda.yaml", form = "reduced")]
pub struct Panda;

/// Positions, rad, and velocities, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Positions.
    pub q: Joints,
    /// Velocities.
    pub qd: Joints,
}

impl State {
    /// The state after an interval with these accelerations, by Euler's semi-implicit method: the new velocities move
    /// the joints.
    #[must_use]
    pub fn after(&self, qdd: &Joints, interval: f64) -> Self {
        let qd = std::array::from_fn(|joint| self.qd[joint] + interval * qdd[joint]);
        Self { q: std::array::from_fn(|joint| self.q[joint] + interval * qd[joint]), qd }
    }
}

/// Accelerations of the arm and their derivatives, for torques to which the external ones are added.
#[must_use]
pub fn accelerations(state: &State, tau: &Joints, external: &Joints) -> (Joints, AccelerationDerivatives<DOF, f64>) {
    let tau = std::array::from_fn(|joint| tau[joint] + external[joint]);
    let qdd = Panda.forward_dynamics(&state.q, &state.qd, &tau);
    (qdd, Panda.forward_dynamics_derivatives(&state.q, &state.qd, &tau))
}

/// The tip in the world, m, and the linear rows of its Jacobian.
#[must_use]
pub fn tip(q: &Joints) -> ([f64; 3], [[f64; DOF]; 3]) {
    let [x, y, z, ..] = Panda.jacobian(q);
    (Panda.forward_kinematics(q).translation, [x, y, z])
}
