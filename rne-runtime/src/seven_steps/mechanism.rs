//! A robot as its functions see it, whatever owns its data: [`Arm`](crate::Arm) and `DynArm` share everything from here
//! on.

use nalgebra::Vector3;
use rne_model::{FixedFrame, Motor, Transform};

use crate::definition::per_joint::PerJoint;
use crate::seven_steps;
use crate::seven_steps::at_tip::AtTip;
use crate::seven_steps::link_frame::{Chain, Table};
use crate::seven_steps::link_state::{ForceMoment, JointMotions, LinkLoad, LinkMotion};
use crate::{BaseMotion, Constant, Scalar};

/// The table, the links prepared from it, and how to hold one value per joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mechanism<'a, J, S> {
    pub(crate) per_joint: J,
    pub(crate) chain: Chain<'a, S>,
    pub(crate) table: Table<'a, S>,
    /// The frames of the named tips.
    pub(crate) frames: &'a [FixedFrame<S>],
    pub(crate) motors: &'a [Option<Motor<S>>],
    /// Whether rotors belong to the arm.
    pub(crate) rotors: bool,
    pub(crate) gravity: &'a [S; 3],
    pub(crate) base: &'a Transform<S>,
    /// The frame that kinematic functions are taken at instead of the tip.
    pub(crate) at: Option<&'a FixedFrame<S>>,
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// The base at rest under the robot's gravity.
    pub(crate) fn fixed_base<T: Scalar>(self) -> BaseMotion<T> {
        BaseMotion::fixed(self.gravity.map(S::to))
    }

    /// The forward pass.
    pub(crate) fn motions<T: Scalar>(self, joints: JointMotions<'_, T>, base: &BaseMotion<T>) -> J::Of<LinkMotion<T>> {
        let mut motions = self.per_joint.all(&LinkMotion::empty());
        seven_steps::forward(self.chain, base, joints, motions.as_mut());
        motions
    }

    /// Step 3, after the forward pass.
    pub(crate) fn velocities<T: Scalar>(
        self,
        joints: JointMotions<'_, T>,
        base: &BaseMotion<T>,
        motions: &J::Of<LinkMotion<T>>,
    ) -> J::Of<Vector3<T>> {
        let mut velocities = self.per_joint.all(&Vector3::zeros());
        seven_steps::velocities(self.chain, base, joints, motions.as_ref(), velocities.as_mut());
        velocities
    }

    /// Both passes of a robot with a floating base: the wrench that must act on the base, about the origin of frame
    /// 0, and the torques.
    pub(crate) fn of_floating_base<T: Scalar>(
        self,
        joints: JointMotions<'_, T>,
        base: &BaseMotion<T>,
        tip: AtTip<'_, T>,
    ) -> (ForceMoment<T>, J::Of<T>) {
        let (_, loads, of_base) = self.all_passes(joints, base, tip);
        let motion = seven_steps::base::motion(self.chain, base);
        let wrench = seven_steps::base::wrench(self.chain, joints, &motion, &of_base);
        (wrench, self.per_joint.of(|joint| loads.as_ref()[joint].tau))
    }

    /// Both passes.
    pub(crate) fn passes<T: Scalar>(
        self,
        joints: JointMotions<'_, T>,
        base: &BaseMotion<T>,
        tip: AtTip<'_, T>,
    ) -> (J::Of<LinkMotion<T>>, J::Of<LinkLoad<T>>) {
        let (motions, loads, _) = self.all_passes(joints, base, tip);
        (motions, loads)
    }

    /// Both passes, and what the joints of the base ask of it.
    #[allow(clippy::type_complexity)] // motions and loads of the links
    fn all_passes<T: Scalar>(
        self,
        joints: JointMotions<'_, T>,
        base: &BaseMotion<T>,
        tip: AtTip<'_, T>,
    ) -> (J::Of<LinkMotion<T>>, J::Of<LinkLoad<T>>, LinkLoad<T>) {
        let motions = self.motions(joints, base);
        let mut loads = self.per_joint.all(&LinkLoad::empty());
        let of_base = seven_steps::backward(self.chain, joints, motions.as_ref(), tip, loads.as_mut());
        for (index, (load, &qdd)) in loads.as_mut().iter_mut().zip(joints.qdd).enumerate() {
            if let Some(rotor) = self.rotor(index) {
                load.tau += rotor.to::<T>() * qdd;
            }
        }
        let of_carrier = |on: Option<usize>| on.map_or(base.omega_dot.into(), |link| motions.as_ref()[link].omega_dot);
        self.chain.spins.resist(joints.qdd, of_carrier, |joint, torque| loads.as_mut()[joint].tau += torque);
        (motions, loads, of_base)
    }

    /// G² Jm of a rotor that belongs to the arm.
    pub(crate) fn rotor(self, joint: usize) -> Option<S> {
        let motor = self.motors[joint].as_ref().filter(|_| self.rotors)?;
        Some((motor.gear_ratio * motor.gear_ratio) * motor.inertia)
    }

    /// Torques of the seven steps.
    pub(crate) fn torques<T: Scalar>(
        self,
        joints: JointMotions<'_, T>,
        base: &BaseMotion<T>,
        tip: AtTip<'_, T>,
    ) -> J::Of<T> {
        let (_, loads) = self.passes(joints, base, tip);
        self.per_joint.of(|joint| loads.as_ref()[joint].tau)
    }

    /// Zero for every joint.
    pub(crate) fn zeros<T: Scalar>(self) -> J::Of<T> {
        self.per_joint.all(&T::zero())
    }

    /// One at `joint`, zero elsewhere.
    pub(crate) fn unit<T: Scalar>(self, joint: usize) -> J::Of<T> {
        self.per_joint.of(|other| if other == joint { T::one() } else { T::zero() })
    }
}
