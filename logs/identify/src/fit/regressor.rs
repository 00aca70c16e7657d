//! Computes the regressor columns of the inertial parameters at the states of a motion, and the torques that do not
//! depend on these parameters.
//!
//! With the ratios of the couplings in the matrix G, the joints of a robot have G q, G q̇ and G q̈, and the torques
//! that work on its coordinates are Gᵀ τ. So its regressor is Gᵀ Y of the robot whose joints all move freely, at those
//! states. The rotors of the list `motors` have torques of their own, which are known: they are those of the robot
//! without links.

use std::ops::Range;

use rne_logs::Motion;
use rne_machine::{CompiledArm, EvaluationError, Form, Function};
use rne_model::{Link, PER_LINK, Robot};

use crate::motions::design::run;

/// The regressor of a robot's geometry, and the torques of its known rotors.
#[derive(Clone, Debug)]
pub(crate) struct Regressor {
    /// The robot without its couplings: every joint moves independently. Only its geometry is used.
    arm: CompiledArm,
    /// Number of joints.
    joints: usize,
    /// Row by row of G: the coordinates that a joint moves with, counted from 0, and the ratio of each.
    follows: Vec<Vec<(usize, f64)>>,
    /// Whether some joint depends on others.
    is_coupled: bool,
    /// The robot with the rotors of the list `motors`, on links without mass.
    rotors: Option<CompiledArm>,
}

/// The columns of each coordinate's torque at some states.
pub(crate) struct Columns {
    numbers: Vec<f64>,
    states: usize,
    joints: usize,
}

impl Columns {
    /// Returns the torques of a coordinate at each state if one parameter of a link is 1 and all others are 0.
    pub(crate) fn of(&self, coordinate: usize, link: usize, parameter: usize) -> &[f64] {
        let column = (coordinate * self.joints + link) * PER_LINK + parameter;
        &self.numbers[column * self.states..][..self.states]
    }
}

impl Regressor {
    pub(crate) fn of(robot: &Robot) -> Self {
        let coordinates: Vec<usize> = robot.coordinates().collect();
        let place = |joint: usize| coordinates.iter().position(|&coordinate| coordinate == joint).unwrap_or_default();
        let follows = robot.joints.iter().enumerate().map(|(joint, row)| match &row.coupling {
            None => vec![(place(joint), 1.0)],
            Some(coupling) => coupling.follows.iter().map(|&(followed, ratio)| (place(followed), ratio)).collect(),
        });
        let bare = bare(robot);
        let rotors = robot.has_spinning_rotors().then(|| CompiledArm::from_robot(&bare).in_form(Form::SevenSteps));
        Self {
            arm: CompiledArm::from_robot(&free(bare)),
            joints: robot.joints.len(),
            follows: follows.collect(),
            is_coupled: robot.has_couplings(),
            rotors,
        }
    }

    /// Returns the regressor in a form whose results have the same bits on every machine.
    pub(crate) fn in_seven_steps(mut self) -> Self {
        self.arm = self.arm.in_form(Form::SevenSteps);
        self
    }

    /// Computes the columns at some states of a motion.
    pub(crate) fn columns(&self, motion: &Motion, range: Range<usize>) -> Result<Columns, EvaluationError> {
        let (states, joints) = (range.len(), self.joints);
        let coordinates = motion.q.len();
        let mut numbers = vec![0.0; states * joints * joints * PER_LINK];
        if states > 0 {
            let columns = numbers.chunks_mut(states).collect();
            if self.is_coupled {
                let all = self.of_all_joints(motion, range);
                run(&self.arm, Function::Regressor, &all, 0..states, columns)?;
            } else {
                run(&self.arm, Function::Regressor, motion, range, columns)?;
            }
        }
        if self.is_coupled {
            let row = states * joints * PER_LINK;
            let mut gathered = vec![0.0; row * coordinates];
            for (of_joint, follows) in numbers.chunks(row.max(1)).zip(&self.follows) {
                for &(coordinate, ratio) in follows {
                    let sum = &mut gathered[coordinate * row..][..row];
                    sum.iter_mut().zip(of_joint).for_each(|(sum, torque)| *sum += ratio * torque);
                }
            }
            numbers = gathered;
        }
        Ok(Columns { numbers, states, joints })
    }

    /// Computes the torques of the rotors of the list `motors` for each coordinate at some states of a motion; `None`
    /// for a robot without such rotors.
    pub(crate) fn of_rotors(
        &self,
        motion: &Motion,
        range: Range<usize>,
    ) -> Result<Option<Vec<Vec<f64>>>, EvaluationError> {
        let Some(arm) = &self.rotors else { return Ok(None) };
        let mut torques = vec![vec![0.0; range.len()]; motion.q.len()];
        if !range.is_empty() {
            run(arm, Function::InverseDynamics, motion, range, torques.iter_mut().map(Vec::as_mut_slice).collect())?;
        }
        Ok(Some(torques))
    }

    /// Returns the states of all joints, without the offsets of the couplings, which are in the rows of the robot
    /// without couplings.
    fn of_all_joints(&self, motion: &Motion, range: Range<usize>) -> Motion {
        let all = |lists: &[Vec<f64>]| -> Vec<Vec<f64>> {
            let of_joint = |follows: &Vec<(usize, f64)>| {
                range
                    .clone()
                    .map(|state| follows.iter().map(|&(coordinate, ratio)| ratio * lists[coordinate][state]).sum())
                    .collect()
            };
            self.follows.iter().map(of_joint).collect()
        };
        Motion {
            time: motion.time[range.clone()].to_vec(),
            q: all(&motion.q),
            qd: all(&motion.qd),
            qdd: all(&motion.qdd),
            ..Motion::default()
        }
    }
}

/// Returns the robot with links without mass and without the rotors of its joints.
pub(crate) fn bare(robot: &Robot) -> Robot {
    let mut bare = Robot { rotors: false, ..robot.clone() };
    for joint in &mut bare.joints {
        joint.row.link = Link::default();
    }
    bare
}

/// Returns the robot without couplings. The zero of a dependent joint is its position when the joints that it depends
/// on are at 0.
fn free(mut robot: Robot) -> Robot {
    robot.drives.clear();
    for joint in &mut robot.joints {
        joint.row = joint.row_with_offset();
        joint.coupling = None;
    }
    robot
}
