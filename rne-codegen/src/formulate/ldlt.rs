//! M x = b for a symmetric M by M = L D Lᵀ, unrolled, without pivots.
//!
//! For each column j: D_j = M_jj - Σ L_jk c_jk, c_ij = M_ij - Σ L_ik c_jk, L_ij = c_ij / D_j, with sums over k < j.
//! Then L y = b, z = y / D and Lᵀ x = z. A singular M divides by zero: the numbers are not finite then, nothing worse.

use crate::ir::name::Name;
use crate::ir::quantity::Quantity;
use crate::ir::{Builder, Symbol};

/// The solution of M x = b; row i of `upper` holds the elements (i, i) to (i, n) of M.
pub(crate) fn solved<'s>(builder: &'s Builder, upper: &[Vec<Symbol<'s>>], b: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
    let dof = b.len();
    let element = |row: usize, column: usize| Name::indexed(Quantity::LowerFactor, row + 1, column + 1);
    let scaled = |row: usize, column: usize| Name::indexed(Quantity::ScaledFactor, row + 1, column + 1);
    let of_joint = |quantity, index: usize| Name::scalar(quantity, index + 1);
    let within = |name: Name, value: &dyn Fn() -> Symbol<'s>| {
        let value = builder.joint(name.joint).within(name.quantity, value);
        builder.name(name, value)
    };
    let one = builder.entry(Name::scalar(Quantity::One, 0), 1.0);
    // rows of L and of L D, below the diagonal
    let mut factors: Vec<Vec<(Symbol<'s>, Symbol<'s>)>> = vec![Vec::new(); dof];
    let mut inverses = Vec::with_capacity(dof);
    for j in 0..dof {
        let pivot =
            within(of_joint(Quantity::Pivot, j), &|| factors[j].iter().fold(upper[j][0], |sum, &(l, c)| sum - l * c));
        let inverse = within(of_joint(Quantity::InversePivot, j), &|| builder.quotient(one, pivot));
        for i in j + 1..dof {
            let c = within(scaled(i, j), &|| {
                let pairs = factors[i].iter().zip(&factors[j]);
                pairs.fold(upper[j][i - j], |sum, (&(l, _), &(_, c))| sum - l * c)
            });
            let l = within(element(i, j), &|| c * inverse);
            factors[i].push((l, c));
        }
        inverses.push(inverse);
    }
    let mut y: Vec<Symbol<'s>> = Vec::with_capacity(dof);
    for (i, (row, &b)) in factors.iter().zip(b).enumerate() {
        let value =
            within(of_joint(Quantity::Reduced, i), &|| row.iter().zip(&y).fold(b, |sum, (&(l, _), &y)| sum - l * y));
        y.push(value);
    }
    let mut x: Vec<Symbol<'s>> = y
        .iter()
        .zip(&inverses)
        .enumerate()
        .map(|(i, (&y, &inverse))| within(of_joint(Quantity::Scaled, i), &|| y * inverse))
        .collect();
    for i in (0..dof).rev() {
        x[i] =
            within(of_joint(Quantity::RateDot, i), &|| (i + 1..dof).fold(x[i], |sum, k| sum - factors[k][i].0 * x[k]));
    }
    x
}
