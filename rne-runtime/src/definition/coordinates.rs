//! Converts between the coordinates of a robot and all its joints, in both directions. If no joint follows another,
//! each joint is a coordinate.

use core::marker::PhantomData;

use crate::definition::per_joint::{Known, PerJoint, Square};
use crate::{Constant, Scalar};

/// The matrix G of the couplings, which relates coordinates and joints: the joints have G q, G q̇ and G q̈, the torques
/// of the coordinates are Gᵀ τ.
pub(crate) trait Coordinates<J: PerJoint, S: Constant>: Copy {
    /// Numbers of all joints; borrowed from those of the coordinates if each joint is a coordinate.
    type OfJoints<'v, T: Scalar>: AsRef<[T]>;

    /// Makes collections with one element for each coordinate.
    fn each(self) -> J;

    /// Whether each joint is a coordinate.
    fn are_joints(self) -> bool;

    /// Returns the values of all joints, from one value for each coordinate.
    fn of_joints<T: Scalar>(self, values: &[T]) -> Self::OfJoints<'_, T>;

    /// Returns sines and cosines of all joints, from those of the coordinates and the positions `q` of all joints.
    fn turns<'v, T: Scalar>(self, turns: [&'v [T]; 2], q: &[T]) -> [Self::OfJoints<'v, T>; 2];

    /// Returns the torques of the actuators at all joints, from one torque for each coordinate. A joint that follows
    /// others has no actuator.
    fn applied<T: Scalar>(self, torques: &[T]) -> Self::OfJoints<'_, T>;

    /// Returns the elements of the coordinates, from one element for each joint.
    fn only<X: Clone>(self, of_joints: J::Of<X>) -> J::Of<X>;

    /// Returns Gᵀ x, where x has numbers or rows for all joints. `plus` adds the second element, times the ratio, to
    /// the first.
    fn gathered<X: Clone>(self, of_joints: J::Of<X>, plus: impl Fn(X, &X, &S) -> X) -> J::Of<X>;

    /// Returns Gᵀ τ.
    fn torques<T: Scalar>(self, of_joints: J::Of<T>) -> J::Of<T> {
        self.gathered(of_joints, |sum, &torque, ratio| sum + torque * ratio.to())
    }

    /// Returns Gᵀ A G, by rows.
    fn matrix<T: Scalar>(self, of_joints: Square<J, T>) -> Square<J, T> {
        if self.are_joints() {
            return of_joints;
        }
        let mut rows = of_joints;
        rows.as_mut().iter_mut().for_each(|row| *row = self.torques(row.clone()));
        self.gathered(rows, |mut sum, row, ratio| {
            sum.as_mut().iter_mut().zip(row.as_ref()).for_each(|(a, &b)| *a += b * ratio.to());
            sum
        })
    }

    /// Returns Gᵀ M G of a symmetric matrix M; it is symmetric to the last bit.
    fn symmetric<T: Scalar>(self, of_joints: Square<J, T>) -> Square<J, T> {
        let mut matrix = self.matrix(of_joints);
        for index in 1..matrix.as_ref().len() {
            let (above, rest) = matrix.as_mut().split_at_mut(index);
            rest[0].as_mut().iter_mut().zip(above).for_each(|(element, row)| *element = row.as_ref()[index]);
        }
        matrix
    }

    /// Returns A G, by rows.
    fn rows<T: Scalar, const ROWS: usize>(self, of_joints: [J::Of<T>; ROWS]) -> [J::Of<T>; ROWS] {
        of_joints.map(|row| self.torques(row))
    }
}

/// The couplings of a robot in which each joint is a coordinate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joints<S>(pub(crate) PhantomData<S>);

impl<const DOF: usize, S: Constant> Coordinates<Known<DOF>, S> for Joints<S> {
    type OfJoints<'v, T: Scalar> = &'v [T];

    fn each(self) -> Known<DOF> {
        Known
    }

    fn are_joints(self) -> bool {
        true
    }

    fn of_joints<T: Scalar>(self, values: &[T]) -> &[T] {
        values
    }

    fn turns<'v, T: Scalar>(self, turns: [&'v [T]; 2], _: &[T]) -> [&'v [T]; 2] {
        turns
    }

    fn applied<T: Scalar>(self, torques: &[T]) -> &[T] {
        torques
    }

    fn only<X: Clone>(self, of_joints: [X; DOF]) -> [X; DOF] {
        of_joints
    }

    fn gathered<X: Clone>(self, of_joints: [X; DOF], _: impl Fn(X, &X, &S) -> X) -> [X; DOF] {
        of_joints
    }
}
