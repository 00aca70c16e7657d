//! Solves M x = b for a symmetric M by M = L D Lᵀ, unrolled, without pivots.
//!
//! For each column j: D_j = M_jj - Σ L_jk c_jk, c_ij = M_ij - Σ L_ik c_jk, L_ij = c_ij / D_j, with sums over k < j.
//! Then L y = b, z = y / D and Lᵀ x = z. For a singular M there is a division by zero, and the results are not finite.
//!
//! Joints on different branches of a tree have zeros in M. Elimination from the base outwards makes these zeros nonzero
//! in L; elimination from the ends inwards keeps them all (R. Featherstone, "Efficient factorization of the joint-space
//! inertia matrix for branched kinematic trees", 2005). So the order of elimination is that of the joints, or the
//! reverse order if L then has fewer elements. The six rows of a floating base come before those of the joints and are
//! eliminated last.

use crate::coordinates::Coordinates;
use crate::function::{Function, Length};
use crate::ir::{Axis, Builder, Component, Cost, Embedding, Name, Policy, Quantity, Symbol, WithRespectTo};

/// The structure of a mass matrix: its rows, and which links carry the joints.
pub(crate) struct System<'a> {
    /// The coordinates, which give the rows and columns of the joints.
    pub(crate) coordinates: &'a Coordinates,
    /// The link that carries each joint; `None` for the base.
    parents: Vec<Option<usize>>,
    /// Number of rows of a floating base, 0 or 6. They come first: forces along x, y, z, then moments about x, y, z.
    of_base: usize,
}

impl<'a> System<'a> {
    /// Returns the structure of the mass matrix of a function: with the rows of the base, if the base is floating.
    pub(crate) fn new(
        function: Function,
        coordinates: &'a Coordinates,
        parents: impl Iterator<Item = Option<usize>>,
    ) -> Self {
        let of_base = if function.is_of_floating_base() { Length::OF_BASE } else { 0 };
        Self { coordinates, parents: parents.collect(), of_base }
    }

    /// Returns the number of rows.
    pub(crate) fn size(&self) -> usize {
        self.of_base + self.coordinates.joints().len()
    }

    /// Whether the element of M can differ from zero for a robot with this structure.
    pub(crate) fn has_element(&self, row: usize, column: usize) -> bool {
        match (self.of_joint(row), self.of_joint(column)) {
            (Some(row), Some(column)) => self.coordinates.meet(&self.parents, [row, column]),
            (None, None) => match [row / 3, column / 3] {
                // m 1 in the linear block, and J in the angular block
                [0, 0] => row == column,
                [1, 1] => true,
                // [h]× in the block between linear and angular rows
                _ => row % 3 != column % 3,
            },
            _ => true,
        }
    }

    /// Returns the coordinate of a row; `None` for a row of the base.
    pub(crate) fn of_joint(&self, row: usize) -> Option<usize> {
        row.checked_sub(self.of_base)
    }

    /// Returns the acceleration that belongs to the force or torque of a row.
    pub(crate) fn acceleration(&self, row: usize) -> WithRespectTo {
        self.of_joint(row).map_or(WithRespectTo::BaseRateDot(row + 1), |place| {
            WithRespectTo::RateDot(self.coordinates.joints()[place] + 1)
        })
    }

    /// Returns the name of an element of the matrix: the derivative of a force or torque with respect to an
    /// acceleration.
    pub(crate) fn name_of_element(&self, row: usize, column: usize) -> Name {
        let force = match self.acceleration(row) {
            WithRespectTo::RateDot(joint) => Name::scalar(Quantity::Torque, joint),
            _ => Name::of_base(Quantity::BaseForce, Quantity::BaseMoment, row),
        };
        Name { by: Some(self.acceleration(column)), ..force }
    }

    /// Returns the name of an acceleration that is solved for, or of an intermediate quantity of its solution.
    pub(crate) fn name(&self, quantity: Quantity, row: usize) -> Name {
        match self.acceleration(row) {
            WithRespectTo::RateDot(joint) => Name::scalar(quantity, joint),
            _ if quantity == Quantity::RateDot => Name::of_base(Quantity::OriginAcceleration, Quantity::OmegaDot, row),
            _ => Name { indices: [0, 1 + row / 3], ..Name::vector(quantity, 0, Axis::ALL[row % 3]) },
        }
    }

    /// Returns the name of an intermediate quantity for an element of a factor. In the rows of the base it has the axes
    /// of the element, and whether each of them is linear or angular.
    fn name_in_factor(&self, quantity: Quantity, row: usize, column: usize) -> Name {
        let name = self.name(quantity, row);
        match self.acceleration(column) {
            WithRespectTo::RateDot(joint) => Name { indices: [joint, name.indices[1]], ..name },
            _ => Name {
                component: Component::Matrix(Axis::ALL[row % 3], Axis::ALL[column % 3]),
                indices: [0, 1 + 2 * (row / 3) + column / 3],
                ..name
            },
        }
    }

    /// Returns the number of elements of the matrix on and above its diagonal that can differ from zero.
    pub(crate) fn elements(&self) -> usize {
        let row = |row: usize| (row..self.size()).filter(|&column| self.has_element(row, column)).count();
        (0..self.size()).map(row).sum()
    }

    /// Returns the number of products and sums for L and D if every nonzero element of M is an argument.
    pub(crate) fn cost_of_factors(&self) -> Cost {
        let mut builder = Builder::untraced(Policy::Value, Embedding::default(), Function::ForwardDynamics);
        let element = |row: usize, column: usize| {
            // a different argument for each element
            let name = Name::scalar(Quantity::Position, row * self.size() + column + 1);
            if self.has_element(row, column) { builder.argument(name) } else { builder.zero() }
        };
        let upper: Vec<Vec<_>> =
            (0..self.size()).map(|row| (row..self.size()).map(|column| element(row, column)).collect()).collect();
        let Factors { rows, inverses, .. } = Factors::of(&builder, self, &upper);
        let outputs =
            rows.iter().flatten().map(|(l, _)| l.at).chain(inverses.iter().map(|inverse| inverse.at)).collect();
        let graph = builder.graph.get_mut();
        graph.outputs = outputs;
        graph.cost(&mut Vec::new())
    }
}

/// Returns the solution of M x = b; row i of `upper` has the elements (i, i) to (i, n) of M.
pub(crate) fn solved<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
    b: &[Symbol<'s>],
) -> Vec<Symbol<'s>> {
    let x = Factors::of(builder, system, upper).solved(0, b, |quantity, row| system.name(quantity, row));
    x.into_iter().flatten().collect()
}

/// The factors L and D of a matrix. Rows and columns are counted in the order of elimination.
pub(crate) struct Factors<'s> {
    builder: &'s Builder,
    /// The rows of the matrix, counted from 0, in the order in which they are eliminated.
    order: Vec<usize>,
    /// Rows of L and of L D, left of the diagonal.
    rows: Vec<Vec<(Symbol<'s>, Symbol<'s>)>>,
    /// The reciprocals of D.
    inverses: Vec<Symbol<'s>>,
}

impl<'s> Factors<'s> {
    /// Factorizes a matrix; row i of `upper` has its elements (i, i) to (i, n).
    pub(crate) fn of(builder: &'s Builder, system: &System<'_>, upper: &[Vec<Symbol<'s>>]) -> Self {
        let dof = upper.len();
        let order = match system.of_base {
            0 => elimination_order(dof, |row, column| system.has_element(row, column)),
            _ => (0..dof).rev().collect(),
        };
        let between = |quantity, row: usize, column: usize| system.name_in_factor(quantity, order[row], order[column]);
        let element = |row: usize, column: usize| between(Quantity::LowerFactor, row, column);
        let scaled = |row: usize, column: usize| between(Quantity::ScaledFactor, row, column);
        let of_joint = |quantity, index: usize| system.name(quantity, order[index]);
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

    /// Returns the factors of the matrix divided by a number.
    pub(crate) fn divided_by(&self, divisor: Symbol<'s>) -> Self {
        let inverses = self.inverses.iter().map(|&inverse| inverse * divisor).collect();
        Self { builder: self.builder, order: self.order.clone(), rows: self.rows.clone(), inverses }
    }

    /// Returns the place of a row of the matrix in the order of elimination.
    pub(crate) fn place(&self, joint: usize) -> usize {
        self.order.iter().position(|other| *other == joint).unwrap_or_default()
    }

    /// Returns L⁻¹ b in the order of elimination; `b` is in the order of the matrix.
    pub(crate) fn forward(&self, b: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
        let mut y: Vec<Symbol<'s>> = Vec::with_capacity(b.len());
        for (row, &joint) in self.rows.iter().zip(&self.order) {
            y.push(row.iter().zip(&y).fold(b[joint], |sum, (&(l, _), &y)| sum - l * y));
        }
        y
    }

    /// Returns D⁻¹ y in the order of elimination.
    pub(crate) fn scaled(&self, y: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
        y.iter().zip(&self.inverses).map(|(&y, &inverse)| y * inverse).collect()
    }

    /// Returns L⁻ᵀ z in the order of the matrix; `z` is in the order of elimination.
    pub(crate) fn backward(&self, z: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
        let mut x = z.to_vec();
        for i in (0..x.len()).rev() {
            x[i] = (i + 1..x.len()).fold(x[i], |sum, k| sum - self.rows[k][i].0 * x[k]);
        }
        (0..x.len()).map(|joint| x[self.place(joint)]).collect()
    }

    /// Returns the solution in the order of the matrix. `b` is zero for all rows that are eliminated before `first`;
    /// for these rows the solution is not computed and is `None`. `name` names the intermediate quantities of a row.
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

/// Returns an element of the symmetric matrix whose upper half is `upper`.
fn element_of<'s>(upper: &[Vec<Symbol<'s>>], row: usize, column: usize) -> Symbol<'s> {
    upper[row.min(column)][row.max(column) - row.min(column)]
}

/// Returns the order of the coordinates, or the reverse order if L then has fewer nonzero elements. `has_element` tells
/// whether an element of the matrix can differ from zero.
fn elimination_order(dof: usize, has_element: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let outward: Vec<usize> = (0..dof).collect();
    let inward: Vec<usize> = outward.iter().rev().copied().collect();
    let elements = |order: &[usize]| elements_of_factor(order, &has_element);
    if elements(&inward) < elements(&outward) { inward } else { outward }
}

/// Returns how many elements of L below the diagonal differ from zero if the coordinates are eliminated in this order.
fn elements_of_factor(order: &[usize], has_element: impl Fn(usize, usize) -> bool) -> usize {
    let row = |&row: &usize| order.iter().map(|&column| has_element(row, column)).collect();
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

    /// Returns which elements of a mass matrix can differ from zero; `parents` are the links that carry the joints.
    fn elements(parents: &[Option<usize>]) -> impl Fn(usize, usize) -> bool {
        let coordinates = Coordinates::of_free_joints(parents.len());
        let parents = parents.to_vec();
        move |row, column| coordinates.meet(&parents, [row, column])
    }

    #[test]
    fn joints_of_a_tree_are_eliminated_from_its_ends_on() {
        // a torso with two arms of two joints: L has an element only for a joint and a joint that moves it
        let torso = elements(&[None, Some(0), Some(1), Some(0), Some(3)]);
        assert_eq!(elements_of_factor(&[4, 3, 2, 1, 0], &torso), 6);
        assert_eq!(elements_of_factor(&[0, 1, 2, 3, 4], &torso), 10, "the torso couples both arms");
        assert_eq!(elimination_order(5, &torso), [4, 3, 2, 1, 0]);
        // L gets no further nonzero elements in a chain, nor if branches meet at the base only
        assert_eq!(elimination_order(3, elements(&[None, Some(0), Some(1)])), [0, 1, 2]);
        assert_eq!(elimination_order(4, elements(&[None, Some(0), None, Some(2)])), [0, 1, 2, 3]);
    }

    /// Adds branches with these numbers of joints, on one link or on the base.
    fn branches(parents: &mut Vec<Option<usize>>, on: Option<usize>, lengths: &[usize]) {
        for length in lengths {
            let first = parents.len();
            parents.extend((first..first + length).map(|joint| if joint == first { on } else { Some(joint - 1) }));
        }
    }

    /// Featherstone's counts for LᵀDL: a joint with d joints before it takes d products for L, and d (d + 1) / 2
    /// products and sums for the elements that remain.
    #[test]
    fn factors_of_a_tree_take_no_more_operations_than_its_elements_ask() {
        let operations = |function, parents: &[Option<usize>]| {
            let coordinates = Coordinates::of_free_joints(parents.len());
            System::new(function, &coordinates, parents.iter().copied()).cost_of_factors().total()
        };
        let mut hyq = Vec::new();
        branches(&mut hyq, None, &[3; 4]);
        let mut allegro = Vec::new();
        branches(&mut allegro, None, &[4; 4]);
        // torso, then two arms and a neck on it, then two legs
        let mut atlas = Vec::new();
        branches(&mut atlas, None, &[3]);
        branches(&mut atlas, Some(2), &[7, 1, 7]);
        branches(&mut atlas, None, &[6, 6]);
        // two legs, waist, two arms on it
        let mut g1 = Vec::new();
        branches(&mut g1, None, &[6, 6, 3]);
        branches(&mut g1, Some(14), &[7, 7]);
        for (name, parents, asked) in
            [("hyq", hyq, 44), ("allegro", allegro, 104), ("atlas", atlas, 924), ("g1", g1, 909)]
        {
            let carriers = |joint: usize| std::iter::successors(parents[joint], |&link| parents[link]).count();
            let least: usize = (0..parents.len()).map(carriers).map(|d| d + d * (d + 1)).sum();
            let counted = operations(Function::ForwardDynamics, &parents);
            println!("{name:8} {counted} operations of LDLᵀ, {least} by the elements that are not zero");
            assert_eq!(counted, least, "{name}");
            assert!(counted <= asked, "{name}");
        }
    }
}
