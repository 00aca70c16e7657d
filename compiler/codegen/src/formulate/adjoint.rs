//! Derivatives of the torques weighted by multipliers, λᵀτ, in reverse mode.
//!
//! λᵀτ is one number, so its gradient takes a few times the operations of the torques, whatever the number of joints.
//! The adjoint of the forces on a link is the velocity that the link would have if the joints had the velocities λ. So
//! the derivatives here are those of the virtual power of the forces that move the robot.

use crate::coordinates::Coordinates;
use crate::formulate::equations::inverse_by;
use crate::formulate::ldlt::{Factors, System};
use crate::formulate::{Outputs, integrator, square};
use crate::function::Function;
use crate::ir::{Builder, Name, Quantity, Symbol, WithRespectTo};

/// Returns λᵀτ, the sum of the torques of the coordinates, each times its multiplier λ.
fn weighted<'s>(builder: &'s Builder, coordinates: &Coordinates, torques: &[Symbol<'s>]) -> Symbol<'s> {
    let terms = coordinates.joints().iter().zip(torques).map(|(joint, &torque)| {
        let multiplier = builder.argument(Name::scalar(Quantity::Multiplier, joint + 1));
        multiplier * torque
    });
    terms.reduce(|sum, term| sum + term).unwrap_or_else(|| builder.zero())
}

/// Returns the derivatives of λᵀτ with respect to q, q̇ and q̈.
pub(crate) fn gradient<'s>(builder: &'s Builder, coordinates: &Coordinates, torques: &[Symbol<'s>]) -> Outputs<'s> {
    let kinds = [WithRespectTo::Position, WithRespectTo::Rate, WithRespectTo::RateDot];
    let by: Vec<_> = kinds.iter().flat_map(|kind| coordinates.joints().iter().map(|joint| kind(joint + 1))).collect();
    let variables: Vec<_> = by.iter().map(|by| by.variable()).collect();
    builder.at(Quantity::WeightedTorque, 0);
    let found = builder.gradient(weighted(builder, coordinates, torques), &variables);
    let name = |by| Name { by: Some(by), ..Name::scalar(Quantity::WeightedTorque, 0) };
    by.into_iter().zip(found).map(|(by, derivative)| (name(by), builder.name(name(by), derivative))).collect()
}

/// The second derivatives of λᵀτ; each block is stored by rows.
pub(crate) struct Hessian<M> {
    /// With respect to q and q: the upper half, from the diagonal on.
    pub(crate) dq_dq: M,
    /// With respect to q (rows) and q̇ (columns).
    pub(crate) dq_dqd: M,
    /// With respect to q̇ and q̇: the upper half, from the diagonal on.
    pub(crate) dqd_dqd: M,
    /// With respect to q (rows) and q̈ (columns).
    pub(crate) dq_dqdd: M,
}

impl<'s> Hessian<Vec<Vec<Symbol<'s>>>> {
    /// Returns the blocks as named results. The elements (i, j) and (j, i) of a symmetric block are one number.
    pub(crate) fn outputs(&self, coordinates: &Coordinates) -> Outputs<'s> {
        use WithRespectTo::{Position, Rate, RateDot};
        let joints = coordinates.joints();
        let block = |rows: &[Vec<Symbol<'s>>], by: Quantity, kind: fn(usize) -> WithRespectTo, is_symmetric: bool| {
            square(joints.len(), |row, column| {
                let (row, column) = if is_symmetric { (row.min(column), row.max(column)) } else { (row, column) };
                let name = Name { by: Some(kind(joints[column] + 1)), ..Name::scalar(by, joints[row] + 1) };
                let element = rows[row][if is_symmetric { column - row } else { column }];
                (name, element.builder.name(name, element))
            })
        };
        let (by_position, by_rate) = (Quantity::WeightedByPosition, Quantity::WeightedByRate);
        [
            block(&self.dq_dq, by_position, Position, true),
            block(&self.dq_dqd, by_position, Rate, false),
            block(&self.dqd_dqd, by_rate, Rate, true),
            block(&self.dq_dqdd, by_position, RateDot, false),
        ]
        .concat()
    }
}

/// Returns the second derivatives of λᵀτ: its gradient, differentiated in forward mode.
pub(crate) fn hessian<'s>(builder: &'s Builder, coordinates: &Coordinates, torques: &[Symbol<'s>]) -> Outputs<'s> {
    let joints = coordinates.joints();
    let dof = joints.len();
    let variables = |kind: fn(usize) -> WithRespectTo| joints.iter().map(move |joint| kind(joint + 1));
    let kinds = [WithRespectTo::Position, WithRespectTo::Rate, WithRespectTo::RateDot];
    let all: Vec<_> = kinds.into_iter().flat_map(variables).map(WithRespectTo::variable).collect();
    builder.at(Quantity::WeightedTorque, 0);
    let gradient = builder.gradient(weighted(builder, coordinates, torques), &all);
    // the derivatives with respect to q̈ are M λ, which does not depend on the velocities
    let by_position = builder.derivatives(&gradient, variables(WithRespectTo::Position));
    let by_rate = builder.derivatives(&gradient[dof..2 * dof], variables(WithRespectTo::Rate));
    let whole = |kind: usize| {
        (0..dof).map(|row| (0..dof).map(|column| by_position[row][kind * dof + column]).collect()).collect()
    };
    let half = |columns: &[Vec<Symbol<'s>>]| {
        (0..dof).map(|row| (row..dof).map(|column| columns[column][row]).collect()).collect()
    };
    let [dq_dqd, dq_dqdd] = [1, 2].map(whole);
    Hessian { dq_dq: half(&by_position), dq_dqd, dqd_dqd: half(&by_rate), dq_dqdd }.outputs(coordinates)
}

/// The inverse of a mass matrix, from which the derivatives of the accelerations are computed.
pub(crate) struct Inverse<'s, 'a> {
    builder: &'s Builder,
    system: &'a System<'a>,
    factors: Factors<'s>,
    /// Elements of the inverse by rows.
    elements: Outputs<'s>,
}

impl<'s, 'a> Inverse<'s, 'a> {
    /// Whether the derivatives are those of an Euler step: then the duration h is a factor of all of them.
    fn is_of_step(builder: &Builder) -> bool {
        builder.function == Function::EulerStepDerivatives
    }

    /// Inverts the matrix; row i of `upper` has the elements (i, i) to (i, n) of it.
    pub(crate) fn of(builder: &'s Builder, system: &'a System<'a>, upper: &[Vec<Symbol<'s>>]) -> Self {
        let factors = Factors::of(builder, system, upper);
        let elements = if Self::is_of_step(builder) {
            // D⁻¹ is multiplied by the duration: that takes fewer products than to multiply every element
            inverse_by(builder, system, &factors.divided_by(integrator::duration(builder)), Quantity::NextRate)
        } else {
            inverse_by(builder, system, &factors, Quantity::RateDot)
        };
        Self { builder, system, factors, elements }
    }

    /// Solves for the accelerations and stores them in the builder, so that later formulas use them as those of the
    /// joints.
    pub(crate) fn keep_accelerations(&self, bias: Vec<Symbol<'s>>) {
        let coordinates = self.system.coordinates;
        let joints = coordinates.joints();
        let rest = joints.iter().zip(bias).map(|(&joint, bias)| coordinates.applied(self.builder, joint) - bias);
        let rest: Vec<_> = rest.collect();
        let solved = self.factors.solved(0, &rest, |quantity, row| self.system.name(quantity, row));
        let of = joints.iter().map(|joint| WithRespectTo::RateDot(joint + 1));
        self.builder.keep_accelerations(of.zip(solved.into_iter().flatten()));
    }

    /// Returns -M⁻¹ ∂τ/∂q, -M⁻¹ ∂τ/∂q̇ and M⁻¹, given ∂τ/∂q and ∂τ/∂q̇ by rows. For an Euler step, returns the
    /// derivatives of the next state, computed from these.
    pub(crate) fn derivatives(self, by_state: &[Vec<Vec<Symbol<'s>>>; 2]) -> Outputs<'s> {
        let joints = self.system.coordinates.joints();
        let dof = joints.len();
        let change = |torques: &[Vec<Symbol<'s>>], row: usize, column: usize| {
            let terms = (0..dof).map(|at| self.elements[row * dof + at].1 * torques[at][column]);
            -terms.reduce(|sum, term| sum + term).unwrap_or_else(|| self.builder.zero())
        };
        if Self::is_of_step(self.builder) {
            let changes = |torques| (0..dof * dof).map(|at| change(torques, at / dof, at % dof)).collect();
            let changes = by_state.each_ref().map(|torques| changes(torques));
            return integrator::derivatives(self.builder, self.system.coordinates, &changes, self.elements);
        }
        let kinds: [fn(usize) -> WithRespectTo; 2] = [WithRespectTo::Position, WithRespectTo::Rate];
        let mut found = Vec::new();
        for (torques, kind) in by_state.iter().zip(kinds) {
            found.extend(square(dof, |row, column| {
                let name =
                    Name { by: Some(kind(joints[column] + 1)), ..Name::scalar(Quantity::RateDot, joints[row] + 1) };
                (name, self.builder.name(name, change(torques, row, column)))
            }));
        }
        found.extend(self.elements);
        found
    }
}
