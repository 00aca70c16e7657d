//! M x = b for a symmetric M by M = L D Lᵀ, unrolled, without pivots.
//!
//! For each column j: D_j = M_jj - Σ L_jk c_jk, c_ij = M_ij - Σ L_ik c_jk, L_ij = c_ij / D_j, with sums over k < j. Then
//! L y = b, z = y / D and Lᵀ x = z. A singular M divides by zero: the numbers are not finite then, nothing worse.

use std::ops::{Mul, Sub};

use crate::name::Name;
use crate::quantity::Quantity;

/// What a symbol of a sheet can do here.
pub(crate) trait Sheet<S> {
    /// 1 / a
    fn inverse(&self, a: S) -> S;
    /// Writes a value and gives it a name.
    fn within(&self, name: Name, value: impl FnOnce() -> S) -> S;
}

/// The solution of M x = b; row i of `upper` holds the elements (i, i) to (i, n) of M.
pub(crate) fn solved<S>(sheet: &impl Sheet<S>, upper: &[Vec<S>], b: &[S]) -> Vec<S>
where
    S: Copy + Sub<Output = S> + Mul<Output = S>,
{
    let dof = b.len();
    let element = |row: usize, column: usize| Name::indexed(Quantity::LowerFactor, row + 1, column + 1);
    let scaled = |row: usize, column: usize| Name::indexed(Quantity::ScaledFactor, row + 1, column + 1);
    let of_joint = |quantity, index: usize| Name::scalar(quantity, index + 1);
    // rows of L and of L D, below the diagonal
    let mut factors: Vec<Vec<(S, S)>> = vec![Vec::new(); dof];
    let mut inverses = Vec::with_capacity(dof);
    for j in 0..dof {
        let pivot = sheet
            .within(of_joint(Quantity::Pivot, j), || factors[j].iter().fold(upper[j][0], |sum, &(l, c)| sum - l * c));
        let inverse = sheet.within(of_joint(Quantity::InversePivot, j), || sheet.inverse(pivot));
        for i in j + 1..dof {
            let c = sheet.within(scaled(i, j), || {
                let pairs = factors[i].iter().zip(&factors[j]);
                pairs.fold(upper[j][i - j], |sum, (&(l, _), &(_, c))| sum - l * c)
            });
            let l = sheet.within(element(i, j), || c * inverse);
            factors[i].push((l, c));
        }
        inverses.push(inverse);
    }
    let mut y: Vec<S> = Vec::with_capacity(dof);
    for (i, (row, &b)) in factors.iter().zip(b).enumerate() {
        let value = sheet
            .within(of_joint(Quantity::Reduced, i), || row.iter().zip(&y).fold(b, |sum, (&(l, _), &y)| sum - l * y));
        y.push(value);
    }
    let mut x: Vec<S> = y
        .iter()
        .zip(&inverses)
        .enumerate()
        .map(|(i, (&y, &inverse))| sheet.within(of_joint(Quantity::Scaled, i), || y * inverse))
        .collect();
    for i in (0..dof).rev() {
        x[i] = sheet
            .within(of_joint(Quantity::RateDot, i), || (i + 1..dof).fold(x[i], |sum, k| sum - factors[k][i].0 * x[k]));
    }
    x
}
