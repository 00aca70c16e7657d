//! M x = b for a symmetric M by M = L D Lᵀ, unrolled, without pivots.
//!
//! For each column j: D_j = M_jj - Σ L_jk c_jk, c_ij = M_ij - Σ L_ik c_jk, L_ij = c_ij / D_j, with sums over k < j.
//! Then L y = b, z = y / D and Lᵀ x = z. A singular M divides by zero: the numbers are not finite then, nothing worse.
//!
//! Joints on different branches of a tree have zeros in M. Eliminated from the base on, these fill; eliminated from the
//! ends on, none of them does (R. Featherstone, "Efficient factorization of the joint-space inertia matrix for branched
//! kinematic trees", 2005). So the order of elimination is that of the joints, or the reverse where this fills less.

use crate::ir::{Builder, Name, Quantity, Symbol};

/// The solution of M x = b; row i of `upper` holds the elements (i, i) to (i, n) of M.
pub(crate) fn solved<'s>(
    builder: &'s Builder,
    parents: &[Option<usize>],
    upper: &[Vec<Symbol<'s>>],
    b: &[Symbol<'s>],
) -> Vec<Symbol<'s>> {
    let x = Factors::of(builder, parents, upper).solved(0, b, |quantity, index| Name::scalar(quantity, index + 1));
    x.into_iter().flatten().collect()
}

/// L and D of a matrix. Rows and columns are counted in the order of elimination.
pub(crate) struct Factors<'s> {
    builder: &'s Builder,
    /// The joints, counted from 0, in the order in which they are eliminated.
    order: Vec<usize>,
    /// Rows of L and of L D, below the diagonal.
    rows: Vec<Vec<(Symbol<'s>, Symbol<'s>)>>,
    /// The reciprocals of D.
    inverses: Vec<Symbol<'s>>,
}

impl<'s> Factors<'s> {
    /// Row i of `upper` holds the elements (i, i) to (i, n) of the matrix. `parents` are the links that carry the
    /// joints.
    pub(crate) fn of(builder: &'s Builder, parents: &[Option<usize>], upper: &[Vec<Symbol<'s>>]) -> Self {
        let dof = upper.len();
        let order = elimination_order(parents);
        let between = |quantity, row: usize, column: usize| Name::indexed(quantity, order[row] + 1, order[column] + 1);
        let element = |row: usize, column: usize| between(Quantity::LowerFactor, row, column);
        let scaled = |row: usize, column: usize| between(Quantity::ScaledFactor, row, column);
        let of_joint = |quantity, index: usize| Name::scalar(quantity, order[index] + 1);
        let given = |row: usize, column: usize| element_of(upper, order[row], order[column]);
        let one = builder.entry(Name::scalar(Quantity::One, 0), 1.0);
        let mut rows: Vec<Vec<(Symbol<'s>, Symbol<'s>)>> = vec![Vec::new(); dof];
        let mut inverses = Vec::with_capacity(dof);
        for j in 0..dof {
            let pivot = within(builder, of_joint(Quantity::Pivot, j), &|| {
                rows[j].iter().fold(given(j, j), |sum, &(l, c)| sum - l * c)
            });
            let inverse = within(builder, of_joint(Quantity::InversePivot, j), &|| builder.quotient(one, pivot));
            for i in j + 1..dof {
                let c = within(builder, scaled(i, j), &|| {
                    let pairs = rows[i].iter().zip(&rows[j]);
                    pairs.fold(given(i, j), |sum, (&(l, _), &(_, c))| sum - l * c)
                });
                let l = within(builder, element(i, j), &|| c * inverse);
                rows[i].push((l, c));
            }
            inverses.push(inverse);
        }
        Self { builder, order, rows, inverses }
    }

    /// The place of a joint in the order of elimination.
    pub(crate) fn place(&self, joint: usize) -> usize {
        self.order.iter().position(|other| *other == joint).unwrap_or_default()
    }

    /// The solution by joint, where `b`, by joint, is zero for all joints that are eliminated before `first`: these
    /// have no element then. `name` names what is written for a joint.
    pub(crate) fn solved(
        &self,
        first: usize,
        b: &[Symbol<'s>],
        name: impl Fn(Quantity, usize) -> Name,
    ) -> Vec<Option<Symbol<'s>>> {
        let (builder, dof, order) = (self.builder, b.len(), &self.order);
        let mut x: Vec<Symbol<'s>> = Vec::with_capacity(dof);
        for (row, &joint) in self.rows.iter().zip(order).skip(first) {
            let row = &row[first..];
            x.push(within(builder, name(Quantity::Reduced, joint), &|| {
                row.iter().zip(&x).fold(b[joint], |sum, (&(l, _), &y)| sum - l * y)
            }));
        }
        for (i, x) in x.iter_mut().enumerate() {
            let y = *x;
            *x = within(builder, name(Quantity::Scaled, order[first + i]), &|| y * self.inverses[first + i]);
        }
        for i in (first..dof).rev() {
            x[i - first] = within(builder, name(Quantity::RateDot, order[i]), &|| {
                (i + 1..dof).fold(x[i - first], |sum, k| sum - self.rows[k][i].0 * x[k - first])
            });
        }
        let mut by_joint = vec![None; dof];
        for (&joint, x) in order.iter().skip(first).zip(x) {
            by_joint[joint] = Some(x);
        }
        by_joint
    }
}

/// The element of the symmetric matrix whose upper half this is.
fn element_of<'s>(upper: &[Vec<Symbol<'s>>], row: usize, column: usize) -> Symbol<'s> {
    upper[row.min(column)][row.max(column) - row.min(column)]
}

/// The order of the joints, or the reverse where fewer elements of L are not zero.
fn elimination_order(parents: &[Option<usize>]) -> Vec<usize> {
    let outward: Vec<usize> = (0..parents.len()).collect();
    let inward: Vec<usize> = outward.iter().rev().copied().collect();
    if elements_of_factor(parents, &inward) < elements_of_factor(parents, &outward) { inward } else { outward }
}

/// How many elements of L below the diagonal are not zero when joints are eliminated in this order. An element of M is
/// not zero where one joint moves the other.
fn elements_of_factor(parents: &[Option<usize>], order: &[usize]) -> usize {
    let moves = |joint: usize, other: usize| {
        std::iter::successors(Some(other), |&link| parents[link]).any(|link| link == joint)
    };
    let is_element = |row: usize, column: usize| moves(row, column) || moves(column, row);
    let row = |&row: &usize| order.iter().map(|&column| is_element(row, column)).collect();
    let mut is_there: Vec<Vec<bool>> = order.iter().map(row).collect();
    let mut count = 0;
    for column in 0..order.len() {
        let rows: Vec<usize> = (column + 1..order.len()).filter(|&row| is_there[row][column]).collect();
        count += rows.len();
        for &row in &rows {
            for &other in &rows {
                is_there[row][other] = true;
            }
        }
    }
    count
}

fn within<'s>(builder: &'s Builder, name: Name, value: &dyn Fn() -> Symbol<'s>) -> Symbol<'s> {
    let value = builder.joint(name.joint).within(name.quantity, value);
    builder.name(name, value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_of_a_tree_are_eliminated_from_its_ends_on() {
        // a torso with two arms of two joints: each joint keeps its elements with those that move it
        let torso = [None, Some(0), Some(1), Some(0), Some(3)];
        assert_eq!(elements_of_factor(&torso, &[4, 3, 2, 1, 0]), 6);
        assert_eq!(elements_of_factor(&torso, &[0, 1, 2, 3, 4]), 10, "the torso couples both arms");
        assert_eq!(elimination_order(&torso), [4, 3, 2, 1, 0]);
        // nothing fills in a chain, nor where branches meet at the base alone
        assert_eq!(elimination_order(&[None, Some(0), Some(1)]), [0, 1, 2]);
        assert_eq!(elimination_order(&[None, Some(0), None, Some(2)]), [0, 1, 2, 3]);
    }
}
