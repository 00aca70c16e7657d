//! Torques that a motion is predicted to take, against effort limits.

use rne_machine::{CompiledArm, EvaluationError, Form};
use rne_model::{Joint, Robot};

use crate::motions::design::{states, torques};
use crate::motions::fourier::{Fourier, Grid};
use crate::motions::motion_limits::MotionLimits;

/// Instants of a period per harmonic.
const INSTANTS: usize = 64;

/// The arm of the file, with its rotors and its friction.
#[derive(Clone, Debug)]
pub(crate) struct Effort {
    arm: CompiledArm,
    /// The friction of each joint at its speed limit, in the worse direction.
    friction: Vec<f64>,
    grid: Grid,
}

impl Effort {
    /// `None` where no joint has an effort limit.
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

    /// The largest torque of each joint, N m or N: at the instants, by how much more it may be between them, and
    /// friction as if at full speed.
    ///
    /// Between samples that are h apart a curve leaves their larger one by h² |f''| / 8 at most; second differences are
    /// h² f''. Twice that is taken, for f'' may be larger between the samples, too.
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
