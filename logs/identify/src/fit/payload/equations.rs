//! The normal equations of a payload and of the errors of the robot file, and their solutions.

use nalgebra::{DMatrix, DVector, Vector3};
use rne_model::{JointKind, PER_LINK, Robot};

use super::{LEAST_FRICTION, LIGHTEST_PAYLOAD, PAYLOAD_REACH, SLOWEST, TENSOR, of_tip, shifted};
use crate::fit::fitted_model::{FittedModel, FrictionParameter, inverse_of_information};
use crate::fit::stretches::Stretches;
use crate::fit::structure::{FRICTION, Structure};

/// Standard deviation of the mass before any log, kg: so large that it has no effect.
const MASS: f64 = 1e3;

/// Number of iterations that adapt the prior to the estimated mass; half as many adapt the noise to the residuals.
const ROUNDS: usize = 10;

/// Rows of a segment of the jackknife, and the smallest and largest number of segments.
const ROWS: u64 = 20;
const PARTS: [usize; 2] = [4, 32];

/// Expected errors of a file's friction on another motion, as parts of Coulomb friction: of Coulomb friction, of
/// viscous friction at the joint's speed, and of the offset of a moving joint.
const COULOMB: f64 = 0.1;
const VISCOUS: f64 = 0.15;
const OFFSET: f64 = 0.25;

/// The variance of the friction of a joint at rest over the square of Coulomb friction: any value between both
/// directions is equally likely.
const AT_REST: f64 = 1.0 / 3.0;

/// Typical acceleration, m/s² or rad/s², which converts a torque error of the model to an error of first moments and
/// inertia.
const ACCELERATION: f64 = 10.0;

/// Number of joints next to the payload that determine first moments and inertia.
const NEAR: usize = 3;

/// Step of numerical derivatives, in standard deviations.
const STEP: f64 = 1e-4;

/// Mass, centre of mass, and inertia about the centre of mass, or their variances.
pub(super) type Numbers = [f64; PER_LINK];

/// An estimate with the variances of its numbers.
pub(super) struct Estimate {
    pub(super) numbers: Numbers,
    pub(super) variances: Numbers,
}

/// For each segment of time and joint, the normal equations for the payload and the errors of the file. The residual
/// torque of the file is the last column.
pub(super) struct Equations {
    pub(super) parts: Vec<Vec<DMatrix<f64>>>,
    /// The standard deviations of the errors of the file's friction.
    errors: Vec<f64>,
    /// The noise of each joint in the fit, N m or N.
    noise: Vec<f64>,
    /// Factors that reduce the weight of the rows of each joint below the weight from this noise.
    factors: Vec<f64>,
}

impl Equations {
    pub(super) fn new(structure: &Structure, model: &FittedModel, stretches: &Stretches) -> Self {
        let (count, dof) = (structure.count(), structure.dof());
        let size = PER_LINK + FRICTION * dof;
        let mut columns = DMatrix::zeros(count + 1, size + 1);
        let rank = structure.parameters().rank();
        columns
            .view_mut((0, 0), (rank, PER_LINK))
            .copy_from(&(structure.payload_columns(PER_LINK) * of_tip(structure.robot())));
        for at in 0..FRICTION * dof {
            columns[(rank + at, PER_LINK + at)] = 1.0;
        }
        columns.view_mut((0, size), (count, 1)).copy_from(&-&model.solution);
        columns[(count, size)] = 1.0;
        let list = stretches.list();
        let most = PARTS[1].min(list.len()).max(1);
        let number = usize::try_from(stretches.rows() / ROWS).unwrap_or(most).clamp(PARTS[0].min(most), most);
        let mut totals = vec![DMatrix::zeros(count + 1, count + 1); dof];
        let part = |part: usize| -> Vec<DMatrix<f64>> {
            let range = part * list.len() / number..(part + 1) * list.len() / number;
            let joint = |(joint, total): (usize, &mut DMatrix<f64>)| {
                let mut products = DMatrix::zeros(count + 1, count + 1);
                list[range.clone()].iter().for_each(|stretch| stretch.add_joint(structure, joint, &mut products));
                *total += &products;
                columns.tr_mul(&products) * &columns
            };
            totals.iter_mut().enumerate().map(joint).collect()
        };
        let parts = (0..number).map(part).collect();
        let errors = totals.iter().enumerate().flat_map(|(joint, total)| errors(structure, model, joint, total));
        let mut equations =
            Self { parts, errors: errors.collect(), noise: model.noise.clone(), factors: vec![1.0; dof] };
        equations.settle_noise();
        equations
    }

    /// Returns the error of the model as a first moment, kg m, and as an inertia, kg m²: the error of the friction's
    /// offset at the last joints, divided by a typical acceleration.
    pub(super) fn moment_error(&self, robot: &Robot) -> f64 {
        let coordinate = |link: usize| {
            let turns = robot.joints[link].row.kind == JointKind::Revolute;
            robot.coordinates().position(|joint| joint == link).filter(|_| turns)
        };
        let near = std::iter::successors(robot.tip().on, |&link| robot.parent(link)).filter_map(coordinate).take(NEAR);
        let coulomb = |joint: usize| self.errors[FRICTION * joint + FrictionParameter::Coulomb as usize] / COULOMB;
        OFFSET * near.map(coulomb).fold(0.0, f64::max) / ACCELERATION
    }

    /// Returns the sum of the normal equations over all segments, except `without`.
    fn total(&self, without: Option<usize>) -> DMatrix<f64> {
        let size = PER_LINK + self.errors.len() + 1;
        let mut total = DMatrix::zeros(size, size);
        for (_, part) in self.parts.iter().enumerate().filter(|(part, _)| Some(*part) != without) {
            part.iter().zip(&self.factors).for_each(|(joint, factor)| total += joint * *factor);
        }
        total
    }

    /// Reduces the weight of a joint's rows if the residual of the file with the payload is larger than the noise.
    fn settle_noise(&mut self) {
        let size = PER_LINK + self.errors.len();
        for _ in 0..ROUNDS / 2 {
            let Some((solution, _)) = self.solution(&self.total(None)) else { return };
            let mut row = DVector::from_element(size + 1, 1.0);
            row.rows_mut(0, size).copy_from(&-solution);
            for joint in 0..self.factors.len() {
                let offset = PER_LINK + FRICTION * joint + FrictionParameter::Offset as usize;
                let products =
                    |part: &Vec<DMatrix<f64>>| (row.dot(&(&part[joint] * &row)), part[joint][(offset, offset)]);
                let (squares, weight) =
                    self.parts.iter().map(products).fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
                let mean = squares / weight / self.noise[joint].powi(2);
                self.factors[joint] = if mean > 1.0 { 1.0 / mean } else { 1.0 };
            }
        }
    }

    /// Solves the normal equations `total` for the payload and the errors of the file; returns them with their
    /// covariance.
    fn solution(&self, total: &DMatrix<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let size = PER_LINK + self.errors.len();
        let slope = total.view((0, size), (size, 1)).column(0).clone_owned();
        let mut gram = total.view((0, 0), (size, size)).clone_owned();
        gram[(0, 0)] += MASS.powi(-2);
        for (at, deviation) in self.errors.iter().enumerate() {
            gram[(PER_LINK + at, PER_LINK + at)] += deviation.powi(-2);
        }
        let mut found: Option<(DVector<f64>, DMatrix<f64>)> = None;
        for _ in 0..ROUNDS {
            let (mass, com) = found.as_ref().map_or((1.0, Vector3::zeros()), |(values, _)| centre(values));
            let (mut held, mut target) = (gram.clone(), slope.clone());
            let size = mass.abs().max(LIGHTEST_PAYLOAD);
            let inertia = shifted(mass, &com);
            for at in 1..PER_LINK {
                let (expected, deviation) = match at.checked_sub(4) {
                    None => (0.0, PAYLOAD_REACH * size),
                    Some(number) => (inertia[TENSOR[number]], PAYLOAD_REACH * PAYLOAD_REACH * size),
                };
                held[(at, at)] += deviation.powi(-2);
                target[at] += expected * deviation.powi(-2);
            }
            let covariance = inverse_of_information(&held)?;
            found = Some((&covariance * target, covariance));
        }
        found
    }

    /// Returns the estimate from all segments, except `without`. If the equations have no solution, it is zero with
    /// infinite variances.
    pub(super) fn estimate(&self, without: Option<usize>) -> Estimate {
        let Some((solution, covariance)) = self.solution(&self.total(without)) else {
            return Estimate { numbers: [0.0; PER_LINK], variances: [f64::INFINITY; PER_LINK] };
        };
        let found = numbers(&solution);
        let mut slopes = DMatrix::zeros(PER_LINK, PER_LINK);
        for column in 0..PER_LINK {
            let step = STEP * covariance[(column, column)].sqrt();
            let at = |sign: f64| {
                let mut values = solution.clone();
                values[column] += sign * step;
                numbers(&values)
            };
            let (above, below) = (at(1.0), at(-1.0));
            for row in 0..PER_LINK {
                slopes[(row, column)] = (above[row] - below[row]) / (2.0 * step);
            }
        }
        let payload = covariance.view((0, 0), (PER_LINK, PER_LINK));
        let variances = &slopes * payload * slopes.transpose();
        Estimate { numbers: found, variances: std::array::from_fn(|at| variances[(at, at)].max(0.0)) }
    }
}

/// Returns the standard deviations of the errors of a file's friction at a joint, from the normal equations of the
/// joint.
fn errors(structure: &Structure, model: &FittedModel, joint: usize, total: &DMatrix<f64>) -> [f64; FRICTION] {
    let at = structure.parameters().rank() + FRICTION * joint;
    let [viscous, coulomb, one] = std::array::from_fn(|k| total[(at + k, at + k)]);
    let torque = total[(structure.count(), structure.count())];
    let mean = |squares: f64| if one > 0.0 { (squares / one).max(0.0) } else { 0.0 };
    let size = model.solution[at + FrictionParameter::Coulomb as usize].abs();
    let size = size.max(LEAST_FRICTION * mean(torque).sqrt()).max(f64::MIN_POSITIVE.sqrt());
    let rest = AT_REST * (1.0 - mean(coulomb)).max(0.0);
    [VISCOUS * size / mean(viscous).sqrt().max(SLOWEST), COULOMB * size, size * (OFFSET * OFFSET + rest).sqrt()]
}

/// Returns mass and centre of mass.
fn centre(values: &DVector<f64>) -> (f64, Vector3<f64>) {
    let mass = values[0];
    // prevents a centre of mass that is far away if the mass is almost zero
    let size = if mass < 0.0 { mass.min(-LIGHTEST_PAYLOAD) } else { mass.max(LIGHTEST_PAYLOAD) };
    (mass, Vector3::new(values[1], values[2], values[3]) / size)
}

/// Converts inertial parameters about the origin to mass, centre of mass, and inertia about the centre of mass.
fn numbers(values: &DVector<f64>) -> Numbers {
    let (mass, com) = centre(values);
    let shift = shifted(mass, &com);
    let j = |at: usize| values[4 + at] - shift[TENSOR[at]];
    [mass, com.x, com.y, com.z, j(0), j(3), j(5), j(1), j(2), j(4)]
}

/// Returns the jackknife variances of an estimate from the estimates that leave out one segment each.
pub(super) fn jackknife(parts: &[Numbers]) -> Numbers {
    #[allow(clippy::cast_precision_loss)] // at most 32
    let count = parts.len() as f64;
    std::array::from_fn(|at| {
        let mean = parts.iter().map(|part| part[at]).sum::<f64>() / count;
        (count - 1.0) / count * parts.iter().map(|part| (part[at] - mean).powi(2)).sum::<f64>()
    })
}
