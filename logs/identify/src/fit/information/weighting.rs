//! Weights of rows by their residuals in the previous fit.

use nalgebra::{DMatrix, DVector};

use crate::fit::structure::Structure;

/// Residual, in standard deviations, above which Huber's function reduces the weight of a row.
const HUBER: f64 = 2.5;

/// The standard deviation of the friction of a joint at rest, as a part of its Coulomb friction: at rest or at a
/// reversal, friction has any value between those of both directions.
const NEAR_REST: f64 = 0.25;

/// The number of rows after the filter that count as one where errors before the filter are white: a Gaussian kernel
/// of width σ leaves the correlation exp(-t²/4σ²), whose integral is 2√π σ, and there is a row for every σ.
pub(crate) const CORRELATED: f64 = 3.544_907_701_811_032;

/// Computes the weights of rows from their residuals in the previous fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Weighting {
    /// For each joint, the values of the unknowns of its columns.
    pub(crate) solutions: Vec<DVector<f64>>,
    /// For each joint, the columns that these unknowns multiply; the torque is last.
    pub(crate) used: Vec<Vec<usize>>,
    /// Standard deviation of each joint's noise, N m or N.
    pub(crate) noise: Vec<f64>,
    /// Index of Coulomb friction among the unknowns of a joint, counted from the end; `None` without friction.
    pub(crate) coulomb: Option<usize>,
    /// Time by which the torques lag behind the positions, s.
    pub(crate) delay: f64,
    /// A row with a residual above this number of standard deviations does not count.
    pub(crate) outlier_bound: f64,
    /// A row with a residual above this number of standard deviations has less weight: Huber's function.
    pub(crate) huber: f64,
    /// For each joint the column of its Coulomb friction and the standard deviation of this friction near rest, N m or
    /// N.
    pub(crate) near_rest: Vec<Option<(usize, f64)>>,
}

/// The rows of a joint that do not count because their residuals are too large.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Rejected {
    /// Number of rows.
    pub rows: u64,
    /// Time of the first such row, s.
    pub time: f64,
}

impl Weighting {
    /// Makes the weighting from a solution of all unknowns, the transition and the noise of each joint; `delay` is the
    /// time by which the torques lag, s.
    pub(crate) fn new(
        structure: &Structure,
        solution: &DVector<f64>,
        transitions: &[usize],
        noise: Vec<f64>,
        delay: f64,
    ) -> Self {
        let of_joint = |joint: usize| {
            let mut values: Vec<f64> = structure.unknowns(joint).iter().map(|&at| solution[at]).collect();
            if structure.options().delay
                && let Some(last) = values.last_mut()
            {
                // no delay is left, because the torques are taken later by `delay`
                *last = 0.0;
            }
            DVector::from_vec(values)
        };
        Self {
            solutions: (0..structure.dof()).map(of_joint).collect(),
            used: transitions.iter().enumerate().map(|(joint, of)| structure.used(joint, *of)).collect(),
            noise,
            // the last unknowns are viscous friction, Coulomb friction, the offset, and the delay
            coulomb: structure.options().friction.then(|| 2 + usize::from(structure.options().delay)),
            delay,
            outlier_bound: f64::INFINITY,
            huber: HUBER,
            near_rest: vec![None; transitions.len()],
        }
    }

    /// Returns the weighting with less weight for rows near rest, where Coulomb friction has no definite value.
    #[must_use]
    pub fn with_doubt_near_rest(mut self) -> Self {
        let friction = |(used, solution): (&Vec<usize>, &DVector<f64>)| {
            let coulomb = self.coulomb?;
            let at = solution.len().checked_sub(coulomb)?;
            Some((*used.get(at)?, NEAR_REST * solution[at].abs()))
        };
        self.near_rest = self.used.iter().zip(&self.solutions).map(friction).collect();
        self
    }

    /// Returns the weighting without Huber's function: a large residual does not reduce the weight of a row.
    #[must_use]
    pub fn with_all_rows(self) -> Self {
        Self { huber: f64::INFINITY, outlier_bound: f64::INFINITY, ..self }
    }

    /// Returns Huber's weights of a joint's rows; 0 for residuals above `outlier_bound`.
    pub(super) fn of(&self, joint: usize, rows: &DMatrix<f64>) -> Vec<f64> {
        let (used, solution) = (&self.used[joint], &self.solutions[joint]);
        let noise = self.noise[joint];
        let near_rest = self.near_rest.get(joint).copied().flatten();
        rows.row_iter()
            .map(|row| {
                let mut residual = used.last().map_or(0.0, |&target| row[target]);
                for (&column, value) in used.iter().zip(solution.iter()) {
                    residual -= row[column] * value;
                }
                let off = residual.abs() / noise;
                let doubt = near_rest.map_or(0.0, |(column, deviation)| {
                    deviation * deviation * (1.0 - row[column] * row[column]).max(0.0)
                });
                let weight = 1.0 / (1.0 + doubt / (CORRELATED * noise * noise));
                // a residual that is NaN keeps its weight, because the comparisons are false
                if off > self.outlier_bound {
                    0.0
                } else if off > self.huber {
                    weight * self.huber / off
                } else {
                    weight
                }
            })
            .collect()
    }
}
