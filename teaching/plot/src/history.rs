//! The torques of an arm along a trajectory.

use rne_model::Robot;
use rne_runtime::{DynArm, WrongLength};

use crate::parts::TorqueParts;
use crate::trajectory::Trajectory;

/// Torques, their parts and powers at every sample of a trajectory.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TorqueHistory {
    /// Torques and their parts at each sample.
    pub parts: Vec<TorqueParts>,
    /// Powers τ q̇ at each sample, W, base to tip.
    pub powers: Vec<Vec<f64>>,
    /// The largest torque of each joint, base to tip; empty for a trajectory without samples.
    pub peaks: Vec<Peak>,
}

/// The largest torque of a joint, by its magnitude.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Peak {
    /// The index of the sample; the first one if several are equal.
    pub sample: usize,
    /// The time of the sample, s.
    pub time: f64,
    /// The torque, with its sign, N m or N.
    pub tau: f64,
    /// The part of the torque that velocities cause, from 0 to 1: [`TorqueParts::velocity_share`].
    pub velocity_share: f64,
}

impl TorqueHistory {
    /// Computes the history of a robot with a free tip. Rotors are included if the robot has them.
    ///
    /// # Errors
    /// When the trajectory does not have one number per joint.
    pub fn new(robot: &Robot, trajectory: &Trajectory) -> Result<Self, WrongLength> {
        let arm = DynArm::from_robot(robot);
        let states = trajectory.q.iter().zip(&trajectory.qd).zip(&trajectory.qdd);
        let parts = states.map(|((q, qd), qdd)| TorqueParts::at(&arm, q, qd, qdd)).collect::<Result<Vec<_>, _>>()?;
        let powers = parts.iter().zip(&trajectory.qd).map(|(parts, qd)| parts.powers(qd)).collect();
        let peaks = (0..robot.dof()).filter_map(|joint| peak(&parts, &trajectory.time, joint)).collect();
        Ok(Self { parts, powers, peaks })
    }

    /// Returns the first sample with a number that is not finite.
    #[must_use]
    pub fn overflows(&self) -> Option<usize> {
        self.parts.iter().position(|parts| !parts.is_finite())
    }
}

fn peak(parts: &[TorqueParts], time: &[f64], joint: usize) -> Option<Peak> {
    let torques = parts.iter().map(|parts| parts.total[joint]).enumerate();
    let larger = |best: (usize, f64), next: (usize, f64)| if next.1.abs() > best.1.abs() { next } else { best };
    let (sample, tau) = torques.reduce(larger)?;
    let velocity_share = parts[sample].velocity_share(joint);
    Some(Peak { sample, time: time[sample], tau, velocity_share })
}
