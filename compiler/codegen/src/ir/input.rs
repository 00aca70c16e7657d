//! The arguments of a function in a graph. A search makes millions of them, so they are small.

use super::{Axis, Component, Name, Quantity};

/// A number among the arguments of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Input {
    quantity: Quantity,
    component: Component,
    joint: u16,
}

impl Input {
    /// The argument of that name: a number, a component of a vector or an element of a matrix.
    pub(crate) fn new(name: Name) -> Self {
        // a robot has few joints and parameters, so `u16` is enough
        Self {
            quantity: name.quantity,
            component: name.component,
            joint: u16::try_from(name.joint).unwrap_or(u16::MAX),
        }
    }

    pub(crate) fn name(self) -> Name {
        Name { component: self.component, ..Name::scalar(self.quantity, self.joint.into()) }
    }

    pub(crate) const fn quantity(self) -> Quantity {
        self.quantity
    }

    /// The joint, counted from 0.
    pub(crate) fn index(self) -> usize {
        usize::from(self.joint).wrapping_sub(1)
    }

    pub(crate) const fn axis(self) -> Option<Axis> {
        self.component.axis()
    }

    /// The element of a matrix, counted by rows; otherwise the axis.
    pub(crate) const fn element(self) -> usize {
        match self.component {
            Component::Scalar => 0,
            Component::Vector(axis) => axis as usize,
            Component::Matrix(row, column) => 3 * row as usize + column as usize,
        }
    }
}
