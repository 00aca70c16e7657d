//! Names numbers, vectors and matrices as results, in the order of the layout.

use crate::coordinates::Coordinates;
use crate::formulate::{Frame, Outputs};
use crate::ir::{Axis, Component, Name, Quantity, Symbol, Vector};

/// Returns the elements of an n × n matrix by rows.
pub(crate) fn square<'s>(dof: usize, element: impl Fn(usize, usize) -> (Name, Symbol<'s>)) -> Outputs<'s> {
    (0..dof)
        .flat_map(|row| (0..dof).map(move |column| (row, column)))
        .map(|(row, column)| element(row, column))
        .collect()
}

/// Returns one result for each coordinate.
pub(crate) fn by_joint<'s>(coordinates: &Coordinates, quantity: Quantity, numbers: Vec<Symbol<'s>>) -> Outputs<'s> {
    let numbers = coordinates.joints().iter().zip(numbers);
    numbers.map(|(joint, number)| coordinates.named(Name::scalar(quantity, joint + 1), number)).collect()
}

/// Returns the components of a vector as results with the vector's name.
pub(super) fn components(name: Name, vector: Vector<'_>) -> [(Name, Symbol<'_>); 3] {
    Axis::ALL.map(|axis| (Name { component: Component::Vector(axis), ..name }, vector.0[axis as usize]))
}

/// Returns a matrix by rows, whose columns are the vectors of the coordinates.
pub(super) fn by_row<'s>(coordinates: &Coordinates, quantity: Quantity, columns: &[Vector<'s>]) -> Outputs<'s> {
    let row = |axis: Axis| {
        let columns = coordinates.joints().iter().zip(columns);
        columns.map(move |(joint, column)| {
            coordinates.named(Name::vector(quantity, joint + 1, axis), column.0[axis as usize])
        })
    };
    Axis::ALL.into_iter().flat_map(row).collect()
}

/// Returns a rotation by rows, then a translation.
pub(super) fn pose<'s>(joint: usize, frame: &Frame<'s>) -> Outputs<'s> {
    let rotation = Axis::ALL.into_iter().zip(frame.rotation.0).flat_map(|(row, values)| {
        Axis::ALL.map(|column| (Name::matrix(Quantity::FrameRotation, joint, row, column), values.0[column as usize]))
    });
    rotation.chain(components(Name::scalar(Quantity::FrameOrigin, joint), frame.origin)).collect()
}
