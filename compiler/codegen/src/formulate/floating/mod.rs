//! Results of a robot with a floating base: the rows of the base come before those of the joints.

pub(crate) mod centroid;
pub(crate) mod contact;
pub(crate) mod step;
pub(crate) mod tips;

use crate::coordinates::Coordinates;
use crate::formulate::layout::components;
use crate::formulate::ldlt::{self, System};
use crate::formulate::{Frame, Outputs, square};
use crate::ir::{Axis, Builder, Matrix, Name, Quantity, Symbol, Vector, WithRespectTo, all_names_of};

/// Returns the rotation of the base, which is an argument.
pub(crate) fn base_rotation(builder: &Builder) -> Matrix<'_> {
    Matrix::from_elements(all_names_of::<9>("base_rotation", 0).map(|name| builder.argument(name)))
}

/// Returns the pose of the base, which is an argument.
pub(crate) fn pose_of_base(builder: &Builder) -> Frame<'_> {
    let [rotation @ .., x, y, z] = all_names_of::<12>("pose", 0).map(|name| builder.argument(name));
    Frame { rotation: Matrix::from_elements(rotation), origin: Vector([x, y, z]) }
}

/// Returns the force and the moment on a floating base as named results.
pub(crate) fn on_base([force, moment]: [Vector<'_>; 2]) -> Outputs<'_> {
    let parts = [(Quantity::BaseForce, force), (Quantity::BaseMoment, moment)];
    parts.into_iter().flat_map(|(part, vector)| components(Name::scalar(part, 0), vector)).collect()
}

/// Returns all elements of M with the rows of a floating base, given its upper half.
pub(crate) fn floating_mass_matrix<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
) -> Outputs<'s> {
    square(upper.len(), |row, column| {
        let (row, column) = (row.min(column), row.max(column));
        let (name, element) = (system.name_of_element(row, column), upper[row][column - row]);
        (name, if system.coordinates.is_every_joint() { element } else { builder.name(name, element) })
    })
}

/// Returns M⁻¹ ((0, τ) - bias): the accelerations of a floating base, then those of the joints.
pub(crate) fn floating_forward_dynamics<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
    bias: Outputs<'s>,
) -> Outputs<'s> {
    let x = ldlt::solved(builder, system, upper, &floating_rest(builder, system, bias)).into_iter().enumerate();
    x.map(|(row, x)| (system.name(Quantity::RateDot, row), x)).collect()
}

/// Returns the right-hand side (0, τ) - bias.
pub(crate) fn floating_rest<'s>(builder: &'s Builder, system: &System<'_>, bias: Outputs<'s>) -> Vec<Symbol<'s>> {
    let rest = |(row, (_, bias)): (usize, (Name, Symbol<'s>))| {
        let name = system.name(Quantity::Reduced, row);
        builder.joint(name.joint).within(Quantity::Reduced, || match system.of_joint(row) {
            Some(place) => system.coordinates.applied(builder, system.coordinates.joints()[place]) - bias,
            None => -bias,
        })
    };
    bias.into_iter().enumerate().map(rest).collect()
}

/// Returns the variables of the derivatives of a robot with a floating base: q, q̇ and the angular velocity of the
/// base.
pub(crate) fn variables(coordinates: &Coordinates) -> [Vec<WithRespectTo>; 3] {
    let of_joints =
        |kind: fn(usize) -> WithRespectTo| coordinates.joints().iter().map(|joint| kind(joint + 1)).collect();
    let about = Axis::ALL.map(|axis| WithRespectTo::BaseRate(4 + axis as usize));
    [of_joints(WithRespectTo::Position), of_joints(WithRespectTo::Rate), about.into()]
}

/// Returns three matrices by rows, the derivatives with respect to q, q̇ and ω, given the columns of all variables;
/// `forces` are the names of the rows.
pub(crate) fn sensitivity_of_floating_base<'s>(
    coordinates: &Coordinates,
    forces: &[Name],
    columns: &[Vec<Symbol<'s>>],
) -> Outputs<'s> {
    let mut columns = columns.iter();
    let matrix = |variables: Vec<WithRespectTo>| {
        let columns: Vec<_> = variables.into_iter().zip(columns.by_ref()).collect();
        let row = |(row, &force): (usize, &Name)| {
            let named =
                |(by, column): &(WithRespectTo, &Vec<Symbol<'s>>)| (Name { by: Some(*by), ..force }, column[row]);
            columns.iter().map(named).collect::<Vec<_>>()
        };
        forces.iter().enumerate().flat_map(row).collect::<Vec<_>>()
    };
    let found = variables(coordinates).map(matrix).concat();
    found.into_iter().map(|(name, symbol)| coordinates.named(name, symbol)).collect()
}

/// Returns the derivatives of the forces with respect to q, q̇ and ω, computed by the product rule.
pub(crate) fn floating_derivatives<'s>(
    builder: &'s Builder,
    coordinates: &Coordinates,
    forces: Outputs<'s>,
) -> Outputs<'s> {
    let (names, forces): (Vec<_>, Vec<_>) = forces.into_iter().unzip();
    let columns = builder.derivatives(&forces, variables(coordinates).concat().into_iter());
    sensitivity_of_floating_base(coordinates, &names, &columns)
}
