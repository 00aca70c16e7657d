//! Small dense matrices: singular values, damped least squares, and the order in which equations are eliminated.

/// A dense matrix, stored row by row.
#[derive(Clone, Debug)]
pub(crate) struct Matrix {
    rows: usize,
    columns: usize,
    elements: Vec<f64>,
}

impl Matrix {
    pub(crate) fn zero(rows: usize, columns: usize) -> Self {
        Self { rows, columns, elements: vec![0.0; rows * columns] }
    }

    pub(crate) fn get(&self, row: usize, column: usize) -> f64 {
        self.elements[row * self.columns + column]
    }

    pub(crate) fn add(&mut self, row: usize, column: usize, value: f64) {
        self.elements[row * self.columns + column] += value;
    }

    /// Returns the matrix of some rows and columns, each with its index and a factor by which it is multiplied.
    pub(crate) fn part(&self, rows: &[(usize, f64)], columns: &[(usize, f64)]) -> Self {
        let row = |&(row, by): &(usize, f64)| {
            columns.iter().map(move |&(column, factor)| by * factor * self.get(row, column))
        };
        Self { rows: rows.len(), columns: columns.len(), elements: rows.iter().flat_map(row).collect() }
    }

    /// Returns as many singular values as the matrix has columns, the largest first, each with its right singular
    /// vector. One-sided Jacobi rotations (G. Golub, C. Van Loan, "Matrix Computations", 4th ed., 2013, section 8.6.3).
    pub(crate) fn singular(&self) -> Vec<(f64, Vec<f64>)> {
        const SWEEPS: usize = 40;
        // each column is extended by a column of the identity, which is rotated with it and becomes a singular vector
        let mut columns: Vec<Vec<f64>> = (0..self.columns)
            .map(|column| {
                let unit = (0..self.columns).map(|row| if row == column { 1.0 } else { 0.0 });
                (0..self.rows).map(|row| self.get(row, column)).chain(unit).collect()
            })
            .collect();
        let product = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).take(self.rows).map(|(a, b)| a * b).sum() };
        for _ in 0..SWEEPS {
            let mut turned = false;
            for p in 0..self.columns {
                for q in p + 1..self.columns {
                    let (left, right) = columns.split_at_mut(q);
                    let (a, b) = (&mut left[p], &mut right[0]);
                    let (alpha, beta, gamma) = (product(a, a), product(b, b), product(a, b));
                    if gamma == 0.0 || gamma.abs() <= 1e-15 * libm::sqrt(alpha * beta) || !gamma.is_finite() {
                        continue;
                    }
                    turned = true;
                    let zeta = (beta - alpha) / (2.0 * gamma);
                    let tangent = zeta.signum() / (zeta.abs() + libm::sqrt(1.0 + zeta * zeta));
                    let cosine = 1.0 / libm::sqrt(1.0 + tangent * tangent);
                    let sine = cosine * tangent;
                    for (a, b) in a.iter_mut().zip(b) {
                        (*a, *b) = (cosine * *a - sine * *b, sine * *a + cosine * *b);
                    }
                }
            }
            if !turned {
                break;
            }
        }
        let value = |column: Vec<f64>| (libm::sqrt(product(&column, &column)), column[self.rows..].to_vec());
        let mut found: Vec<(f64, Vec<f64>)> = columns.into_iter().map(value).collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found
    }

    /// Returns the step x that minimises |A x + r|² + damping |x|²; `None` where rounding or overflow leaves no
    /// solution.
    pub(crate) fn damped_step(&self, residual: &[f64], damping: f64) -> Option<Vec<f64>> {
        let n = self.columns;
        let mut normal = Self::zero(n, n);
        let mut step = vec![0.0; n];
        for (row, residual) in self.elements.chunks_exact(n.max(1)).zip(residual) {
            for (i, a) in row.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                step[i] -= a * residual;
                row[..=i].iter().enumerate().for_each(|(j, b)| normal.add(i, j, a * b));
            }
        }
        // Cholesky factorisation L Lᵀ, in place
        for i in 0..n {
            normal.add(i, i, damping);
            for j in 0..=i {
                let sum: f64 = (0..j).map(|k| normal.get(i, k) * normal.get(j, k)).sum();
                let rest = normal.get(i, j) - sum;
                let value = if i == j { libm::sqrt(rest) } else { rest / normal.get(j, j) };
                if !value.is_finite() || (i == j && value == 0.0) {
                    return None;
                }
                normal.elements[i * n + j] = value;
            }
        }
        for i in 0..n {
            let sum: f64 = (0..i).map(|k| normal.get(i, k) * step[k]).sum();
            step[i] = (step[i] - sum) / normal.get(i, i);
        }
        for i in (0..n).rev() {
            let sum: f64 = (i + 1..n).map(|k| normal.get(k, i) * step[k]).sum();
            step[i] = (step[i] - sum) / normal.get(i, i);
        }
        Some(step)
    }
}

/// A pivot below this, in at least one of the matrices, counts as zero up to rounding.
const LEAST_PIVOT: f64 = 1e-9;

/// A step of the elimination: the row and the column of the pivot, and its smallest magnitude over all matrices.
pub(crate) type Step = (usize, usize, f64);

/// Returns the order in which Gaussian elimination takes rows and columns, the same for several matrices, with as many
/// steps as there are pivots. Each step takes the pivot whose smallest magnitude over all matrices is largest; among
/// equal ones the first by row, then by column. Columns that are `preferred` come first as long as they have a pivot.
pub(crate) fn elimination(matrices: &[Matrix], preferred: impl Fn(usize) -> bool) -> Vec<Step> {
    let mut rest = matrices.to_vec();
    let mut steps: Vec<Step> = Vec::new();
    let Some(first) = matrices.first() else { return steps };
    let (rows, columns) = (first.rows, first.columns);
    for _ in 0..rows.min(columns) {
        let best = |of: &dyn Fn(usize) -> bool| {
            let mut best: Option<Step> = None;
            for row in (0..rows).filter(|row| steps.iter().all(|step| step.0 != *row)) {
                for column in (0..columns).filter(|&column| of(column) && steps.iter().all(|step| step.1 != column)) {
                    let least = rest.iter().map(|it| it.get(row, column).abs()).fold(f64::INFINITY, f64::min);
                    // pivots that differ only by rounding count as equal
                    if least >= LEAST_PIVOT && best.is_none_or(|(.., known)| least > known * (1.0 + 1e-9)) {
                        best = Some((row, column, least));
                    }
                }
            }
            best
        };
        let Some(step) = best(&preferred).or_else(|| best(&|_| true)) else { break };
        for matrix in &mut rest {
            eliminate(matrix, step);
        }
        steps.push(step);
    }
    steps
}

/// Returns the pivots of a matrix that is eliminated in the given order.
pub(crate) fn pivots(matrix: &Matrix, steps: &[Step]) -> Vec<f64> {
    let mut rest = matrix.clone();
    let pivot = |&step: &Step| {
        let pivot = rest.get(step.0, step.1);
        eliminate(&mut rest, step);
        pivot
    };
    steps.iter().map(pivot).collect()
}

/// Eliminates the column of a pivot from all other rows.
fn eliminate(matrix: &mut Matrix, (pivot_row, pivot_column, _): Step) {
    let pivot = matrix.get(pivot_row, pivot_column);
    for row in (0..matrix.rows).filter(|row| *row != pivot_row) {
        let factor = matrix.get(row, pivot_column) / pivot;
        if factor == 0.0 {
            continue;
        }
        for column in 0..matrix.columns {
            let of_pivot = matrix.get(pivot_row, column);
            matrix.add(row, column, -factor * of_pivot);
        }
        matrix.elements[row * matrix.columns + pivot_column] = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix<const N: usize>(rows: &[[f64; N]]) -> Matrix {
        Matrix { rows: rows.len(), columns: N, elements: rows.concat() }
    }

    /// The singular values of [[3, 0], [4, 5]] are 3√5 and √5.
    #[test]
    fn singular_values() {
        let found = matrix(&[[3.0, 0.0], [4.0, 5.0], [0.0, 0.0]]).singular();
        let values: Vec<f64> = found.iter().map(|(value, _)| *value).collect();
        assert!((values[0] - 45.0_f64.sqrt()).abs() < 1e-14 && (values[1] - 5.0_f64.sqrt()).abs() < 1e-14);
        // (1, -1) is in the null space: both columns are (1, 2)
        let found = matrix(&[[1.0, 1.0], [2.0, 2.0]]).singular();
        assert!(found[1].0 < 1e-15 && (found[1].1[0] + found[1].1[1]).abs() < 1e-15, "{found:?}");
        assert!(matrix(&[[f64::NAN, 1.0], [f64::INFINITY, 2.0]]).singular().len() == 2);
    }

    #[test]
    fn steps_solve_and_overflow_has_none() {
        let step = matrix(&[[2.0, 0.0], [1.0, 1.0]]).damped_step(&[-2.0, 0.0], 0.0);
        let step = step.expect("the matrix is regular");
        assert!((step[0] - 1.0).abs() < 1e-14 && (step[1] + 1.0).abs() < 1e-14, "{step:?}");
        assert!(matrix(&[[1e200, 0.0], [0.0, 1.0]]).damped_step(&[1.0, 1.0], 0.0).is_none());
        assert!(matrix(&[[0.0, 0.0]]).damped_step(&[1.0], 0.0).is_none());
    }

    /// The first pivot is 2, not 3, because the element with 3 is zero in the second matrix.
    #[test]
    fn the_order_of_elimination_holds_for_all_matrices() {
        let both = [matrix(&[[3.0, 1.0], [1.0, 2.0]]), matrix(&[[0.0, 1.0], [1.0, 2.0]])];
        let steps = elimination(&both, |_| true);
        assert_eq!(steps.iter().map(|step| (step.0, step.1)).collect::<Vec<_>>(), [(1, 1), (0, 0)]);
        assert_eq!((steps[0].2, steps[1].2), (2.0, 0.5));
        assert_eq!(pivots(&both[0], &steps), [2.0, 2.5]);
        assert!(elimination(&[matrix(&[[1e-12]])], |_| true).is_empty());
    }
}
