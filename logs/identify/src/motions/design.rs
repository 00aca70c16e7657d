//! Computes how well a motion determines the parameters: the regressor along the motion, its condition number, and the
//! standard deviations of the parameters.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rne_logs::Motion;
use rne_machine::{Arguments, Array, CompiledArm, Destination, EvaluationError, Function};
use rne_model::{JointKind, Robot};

use crate::fit::information::{Walk, plain_columns};
use crate::fit::prior::{self, Scales};
use crate::fit::r_factor::RFactor;
use crate::fit::r_factor::condition;
use crate::fit::structure::{FRICTION, Options, Structure};
use crate::motions::fourier::{Fourier, Grid};
use crate::motions::motion_limits::MotionLimits;

/// Number of rows of a joint in a period, for each harmonic.
const ROWS: usize = 20;

/// Width of the range of speed in which friction changes its sign, rad/s or m/s.
const WIDTH: f64 = 0.025;

/// Assumed noise of torques as a part of the effort limit or, if a file has no limits, of the torque for the motion.
const NOISE_OF_LIMIT: f64 = 0.01;
const NOISE_OF_EFFORT: f64 = 0.05;
/// Squares of singular values below this part of the largest one count as rounding errors.
const ROUNDING: f64 = 1e-13;
/// Smallest noise of a torque that is assumed, N m or N.
const SMALLEST: f64 = 1e-6;

/// The equations of a robot along motions.
#[derive(Clone, Debug)]
pub(crate) struct Design {
    structure: Structure,
    /// The factor by which the rows of each joint are multiplied.
    weights: Vec<f64>,
    has_efforts: bool,
    grid: Grid,
    /// The base parameters of the links of the file, or of plausible links where the file has none.
    plausible: DVector<f64>,
    scales: Scales,
}

/// The rows of each joint, one for every instant: the base parameters that its torque depends on, then friction.
type Rows = Vec<DMatrix<f64>>;

impl Design {
    /// Weights the rows of each joint by one over its effort limit if every joint has one, otherwise all alike.
    pub(crate) fn new(robot: &Robot, limits: &[MotionLimits], harmonics: usize, friction: bool, rotors: bool) -> Self {
        let options =
            Options { friction, rotors, delay: false, cutoff: None, widths: vec![WIDTH], displacements: Vec::new() };
        let mut structure = Structure::new(robot, options);
        // the results need the same bits on every machine, because the last bit can change the course of the search
        structure.regressor = structure.regressor.in_seven_steps();
        let efforts: Option<Vec<f64>> = robot.independent_joints().map(|joint| joint.limits.effort).collect();
        let efforts = efforts.filter(|efforts| efforts.len() == limits.len() && efforts.iter().all(|x| *x > 0.0));
        let has_efforts = efforts.is_some();
        let weights = efforts.map_or(vec![1.0; robot.dof()], |efforts| efforts.iter().map(|x| 1.0 / x).collect());
        let scales = Scales::of(robot, structure.parameters(), &vec![0.0; robot.dof()]);
        let plausible = plausible(&structure);
        Self { structure, weights, has_efforts, grid: Grid::new(ROWS * harmonics), plausible, scales }
    }

    pub(crate) fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Number of instants that have rows.
    pub(crate) fn instants(&self) -> usize {
        self.grid.points()
    }

    fn rows(&self, motion: &Fourier) -> Result<Rows, EvaluationError> {
        let states = states(motion, &self.grid);
        plain_columns(&self.structure, &states, 0..states.len(), &Walk::new(&self.structure))
    }

    /// Computes the quality of a motion from products of columns, which are exact to half the digits.
    pub(crate) fn quality(&self, motion: &Fourier) -> Result<Quality, EvaluationError> {
        let rows = self.rows(motion)?;
        let own: Vec<DMatrix<f64>> = rows.iter().map(|rows| rows.tr_mul(rows)).collect();
        let efforts: Vec<f64> = (0..rows.len()).map(|joint| self.effort(joint, &rows[joint])).collect();
        let asked = self.asked();
        let products = self.products(&own, &self.weights).select_rows(&asked).select_columns(&asked);
        let condition = condition_of(products);
        Ok(Quality { condition, deviations: self.deviations(&own, &efforts) })
    }

    /// Returns the unknowns that a motion has to distinguish: all, except the offset of a prismatic joint with a rotor.
    /// If the joint is vertical, its mass has the column q̈ + g, the rotor q̈ and the offset 1, and these are linearly
    /// dependent for every motion.
    fn asked(&self) -> Vec<usize> {
        let Structure { options, parameters, robot, .. } = &self.structure;
        let slides = |joint: usize| robot.coordinate_kind(joint) == JointKind::Prismatic;
        let is_asked = |unknown: &usize| {
            let friction = unknown.checked_sub(parameters.rank()).filter(|_| options.friction && options.rotors);
            !friction.is_some_and(|at| at % FRICTION == FRICTION - 1 && slides(at / FRICTION))
        };
        (0..self.structure.count()).filter(is_asked).collect()
    }

    /// Returns the products of all columns, with rows weighted by joint.
    fn products(&self, own: &[DMatrix<f64>], weights: &[f64]) -> DMatrix<f64> {
        let count = self.structure.count();
        let mut products = DMatrix::<f64>::zeros(count, count);
        for (joint, (own, weight)) in own.iter().zip(weights).enumerate() {
            let unknowns = self.structure.unknowns(joint);
            for (row, &to) in unknowns.iter().enumerate() {
                for (column, &from) in unknowns.iter().enumerate() {
                    products[(to, from)] += weight * weight * own[(row, column)];
                }
            }
        }
        products
    }

    /// Returns the torque for plausible links, root mean square.
    fn effort(&self, joint: usize, rows: &DMatrix<f64>) -> f64 {
        let felt = &self.structure.felt[joint];
        let values = DVector::from_iterator(felt.len(), felt.iter().map(|&base| self.plausible[base]));
        #[allow(clippy::cast_precision_loss)] // some hundreds
        let count = rows.nrows().max(1) as f64;
        (rows.columns(0, felt.len()) * values).norm() / count.sqrt()
    }

    /// Returns the standard deviation of each base parameter that an identification would find if the noise of all rows
    /// were independent.
    fn deviations(&self, own: &[DMatrix<f64>], efforts: &[f64]) -> Vec<f64> {
        let noise = |joint: usize| match self.weights[joint] {
            weight if self.has_efforts => NOISE_OF_LIMIT / weight,
            _ => (NOISE_OF_EFFORT * efforts[joint]).max(SMALLEST),
        };
        let weights: Vec<f64> = (0..own.len()).map(|joint| 1.0 / noise(joint)).collect();
        let mut products = self.products(own, &weights);
        let scales =
            Scales { bases: self.scales.bases.clone(), friction: efforts.iter().map(|x| x.max(1e-6)).collect() };
        for (at, ridge) in scales.ridge(&self.structure).iter().enumerate() {
            products[(at, at)] += ridge * ridge;
        }
        let lengths = normalised(&mut products);
        let inverse = products.cholesky().map(|cholesky| cholesky.inverse());
        let deviation =
            |at: usize| inverse.as_ref().map_or(f64::INFINITY, |inverse| inverse[(at, at)].sqrt() / lengths[at]);
        (0..self.structure.parameters().rank()).map(deviation).collect()
    }

    /// The magnitude of each base parameter for plausible links.
    pub(crate) fn scales(&self) -> &DVector<f64> {
        &self.scales.bases
    }

    /// Returns the condition number as an identification computes it.
    pub(crate) fn condition(&self, motion: &Fourier) -> Result<f64, EvaluationError> {
        let count = self.structure.count();
        let mut triangle = RFactor::new(count + 1);
        for (joint, rows) in self.rows(motion)?.into_iter().enumerate() {
            let mut all = DMatrix::zeros(rows.nrows(), count + 1);
            for (column, &to) in self.structure.unknowns(joint).iter().enumerate() {
                all.set_column(to, &(rows.column(column) * self.weights[joint]));
            }
            // no error: both have this number of columns
            let _ = triangle.absorb(all);
        }
        let mut left_out = DVector::from_element(count, f64::INFINITY);
        self.asked().iter().for_each(|&unknown| left_out[unknown] = 0.0);
        Ok(condition(&triangle, count, &left_out))
    }
}

/// How well a motion determines the parameters.
#[derive(Clone, Debug)]
pub(crate) struct Quality {
    /// Condition number: largest over smallest singular value of the weighted columns, each scaled to length one.
    pub(crate) condition: f64,
    /// The standard deviation of each base parameter.
    pub(crate) deviations: Vec<f64>,
}

/// Scales products of columns so that their diagonal is one; returns the lengths of the columns.
fn normalised(products: &mut DMatrix<f64>) -> Vec<f64> {
    let lengths: Vec<f64> = products.diagonal().iter().map(|square| square.sqrt()).collect();
    for (row, one) in lengths.iter().enumerate() {
        for (column, other) in lengths.iter().enumerate() {
            products[(row, column)] /= one * other;
        }
    }
    lengths
}

fn condition_of(mut products: DMatrix<f64>) -> f64 {
    normalised(&mut products);
    if !products.iter().all(|product| product.is_finite()) {
        return f64::INFINITY;
    }
    let squares = products.symmetric_eigenvalues();
    let (least, most) = (squares.min(), squares.max());
    if least > ROUNDING * most { (most / least).sqrt() } else { f64::INFINITY }
}

/// Returns the base parameters of the links of the file, or of plausible links where the file has none.
fn plausible(structure: &Structure) -> DVector<f64> {
    let parameters = structure.parameters();
    let mut values = DVector::zeros(parameters.regrouping.ncols());
    for (link, prior) in prior::links(structure.robot()).iter().enumerate() {
        let of_link = crate::fit::pseudo_inertia::parameters(&prior.pseudo_inertia);
        values.rows_mut(link * of_link.len(), of_link.len()).copy_from_slice(&of_link);
    }
    &parameters.regrouping * values
}

/// Returns the states of a motion at the points of a grid, without torques.
pub(crate) fn states(motion: &Fourier, grid: &Grid) -> Motion {
    #[allow(clippy::cast_precision_loss)] // some hundreds
    let time = (0..grid.points()).map(|point| motion.period() * point as f64 / grid.points() as f64).collect();
    let mut states = Motion { time, q: Vec::new(), qd: Vec::new(), qdd: Vec::new(), ..Motion::default() };
    for series in motion.joints() {
        let of_joint = series.on(grid, motion.period());
        states.q.push(of_joint.iter().map(|state| series.centre + state[0]).collect());
        states.qd.push(of_joint.iter().map(|state| state[1]).collect());
        states.qdd.push(of_joint.iter().map(|state| state[2]).collect());
    }
    states
}

/// Computes the torques of each joint of an arm at some states.
pub(crate) fn torques(arm: &CompiledArm, states: &Motion) -> Result<Vec<Vec<f64>>, EvaluationError> {
    let mut torques = vec![vec![0.0; states.len()]; arm.dof()];
    let columns = torques.iter_mut().map(Vec::as_mut_slice).collect();
    run(arm, Function::InverseDynamics, states, 0..states.len(), columns)?;
    Ok(torques)
}

/// Runs a function of an arm at some states of a motion; each number of the result has a column.
pub(crate) fn run(
    arm: &CompiledArm,
    function: Function,
    motion: &Motion,
    range: Range<usize>,
    columns: Vec<&mut [f64]>,
) -> Result<(), EvaluationError> {
    let [q, qd, qdd] = [&motion.q, &motion.qd, &motion.qdd]
        .map(|lists| lists.iter().map(|list| &list[range.clone()]).collect::<Vec<_>>());
    let arguments = Arguments::new().q(Array::Columns(&q)).qd(Array::Columns(&qd)).qdd(Array::Columns(&qdd));
    arm.run(function, range.len(), &arguments, Destination::Columns(columns))
}
