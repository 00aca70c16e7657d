//! Joints that follow others: from the coordinates of a robot to all its joints, and from the torques of all joints to
//! those that work on the coordinates.
//!
//! With the ratios of the couplings in the matrix G: the joints have G q, G q̇ and G q̈, the torques are Gᵀ τ, the mass
//! matrix is Gᵀ M G. The order of the operations is part of the contract; generated code repeats it: terms in the order
//! of the joints, one after the other.

use std::borrow::Cow;

use rne_model::Robot;

use crate::{Constant, Scalar};

/// The joints that are coordinates, and those that follow them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Couplings<S> {
    /// The joints that follow no other, counted from 0.
    coordinates: Vec<usize>,
    /// For each joint the joints that it follows, with their ratios; `None` for a coordinate.
    follows: Vec<Option<Vec<(usize, S)>>>,
}

impl Couplings<f64> {
    pub(crate) fn of(robot: &Robot) -> Self {
        let follows = |joint: &rne_model::Joint| joint.coupling.as_ref().map(|coupling| coupling.follows.clone());
        let coordinates = (0..robot.joints.len()).filter(|&at| robot.joints[at].coupling.is_none()).collect();
        Self { coordinates, follows: robot.joints.iter().map(follows).collect() }
    }

    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
    pub(crate) fn to_f32(&self) -> Couplings<f32> {
        let single =
            |follows: &Vec<(usize, f64)>| follows.iter().map(|&(joint, ratio)| (joint, ratio as f32)).collect();
        let follows = self.follows.iter().map(|follows| follows.as_ref().map(single)).collect();
        Couplings { coordinates: self.coordinates.clone(), follows }
    }
}

impl<S: Constant> Couplings<S> {
    /// No joint follows another.
    pub(crate) fn none(joints: usize) -> Self {
        Self { coordinates: (0..joints).collect(), follows: vec![None; joints] }
    }

    /// The joints that follow no other, counted from 0.
    pub(crate) fn joints(&self) -> &[usize] {
        &self.coordinates
    }

    /// Number of coordinates.
    pub(crate) fn dof(&self) -> usize {
        self.coordinates.len()
    }

    fn is_empty(&self) -> bool {
        self.coordinates.len() == self.follows.len()
    }

    /// The values of all joints, from one for each coordinate.
    pub(crate) fn of_joints<'a, T: Scalar>(&self, values: &'a [T]) -> Cow<'a, [T]> {
        if self.is_empty() {
            return Cow::Borrowed(values);
        }
        let mut all = self.only(values);
        for (joint, follows) in self.follows.iter().enumerate() {
            if let Some(follows) = follows {
                let terms = follows.iter().map(|(followed, ratio)| all[*followed] * ratio.to());
                all[joint] = terms.reduce(|sum, term| sum + term).unwrap_or_else(T::zero);
            }
        }
        Cow::Owned(all)
    }

    /// Sines and cosines of all joints, from those of the coordinates and the positions `q` of all joints.
    pub(crate) fn turns<'a, T: Scalar>(&self, sin: &'a [T], cos: &'a [T], q: &[T]) -> (Cow<'a, [T]>, Cow<'a, [T]>) {
        if self.is_empty() {
            return (Cow::Borrowed(sin), Cow::Borrowed(cos));
        }
        let (mut sin, mut cos) = (self.only(sin), self.only(cos));
        for (joint, _) in self.follows.iter().enumerate().filter(|(_, follows)| follows.is_some()) {
            (sin[joint], cos[joint]) = T::sin_cos(q[joint]);
        }
        (Cow::Owned(sin), Cow::Owned(cos))
    }

    /// The elements of the coordinates, from one element for each joint.
    pub(crate) fn of_coordinates<X: Clone>(&self, of_joints: Vec<X>) -> Vec<X> {
        if self.is_empty() {
            of_joints
        } else {
            self.coordinates.iter().map(|&joint| of_joints[joint].clone()).collect()
        }
    }

    /// The torques of the actuators of all joints, from one for each coordinate: a follower has no actuator.
    pub(crate) fn applied<'a, T: Scalar>(&self, torques: &'a [T]) -> Cow<'a, [T]> {
        if self.is_empty() { Cow::Borrowed(torques) } else { Cow::Owned(self.only(torques)) }
    }

    fn only<T: Scalar>(&self, values: &[T]) -> Vec<T> {
        let mut all = vec![T::zero(); self.follows.len()];
        for (&joint, &value) in self.coordinates.iter().zip(values) {
            all[joint] = value;
        }
        all
    }

    /// Gᵀ x, of numbers or rows x of all joints: `plus` adds the second, times the ratio, to the first.
    pub(crate) fn gathered<X: Clone>(&self, of_joints: Vec<X>, plus: impl Fn(X, &X, &S) -> X) -> Vec<X> {
        if self.is_empty() {
            return of_joints;
        }
        let of_coordinate = |&coordinate: &usize| {
            let followers = self.follows.iter().zip(&of_joints).filter_map(|(follows, x)| {
                let (_, ratio) = follows.as_ref()?.iter().find(|(followed, _)| *followed == coordinate)?;
                Some((x, ratio))
            });
            followers.fold(of_joints[coordinate].clone(), |sum, (x, ratio)| plus(sum, x, ratio))
        };
        self.coordinates.iter().map(of_coordinate).collect()
    }

    /// Gᵀ τ
    pub(crate) fn torques<T: Scalar>(&self, of_joints: Vec<T>) -> Vec<T> {
        self.gathered(of_joints, |sum, &torque, ratio| sum + torque * ratio.to())
    }

    /// Gᵀ A G, by rows.
    pub(crate) fn matrix<T: Scalar>(&self, of_joints: Vec<Vec<T>>) -> Vec<Vec<T>> {
        let rows = of_joints.into_iter().map(|row| self.torques(row)).collect();
        self.gathered(rows, |sum, row, ratio| sum.into_iter().zip(row).map(|(a, &b)| a + b * ratio.to()).collect())
    }

    /// Gᵀ M G of a symmetric matrix, symmetric to the last bit.
    pub(crate) fn symmetric<T: Scalar>(&self, of_joints: Vec<Vec<T>>) -> Vec<Vec<T>> {
        let mut matrix = self.matrix(of_joints);
        for index in 1..matrix.len() {
            let (above, rest) = matrix.split_at_mut(index);
            rest[0].iter_mut().zip(above).for_each(|(element, row)| *element = row[index]);
        }
        matrix
    }

    /// A G, by rows.
    pub(crate) fn rows<T: Scalar, const ROWS: usize>(&self, of_joints: [Vec<T>; ROWS]) -> [Vec<T>; ROWS] {
        of_joints.map(|row| self.torques(row))
    }
}
