//! Results of a robot whose base nothing holds: the rows of the base stand before those of the joints.

use crate::formulate::ldlt::{self, System};
use crate::formulate::{Outputs, components, square};
use crate::ir::{Builder, Matrix, Name, Quantity, Symbol, Vector};

/// The rotation of the base: an argument.
pub(crate) fn base_rotation(builder: &Builder) -> Matrix<'_> {
    Matrix::from_elements(Name::of_base_rotation().map(|name| builder.argument(name)))
}

/// The force and the moment on a base that nothing holds.
pub(crate) fn on_base([force, moment]: [Vector<'_>; 2]) -> Outputs<'_> {
    let parts = [(Quantity::BaseForce, force), (Quantity::BaseMoment, moment)];
    parts.into_iter().flat_map(|(part, vector)| components(Name::scalar(part, 0), vector)).collect()
}

/// M with the rows of a base that nothing holds, by its upper half.
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

/// M⁻¹ ((0, τ) - bias): the accelerations of a base that nothing holds, and of the joints.
pub(crate) fn floating_forward_dynamics<'s>(
    builder: &'s Builder,
    system: &System<'_>,
    upper: &[Vec<Symbol<'s>>],
    bias: Outputs<'s>,
) -> Outputs<'s> {
    let x = ldlt::solved(builder, system, upper, &floating_rest(builder, system, bias)).into_iter().enumerate();
    x.map(|(row, x)| (system.name(Quantity::RateDot, row), x)).collect()
}

/// (0, τ) - bias
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
