//! One value per joint: an array where the number of joints is known at compile time, a vector where it is not.

use crate::Constant;
use crate::definition::coordinates::{Coordinates, Joints};

/// Makes collections with one element per joint. The functions of a robot are written once, for both kinds.
pub(crate) trait PerJoint: Copy {
    /// One `U` per joint, base to tip.
    type Of<U: Clone>: Clone + AsRef<[U]> + AsMut<[U]>;

    /// From the coordinates of a robot to its joints.
    type Coordinates<'a, S: Constant>: Coordinates<Self, S>;

    /// `value` of every joint's index.
    fn of<U: Clone>(self, value: impl FnMut(usize) -> U) -> Self::Of<U>;

    /// Returns a list with one value for every joint.
    fn all<U: Clone>(self, value: &U) -> Self::Of<U> {
        self.of(|_| value.clone())
    }
}

/// One row of elements per joint.
pub(crate) type Square<J, U> = <J as PerJoint>::Of<<J as PerJoint>::Of<U>>;

/// Arrays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known<const DOF: usize>;

impl<const DOF: usize> PerJoint for Known<DOF> {
    type Of<U: Clone> = [U; DOF];
    type Coordinates<'a, S: Constant> = Joints<S>;

    fn of<U: Clone>(self, value: impl FnMut(usize) -> U) -> [U; DOF] {
        core::array::from_fn(value)
    }
}
