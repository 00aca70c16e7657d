//! The arguments of a function, as a graph holds them: by the million in a search, so small ones.

use crate::ir::name::Name;
use crate::ir::quantity::{Axis, Component, Quantity};

/// One number that is given to a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Input {
    quantity: Quantity,
    axis: Option<Axis>,
    joint: u16,
}

impl Input {
    /// The argument of that name: a number, or a component of a vector.
    pub(crate) fn new(name: Name) -> Self {
        // joints and parameters are few
        Self {
            quantity: name.quantity,
            axis: name.component.axis(),
            joint: u16::try_from(name.joint).unwrap_or(u16::MAX),
        }
    }

    pub(crate) fn name(self) -> Name {
        let component = self.axis.map_or(Component::Scalar, Component::Vector);
        Name { component, ..Name::scalar(self.quantity, self.joint.into()) }
    }

    pub(crate) const fn quantity(self) -> Quantity {
        self.quantity
    }

    /// The joint, counted from 0.
    pub(crate) fn index(self) -> usize {
        usize::from(self.joint).wrapping_sub(1)
    }

    pub(crate) const fn axis(self) -> Option<Axis> {
        self.axis
    }
}
