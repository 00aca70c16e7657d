//! Estimates a change by least squares over two logs that have all parameters in common except the changed ones.
//!
//! Let θ be the parameters of the baseline and M their information matrix, X the rows of the watched log and N = Xᵀ X,
//! r the residual of its torques with θ, and F columns that are added for the changed parameters:
//!
//! ```text
//! L = (M + N)⁻¹     G = Fᵀ F - Fᵀ X L Xᵀ F     g = Fᵀ r - Fᵀ X L r     δ = G⁻¹ g     covariance = G⁻¹
//! ```
//!
//! Friction, offsets and a payload are already parameters of the model. So F is X times some directions over a window
//! of time, and the normal equations of short stretches are sufficient. For the gain of a joint's effort, X has one
//! more column, the torques X θ of this joint. Its parameter is 0 in the baseline, and not common to both logs.
//!
//! G. C. Chow, Tests of equality between sets of coefficients in two linear regressions, Econometrica 28 (1960),
//! 591-605. Woodbury's formula for L.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rne_identify::{FittedModel, LIGHTEST_PAYLOAD, PAYLOAD_REACH, Stretch, Structure, inverse_of_information};

use crate::baseline;
use crate::candidate::{Candidate, MOMENTS};

/// Number of iterations that adapt the prior of a payload's first moments to its mass.
const ROUNDS: usize = 4;

/// The sums over a log from which the estimates of all changes follow.
#[derive(Clone, Debug)]
pub(crate) struct Score {
    /// Cumulative sums up to each stretch: products of the columns, and of the columns with the residual of the
    /// baseline.
    products: Vec<DMatrix<f64>>,
    left: Vec<DVector<f64>>,
    /// The matrix L.
    covariance: DMatrix<f64>,
    /// L times the last sum of `left`.
    shift: DVector<f64>,
    candidates: Vec<(Candidate, DMatrix<f64>)>,
    /// The directions of all candidates, side by side.
    columns: DMatrix<f64>,
}

/// A candidate over a window of stretches.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Change {
    pub(crate) candidate: usize,
    pub(crate) window: Range<usize>,
}

/// The estimate of a change.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Estimate {
    /// The estimated numbers of the candidate.
    pub(crate) values: Vec<f64>,
    /// Standard deviation of the first number, for errors that are white.
    pub(crate) deviation: f64,
    /// The decrease of the sum of squares.
    pub(crate) drop: f64,
}

impl Estimate {
    pub(crate) fn value(&self) -> f64 {
        self.values.first().copied().unwrap_or_default()
    }
}

/// A change with the products of its columns, without and with the factor L.
#[derive(Clone, Debug)]
pub(crate) struct Projected {
    pub(crate) change: Change,
    products: DMatrix<f64>,
    common: DMatrix<f64>,
}

impl Score {
    /// Computes the sums; `None` if the information matrix is not positive definite. `is_dead` is true for joints whose
    /// effort is zero.
    pub(crate) fn new(
        structure: &Structure,
        model: &FittedModel,
        stretches: &[&Stretch],
        is_dead: &[bool],
    ) -> Option<Self> {
        let (count, dof) = (structure.count(), structure.dof());
        let size = count + dof;
        let (mut of_columns, mut rest) = (DMatrix::zeros(size, size), DVector::zeros(size));
        let (mut products, mut left) = (vec![of_columns.clone()], vec![rest.clone()]);
        for stretch in stretches {
            for (joint, is_dead) in is_dead.iter().enumerate() {
                add(structure, model, stretch, (joint, *is_dead), &mut of_columns, &mut rest);
            }
            products.push(of_columns.clone());
            left.push(rest.clone());
        }
        let common = &model.information + of_columns.view((0, 0), (count, count));
        let mut covariance = DMatrix::zeros(size, size);
        covariance.view_mut((0, 0), (count, count)).copy_from(&inverse_of_information(&common)?);
        let shift = &covariance * left.last()?;
        let candidates = Candidate::all(structure.dof()).into_iter();
        let candidates: Vec<(Candidate, DMatrix<f64>)> =
            candidates.map(|candidate| (candidate, candidate.columns(structure))).collect();
        let each: Vec<_> = candidates.iter().flat_map(|(_, columns)| columns.column_iter()).collect();
        let columns = DMatrix::from_columns(&each);
        Some(Self { products, left, covariance, shift, candidates, columns })
    }

    /// Number of stretches.
    pub(crate) fn len(&self) -> usize {
        self.products.len() - 1
    }

    pub(crate) fn candidates(&self) -> &[(Candidate, DMatrix<f64>)] {
        &self.candidates
    }

    /// Returns the change of the parameters that both logs have in common, given the other changes, each with its
    /// window and as changes of all unknowns and gains.
    pub(crate) fn common(&self, changes: &[(Range<usize>, DVector<f64>)]) -> DVector<f64> {
        let mut shift = self.shift.clone();
        for (window, change) in changes {
            shift -= &self.covariance * (self.products_in(window) * change);
        }
        shift
    }

    fn products_in(&self, window: &Range<usize>) -> DMatrix<f64> {
        &self.products[window.end] - &self.products[window.start]
    }

    pub(crate) fn projected(&self, change: Change) -> Projected {
        let products = self.products_in(&change.window) * &self.candidates[change.candidate].1;
        let common = &self.covariance * &products;
        Projected { change, products, common }
    }

    /// Projects every candidate over one window.
    fn projected_in(&self, window: &Range<usize>) -> Vec<Projected> {
        let products = self.products_in(window) * &self.columns;
        let common = &self.covariance * &products;
        let mut first = 0;
        let scores = self.candidates.iter().enumerate().map(|(candidate, (_, columns))| {
            let range = (first, columns.ncols());
            first += columns.ncols();
            Projected {
                change: Change { candidate, window: window.clone() },
                products: products.columns(range.0, range.1).clone_owned(),
                common: common.columns(range.0, range.1).clone_owned(),
            }
        });
        scores.collect()
    }

    /// Returns Fᵀ F - Fᵀ X L Xᵀ F of two changes.
    fn gram(&self, a: &Projected, b: &Projected) -> DMatrix<f64> {
        let columns = |of: &Projected| &self.candidates[of.change.candidate].1;
        let (of_a, of_b) = (&a.change.window, &b.change.window);
        let both = of_a.start.max(of_b.start)..of_a.end.min(of_b.end);
        let common = -a.products.tr_mul(&b.common);
        if both.is_empty() {
            common
        } else if both == *of_b {
            columns(a).tr_mul(&b.products) + common
        } else if both == *of_a {
            a.products.tr_mul(columns(b)) + common
        } else {
            columns(a).tr_mul(&(self.products_in(&both) * columns(b))) + common
        }
    }

    /// Returns Fᵀ r - Fᵀ X L Xᵀ r.
    fn slope(&self, of: &Projected) -> DVector<f64> {
        let left = &self.left[of.change.window.end] - &self.left[of.change.window.start];
        self.candidates[of.change.candidate].1.tr_mul(&left) - of.products.tr_mul(&self.shift)
    }

    /// Returns the decrease of the sum of squares of one stretch if a change is added to a shift of all unknowns.
    pub(crate) fn gain(&self, at: usize, shift: &DVector<f64>, change: &DVector<f64>) -> f64 {
        let products = self.products_in(&(at..at + 1));
        let left = &self.left[at + 1] - &self.left[at];
        2.0 * change.dot(&(left - &products * shift)) - change.dot(&(&products * change))
    }

    /// Estimates every candidate over one window, together with the given changes.
    pub(crate) fn estimates(&self, window: &Range<usize>, given: &[Projected]) -> Vec<Option<Estimate>> {
        let before = self.fitted(&given.iter().collect::<Vec<_>>()).map_or(0.0, |fitted| fitted.drop);
        self.projected_in(window).iter().map(|last| self.beside(given, last, before)).collect()
    }

    /// Estimates one change together with the given changes.
    pub(crate) fn estimate(&self, change: Change, given: &[Projected]) -> Option<Estimate> {
        let before = self.fitted(&given.iter().collect::<Vec<_>>()).map_or(0.0, |fitted| fitted.drop);
        self.beside(given, &self.projected(change), before)
    }

    fn beside(&self, given: &[Projected], last: &Projected, before: f64) -> Option<Estimate> {
        let all: Vec<&Projected> = given.iter().chain([last]).collect();
        let fitted = self.fitted(&all)?;
        let at = fitted.values.len() - last.products.ncols();
        Some(Estimate {
            values: fitted.values[at..].to_vec(),
            deviation: fitted.deviations[at],
            drop: fitted.drop - before,
        })
    }

    /// Estimates some changes together; returns each as a change of all unknowns, with its window.
    pub(crate) fn changes(&self, given: &[Projected]) -> Option<Vec<(Range<usize>, DVector<f64>)>> {
        let mut values = self.fitted(&given.iter().collect::<Vec<_>>())?.values.into_iter();
        let score = |projected: &Projected| {
            let columns = &self.candidates[projected.change.candidate].1;
            let numbers: Vec<f64> = values.by_ref().take(columns.ncols()).collect();
            (projected.change.window.clone(), columns * DVector::from_vec(numbers))
        };
        Some(given.iter().map(score).collect())
    }

    fn fitted(&self, all: &[&Projected]) -> Option<Fitted> {
        let mut places = Vec::with_capacity(all.len());
        let mut size = 0;
        for of in all {
            places.push(size);
            size += of.products.ncols();
        }
        let (mut gram, mut slope) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for (row, a) in all.iter().enumerate() {
            let part = self.slope(a);
            slope.rows_mut(places[row], part.len()).copy_from(&part);
            for (column, b) in all.iter().enumerate().take(row + 1) {
                let block = self.gram(a, b);
                let at = (places[row], places[column]);
                gram.view_mut(at, block.shape()).copy_from(&block);
                gram.view_mut((at.1, at.0), (block.ncols(), block.nrows())).copy_from(&block.transpose());
            }
        }
        // keeps numbers finite that no row determines
        for at in 0..size {
            gram[(at, at)] += TINY * gram[(at, at)].abs() + TINY;
        }
        let payloads: Vec<usize> = all
            .iter()
            .zip(&places)
            .filter(|(of, _)| self.candidates[of.change.candidate].0 == Candidate::Payload)
            .map(|(_, at)| *at)
            .collect();
        let mut values = DVector::<f64>::zeros(size);
        let mut covariance = gram.clone();
        for round in 0..if payloads.is_empty() { 1 } else { ROUNDS } {
            let mut held = gram.clone();
            for &at in &payloads {
                let mass = if round == 0 { 1.0 } else { values[at].abs().max(LIGHTEST_PAYLOAD) };
                (at + 1..at + MOMENTS).for_each(|moment| held[(moment, moment)] += (PAYLOAD_REACH * mass).powi(-2));
            }
            covariance = inverse_of_information(&held)?;
            values = &covariance * &slope;
        }
        let drop = slope.dot(&values);
        let deviations = covariance.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect();
        Some(Fitted { values: values.iter().copied().collect(), deviations, drop })
    }
}

/// Adds the products of a joint's rows, including the column of the torques that the model predicts for the joint.
fn add(
    structure: &Structure,
    model: &FittedModel,
    stretch: &Stretch,
    (joint, is_dead): (usize, bool),
    products: &mut DMatrix<f64>,
    left: &mut DVector<f64>,
) {
    let count = structure.count();
    let total = baseline::products(structure, joint, [stretch]);
    let of_columns = total.view((0, 0), (count, count));
    let with_torques = of_columns * &model.solution;
    let rest = total.view((0, count), (count, 1)).column(0) - &with_torques;
    let gain = count + joint;
    if is_dead {
        // the rows of a dead effort only show that the gain has changed by -1
        let product = model.solution.dot(&with_torques);
        products[(gain, gain)] += product;
        left[gain] -= product;
        return;
    }
    products.view_mut((0, 0), (count, count)).zip_apply(&of_columns, |sum, product| *sum += product);
    for (at, product) in with_torques.iter().enumerate() {
        products[(at, gain)] += product;
        products[(gain, at)] += product;
    }
    products[(gain, gain)] += model.solution.dot(&with_torques);
    left.rows_mut(0, count).zip_apply(&rest, |sum, rest| *sum += rest);
    left[gain] += model.solution.dot(&rest);
}

/// Information that is added for numbers that no row determines.
const TINY: f64 = 1e-9;

struct Fitted {
    values: Vec<f64>,
    deviations: Vec<f64>,
    drop: f64,
}
