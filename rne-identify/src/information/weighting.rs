//! Weights of rows, by their distance from the fit before.

use nalgebra::{DMatrix, DVector};

/// A row that is off by more deviations than that counts less: Huber's function.
const HUBER: f64 = 2.5;

/// The weights of rows, which follow from the residuals of the fit before.
#[derive(Clone, Debug, PartialEq)]
pub struct Weighting {
    /// Unknowns of each joint's columns.
    pub(crate) solutions: Vec<DVector<f64>>,
    /// Columns of each joint that they belong to.
    pub(crate) used: Vec<Vec<usize>>,
    /// Deviation of each joint's noise, N m or N.
    pub(crate) noise: Vec<f64>,
    /// s
    pub(crate) delay: f64,
    /// A row that is off by more standard deviations does not count.
    pub(crate) outlier_bound: f64,
}

/// Rows of a joint that do not count.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Rejected {
    /// Number of rows.
    pub rows: u64,
    /// s: the first.
    pub time: f64,
}

impl Weighting {
    /// Huber's weights of a joint's rows; none of what is too far off to be of the same motion.
    pub(super) fn of(&self, joint: usize, rows: &DMatrix<f64>) -> Vec<f64> {
        let (used, solution) = (&self.used[joint], &self.solutions[joint]);
        let noise = self.noise[joint];
        rows.row_iter()
            .map(|row| {
                let mut residual = used.last().map_or(0.0, |&target| row[target]);
                for (&column, value) in used.iter().zip(solution.iter()) {
                    residual -= row[column] * value;
                }
                let off = residual.abs() / noise;
                // what is no number counts as it is
                if off > self.outlier_bound {
                    0.0
                } else if off > HUBER {
                    HUBER / off
                } else {
                    1.0
                }
            })
            .collect()
    }
}
