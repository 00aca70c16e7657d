//! Least squares for a stream of rows: the triangular factor of a QR factorisation, updated by blocks of rows.
//!
//! The triangular matrix R with RᵀR = AᵀA of a matrix A with too many rows to keep is all that least squares need, and
//! its size does not depend on the number of rows. Householder reflections fold a block of new rows into it. The
//! condition number of A is not squared, as normal equations would. The factors of parts of the rows can be merged into
//! that of all rows, in any order.
//!
//! Å. Björck, Numerical Methods for Least Squares Problems, SIAM 1996, section 3.2.3.

use nalgebra::{DMatrix, DVector};

/// Largest square that counts as zero.
const SMALLEST: f64 = 1e-280;

/// The triangular factor R of a QR factorisation of the absorbed rows, and their number.
#[derive(Clone, Debug, PartialEq)]
pub struct RFactor {
    /// R, upper triangular, with zeros below the diagonal.
    triangle: DMatrix<f64>,
    /// Number of absorbed rows.
    rows: u64,
    /// Sum of the weights of the rows; a row without a weight has weight 1.
    weight: f64,
}

impl RFactor {
    /// Makes the factor of no rows.
    #[must_use]
    pub fn new(columns: usize) -> Self {
        Self { triangle: DMatrix::zeros(columns, columns), rows: 0, weight: 0.0 }
    }

    /// Makes a factor from the upper triangle, row by row from the diagonal on; `None` if the number of values does not
    /// fit `columns`.
    pub(crate) fn from_upper(columns: usize, rows: u64, weight: f64, upper: &[f64]) -> Option<Self> {
        if upper.len() != columns * (columns + 1) / 2 {
            return None;
        }
        let mut numbers = upper.iter().copied();
        let mut triangle = DMatrix::zeros(columns, columns);
        for row in 0..columns {
            for column in row..columns {
                triangle[(row, column)] = numbers.next()?;
            }
        }
        Some(Self { triangle, rows, weight })
    }

    /// Returns the upper triangle, row by row from the diagonal on.
    pub(crate) fn upper(&self) -> impl Iterator<Item = f64> {
        let columns = self.columns();
        (0..columns).flat_map(move |row| (row..columns).map(move |column| self.triangle[(row, column)]))
    }

    /// Number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.triangle.ncols()
    }

    /// Number of rows that were absorbed.
    #[must_use]
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// The sum of the weights of its rows.
    #[must_use]
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// R, upper triangular: RᵀR is the sum of the outer products of the rows.
    #[must_use]
    pub fn triangle(&self) -> &DMatrix<f64> {
        &self.triangle
    }

    /// Adds a block of rows with weight 1 each.
    ///
    /// # Errors
    /// When the rows have another length; nothing has been added then.
    pub fn absorb(&mut self, rows: DMatrix<f64>) -> Result<(), WrongColumns> {
        #[allow(clippy::cast_precision_loss)] // a block
        let weight = rows.nrows() as f64;
        self.absorb_weighted(rows, weight)
    }

    /// Adds a block of rows that have been multiplied by the square roots of their weights; `weight` is the sum of the
    /// weights.
    ///
    /// # Errors
    /// When the rows have another length; nothing has been added then.
    pub fn absorb_weighted(&mut self, rows: DMatrix<f64>, weight: f64) -> Result<(), WrongColumns> {
        self.fits(rows.ncols())?;
        self.rows += rows.nrows() as u64;
        self.weight += weight;
        self.fold(rows);
        Ok(())
    }

    /// Adds all rows of another factor.
    ///
    /// # Errors
    /// When its rows have another length; nothing has been added then.
    pub fn merge(&mut self, other: &Self) -> Result<(), WrongColumns> {
        self.fits(other.columns())?;
        self.rows += other.rows;
        self.weight += other.weight;
        self.fold(other.triangle.clone());
        Ok(())
    }

    /// Returns the factor of some of the columns, in this order.
    #[must_use]
    pub fn selected(&self, columns: &[usize]) -> Self {
        let chosen = DMatrix::from_fn(self.columns(), columns.len(), |row, column| {
            columns.get(column).and_then(|&at| self.triangle.get((row, at))).copied().unwrap_or_default()
        });
        let mut selected = Self { rows: self.rows, weight: self.weight, ..Self::new(columns.len()) };
        selected.fold(chosen);
        selected
    }

    /// Multiplies the weight of every row.
    pub(crate) fn weighted(&self, weight: f64) -> Self {
        Self { triangle: &self.triangle * weight.sqrt(), rows: self.rows, weight: self.weight * weight }
    }

    fn fits(&self, found: usize) -> Result<(), WrongColumns> {
        let expected = self.columns();
        if found == expected { Ok(()) } else { Err(WrongColumns { expected, found }) }
    }

    /// Reflects the rows into the triangular factor, column by column. Each reflection changes only one row of the
    /// factor.
    fn fold(&mut self, mut block: DMatrix<f64>) {
        let columns = self.columns();
        for k in 0..columns {
            let below = block.column(k).norm_squared();
            // counts as zero, because the reciprocal would overflow
            if below < SMALLEST {
                continue;
            }
            let head = self.triangle[(k, k)];
            // this sign avoids cancellation
            let length = -(head * head + below).sqrt().copysign(head);
            let pivot = head - length;
            let scale = 1.0 / (length * pivot);
            self.triangle[(k, k)] = length;
            let reflector = block.column(k).clone_owned();
            for j in k + 1..columns {
                let dot = reflector.dot(&block.column(j));
                let factor = scale * (pivot * self.triangle[(k, j)] + dot);
                self.triangle[(k, j)] += factor * pivot;
                block.column_mut(j).axpy(factor, &reflector, 1.0);
            }
        }
    }
}

/// The error that rows have another length than those of the factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongColumns {
    /// Columns of the factor.
    pub expected: usize,
    /// Columns of the rows.
    pub found: usize,
}

impl std::fmt::Display for WrongColumns {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "the rows have {} columns, but this robot needs {}: the rows come from another robot or another choice of \
             friction",
            self.found, self.expected
        )
    }
}

impl std::error::Error for WrongColumns {}

/// Returns the root mean square of the efforts of a joint's rows, N m or N.
pub(crate) fn effort(factor: &RFactor) -> f64 {
    let power = factor.triangle().column(factor.columns() - 1).norm_squared();
    (power / factor.weight().max(1.0)).sqrt()
}

/// Solves for the unknowns by a triangular factor whose last column is the torque.
pub(crate) fn solved(triangle: &RFactor, count: usize) -> DVector<f64> {
    let square = triangle.triangle().view((0, 0), (count, count));
    let target = triangle.triangle().view((0, count), (count, 1));
    square
        .solve_upper_triangular(&target.clone_owned())
        .map_or_else(|| DVector::zeros(count), |solution| solution.column(0).clone_owned())
}

/// Returns the inverse of a triangular factor without its last column, the torque.
pub(crate) fn inverse(triangle: &RFactor, count: usize) -> Option<DMatrix<f64>> {
    triangle.triangle().view((0, 0), (count, count)).solve_upper_triangular(&DMatrix::identity(count, count))
}

/// Returns the condition number of the columns, each scaled to length one. Columns that only the weak rows `ridge`
/// determine are left out.
pub(crate) fn condition(triangle: &RFactor, count: usize, ridge: &DVector<f64>) -> f64 {
    let square = triangle.triangle().view((0, 0), (count, count));
    let kept: Vec<usize> = (0..count).filter(|&at| square.column(at).norm() > 2.0 * ridge[at]).collect();
    if kept.is_empty() {
        return 1.0;
    }
    // the singular value iteration would not end for NaN
    if square.iter().any(|x| !x.is_finite()) {
        return f64::INFINITY;
    }
    let mut columns = square.clone_owned().select_columns(&kept);
    for mut column in columns.column_iter_mut() {
        column.normalize_mut();
    }
    let values = columns.singular_values();
    if values.is_empty() { 1.0 } else { values.max() / values.min() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(rows: usize, columns: usize, seed: u64) -> DMatrix<f64> {
        let mut rng = fastrand::Rng::with_seed(seed);
        DMatrix::from_fn(rows, columns, |_, _| rng.f64() - 0.5)
    }

    #[test]
    fn the_triangle_has_the_squares_of_the_rows() {
        let rows = random(57, 6, 1);
        let mut factor = RFactor::new(6);
        factor.absorb(rows.rows(0, 20).clone_owned()).unwrap();
        factor.absorb(rows.rows(20, 37).clone_owned()).unwrap();
        let expected = rows.tr_mul(&rows);
        assert!((factor.triangle().tr_mul(factor.triangle()) - expected).norm() < 1e-13);
        assert_eq!((factor.rows(), factor.weight()), (57, 57.0));
        assert!(factor.triangle().lower_triangle().iter().filter(|x| **x != 0.0).count() <= 6);
    }

    #[test]
    fn parts_merge_into_the_whole_and_columns_are_selected() {
        let rows = random(40, 5, 2);
        let mut parts: Vec<RFactor> = vec![RFactor::new(5); 8];
        for (index, row) in rows.row_iter().enumerate() {
            parts[index % 8].absorb(DMatrix::from_iterator(1, 5, row.iter().copied())).unwrap();
        }
        let mut whole = RFactor::new(5);
        for part in parts.iter().rev() {
            whole.merge(part).unwrap();
        }
        let chosen = whole.selected(&[4, 1]);
        let expected = rows.select_columns(&[4, 1]);
        assert!((chosen.triangle().tr_mul(chosen.triangle()) - expected.tr_mul(&expected)).norm() < 1e-13);
    }

    #[test]
    fn rows_of_another_length_are_refused() {
        let mut factor = RFactor::new(3);
        assert_eq!(factor.absorb(DMatrix::zeros(2, 4)), Err(WrongColumns { expected: 3, found: 4 }));
        assert!(factor.merge(&RFactor::new(2)).is_err());
        assert_eq!(factor, RFactor::new(3));
    }
}
