//! Predicts the torques of a motion, to compare them with effort limits.

use rne_machine::{CompiledArm, EvaluationError, Form};
use rne_model::{Joint, Robot};

use crate::motions::design::{states, torques};
use crate::motions::fourier::{Fourier, Grid};
use crate::motions::motion_limits::MotionLimits;

/// Number of instants in a period, for each harmonic.
const INSTANTS: usize = 64;

/// Predicts torques by the arm of the file, with its rotors and its friction.
#[derive(Clone, Debug)]
pub(crate) struct Effort {
    arm: CompiledArm,
    /// The friction of each joint at its speed limit, in the direction with more friction.
    friction: Vec<f64>,
    grid: Grid,
}

impl Effort {
    /// Sets up the prediction; `None` if no joint has an effort limit.
    pub(crate) fn of(robot: &Robot, limits: &[MotionLimits], harmonics: usize) -> Option<Self> {
        limits.iter().any(|limits| limits.effort.is_some()).then(|| {
            let arm = CompiledArm::from_robot(&robot.clone().with_rotors()).in_form(Form::SevenSteps);
            let worse = |(joint, limits): (&Joint, &MotionLimits)| {
                joint.friction(limits.velocity).abs().max(joint.friction(-limits.velocity).abs())
            };
            let friction = robot.independent_joints().zip(limits).map(worse).collect();
            Self { arm, friction, grid: Grid::new(INSTANTS * harmonics) }
        })
    }

    /// Returns an upper bound of the torque of each joint, N m or N: the largest value at the instants, plus a bound of
    /// the excess between them, plus friction at the speed limit.
    ///
    /// Between samples at a distance h, a curve exceeds the larger one by at most h² |f''| / 8; second differences
    /// approximate h² f''. Twice this bound is taken, because f'' may be larger between the samples.
    pub(crate) fn largest(&self, motion: &Fourier) -> Result<Vec<f64>, EvaluationError> {
        let all = torques(&self.arm, &states(motion, &self.grid))?;
        let largest = |(torques, friction): (&Vec<f64>, &f64)| {
            let count = torques.len();
            let most = torques.iter().fold(0.0_f64, |most, torque| torque.abs().max(most));
            let bend = |at: usize| torques[(at + 1) % count] - 2.0 * torques[at] + torques[(at + count - 1) % count];
            let bent = (0..count).fold(0.0_f64, |most, at| bend(at).abs().max(most));
            most + 0.25 * bent + friction
        };
        Ok(all.iter().zip(&self.friction).map(largest).collect())
    }
}
