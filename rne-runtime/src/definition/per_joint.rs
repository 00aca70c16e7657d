//! Collections of one value per joint: arrays if the number of joints is known at compile time, otherwise vectors.

use crate::Constant;
use crate::definition::coordinates::{Coordinates, Joints};

/// Makes collections with one element per joint. The functions of a robot are written once, for both kinds.
pub(crate) trait PerJoint: Copy {
    /// A collection with one `U` per joint, base to tip.
    type Of<U: Clone>: Clone + AsRef<[U]> + AsMut<[U]>;

    /// The type that converts between the coordinates of a robot and its joints.
    type Coordinates<'a, S: Constant>: Coordinates<Self, S>;

    /// Returns a collection with `value(index)` for every joint.
    fn of<U: Clone>(self, value: impl FnMut(usize) -> U) -> Self::Of<U>;

    /// Returns a list with one value for every joint.
    fn all<U: Clone>(self, value: &U) -> Self::Of<U> {
        self.of(|_| value.clone())
    }
}

/// A square matrix: one row per joint, with one element per joint.
pub(crate) type Square<J, U> = <J as PerJoint>::Of<<J as PerJoint>::Of<U>>;

/// Makes arrays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known<const DOF: usize>;

impl<const DOF: usize> PerJoint for Known<DOF> {
    type Of<U: Clone> = [U; DOF];
    type Coordinates<'a, S: Constant> = Joints<S>;

    fn of<U: Clone>(self, value: impl FnMut(usize) -> U) -> [U; DOF] {
        core::array::from_fn(value)
    }
}
