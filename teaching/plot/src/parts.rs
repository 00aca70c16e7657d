//! Splits a torque into its parts.
//!
//! ```text
//! τ = M(q) q̈ + C(q, q̇) q̇ + g(q)
//! ```
//!
//! Each part is a separate call of inverse dynamics, without gravity or without motion, so that their sum is a check.

use rne_runtime::{BaseMotion, DynArm, WrongLength};

/// The torques of one state and their parts, base to tip: N m for a revolute joint, N for a prismatic joint.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TorqueParts {
    /// M(q) q̈: the torques that accelerate the arm, including its rotors if it has them.
    pub inertia: Vec<f64>,
    /// C(q, q̇) q̇: Coriolis and centrifugal torques, quadratic in the velocities.
    pub velocity: Vec<f64>,
    /// g(q): the torques that hold the arm at rest.
    pub gravity: Vec<f64>,
    /// τ(q, q̇, q̈), computed by a single call.
    pub total: Vec<f64>,
}

impl TorqueParts {
    /// Computes the parts at a state of an arm with a free tip.
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

    /// Returns the powers τ q̇ of the actuators, W, base to tip; negative if they brake.
    #[must_use]
    pub fn powers(&self, qd: &[f64]) -> Vec<f64> {
        self.total.iter().zip(qd).map(|(tau, qd)| tau * qd).collect()
    }

    /// Returns the share of velocities in a joint's torque: the magnitude of the velocity part over the sum of the
    /// magnitudes of all three parts; 0 if there is no torque.
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
