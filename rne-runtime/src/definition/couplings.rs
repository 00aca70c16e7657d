//! Joints that follow others by couplings, for a robot whose number of joints is known at run time.
//!
//! The order of the operations is part of the contract; generated code repeats it: terms in the order of the joints,
//! one after the other.

use std::borrow::Cow;

use rne_model::Robot;

use crate::definition::coordinates::Coordinates;
use crate::definition::per_joint::PerJoint;
use crate::{Constant, Scalar};

/// Makes vectors of this length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counted(pub(crate) usize);

impl PerJoint for Counted {
    type Of<U: Clone> = Vec<U>;
    type Coordinates<'a, S: Constant> = &'a Couplings<S>;

    fn of<U: Clone>(self, value: impl FnMut(usize) -> U) -> Vec<U> {
        (0..self.0).map(value).collect()
    }
}

/// The couplings of a robot: its coordinates, and the joints that follow them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Couplings<S> {
    /// The joints that follow no other, counted from 0.
    coordinates: Vec<usize>,
    /// For each joint, the joints that it follows, with their ratios; `None` for a coordinate.
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
    /// Couplings of a robot in which no joint follows another.
    pub(crate) fn none(joints: usize) -> Self {
        Self { coordinates: (0..joints).collect(), follows: vec![None; joints] }
    }

    /// Returns the joints that follow no other, counted from 0.
    pub(crate) fn joints(&self) -> &[usize] {
        &self.coordinates
    }

    /// Number of coordinates.
    pub(crate) fn dof(&self) -> usize {
        self.coordinates.len()
    }

    /// Returns a list of all joints with the values at the coordinates, and zeros at the other joints.
    fn spread<T: Scalar>(&self, values: &[T]) -> Vec<T> {
        let mut all = vec![T::zero(); self.follows.len()];
        for (&joint, &value) in self.coordinates.iter().zip(values) {
            all[joint] = value;
        }
        all
    }
}

impl<S: Constant> Coordinates<Counted, S> for &Couplings<S> {
    type OfJoints<'v, T: Scalar> = Cow<'v, [T]>;

    fn each(self) -> Counted {
        Counted(self.dof())
    }

    fn are_joints(self) -> bool {
        self.coordinates.len() == self.follows.len()
    }

    fn of_joints<T: Scalar>(self, values: &[T]) -> Cow<'_, [T]> {
        if self.are_joints() {
            return Cow::Borrowed(values);
        }
        let mut all = self.spread(values);
        for (joint, follows) in self.follows.iter().enumerate() {
            if let Some(follows) = follows {
                let terms = follows.iter().map(|(followed, ratio)| all[*followed] * ratio.to());
                all[joint] = terms.reduce(|sum, term| sum + term).unwrap_or_else(T::zero);
            }
        }
        Cow::Owned(all)
    }

    fn turns<'v, T: Scalar>(self, turns: [&'v [T]; 2], q: &[T]) -> [Cow<'v, [T]>; 2] {
        if self.are_joints() {
            return turns.map(Cow::Borrowed);
        }
        let [mut sin, mut cos] = turns.map(|values| self.spread(values));
        for (joint, _) in self.follows.iter().enumerate().filter(|(_, follows)| follows.is_some()) {
            (sin[joint], cos[joint]) = T::sin_cos(q[joint]);
        }
        [sin, cos].map(Cow::Owned)
    }

    fn applied<T: Scalar>(self, torques: &[T]) -> Cow<'_, [T]> {
        if self.are_joints() { Cow::Borrowed(torques) } else { Cow::Owned(self.spread(torques)) }
    }

    fn only<X: Clone>(self, of_joints: Vec<X>) -> Vec<X> {
        self.coordinates.iter().map(|&joint| of_joints[joint].clone()).collect()
    }

    fn gathered<X: Clone>(self, of_joints: Vec<X>, plus: impl Fn(X, &X, &S) -> X) -> Vec<X> {
        if self.are_joints() {
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
}
