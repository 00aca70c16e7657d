//! Weighted least squares on the triangles: unknowns, noise, transitions of friction, and deviations.

use nalgebra::{DMatrix, DVector};

use crate::fit::friction::{FrictionExcitation, Hold};
use crate::fit::information::{Information, Segment, Weighting};
use crate::fit::prior::Scales;
use crate::fit::r_factor::{RFactor, condition, effort, inverse, solved};
use crate::fit::structure::Structure;

/// Rounds in which noise and unknowns settle.
const ROUNDS: usize = 12;
/// Rounds before the transitions of friction are chosen, and in which they are.
const FIRST: usize = 3;
const CHOOSING: usize = 2;
/// N m or N: no joint's noise is less, so that efforts without any divide nothing by nothing.
const LEAST_NOISE: f64 = 1e-12;
/// Efforts of which none is more than this part of the largest one of all joints are not measured: by their noise,
/// which is as small, they would outweigh all other joints.
const NOT_MEASURED: f64 = 1e-8;

/// Rows of joints give deviations if there are this many times as many as unknowns.
const ENOUGH: usize = 2;

/// An offset counts if it exceeds Coulomb friction by this number of deviations, and by this part of the effort, root
/// mean square.
const BEYOND: [f64; 2] = [4.0, 0.02];

/// The least-squares estimate of the unknowns.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct LeastSquares {
    /// Base parameters; viscous friction, Coulomb's and the offset of each joint; the delay. Of what logs do not excite
    /// at all, 0.
    pub solution: DVector<f64>,
    /// Covariance of the unknowns: of errors that depend on each other over time, too. Not a number where too few rows
    /// tell it.
    pub covariance: DMatrix<f64>,
    /// Deviation of each joint's noise, N m or N; infinite where efforts are no torques but zeros, so that they do not
    /// count.
    pub noise: Vec<f64>,
    /// s: how much the torques lag behind the positions, as the rows were shifted and as is left.
    pub delay: f64,
    /// How the friction of each joint changes its sign: which of [`Options::transitions`](crate::Options::transitions).
    pub transitions: Vec<usize>,
    /// Largest over smallest singular value of the weighted columns, each of length one.
    pub condition: f64,
    /// Segments of time that the deviations are from.
    pub segments: usize,
    /// The triangle of all weighted rows, torque last.
    pub(crate) triangle: RFactor,
    /// Degrees of freedom of the deviations.
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
            // the torque itself, to begin with
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

    /// The estimate from the same rows with the same noise and transitions, with friction of some joints held; also the
    /// root mean square of what is left of each joint's rows, N m or N.
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

    /// The weighting of rows in the next pass.
    #[must_use]
    pub fn weighting(&self, structure: &Structure) -> Weighting {
        Weighting::new(structure, &self.solution, &self.transitions, self.noise.clone(), self.delay)
    }

    /// The slope of half the weighted sum of squares by the unknowns.
    #[must_use]
    pub fn gradient(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let count = self.solution.len();
        let design = self.triangle.triangle().view((0, 0), (count, count));
        let target = self.triangle.triangle().view((0, count), (count, 1));
        design.tr_mul(&(design * unknowns - target.column(0)))
    }

    /// The offset of a joint and its Coulomb friction, N m or N, where the former is larger: a spring, a counterweight,
    /// a sensor. No robot file holds what is more. `effort` is of the joint, root mean square.
    #[must_use]
    pub fn loose_offset(&self, structure: &Structure, joint: usize, effort: f64) -> Option<(f64, f64)> {
        let at = structure.friction_at(joint)?;
        let (coulomb, offset) = (self.solution[at + 1], self.solution[at + 2]);
        // of the friction of the direction against which the offset goes
        let deviation = self.coulomb_deviation(at, -offset.signum());
        let beyond = offset.abs() - coulomb;
        let [deviations, part] = BEYOND;
        let is_larger = beyond > part * effort && beyond > deviations * deviation;
        (coulomb > 0.0 && is_larger).then_some((offset, coulomb))
    }

    /// The deviation of Coulomb friction forward (1) or backward (-1) of the joint whose friction is at these unknowns:
    /// its odd part plus or minus the offset. What is no number stays none.
    pub(crate) fn coulomb_deviation(&self, at: usize, direction: f64) -> f64 {
        let covariance = |row: usize, column: usize| self.covariance[(at + row, at + column)];
        let variance = covariance(1, 1) + covariance(2, 2) + 2.0 * direction * covariance(1, 2);
        if variance < 0.0 { 0.0 } else { variance.sqrt() }
    }

    /// Half the width of an unknown's interval of 95 %: its deviation times the quantile of Student's t with one degree
    /// of freedom less than there are segments of time; of rows without an order, with the rows that are
    /// more than unknowns.
    #[must_use]
    pub fn half_interval(&self, unknown: usize) -> f64 {
        #[allow(clippy::cast_precision_loss)] // of many, z is left
        let freedom = self.freedom as f64;
        student(freedom) * self.deviation(unknown)
    }

    /// The deviation of an unknown.
    #[must_use]
    pub fn deviation(&self, unknown: usize) -> f64 {
        // what is not known stays so
        self.covariance.get((unknown, unknown)).map_or(f64::NAN, |variance| variance.sqrt())
    }
}

/// Errors after the filter are correlated across the ends of segments, too: white noise after a Gaussian kernel of
/// width σ has the correlation exp(-t²/4σ²), of which segments of n σ miss ∫|t| exp(-t²/4σ²) dt over n σ times ∫
/// exp(-t²/4σ²) dt, that is 2/√π over n. A row stands for σ.
const ACROSS: f64 = std::f64::consts::FRAC_2_SQRT_PI;

/// The quantile 0.975 of Student's t, by Cornish and Fisher's expansion: to 0.002 from five degrees of freedom on.
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
    /// One entry for each joint, or none at all.
    holds: Vec<Hold>,
}

impl State<'_> {
    /// The unknowns and their deviations, with noise and transitions as they are.
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
        // what is left of so few is their number and no noise, and numbers overflow
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

    /// A joint's triangle as rows of all unknowns and the torque, in units of its noise.
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

    /// The ridge keeps unknowns finite that no log excites: a row for each, far weaker than anything that was measured.
    /// The rows of friction that is held are far stronger.
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
            // of as many columns
            let _ = all.absorb_weighted(rows, 0.0);
        };
        add(self.ridge());
        for (joint, factor) in segment.iter().enumerate() {
            add(self.rows(joint, self.transitions[joint], factor));
        }
        all
    }

    /// The noise is what is left, with as many degrees of freedom as the unknowns leave to the joint.
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

    /// The sum of squares that a solution leaves of a joint's rows, in units of its noise.
    fn residual(&self, joint: usize, factor: &RFactor, solution: &DVector<f64>) -> f64 {
        let rows = self.rows(joint, self.transitions[joint], factor);
        (rows.column(self.count()) - rows.columns(0, self.count()) * solution).norm_squared()
    }

    /// Joint by joint the transition that leaves the least.
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

    /// The covariance of the unknowns where errors of rows do not depend on each other: (RᵀR)⁻¹, in units of the noise.
    fn independent(&self, triangle: &RFactor) -> DMatrix<f64> {
        let count = self.count();
        inverse(triangle, count)
            .map_or_else(|| DMatrix::from_element(count, count, f64::NAN), |inverse| &inverse * inverse.transpose())
    }

    /// The covariance of the unknowns by leaving out one segment of time after the other: errors within a segment may
    /// depend on each other as they like.
    ///
    /// B. Efron, C. Stein, The jackknife estimate of variance, Annals of Statistics 9 (1981), 586-596.
    fn covariance(&self, segments: &[Segment], triangle: &RFactor, solution: &DVector<f64>) -> DMatrix<f64> {
        let count = self.count();
        let Some(inverse) = inverse(triangle, count) else { return DMatrix::from_element(count, count, f64::NAN) };
        let mut sum = DMatrix::zeros(count, count);
        let mut shifts: Vec<DVector<f64>> = Vec::with_capacity(segments.len());
        for segment in segments {
            // in the coordinates in which all rows together are the unit matrix
            let mut share = DMatrix::identity(count, count);
            let mut slope = DVector::zeros(count);
            for (joint, factor) in segment.iter().enumerate() {
                let rows = self.rows(joint, self.transitions[joint], factor);
                let design = rows.columns(0, count) * &inverse;
                let residual = rows.column(count) - rows.columns(0, count) * solution;
                slope += design.tr_mul(&residual);
                share -= design.tr_mul(&design);
            }
            // what only this segment tells has no finite deviation
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

    /// The covariance that the ridge adds: it draws unknowns to zero, and they may be as far from there as it supposes.
    /// Of what the rows tell it is nothing beside their own covariance; what they do not tell is as unknown as before,
    /// although it is zero whatever segment is left out.
    fn of_ridge(&self, inverse: &DMatrix<f64>) -> DMatrix<f64> {
        let drawn = inverse * inverse.transpose() * self.ridge().columns(0, self.count()).transpose();
        &drawn * drawn.transpose()
    }
}
