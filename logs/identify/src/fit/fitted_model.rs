//! Base parameters and friction that were fitted to logs, as the reference for other logs of the same arm.

use nalgebra::{DMatrix, DVector};
use rne_logs::Motion;
use rne_model::Robot;

use crate::fit::identification::over_logs;
use crate::fit::information::{MotionError, WINDOW, Walk, Weighting, checked, plain_columns};
use crate::fit::stretches::{Stretch, Stretches};
use crate::fit::structure::{FRICTION, Structure};

/// A model that was fitted to logs, with the information of the logs about its unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedModel {
    /// Base parameters; viscous friction, Coulomb friction and the offset of each joint; the remaining delay in
    /// addition to [`delay`](Self::delay), s.
    pub solution: DVector<f64>,
    /// The inverse of the covariance of the unknowns, for errors that are white before the filter.
    pub information: DMatrix<f64>,
    /// Standard deviation of each joint's noise after the filter, N m or N; infinite for a joint without efforts.
    pub noise: Vec<f64>,
    /// The transition of each joint's Coulomb friction: an index into [`Options::transitions`](crate::Options).
    pub transitions: Vec<usize>,
    /// Time by which the torques lag behind the positions, s.
    pub delay: f64,
}

/// The unknowns of one joint's friction, in the order of [`FittedModel::solution`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FrictionParameter {
    /// Viscous friction, N m s/rad or N s/m.
    Viscous,
    /// Coulomb friction, N m or N.
    Coulomb,
    /// The constant part of the friction torque, N m or N.
    Offset,
}

impl FittedModel {
    /// Fits a model to motions. `pass` is called several times and passes all motions to its argument, each with the
    /// number of its run. Parameters that the motions do not excite stay as in the robot file. The second value
    /// contains the equations of the motions.
    ///
    /// # Errors
    /// When a motion is of another robot; when all motions give too few rows, or have no efforts; or when `pass` fails.
    pub fn of<E: From<MotionError>>(
        structure: &Structure,
        mut pass: impl FnMut(&mut dyn FnMut(u64, &Motion) -> Result<(), MotionError>) -> Result<(), E>,
    ) -> Result<(Self, Stretches), E> {
        let found = over_logs(structure, true, &mut |take| pass(&mut |_, motion| take(motion)))?;
        let fit = found.least_squares;
        let weighting = fit.weighting(structure).with_doubt_near_rest();
        let mut model = Self {
            solution: fit.solution,
            information: DMatrix::zeros(0, 0),
            noise: fit.noise,
            transitions: fit.transitions,
            delay: fit.delay,
        };
        let mut stretches = Stretches::with_weighting(structure, &model, weighting);
        pass(&mut |run, motion| stretches.absorb(structure, run, motion))?;
        let count = structure.count();
        let total = stretches.total(structure);
        let ridge = found.scales.ridge(structure).map(|ridge| ridge * ridge);
        model.information = total.view((0, 0), (count, count)).clone_owned();
        let mut target = total.view((0, count), (count, 1)).clone_owned();
        let file = Self::of_file(structure, &model.transitions).solution;
        for at in 0..count {
            model.information[(at, at)] += ridge[at];
            target[at] += ridge[at] * file[at];
        }
        if let Some(solution) = solved(&model.information, &target.column(0).clone_owned()) {
            model.solution = solution;
        }
        Ok((model, stretches))
    }

    /// Returns the model of the robot file itself, without information on the uncertainty of its parameters.
    #[must_use]
    pub fn of_file(structure: &Structure, transitions: &[usize]) -> Self {
        let (count, rank) = (structure.count(), structure.parameters.rank());
        let mut solution = DVector::zeros(count);
        let bases = &structure.parameters.regrouping * structure.parameters.of_robot(&structure.robot);
        solution.rows_mut(0, rank).copy_from(&bases);
        for joint in 0..structure.dof() {
            let Some(at) = structure.friction_at(joint) else { continue };
            let friction = file_friction(&structure.robot, joint);
            solution.rows_mut(at, FRICTION).copy_from_slice(&friction);
        }
        Self {
            solution,
            information: DMatrix::zeros(count, count),
            noise: vec![f64::INFINITY; structure.dof()],
            transitions: transitions.to_vec(),
            delay: 0.0,
        }
    }

    /// Returns the model without some of the stretches from which it was fitted; `None` if the rest is too little for a
    /// fit.
    #[must_use]
    pub fn without(&self, structure: &Structure, stretches: &[Stretch]) -> Option<Self> {
        let count = structure.count();
        let mut left_out = DMatrix::zeros(count + 1, count + 1);
        for stretch in stretches {
            stretch.add_to(structure, &mut left_out);
        }
        let of_columns = left_out.view((0, 0), (count, count)).clone_owned();
        let of_torques = left_out.view((0, count), (count, 1)).column(0).clone_owned();
        let information = &self.information - of_columns;
        let target = &self.information * &self.solution - of_torques;
        Some(Self { solution: solved(&information, &target)?, information, ..self.clone() })
    }

    /// Returns the torques of each joint that a change of the unknowns adds along a motion, N m or N. A change of the
    /// delay adds none.
    ///
    /// # Errors
    /// When the motion is of another robot, or has numbers that are not finite.
    pub fn torques(
        &self,
        structure: &Structure,
        motion: &Motion,
        change: &DVector<f64>,
    ) -> Result<Vec<Vec<f64>>, MotionError> {
        checked(structure.dof(), motion)?;
        let mut torques = vec![Vec::with_capacity(motion.len()); structure.dof()];
        let mut walk = Walk::new(structure);
        for start in (0..motion.len()).step_by(WINDOW) {
            let range = start..(start + WINDOW).min(motion.len());
            walk.advance(motion, start);
            let columns = plain_columns(structure, motion, range, &walk)?;
            for (joint, (torques, columns)) in torques.iter_mut().zip(&columns).enumerate() {
                let used = structure.used(joint, self.transitions[joint]);
                let mut sum = DVector::zeros(columns.nrows());
                let places = used.iter().filter(|column| **column < columns.ncols());
                for (column, unknown) in places.zip(structure.unknowns(joint)) {
                    sum.axpy(change[unknown], &columns.column(*column), 1.0);
                }
                torques.extend(sum.iter());
            }
        }
        Ok(torques)
    }

    /// Returns the index of a joint's friction parameter among the unknowns; `None` without friction.
    #[must_use]
    pub fn place(structure: &Structure, joint: usize, parameter: FrictionParameter) -> Option<usize> {
        Some(structure.friction_at(joint)? + parameter as usize)
    }

    /// Returns the weighting of rows of other logs: rows near rest have less weight; large residuals do not reduce the
    /// weight.
    #[must_use]
    pub fn weighting(&self, structure: &Structure) -> Weighting {
        Weighting::new(structure, &self.solution, &self.transitions, self.noise.clone(), self.delay)
            .with_doubt_near_rest()
            .with_all_rows()
    }
}

/// Returns the friction of a joint in the robot file: viscous friction, and half the sum and half the difference of
/// Coulomb friction in both directions.
pub(crate) fn file_friction(robot: &Robot, joint: usize) -> [f64; FRICTION] {
    let Some(motor) = robot.independent_joint(joint).and_then(|joint| joint.motor) else { return [0.0; FRICTION] };
    let ratio = motor.gear_ratio.abs();
    let [forward, backward] = motor.coulomb.map(|coulomb| ratio * coulomb);
    [ratio * ratio * motor.viscous, 0.5 * (forward - backward), 0.5 * (forward + backward)]
}

/// Solves symmetric equations, scaled first because their unknowns have different units; `None` if the matrix is not
/// positive definite.
pub(crate) fn solved(matrix: &DMatrix<f64>, target: &DVector<f64>) -> Option<DVector<f64>> {
    let scale = unit_diagonal(matrix);
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| {
        matrix[(row, column)] * scale[row] * scale[column]
    });
    Some(scaled.cholesky()?.solve(&target.component_mul(&scale)).component_mul(&scale))
}

/// Returns the inverse of an information matrix, which is the covariance. The matrix is scaled first, because its
/// unknowns have different units. `None` if it is not positive definite.
#[must_use]
pub fn inverse_of_information(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = unit_diagonal(matrix);
    let scaled = |matrix: &DMatrix<f64>| {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| {
            matrix[(row, column)] * scale[row] * scale[column]
        })
    };
    Some(scaled(&scaled(matrix).cholesky()?.inverse()))
}

fn unit_diagonal(matrix: &DMatrix<f64>) -> DVector<f64> {
    matrix.diagonal().map(|square| if square > 0.0 { 1.0 / square.sqrt() } else { 1.0 })
}
