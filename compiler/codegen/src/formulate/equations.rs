//! The equations of motion as results: the mass matrix, its inverse, accelerations, the Coriolis matrix and
//! derivatives.

use crate::coordinates::Coordinates;
use crate::formulate::Outputs;
use crate::formulate::layout::{by_joint, square};
use crate::formulate::ldlt::{self, System};
use crate::ir::{Builder, Cause, Name, Quantity, Symbol, WithRespectTo};

/// Returns all elements of M, given its upper half: row i of `upper` has the elements (i, i) to (i, n).
pub(crate) fn mass_matrix<'s>(coordinates: &Coordinates, upper: &[Vec<Symbol<'s>>]) -> Outputs<'s> {
    let joints = coordinates.joints();
    square(upper.len(), |row, column| {
        let (row, column) = (row.min(column), row.max(column));
        coordinates.named(torque_by(joints[row], WithRespectTo::RateDot(joints[column] + 1)), upper[row][column - row])
    })
}

/// Returns the Coriolis matrix ½ ∂(bias torques)/∂q̇.
pub(crate) fn coriolis_matrix<'s>(
    builder: &'s Builder,
    coordinates: &Coordinates,
    torques: &[Symbol<'s>],
    half: Symbol<'s>,
) -> Outputs<'s> {
    let joints = coordinates.joints();
    let columns = builder.derivatives(torques, joints.iter().map(|joint| WithRespectTo::Rate(joint + 1)));
    square(torques.len(), |row, column| {
        let name = Name::indexed(Quantity::CoriolisElement, joints[row] + 1, joints[column] + 1);
        let line = builder.joint(joints[row] + 1);
        (name, builder.name(name, line.within(Quantity::CoriolisElement, || columns[column][row] * half)))
    })
}

/// Returns the accelerations M⁻¹ (τ - bias).
pub(crate) fn forward_dynamics<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
    bias: &[Symbol<'s>],
) -> Outputs<'s> {
    accelerations(builder, system, upper, |applied, place| applied - bias[place])
}

/// Returns M⁻¹ r. `left` gives r: it subtracts the bias from the applied torque of each coordinate.
pub(crate) fn accelerations<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
    left: impl Fn(Symbol<'s>, usize) -> Symbol<'s>,
) -> Outputs<'s> {
    let rest = |(place, &joint): (usize, &usize)| {
        let applied = system.coordinates.applied(builder, joint);
        builder.joint(joint + 1).within(Quantity::Reduced, || left(applied, place))
    };
    let rest: Vec<_> = system.coordinates.joints().iter().enumerate().map(rest).collect();
    by_joint(system.coordinates, Quantity::RateDot, ldlt::solved(builder, system, upper, &rest))
}

/// Returns ∂τ/∂q, then ∂τ/∂q̇.
pub(crate) fn derivatives<'s>(builder: &'s Builder, coordinates: &Coordinates, torques: &[Symbol<'s>]) -> Outputs<'s> {
    let joints = coordinates.joints();
    let by = |kind: fn(usize) -> WithRespectTo| {
        let columns = builder.derivatives(torques, joints.iter().map(|joint| kind(joint + 1)));
        square(torques.len(), |row, column| {
            coordinates.named(torque_by(joints[row], kind(joints[column] + 1)), columns[column][row])
        })
    };
    [by(WithRespectTo::Position), by(WithRespectTo::Rate)].concat()
}

/// Returns the name of the derivative of a torque; its joint is counted from 0.
pub(crate) fn torque_by(row: usize, by: WithRespectTo) -> Name {
    Name { by: Some(by), ..Name::scalar(Quantity::Torque, row + 1) }
}

/// Returns M⁻¹ = L⁻ᵀ D⁻¹ L⁻¹. Column j is solved only from joint j on in the order of elimination; the other elements
/// follow by symmetry. Row i of `upper` has the elements (i, i) to (i, n) of M.
pub(crate) fn inverse_mass_matrix<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
) -> Outputs<'s> {
    inverse_by(builder, system, &ldlt::Factors::of(builder, system, upper), Quantity::RateDot)
}

/// Returns the inverse of a matrix, given its factors; its elements get names of the quantity `element`.
pub(super) fn inverse_by<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    factors: &ldlt::Factors<'s>,
    element: Quantity,
) -> Outputs<'s> {
    let joints = system.coordinates.joints();
    let dof = joints.len();
    let (zero, one) = (builder.constant(0.0, Cause::Arithmetic), builder.constant(1.0, Cause::Arithmetic));
    let name = |quantity, row: usize, column: usize| {
        let quantity = if quantity == Quantity::RateDot { element } else { quantity };
        Name::indexed(quantity, joints[row] + 1, joints[column] + 1)
    };
    let columns: Vec<Vec<Option<Symbol<'s>>>> = (0..dof)
        .map(|column| {
            let unit: Vec<_> = (0..dof).map(|row| if row == column { one } else { zero }).collect();
            factors.solved(factors.place(column), &unit, |quantity, row| name(quantity, row, column))
        })
        .collect();
    square(dof, |row, column| {
        let is_mirror = factors.place(row) < factors.place(column);
        let (row, column) = if is_mirror { (column, row) } else { (row, column) };
        (name(Quantity::RateDot, row, column), columns[column][row].unwrap_or(zero))
    })
}
