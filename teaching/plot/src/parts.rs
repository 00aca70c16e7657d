//! The parts of a torque.
//!
//! ```text
//! τ = M(q) q̈ + C(q, q̇) q̇ + g(q)
//! ```
//!
//! Each part is a call of inverse dynamics of its own, without gravity or without motion, so that their sum is a check.

use rne_runtime::{BaseMotion, DynArm, WrongLength};

/// The torques of one state and their parts, base to tip: N m of a revolute joint, N of a prismatic one.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TorqueParts {
    /// M(q) q̈: what accelerates the arm; rotors too, where they belong to it.
    pub inertia: Vec<f64>,
    /// C(q, q̇) q̇: Coriolis and centrifugal torques, quadratic in the velocities.
    pub velocity: Vec<f64>,
    /// g(q): what holds the arm still.
    pub gravity: Vec<f64>,
    /// τ(q, q̇, q̈), computed at once.
    pub total: Vec<f64>,
}

impl TorqueParts {
    /// The parts at a state of an arm with a free tip.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn at(arm: &DynArm, q: &[f64], qd: &[f64], qdd: &[f64]) -> Result<Self, WrongLength> {
        let weightless = BaseMotion::fixed([0.0; 3]);
        let still = vec![0.0; arm.dof()];
        Ok(Self {
            inertia: arm.inverse_dynamics_on_moving_base(q, &still, qdd, &weightless)?,
            velocity: arm.inverse_dynamics_on_moving_base(q, qd, &still, &weightless)?,
            gravity: arm.gravity_torques(q)?,
            total: arm.inverse_dynamics(q, qd, qdd)?,
        })
    }

    /// The powers τ q̇ that the actuators deliver, W, base to tip; negative where they brake.
    #[must_use]
    pub fn powers(&self, qd: &[f64]) -> Vec<f64> {
        self.total.iter().zip(qd).map(|(tau, qd)| tau * qd).collect()
    }

    /// The part of a joint's torque that comes of velocities: its magnitude, of the sum of the magnitudes of all three
    /// parts; 0 where there is no torque.
    #[must_use]
    pub fn velocity_share(&self, joint: usize) -> f64 {
        let magnitude = |part: &[f64]| part.get(joint).map_or(0.0, |value| value.abs());
        let all = magnitude(&self.inertia) + magnitude(&self.velocity) + magnitude(&self.gravity);
        if all == 0.0 { 0.0 } else { magnitude(&self.velocity) / all }
    }

    /// Whether every number is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        [&self.inertia, &self.velocity, &self.gravity, &self.total].into_iter().flatten().all(|value| value.is_finite())
    }
}
