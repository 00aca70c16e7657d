//! Torques of a robot whose base nothing holds, and the wrench that must act on this base.

use rne_model::FixedFrame;

use crate::at_tip::AtTip;
use crate::link_state::JointMotions;
use crate::{Arm, BaseMotion, Constant, FloatingTorques, Scalar, Wrench};
#[cfg(feature = "std")]
use crate::{DynArm, WrongLength};

/// An arm that does not know its tips takes them with the wrenches.
impl<const DOF: usize, S: Constant> Arm<DOF, S> {
    /// As [`FloatingBase::inverse_dynamics_of_floating_base`](crate::FloatingBase::inverse_dynamics_of_floating_base),
    /// at these tips. A tip on the base, or on a link that there is not, carries no load.
    #[must_use]
    pub fn inverse_dynamics_of_floating_base<T: Scalar, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
        (tips, wrenches): (&[FixedFrame<S>; TIPS], &[Wrench<T>; TIPS]),
    ) -> FloatingTorques<DOF, T> {
        let (joints, at_tips) = (JointMotions::new(q, qd, qdd), self.at_tips(tips, wrenches));
        let (wrench, tau) = self.mechanism().of_floating_base(joints, base, AtTip::Wrenches(&at_tips));
        FloatingTorques { wrench: Wrench::from_vectors(wrench.force, wrench.moment), tau }
    }
}

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
    /// As [`FloatingBase::inverse_dynamics_of_floating_base`](crate::FloatingBase::inverse_dynamics_of_floating_base),
    /// with one of `wrenches` for each of the [tips](Self::tips): the wrench on the base, and the torques.
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint, or `wrenches` not one element per tip.
    pub fn inverse_dynamics_of_floating_base<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        base: &BaseMotion<T>,
        wrenches: &[Wrench<T>],
    ) -> Result<(Wrench<T>, Vec<T>), WrongLength> {
        let (q, qd, qdd) = self.of_all_joints(q, qd, qdd)?;
        let (joints, at_tips) = (JointMotions::new(&q, &qd, &qdd), self.at_tips(wrenches)?);
        let (wrench, of_joints) = self.mechanism().of_floating_base(joints, base, AtTip::Wrenches(&at_tips));
        Ok((Wrench::from_vectors(wrench.force, wrench.moment), self.couplings.torques(of_joints)))
    }
}
