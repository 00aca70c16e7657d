//! Compares two arms at many states.

use nalgebra::{Matrix3, Vector3};
use rne_model::{ClosedLoops, Frame, Robot};
use rne_runtime::{DynArm, Pose};

use crate::dynamics::{Dynamics, State};

/// Number of states at which two arms are compared.
pub(crate) const STATES: usize = 1000;

/// The largest differences between two arms over 1,000 states within the position limits, with speeds up to 2 and
/// accelerations up to 5 (in rad or m).
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
pub struct Difference {
    /// The difference of the place of the tip or of a named frame, m.
    pub position: f64,
    /// The difference of the rotation of the tip or of a named frame, rad.
    pub rotation: f64,
    /// The difference of a torque or force, relative to the largest torque of the same state.
    pub torque: f64,
    /// The difference of a torque or force, N m or N.
    pub absolute_torque: f64,
    /// The difference of an acceleration for the same torques, relative to the largest acceleration of the same state;
    /// `None` where the mass matrix is singular.
    pub acceleration: Option<f64>,
}

impl Difference {
    /// Compares two chains.
    pub(crate) fn of_chains(one: &Dynamics, other: &Dynamics) -> Self {
        let mut difference = Self { acceleration: Some(0.0), ..Self::default() };
        for State { q, qd, qdd } in one.states(STATES) {
            difference.tips(one.tip(&q), other.tip(&q));
            let torques = one.torques(&q, &qd, &qdd);
            difference.torques(&torques, &other.torques(&q, &qd, &qdd));
            // The accelerations of the other chain under the torques that cause q̈ in the first one.
            let caused = other.accelerations(&q, &qd, &torques);
            difference.acceleration = difference
                .acceleration
                .zip(one.accelerations(&q, &qd, &torques).zip(caused))
                .map(|(largest, (a, b))| largest.max(relative(&a, &b)));
        }
        difference
    }

    /// Compares a chain with the table made of it, for which the rne runtime computes the values.
    pub(crate) fn of_table(chain: &Dynamics, robot: &Robot) -> Self {
        // the dynamics of the chain ignore couplings and loops, so all joints move freely on both sides
        let mut robot = Robot { closed: ClosedLoops::default(), ..robot.clone() };
        robot.joints.iter_mut().for_each(|joint| joint.coupling = None);
        let arm = DynArm::from_robot(&robot);
        let at = |frame: &Frame| arm.clone().at_frame(frame.fixed);
        let frames: Vec<DynArm> = robot.frames.iter().filter_map(at).collect();
        let mut difference = Self::default();
        for State { q, qd, qdd } in chain.states(STATES) {
            if let Ok(tip) = arm.forward_kinematics(&q) {
                difference.tips(chain.tip(&q), placed(&tip));
            }
            for (arm, expected) in frames.iter().zip(chain.frames(&q)) {
                if let Ok(frame) = arm.forward_kinematics(&q) {
                    difference.tips(expected, placed(&frame));
                }
            }
            if let Ok(torques) = arm.inverse_dynamics(&q, &qd, &qdd) {
                difference.torques(&chain.torques(&q, &qd, &qdd), &torques);
            }
        }
        difference
    }

    fn tips(&mut self, (r, p): (Matrix3<f64>, Vector3<f64>), (rotation, position): (Matrix3<f64>, Vector3<f64>)) {
        self.position = self.position.max((p - position).norm());
        // Sine of half the angle from the distance of the two matrices, which is accurate for small angles.
        let half = ((r - rotation).norm() / 8.0_f64.sqrt()).min(1.0);
        self.rotation = self.rotation.max(2.0 * half.asin());
    }

    fn torques(&mut self, one: &[f64], other: &[f64]) {
        self.torque = self.torque.max(relative(one, other));
        let difference = one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        self.absolute_torque = self.absolute_torque.max(difference);
    }
}

fn relative(one: &[f64], other: &[f64]) -> f64 {
    let largest = one.iter().map(|x| x.abs()).fold(0.0, f64::max);
    let difference = one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if difference == 0.0 { 0.0 } else { difference / largest.max(f64::MIN_POSITIVE) }
}

fn placed(pose: &Pose<f64>) -> (Matrix3<f64>, Vector3<f64>) {
    (pose.rotation_matrix(), pose.translation_vector())
}
