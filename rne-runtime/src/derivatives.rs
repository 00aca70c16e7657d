//! Derivatives of the torques, and of the wrench on a base that nothing holds, by dual numbers through the seven steps:
//! exact up to rounding, one direction at a time.

use rne_model::FixedFrame;

use crate::at_tip::{AtTip, WrenchAtTip};
use crate::floating_base::BASE;
use crate::link_state::JointMotions;
use crate::mechanism::Mechanism;
use crate::per_joint::{PerJoint, Square};
use crate::{
    Arm, BaseMotion, Constant, Dual, FloatingTorqueDerivatives, InverseDynamicsDerivatives, Payload, Scalar,
    TorqueDerivatives, Wrench,
};
#[cfg(feature = "std")]
use crate::{DynArm, DynFloatingTorqueDerivatives, WrongLength};

/// [`TorqueDerivatives`] of a [`DynArm`](crate::DynArm).
#[cfg(feature = "std")]
#[derive(Clone, Debug, PartialEq)]
pub struct DynTorqueDerivatives<T> {
    /// ∂τ_i/∂q_j.
    pub dq: Vec<Vec<T>>,
    /// ∂τ_i/∂q̇_j.
    pub dqd: Vec<Vec<T>>,
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// ∂τ/∂q and ∂τ/∂q̇ of an arm with or without a payload.
    pub(crate) fn torque_derivatives<T: Scalar>(
        self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        payload: Option<&Payload<T>>,
    ) -> (Square<J, T>, Square<J, T>) {
        let constant = |x: &[T]| self.per_joint.of(|i| Dual::constant(x[i]));
        // x, with joint j on its way
        let along = |x: &[T], j: usize| {
            let unit = self.unit::<T>(j);
            self.per_joint.of(|i| Dual { value: x[i], derivative: unit.as_ref()[i] })
        };
        let base = self.fixed_base();
        let payload = payload.map(Payload::still);
        let tip = payload.as_ref().map_or(AtTip::Nothing, AtTip::Payload);
        let torques = |q: &J::Of<Dual<T>>, qd: &J::Of<Dual<T>>| {
            let qdd = constant(qdd);
            self.torques(JointMotions::new(q.as_ref(), qd.as_ref(), qdd.as_ref()), &base, tip)
        };
        let (still_q, still_qd) = (constant(q), constant(qd));
        // Columns first.
        let dq = self.per_joint.of(|j| torques(&along(q, j), &still_qd));
        let dqd = self.per_joint.of(|j| torques(&still_q, &along(qd, j)));
        let rows = |columns: Square<J, Dual<T>>| {
            self.per_joint.of(|i| self.per_joint.of(|j| columns.as_ref()[j].as_ref()[i].derivative))
        };
        (rows(dq), rows(dqd))
    }
}

/// Six rows of the base, and those of the joints.
type Column<J, T> = ([T; BASE], <J as PerJoint>::Of<T>);

/// Columns by the position and by the rate of each joint, and by the angular velocity of the base.
struct OfFloatingBase<J: PerJoint, T: Clone> {
    joints: [J::Of<Column<J, T>>; 2],
    omega: [Column<J, T>; 3],
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// The derivatives of a robot whose base nothing holds, with constant wrenches at its tips.
    fn floating_derivatives<T: Scalar>(
        self,
        JointMotions { q, qd, qdd, .. }: JointMotions<'_, T>,
        base: &BaseMotion<T>,
        at_tips: &[WrenchAtTip<Dual<T>>],
    ) -> OfFloatingBase<J, T> {
        let along = |x: &[T], direction: Option<usize>| {
            let derivative = |i| if direction == Some(i) { T::one() } else { T::zero() };
            self.per_joint.of(|i| Dual { value: x[i], derivative: derivative(i) })
        };
        let constant = |x: [T; 3]| x.map(Dual::constant);
        let still = BaseMotion {
            omega: constant(base.omega),
            omega_dot: constant(base.omega_dot),
            velocity: constant(base.velocity),
            acceleration: constant(base.acceleration),
            gravity: constant(base.gravity),
        };
        let column = |by_q, by_qd, base: &BaseMotion<Dual<T>>| {
            let (q, qd, qdd) = (along(q, by_q), along(qd, by_qd), along(qdd, None));
            let joints = JointMotions::new(q.as_ref(), qd.as_ref(), qdd.as_ref());
            let (wrench, tau) = self.of_floating_base(joints, base, AtTip::Wrenches(at_tips));
            let of_base = core::array::from_fn(|row| {
                (if row < 3 { wrench.force[row] } else { wrench.moment[row - 3] }).derivative
            });
            (of_base, self.per_joint.of(|joint| tau.as_ref()[joint].derivative))
        };
        let omega = [0, 1, 2].map(|axis| {
            let mut turning = still;
            turning.omega[axis].derivative = T::one();
            column(None, None, &turning)
        });
        let by_q = self.per_joint.of(|joint| column(Some(joint), None, &still));
        let by_qd = self.per_joint.of(|joint| column(None, Some(joint), &still));
        OfFloatingBase { joints: [by_q, by_qd], omega }
    }
}

impl<const DOF: usize, S: Constant> InverseDynamicsDerivatives<DOF> for Arm<DOF, S> {
    fn inverse_dynamics_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
    ) -> TorqueDerivatives<DOF, T> {
        let (dq, dqd) = self.mechanism().torque_derivatives(q, qd, qdd, None);
        TorqueDerivatives { dq, dqd }
    }
}

/// An arm that does not know its tips takes them with the wrenches.
impl<const DOF: usize, S: Constant> Arm<DOF, S> {
    /// As [`FloatingInverseDynamicsDerivatives`](crate::FloatingInverseDynamicsDerivatives), at these tips; `NV` is
    /// `DOF` + 6.
    #[must_use]
    pub fn floating_inverse_dynamics_derivatives<T: Scalar, const NV: usize, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
        (tips, wrenches): (&[FixedFrame<S>; TIPS], &[Wrench<T>; TIPS]),
    ) -> FloatingTorqueDerivatives<DOF, NV, T> {
        const { assert!(NV == DOF + BASE, "the matrices have a row for each joint and six for the base") };
        let wrenches = wrenches.map(Wrench::still);
        let at_tips = self.at_tips(tips, &wrenches);
        let OfFloatingBase { joints, omega } =
            self.mechanism().floating_derivatives(JointMotions::new(q, qd, qdd), base, &at_tips);
        let element = |(of_base, of_joints): &([T; BASE], [T; DOF]), row: usize| match row.checked_sub(BASE) {
            Some(joint) => of_joints[joint],
            None => of_base[row],
        };
        let [dq, dqd] =
            joints.map(|columns| core::array::from_fn(|row| core::array::from_fn(|j| element(&columns[j], row))));
        let domega = core::array::from_fn(|row| [0, 1, 2].map(|axis| element(&omega[axis], row)));
        FloatingTorqueDerivatives { dq, dqd, domega }
    }
}

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
    /// As [`FloatingInverseDynamicsDerivatives`](crate::FloatingInverseDynamicsDerivatives), with one of `wrenches` for
    /// each of the [tips](Self::tips): 6 + n rows.
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint, or `wrenches` not one element per tip.
    pub fn floating_inverse_dynamics_derivatives<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        base: &BaseMotion<T>,
        wrenches: &[Wrench<T>],
    ) -> Result<DynFloatingTorqueDerivatives<T>, WrongLength> {
        let (q, qd, qdd) = self.of_all_joints(q, qd, qdd)?;
        let wrenches: Vec<_> = wrenches.iter().copied().map(Wrench::still).collect();
        let at_tips = self.at_tips(&wrenches)?;
        let OfFloatingBase { joints, omega } =
            self.mechanism().floating_derivatives(JointMotions::new(&q, &qd, &qdd), base, &at_tips);
        let [dq, dqd] = joints.map(|columns| {
            let of_base: [Vec<T>; BASE] =
                core::array::from_fn(|row| columns.iter().map(|(of_base, _)| of_base[row]).collect());
            let row = |joint: usize| columns.iter().map(|(_, of_joints)| of_joints[joint]).collect();
            let of_joints = (0..columns.len()).map(row).collect();
            let rows = self.couplings.rows(of_base).into_iter();
            rows.chain(self.couplings.matrix(of_joints)).collect()
        });
        let omega = omega.map(|(of_base, of_joints)| [of_base.to_vec(), self.couplings.torques(of_joints)].concat());
        let domega = (0..BASE + self.dof()).map(|row| [0, 1, 2].map(|axis| omega[axis][row])).collect();
        Ok(DynFloatingTorqueDerivatives { dq, dqd, domega })
    }

    /// As [`InverseDynamicsDerivatives::inverse_dynamics_derivatives`]: rows of ∂τ/∂q and ∂τ/∂q̇.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn inverse_dynamics_derivatives<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
    ) -> Result<DynTorqueDerivatives<T>, WrongLength> {
        let (q, qd, qdd) = self.of_all_joints(q, qd, qdd)?;
        let (dq, dqd) = self.mechanism().torque_derivatives(&q, &qd, &qdd, None);
        Ok(DynTorqueDerivatives { dq: self.couplings.matrix(dq), dqd: self.couplings.matrix(dqd) })
    }
}
