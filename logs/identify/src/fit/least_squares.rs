//! Weighted least squares on triangular factors: unknowns, noise, transitions of friction, and standard deviations.

use nalgebra::{DMatrix, DVector};

use crate::fit::friction::{FrictionExcitation, Hold};
use crate::fit::information::{Information, Segment, Weighting};
use crate::fit::prior::Scales;
use crate::fit::r_factor::{RFactor, condition, effort, inverse, solved};
use crate::fit::structure::Structure;

/// Number of iterations for noise and unknowns.
const ROUNDS: usize = 12;
/// Number of iterations before the transitions of friction are chosen, and number of iterations that choose them.
const FIRST: usize = 3;
const CHOOSING: usize = 2;
/// Smallest noise of a joint, N m or N, so that zero efforts do not cause a division of 0 by 0.
const LEAST_NOISE: f64 = 1e-12;
/// Efforts of a joint count as not measured if none is more than this part of the largest effort of all joints.
/// Otherwise their noise, which would be as small, would give them more weight than all other joints.
const NOT_MEASURED: f64 = 1e-8;

/// Standard deviations need at least this many times as many rows as unknowns.
const ENOUGH: usize = 2;

/// An offset counts as larger than Coulomb friction if it exceeds it by this number of standard deviations, and by this
/// part of the effort, root mean square.
const BEYOND: [f64; 2] = [4.0, 0.02];

/// The least-squares estimate of the unknowns.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LeastSquares {
    /// Base parameters; viscous friction, Coulomb friction and the offset of each joint; the delay. Unknowns that the
    /// logs do not excite at all are 0.
    pub solution: DVector<f64>,
    /// Covariance of the unknowns, also for errors that are correlated in time. NaN if there are too few rows.
    pub covariance: DMatrix<f64>,
    /// Standard deviation of each joint's noise, N m or N; infinite if the efforts of a joint are zeros, so that they
    /// do not count.
    pub noise: Vec<f64>,
    /// Time by which the torques lag behind the positions, s: the shift of the rows plus the fitted rest.
    pub delay: f64,
    /// The transition of each joint's friction between its signs, as an index into
    /// [`Options::transitions`](crate::Options::transitions).
    pub transitions: Vec<usize>,
    /// Condition number: largest over smallest singular value of the weighted columns, each scaled to length one.
    pub condition: f64,
    /// Number of segments of time from which the standard deviations are computed.
    pub segments: usize,
    /// The triangular factor of all weighted rows; the torque is the last column.
    pub(crate) triangle: RFactor,
    /// Degrees of freedom of the standard deviations.
    freedom: usize,
}

impl LeastSquares {
    /// Solves for the unknowns.
    #[must_use]
    pub fn of(structure: &Structure, information: &Information, scales: &Scales) -> Self {
        let total = information.total(structure);
        let dof = structure.dof();
        let middle = structure.options.widths.len() / 2;
        let (noise, transitions) = (vec![1.0; dof], vec![middle; dof]);
        let mut state = State { structure, scales, noise, transitions, holds: Vec::new() };
        let largest = information.largest.iter().copied().fold(0.0, f64::max);
        for ((noise, factor), most) in state.noise.iter_mut().zip(&total).zip(&information.largest) {
            // the first value of the noise is the torque itself
            let is_measured = *most > NOT_MEASURED * largest;
            *noise = if is_measured { effort(factor).max(LEAST_NOISE) } else { f64::INFINITY };
        }
        for round in 0..ROUNDS {
            if (FIRST..FIRST + CHOOSING).contains(&round) && structure.options.friction {
                state.choose_transitions(&total);
            }
            state.settle_noise(&total);
        }
        state.estimate(information, &total)
    }

    /// Repeats the estimate with the same rows, noise and transitions, but with friction of some joints fixed. Also
    /// returns the root mean square of each joint's residual, N m or N.
    pub(crate) fn with_holds(
        &self,
        structure: &Structure,
        information: &Information,
        scales: &Scales,
        holds: Vec<Hold>,
    ) -> (Self, Vec<f64>) {
        let total = information.total(structure);
        let (noise, transitions) = (self.noise.clone(), self.transitions.clone());
        let state = State { structure, scales, noise, transitions, holds };
        let estimate = state.estimate(information, &total);
        let left = total.iter().enumerate().map(|(joint, factor)| {
            let squares = state.residual(joint, factor, &estimate.solution);
            if squares > 0.0 { (squares / factor.weight().max(1.0)).sqrt() * state.noise[joint] } else { 0.0 }
        });
        let left = left.collect();
        (estimate, left)
    }

    /// Returns the weighting of rows for the next pass.
    #[must_use]
    pub fn weighting(&self, structure: &Structure) -> Weighting {
        Weighting::new(structure, &self.solution, &self.transitions, self.noise.clone(), self.delay)
    }

    /// Returns the gradient of half the weighted sum of squares with respect to the unknowns.
    #[must_use]
    pub fn gradient(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let count = self.solution.len();
        let design = self.triangle.triangle().view((0, 0), (count, count));
        let target = self.triangle.triangle().view((0, count), (count, 1));
        design.tr_mul(&(design * unknowns - target.column(0)))
    }

    /// Returns the offset of a joint and its Coulomb friction, N m or N, if the offset is larger: a spring, a
    /// counterweight, a faulty sensor. A robot file can contain an offset up to Coulomb friction only. `effort` is that
    /// of the joint, root mean square.
    #[must_use]
    pub fn loose_offset(&self, structure: &Structure, joint: usize, effort: f64) -> Option<(f64, f64)> {
        let at = structure.friction_at(joint)?;
        let (coulomb, offset) = (self.solution[at + 1], self.solution[at + 2]);
        // standard deviation of the friction in the direction opposite to the offset
        let deviation = self.coulomb_deviation(at, -offset.signum());
        let beyond = offset.abs() - coulomb;
        let [deviations, part] = BEYOND;
        let is_larger = beyond > part * effort && beyond > deviations * deviation;
        (coulomb > 0.0 && is_larger).then_some((offset, coulomb))
    }

    /// Returns the standard deviation of Coulomb friction forward (1) or backward (-1), which is the half sum of both
    /// directions plus or minus the offset. `at` is the joint's first unknown of friction. NaN if the covariance is
    /// NaN.
    pub(crate) fn coulomb_deviation(&self, at: usize, direction: f64) -> f64 {
        let covariance = |row: usize, column: usize| self.covariance[(at + row, at + column)];
        let variance = covariance(1, 1) + covariance(2, 2) + 2.0 * direction * covariance(1, 2);
        if variance < 0.0 { 0.0 } else { variance.sqrt() }
    }

    /// Returns half the width of an unknown's 95 % confidence interval: its standard deviation times the quantile of
    /// Student's t. The degrees of freedom are the segments of time minus one or, for rows without an order, the rows
    /// minus the unknowns.
    #[must_use]
    pub fn half_interval(&self, unknown: usize) -> f64 {
        #[allow(clippy::cast_precision_loss)] // of many, z is left
        let freedom = self.freedom as f64;
        student(freedom) * self.deviation(unknown)
    }

    /// Returns the standard deviation of an unknown.
    #[must_use]
    pub fn deviation(&self, unknown: usize) -> f64 {
        // an unknown out of range has no known deviation
        self.covariance.get((unknown, unknown)).map_or(f64::NAN, |variance| variance.sqrt())
    }
}

/// Correction for errors that the filter correlates across the ends of segments: white noise after a Gaussian kernel of
/// width σ has the correlation exp(-t²/4σ²). Segments of length n σ miss the part ∫|t| exp(-t²/4σ²) dt / (n σ ∫
/// exp(-t²/4σ²) dt) of it, that is 2/√π over n. There is one row for every σ.
const ACROSS: f64 = std::f64::consts::FRAC_2_SQRT_PI;

/// Returns the quantile 0.975 of Student's t by the Cornish-Fisher expansion. The error is below 0.002 from five
/// degrees of freedom on.
///
/// M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, 26.7.5.
#[must_use]
pub fn student(freedom: f64) -> f64 {
    let n = freedom.max(1.0);
    let z: f64 = 1.959_964;
    let (z3, z5, z7) = (z.powi(3), z.powi(5), z.powi(7));
    z + (z3 + z) / (4.0 * n)
        + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n)
        + (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n)
}

struct State<'a> {
    structure: &'a Structure,
    scales: &'a Scales,
    noise: Vec<f64>,
    transitions: Vec<usize>,
    /// The fixed friction: one entry for each joint, or empty if none is fixed.
    holds: Vec<Hold>,
}

impl State<'_> {
    /// Computes the unknowns and their standard deviations with the current noise and transitions.
    fn estimate(&self, information: &Information, total: &Segment) -> LeastSquares {
        let structure = self.structure;
        let triangle = self.stacked(total);
        let solution = solved(&triangle, self.count());
        let (mut covariance, freedom) = if information.is_unordered() {
            let left = information.rows().saturating_sub(solution.len() as u64);
            (self.independent(&triangle), usize::try_from(left).unwrap_or(usize::MAX))
        } else {
            let segments = &information.segments;
            (self.covariance(segments, &triangle, &solution), segments.len().saturating_sub(1))
        };
        let measured = self.noise.iter().filter(|noise| noise.is_finite()).count();
        let equations = usize::try_from(information.rows()).unwrap_or(usize::MAX).saturating_mul(measured);
        // with so few rows, residuals do not show the noise; with overflow, nothing is known
        if equations < ENOUGH * solution.len() || solution.iter().any(|value| !value.is_finite()) {
            covariance.fill(f64::NAN);
        }
        let condition = condition(&triangle, self.count(), &self.scales.ridge(structure));
        let left = if structure.options.delay { solution[solution.len() - 1] } else { 0.0 };
        let delay = information.shift + left;
        let segments = information.segments.len();
        let (noise, transitions) = (self.noise.clone(), self.transitions.clone());
        LeastSquares { solution, covariance, noise, delay, transitions, condition, segments, triangle, freedom }
    }

    fn count(&self) -> usize {
        self.structure.count()
    }

    /// Returns a joint's triangular factor as rows of all unknowns and the torque, in units of its noise.
    fn rows(&self, joint: usize, transition: usize, factor: &RFactor) -> DMatrix<f64> {
        let selected = factor.selected(&self.structure.used(joint, transition));
        let mut columns = self.structure.unknowns(joint);
        columns.push(self.count());
        let mut rows = DMatrix::zeros(columns.len(), self.count() + 1);
        for (from, &to) in columns.iter().enumerate() {
            rows.set_column(to, &(selected.triangle().column(from) / self.noise[joint]));
        }
        rows
    }

    /// Returns the rows that keep unknowns finite that no log excites: one row for each unknown, with far less weight
    /// than measured rows. The rows of fixed friction have far more weight.
    fn ridge(&self) -> DMatrix<f64> {
        let count = self.count();
        let mut rows = DMatrix::zeros(count, count + 1);
        rows.view_mut((0, 0), (count, count)).set_diagonal(&self.scales.ridge(self.structure));
        for (joint, hold) in self.holds.iter().enumerate() {
            let Some(at) = self.structure.friction_at(joint) else { continue };
            let weight = Hold::weight(self.scales.friction[joint]);
            match hold.excitation {
                FrictionExcitation::Full => {}
                FrictionExcitation::WithoutOffset => {
                    rows[(at + 2, at + 2)] = weight;
                    rows[(at + 2, at + 1)] = -weight * hold.asymmetry();
                }
                FrictionExcitation::None => {
                    for (k, value) in hold.of_file.iter().enumerate() {
                        rows[(at + k, at + k)] = weight;
                        rows[(at + k, count)] = weight * value;
                    }
                }
            }
        }
        rows
    }

    fn stacked(&self, segment: &Segment) -> RFactor {
        let mut all = RFactor::new(self.count() + 1);
        let mut add = |rows| {
            // no error: all have this number of columns
            let _ = all.absorb_weighted(rows, 0.0);
        };
        add(self.ridge());
        for (joint, factor) in segment.iter().enumerate() {
            add(self.rows(joint, self.transitions[joint], factor));
        }
        all
    }

    /// Updates the noise of each joint from its residual and the degrees of freedom that the unknowns leave to its
    /// rows.
    fn settle_noise(&mut self, total: &Segment) {
        let triangle = self.stacked(total);
        let solution = solved(&triangle, self.count());
        let Some(inverse) = inverse(&triangle, self.count()) else { return };
        for (joint, factor) in total.iter().enumerate() {
            if self.noise[joint].is_infinite() {
                continue;
            }
            let rows = self.rows(joint, self.transitions[joint], factor);
            let residual = self.residual(joint, factor, &solution) * self.noise[joint].powi(2);
            let taken = (rows.columns(0, self.count()) * &inverse).norm_squared();
            let left = (factor.weight() - taken).max(1.0);
            self.noise[joint] = (residual / left).sqrt().max(1e-9 * effort(factor)).max(LEAST_NOISE);
        }
    }

    /// Returns the sum of squared residuals of a joint's rows for a solution, in units of its noise.
    fn residual(&self, joint: usize, factor: &RFactor, solution: &DVector<f64>) -> f64 {
        let rows = self.rows(joint, self.transitions[joint], factor);
        (rows.column(self.count()) - rows.columns(0, self.count()) * solution).norm_squared()
    }

    /// Chooses for one joint after the other the transition with the smallest residual.
    fn choose_transitions(&mut self, total: &Segment) {
        for joint in 0..self.structure.dof() {
            let before = self.transitions[joint];
            let left = |state: &Self| {
                let triangle = state.stacked(total);
                triangle.triangle()[(state.count(), state.count())].abs()
            };
            let mut best = (before, left(self));
            for transition in 0..self.structure.transitions.len() {
                self.transitions[joint] = transition;
                let left = left(self);
                if left < best.1 {
                    best = (transition, left);
                }
            }
            self.transitions[joint] = best.0;
        }
    }

    /// Returns the covariance of the unknowns for independent errors of the rows: (RᵀR)⁻¹, in units of the noise.
    fn independent(&self, triangle: &RFactor) -> DMatrix<f64> {
        let count = self.count();
        inverse(triangle, count)
            .map_or_else(|| DMatrix::from_element(count, count, f64::NAN), |inverse| &inverse * inverse.transpose())
    }

    /// Returns the covariance of the unknowns by leaving out one segment of time after the other (jackknife): errors
    /// within a segment may be correlated in any way.
    ///
    /// B. Efron, C. Stein, The jackknife estimate of variance, Annals of Statistics 9 (1981), 586-596.
    fn covariance(&self, segments: &[Segment], triangle: &RFactor, solution: &DVector<f64>) -> DMatrix<f64> {
        let count = self.count();
        let Some(inverse) = inverse(triangle, count) else { return DMatrix::from_element(count, count, f64::NAN) };
        let mut sum = DMatrix::zeros(count, count);
        let mut shifts: Vec<DVector<f64>> = Vec::with_capacity(segments.len());
        for segment in segments {
            // in coordinates in which the normal matrix of all rows is the unit matrix
            let mut share = DMatrix::identity(count, count);
            let mut slope = DVector::zeros(count);
            for (joint, factor) in segment.iter().enumerate() {
                let rows = self.rows(joint, self.transitions[joint], factor);
                let design = rows.columns(0, count) * &inverse;
                let residual = rows.column(count) - rows.columns(0, count) * solution;
                slope += design.tr_mul(&residual);
                share -= design.tr_mul(&design);
            }
            // keeps the matrix positive definite if only this segment determines an unknown
            for at in 0..count {
                share[(at, at)] += 1e-9;
            }
            let shift = share.cholesky().map_or_else(|| slope.clone(), |cholesky| cholesky.solve(&slope));
            shifts.push(shift);
        }
        #[allow(clippy::cast_precision_loss)]
        let number = shifts.len() as f64;
        let mean: DVector<f64> = shifts.iter().fold(DVector::zeros(count), |sum, shift| sum + shift) / number.max(1.0);
        for shift in &shifts {
            let shift = shift - &mean;
            sum += &shift * shift.transpose();
        }
        if number < 2.0 {
            return DMatrix::from_element(count, count, f64::NAN);
        }
        let rows: u64 = segments.iter().filter_map(|segment| Some(segment.first()?.rows())).sum();
        #[allow(clippy::cast_precision_loss)]
        let length = rows as f64 / number;
        let across = if self.structure.options.cutoff.is_some() { ACROSS / length.max(2.0 * ACROSS) } else { 0.0 };
        let of_rows = &inverse * (sum * ((number - 1.0) / number / (1.0 - across))) * inverse.transpose();
        of_rows + self.of_ridge(&inverse)
    }

    /// Returns the covariance that the rows of [`ridge`](Self::ridge) add, because they pull unknowns to zero. It is
    /// negligible for unknowns that the measured rows determine. The other unknowns keep the prior uncertainty,
    /// although they are zero whichever segment is left out.
    fn of_ridge(&self, inverse: &DMatrix<f64>) -> DMatrix<f64> {
        let drawn = inverse * inverse.transpose() * self.ridge().columns(0, self.count()).transpose();
        &drawn * drawn.transpose()
    }
}
