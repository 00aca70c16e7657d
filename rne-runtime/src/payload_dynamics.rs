//! The functions of an arm with a payload: those without one, with the payload as one link more.

use crate::at_tip::AtTip;
use crate::{Arm, Constant, InverseDynamics, MomentumAndRate, Payload, PayloadDynamics, Scalar, TorqueDerivatives};
#[cfg(feature = "std")]
use crate::{DynArm, DynTorqueDerivatives, WrongLength};

impl<const DOF: usize, S: Constant> PayloadDynamics<DOF> for Arm<DOF, S> {
    fn gravity_torques_with_payload<T: Scalar>(&self, q: &[T; DOF], payload: &Payload<T>) -> [T; DOF] {
        let zero = [T::zero(); DOF];
        self.inverse_dynamics_with_payload(q, &zero, &zero, payload)
    }

    fn bias_torques_with_payload<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], payload: &Payload<T>) -> [T; DOF] {
        self.inverse_dynamics_with_payload(q, qd, &[T::zero(); DOF], payload)
    }

    fn mass_matrix_with_payload<T: Scalar>(&self, q: &[T; DOF], payload: &Payload<T>) -> [[T; DOF]; DOF] {
        self.mechanism().mass_matrix(q, AtTip::Payload(payload))
    }

    fn forward_dynamics_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        payload: &Payload<T>,
    ) -> [T; DOF] {
        self.mechanism().forward_dynamics(q, qd, tau, AtTip::Payload(payload))
    }

    fn inverse_dynamics_derivatives_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        payload: &Payload<T>,
    ) -> TorqueDerivatives<DOF, T> {
        let (dq, dqd) = self.mechanism().torque_derivatives(q, qd, qdd, Some(payload));
        TorqueDerivatives { dq, dqd }
    }

    fn momentum_and_rate_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        payload: &Payload<T>,
    ) -> MomentumAndRate<DOF, T> {
        let [momentum, rate] = self.mechanism().momentum_and_rate(q, qd, tau, Some(payload));
        MomentumAndRate { momentum, rate }
    }
}

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
    /// As [`PayloadDynamics::gravity_torques_with_payload`].
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn gravity_torques_with_payload<T: Scalar>(
        &self,
        q: &[T],
        payload: &Payload<T>,
    ) -> Result<Vec<T>, WrongLength> {
        let zeros = vec![T::zero(); q.len()];
        self.inverse_dynamics_with_payload(q, &zeros, &zeros, payload)
    }

    /// As [`PayloadDynamics::bias_torques_with_payload`].
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn bias_torques_with_payload<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        payload: &Payload<T>,
    ) -> Result<Vec<T>, WrongLength> {
        self.inverse_dynamics_with_payload(q, qd, &vec![T::zero(); q.len()], payload)
    }

    /// As [`PayloadDynamics::mass_matrix_with_payload`]: rows of M(q).
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn mass_matrix_with_payload<T: Scalar>(
        &self,
        q: &[T],
        payload: &Payload<T>,
    ) -> Result<Vec<Vec<T>>, WrongLength> {
        let q = &*self.of_joints("q", q)?;
        Ok(self.couplings.symmetric(self.mechanism().mass_matrix(q, AtTip::Payload(payload))))
    }

    /// As [`PayloadDynamics::forward_dynamics_with_payload`].
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn forward_dynamics_with_payload<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        payload: &Payload<T>,
    ) -> Result<Vec<T>, WrongLength> {
        self.forward_dynamics_with(q, qd, tau, AtTip::Payload(payload))
    }

    /// As [`PayloadDynamics::inverse_dynamics_derivatives_with_payload`]: rows of ∂τ/∂q and ∂τ/∂q̇.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn inverse_dynamics_derivatives_with_payload<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        payload: &Payload<T>,
    ) -> Result<DynTorqueDerivatives<T>, WrongLength> {
        let (q, qd, qdd) = self.of_all_joints(q, qd, qdd)?;
        let (dq, dqd) = self.mechanism().torque_derivatives(&q, &qd, &qdd, Some(payload));
        Ok(DynTorqueDerivatives { dq: self.couplings.matrix(dq), dqd: self.couplings.matrix(dqd) })
    }

    /// As [`PayloadDynamics::momentum_and_rate_with_payload`]: the momenta, then their rates.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn momentum_and_rate_with_payload<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        payload: &Payload<T>,
    ) -> Result<[Vec<T>; 2], WrongLength> {
        let q = &*self.of_joints("q", q)?;
        let qd = &*self.of_joints("qd", qd)?;
        let tau = &*self.applied(tau)?;
        Ok(self.couplings.rows(self.mechanism().momentum_and_rate(q, qd, tau, Some(payload))))
    }
}
