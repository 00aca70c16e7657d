//! Derivatives of the torques with respect to positions and velocities, by dual numbers through the seven steps: exact
//! up to rounding, one direction at a time.

use crate::at_tip::AtTip;
use crate::link_state::JointMotions;
use crate::mechanism::Mechanism;
use crate::per_joint::{PerJoint, Square};
use crate::{Arm, Constant, Dual, InverseDynamicsDerivatives, Payload, Scalar, TorqueDerivatives};
#[cfg(feature = "std")]
use crate::{DynArm, WrongLength};

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
        let payload = payload.map(|payload| Payload::from_array(payload.to_array().map(Dual::constant)));
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

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
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
