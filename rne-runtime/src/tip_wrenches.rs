//! Torques and accelerations of a robot with a wrench at each of its named tips.

use rne_model::FixedFrame;

use crate::at_tip::{AtTip, Tip};
use crate::link_state::JointMotions;
use crate::{AccelerationDerivatives, Arm, Constant, Scalar, TipWrenches, TorqueDerivatives, Wrench};
#[cfg(feature = "std")]
use crate::{DynArm, WrongLength};

/// An arm that does not know its tips takes them with the wrenches.
impl<const DOF: usize, S: Constant> Arm<DOF, S> {
    /// As [`TipWrenches::inverse_dynamics_with_wrenches`](crate::TipWrenches::inverse_dynamics_with_wrenches), at these
    /// tips. A tip on the base, or on a link that there is not, carries no load.
    #[must_use]
    pub fn inverse_dynamics_with_wrenches<T: Scalar, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        tips: &[FixedFrame<S>; TIPS],
        wrenches: &[Wrench<T>; TIPS],
    ) -> [T; DOF] {
        let at_tips = self.at_tips(tips, wrenches);
        let joints = JointMotions::new(q, qd, qdd);
        self.mechanism().torques(joints, &self.fixed_base(), AtTip::Wrenches(&at_tips))
    }

    /// As [`TipWrenches::forward_dynamics_with_wrenches`](crate::TipWrenches::forward_dynamics_with_wrenches), at these
    /// tips. A tip on the base, or on a link that there is not, carries no load.
    #[must_use]
    pub fn forward_dynamics_with_wrenches<T: Scalar, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        tips: &[FixedFrame<S>; TIPS],
        wrenches: &[Wrench<T>; TIPS],
    ) -> [T; DOF] {
        self.mechanism().forward_dynamics(q, qd, tau, AtTip::Wrenches(&self.at_tips(tips, wrenches)))
    }

    /// As [`TipWrenches::inverse_dynamics_derivatives_with_wrenches`], at these tips.
    #[must_use]
    pub fn inverse_dynamics_derivatives_with_wrenches<T: Scalar, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        tips: &[FixedFrame<S>; TIPS],
        wrenches: &[Wrench<T>; TIPS],
    ) -> TorqueDerivatives<DOF, T> {
        AtTheseTips { arm: self, tips }.inverse_dynamics_derivatives_with_wrenches(q, qd, qdd, wrenches)
    }

    /// As [`TipWrenches::forward_dynamics_derivatives_with_wrenches`], at these tips.
    #[must_use]
    pub fn forward_dynamics_derivatives_with_wrenches<T: Scalar, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        tips: &[FixedFrame<S>; TIPS],
        wrenches: &[Wrench<T>; TIPS],
    ) -> AccelerationDerivatives<DOF, T> {
        AtTheseTips { arm: self, tips }.forward_dynamics_derivatives_with_wrenches(q, qd, tau, wrenches)
    }

    pub(crate) fn at_tips<T: Scalar, const TIPS: usize>(
        &self,
        tips: &[FixedFrame<S>; TIPS],
        wrenches: &[Wrench<T>; TIPS],
    ) -> [crate::at_tip::WrenchAtTip<T>; TIPS] {
        let table = self.mechanism().table;
        core::array::from_fn(|index| {
            let tip = FixedFrame { on: tips[index].on.filter(|on| *on < DOF), ..tips[index] };
            Tip::new(table, &tip).with(&wrenches[index])
        })
    }
}

/// An arm with its tips, for what the trait makes of its functions.
struct AtTheseTips<'a, const DOF: usize, const TIPS: usize, S> {
    arm: &'a Arm<DOF, S>,
    tips: &'a [FixedFrame<S>; TIPS],
}

impl<const DOF: usize, const TIPS: usize, S: Constant> TipWrenches<DOF, TIPS> for AtTheseTips<'_, DOF, TIPS, S> {
    fn inverse_dynamics_with_wrenches<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
    ) -> [T; DOF] {
        self.arm.inverse_dynamics_with_wrenches(q, qd, qdd, self.tips, wrenches)
    }

    fn forward_dynamics_with_wrenches<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
    ) -> [T; DOF] {
        self.arm.forward_dynamics_with_wrenches(q, qd, tau, self.tips, wrenches)
    }
}

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
    /// The frames that carry wrenches, in the order of these: those of the list `tips` of the robot file, or the tip
    /// frame alone.
    #[must_use]
    pub fn tips(&self) -> &[FixedFrame<S>] {
        &self.tips
    }

    /// As [`TipWrenches::inverse_dynamics_with_wrenches`](crate::TipWrenches::inverse_dynamics_with_wrenches): torques
    /// when the robot exerts `wrenches`, one at each of its [tips](Self::tips), in axes of the tip.
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint, or `wrenches` not one element per tip.
    pub fn inverse_dynamics_with_wrenches<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        wrenches: &[Wrench<T>],
    ) -> Result<Vec<T>, WrongLength> {
        let (q, qd, qdd) = self.of_all_joints(q, qd, qdd)?;
        let (joints, at_tips) = (JointMotions::new(&q, &qd, &qdd), self.at_tips(wrenches)?);
        let of_joints = self.mechanism().torques(joints, &self.fixed_base(), AtTip::Wrenches(&at_tips));
        Ok(self.couplings.torques(of_joints))
    }

    /// As [`TipWrenches::forward_dynamics_with_wrenches`](crate::TipWrenches::forward_dynamics_with_wrenches):
    /// accelerations when the robot exerts `wrenches`, one at each of its [tips](Self::tips), in axes of the tip.
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint, or `wrenches` not one element per tip.
    pub fn forward_dynamics_with_wrenches<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        wrenches: &[Wrench<T>],
    ) -> Result<Vec<T>, WrongLength> {
        self.forward_dynamics_with(q, qd, tau, AtTip::Wrenches(&self.at_tips(wrenches)?))
    }

    pub(crate) fn at_tips<T: Scalar>(
        &self,
        wrenches: &[Wrench<T>],
    ) -> Result<Vec<crate::at_tip::WrenchAtTip<T>>, WrongLength> {
        let (expected, found) = (self.tips.len(), wrenches.len());
        if expected != found {
            return Err(WrongLength { argument: "wrenches", expected, found });
        }
        let table = self.mechanism().table;
        Ok(self.tips.iter().zip(wrenches).map(|(tip, wrench)| Tip::new(table, tip).with(wrench)).collect())
    }
}
