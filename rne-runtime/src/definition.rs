//! The functions of a robot by their definitions: the seven steps on numbers, and everything else derived from them.
//! They are written once, for [`Arm`](crate::Arm) with its arrays and for `DynArm` with its lists.

pub(crate) mod actuation;
#[cfg(all(feature = "arm", feature = "std"))]
pub(crate) mod base_parameters;
pub(crate) mod centre_of_mass;
#[cfg(all(feature = "arm", feature = "std"))]
pub(crate) mod closed_loops;
pub(crate) mod contact_dynamics;
pub(crate) mod coordinates;
#[cfg(all(feature = "arm", feature = "std"))]
pub(crate) mod couplings;
pub(crate) mod derivatives;
pub(crate) mod energy;
pub(crate) mod floating_base;
pub(crate) mod floating_change;
pub(crate) mod floating_euler_step;
pub(crate) mod floating_kinematics;
pub(crate) mod forward_dynamics;
pub(crate) mod joint_wrenches;
pub(crate) mod kinematics;
pub(crate) mod mass_matrix;
pub(crate) mod momentum;
#[cfg(all(feature = "arm", feature = "std"))]
pub(crate) mod motors;
pub(crate) mod per_joint;
pub(crate) mod regressor;
pub(crate) mod still_wrenches;

use rne_model::{Contact, FixedFrame};

use crate::definition::coordinates::Coordinates;
use crate::definition::per_joint::{PerJoint, Square};
use crate::seven_steps::at_tip::AtTip;
use crate::seven_steps::link_state::JointMotions;
use crate::seven_steps::mechanism::Mechanism;
use crate::{BaseMotion, Constant, Dual, Scalar, Wrench};

/// A robot with couplings, tips and contacts. Arguments and results of its functions have one element for each
/// coordinate, that is, for each joint that follows no other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Definition<'a, J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> {
    pub(crate) mechanism: Mechanism<'a, J, S>,
    pub(crate) coordinates: J::Coordinates<'a, S>,
    /// Makes collections with six elements for a floating base, and one for each coordinate.
    pub(crate) velocities: V,
    /// Makes collections with one element for each named tip.
    pub(crate) tips: P,
    /// The contacts, at tips that something outside the robot holds.
    pub(crate) contacts: &'a [Contact],
}

impl<'a, J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'a, J, V, P, S> {
    /// The base at rest under the robot's gravity.
    pub(crate) fn fixed_base<T: Scalar>(self) -> BaseMotion<T> {
        self.mechanism.fixed_base()
    }

    /// Returns zeros, one for each coordinate.
    pub(crate) fn zeros<T: Scalar>(self) -> J::Of<T> {
        self.coordinates.each().all(&T::zero())
    }

    /// Copies the numbers of a slice, one for each coordinate.
    pub(crate) fn list<T: Scalar>(self, x: &[T]) -> J::Of<T> {
        self.coordinates.each().of(|i| x[i])
    }

    /// Returns the values of all joints, from one value for each coordinate.
    pub(crate) fn of_joints<T: Scalar>(
        self,
        values: &[T],
    ) -> <J::Coordinates<'a, S> as Coordinates<J, S>>::OfJoints<'_, T> {
        self.coordinates.of_joints(values)
    }

    /// Returns the results of `of_tip` for the frames of all tips.
    pub(crate) fn each_tip<X: Clone>(self, of_tip: impl Fn(&FixedFrame<S>) -> X) -> P::Of<X> {
        self.tips.of(|tip| of_tip(&self.mechanism.frames[tip]))
    }

    /// Returns, by the seven steps, the wrench that must act on the base, about the origin of frame 0, and the torques.
    pub(crate) fn torques_and_wrench<T: Scalar>(
        self,
        [q, qd, qdd]: [&[T]; 3],
        base: &BaseMotion<T>,
        load: AtTip<'_, T>,
    ) -> (Wrench<T>, J::Of<T>) {
        let [q, qd, qdd] = [q, qd, qdd].map(|values| self.of_joints(values));
        let joints = JointMotions::new(q.as_ref(), qd.as_ref(), qdd.as_ref());
        let (wrench, of_joints) = self.mechanism.of_floating_base(joints, base, load);
        (Wrench::from_vectors(wrench.force, wrench.moment), self.coordinates.torques(of_joints))
    }

    /// Returns the torques on a base that moves, by the seven steps.
    pub(crate) fn torques_on<T: Scalar>(
        self,
        [q, qd, qdd]: [&[T]; 3],
        base: &BaseMotion<T>,
        load: AtTip<'_, T>,
    ) -> J::Of<T> {
        let [q, qd, qdd] = [q, qd, qdd].map(|values| self.of_joints(values));
        let joints = JointMotions::new(q.as_ref(), qd.as_ref(), qdd.as_ref());
        self.coordinates.torques(self.mechanism.torques(joints, base, load))
    }

    /// Returns the torques on a base at rest, by the seven steps.
    pub(crate) fn torques<T: Scalar>(self, motion: [&[T]; 3], load: AtTip<'_, T>) -> J::Of<T> {
        self.torques_on(motion, &self.fixed_base(), load)
    }

    /// Returns the torques of a motion without accelerations.
    pub(crate) fn bias<T: Scalar>(self, q: &[T], qd: &[T], load: AtTip<'_, T>) -> J::Of<T> {
        self.torques([q, qd, self.zeros().as_ref()], load)
    }

    /// Returns the torques that hold the robot at rest.
    pub(crate) fn gravity<T: Scalar>(self, q: &[T], load: AtTip<'_, T>) -> J::Of<T> {
        self.bias(q, self.zeros().as_ref(), load)
    }

    /// Returns the torques from sines and cosines of the positions.
    pub(crate) fn torques_from_turns<T: Scalar>(self, [sin, cos]: [&[T]; 2], [q, qd, qdd]: [&[T]; 3]) -> J::Of<T> {
        let [q, qd, qdd] = [q, qd, qdd].map(|values| self.of_joints(values));
        let [sin, cos] = self.coordinates.turns([sin, cos], q.as_ref());
        let turns = Some((sin.as_ref(), cos.as_ref()));
        let joints = JointMotions { turns, ..JointMotions::new(q.as_ref(), qd.as_ref(), qdd.as_ref()) };
        self.coordinates.torques(self.mechanism.torques(joints, &self.fixed_base(), AtTip::Nothing))
    }

    /// Returns numbers whose derivatives are zero.
    pub(crate) fn still<T: Scalar>(self, x: &[T]) -> J::Of<Dual<T>> {
        self.coordinates.each().of(|i| Dual::constant(x[i]))
    }

    /// Returns numbers with the derivative 1 for element `j` and 0 for the others.
    pub(crate) fn along<T: Scalar>(self, x: &[T], j: usize) -> J::Of<Dual<T>> {
        let derivative = |i| if i == j { T::one() } else { T::zero() };
        self.coordinates.each().of(|i| Dual { value: x[i], derivative: derivative(i) })
    }

    /// Returns the derivatives of the elements of y(x): one row per element of y, one column per coordinate.
    pub(crate) fn rows_by<T: Scalar>(self, x: &[T], y: impl Fn(&[Dual<T>]) -> J::Of<Dual<T>>) -> Square<J, T> {
        let each = self.coordinates.each();
        let columns = each.of(|j| y(self.along(x, j).as_ref()));
        each.of(|i| each.of(|j| columns.as_ref()[j].as_ref()[i].derivative))
    }
}
