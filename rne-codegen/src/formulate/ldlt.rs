//! M x = b for a symmetric M by M = L D Lᵀ, unrolled, without pivots.
//!
//! For each column j: D_j = M_jj - Σ L_jk c_jk, c_ij = M_ij - Σ L_ik c_jk, L_ij = c_ij / D_j, with sums over k < j.
//! Then L y = b, z = y / D and Lᵀ x = z. A singular M divides by zero: the numbers are not finite then, nothing worse.

use crate::ir::{Builder, Name, Quantity, Symbol};

/// The solution of M x = b; row i of `upper` holds the elements (i, i) to (i, n) of M.
pub(crate) fn solved<'s>(builder: &'s Builder, upper: &[Vec<Symbol<'s>>], b: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
    Factors::of(builder, upper).solved(0, b, |quantity, index| Name::scalar(quantity, index + 1))
}

/// L and D of a matrix.
pub(crate) struct Factors<'s> {
    builder: &'s Builder,
    /// Rows of L and of L D, below the diagonal.
    rows: Vec<Vec<(Symbol<'s>, Symbol<'s>)>>,
    /// The reciprocals of D.
    inverses: Vec<Symbol<'s>>,
}

impl<'s> Factors<'s> {
    /// Row i of `upper` holds the elements (i, i) to (i, n) of the matrix.
    pub(crate) fn of(builder: &'s Builder, upper: &[Vec<Symbol<'s>>]) -> Self {
        let dof = upper.len();
        let element = |row: usize, column: usize| Name::indexed(Quantity::LowerFactor, row + 1, column + 1);
        let scaled = |row: usize, column: usize| Name::indexed(Quantity::ScaledFactor, row + 1, column + 1);
        let of_joint = |quantity, index: usize| Name::scalar(quantity, index + 1);
        let one = builder.entry(Name::scalar(Quantity::One, 0), 1.0);
        let mut rows: Vec<Vec<(Symbol<'s>, Symbol<'s>)>> = vec![Vec::new(); dof];
        let mut inverses = Vec::with_capacity(dof);
        for j in 0..dof {
            let pivot = within(builder, of_joint(Quantity::Pivot, j), &|| {
                rows[j].iter().fold(upper[j][0], |sum, &(l, c)| sum - l * c)
            });
            let inverse = within(builder, of_joint(Quantity::InversePivot, j), &|| builder.quotient(one, pivot));
            for i in j + 1..dof {
                let c = within(builder, scaled(i, j), &|| {
                    let pairs = rows[i].iter().zip(&rows[j]);
                    pairs.fold(upper[j][i - j], |sum, (&(l, _), &(_, c))| sum - l * c)
                });
                let l = within(builder, element(i, j), &|| c * inverse);
                rows[i].push((l, c));
            }
            inverses.push(inverse);
        }
        Self { builder, rows, inverses }
    }

    /// The elements of the solution from `first` on, where `b` is zero before; `name` names what is written for a row.
    pub(crate) fn solved(
        &self,
        first: usize,
        b: &[Symbol<'s>],
        name: impl Fn(Quantity, usize) -> Name,
    ) -> Vec<Symbol<'s>> {
        let (builder, dof) = (self.builder, b.len());
        let mut x: Vec<Symbol<'s>> = Vec::with_capacity(dof);
        for (i, (row, &b)) in self.rows.iter().zip(b).enumerate().skip(first) {
            let row = &row[first..];
            x.push(within(builder, name(Quantity::Reduced, i), &|| {
                row.iter().zip(&x).fold(b, |sum, (&(l, _), &y)| sum - l * y)
            }));
        }
        for (i, x) in x.iter_mut().enumerate() {
            let y = *x;
            *x = within(builder, name(Quantity::Scaled, first + i), &|| y * self.inverses[first + i]);
        }
        for i in (first..dof).rev() {
            x[i - first] = within(builder, name(Quantity::RateDot, i), &|| {
                (i + 1..dof).fold(x[i - first], |sum, k| sum - self.rows[k][i].0 * x[k - first])
            });
        }
        x
    }
}

fn within<'s>(builder: &'s Builder, name: Name, value: &dyn Fn() -> Symbol<'s>) -> Symbol<'s> {
    let value = builder.joint(name.joint).within(name.quantity, value);
    builder.name(name, value)
}
