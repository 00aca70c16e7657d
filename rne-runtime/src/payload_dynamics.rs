//! The functions of an arm with a payload: those without one, with the payload as one link more.

use crate::at_tip::AtTip;
use crate::definition::definitions;
use crate::{Arm, Constant, Payload, PayloadDynamics, Scalar};

definitions! { PayloadDynamics<DOF> {
    /// As [`PayloadDynamics::gravity_torques_with_payload`].
    fn gravity_torques_with_payload(q: joints, payload: payload) -> vector =
        |robot| robot.gravity(q, AtTip::Payload(payload));
    /// As [`PayloadDynamics::bias_torques_with_payload`].
    fn bias_torques_with_payload(q: joints, qd: joints, payload: payload) -> vector =
        |robot| robot.bias(q, qd, AtTip::Payload(payload));
    /// As [`PayloadDynamics::mass_matrix_with_payload`]: rows of M(q).
    fn mass_matrix_with_payload(q: joints, payload: payload) -> matrix =
        |robot| robot.mass_matrix(q, AtTip::Payload(payload));
    /// As [`PayloadDynamics::forward_dynamics_with_payload`].
    fn forward_dynamics_with_payload(q: joints, qd: joints, tau: joints, payload: payload) -> vector =
        |robot| robot.forward_dynamics([q, qd, tau], AtTip::Payload(payload));
    /// As [`PayloadDynamics::inverse_dynamics_derivatives_with_payload`]: rows of ∂τ/∂q and ∂τ/∂q̇.
    fn inverse_dynamics_derivatives_with_payload(q: joints, qd: joints, qdd: joints, payload: payload)
        -> TorqueDerivatives<DOF> = |robot| robot.torque_derivatives([q, qd, qdd], AtTip::Payload(&payload.still()));
    /// As [`PayloadDynamics::momentum_and_rate_with_payload`]: the momenta, then their rates.
    fn momentum_and_rate_with_payload(q: joints, qd: joints, tau: joints, payload: payload) -> MomentumAndRate<DOF> =
        |robot| robot.momentum_and_rate([q, qd, tau], Some(payload));
    /// As [`PayloadDynamics::forward_dynamics_derivatives_with_payload`].
    fn forward_dynamics_derivatives_with_payload(q: joints, qd: joints, tau: joints, payload: payload)
        -> AccelerationDerivatives<DOF> =
        |robot| robot.acceleration_derivatives([q, qd, tau], AtTip::Payload(payload), AtTip::Payload(&payload.still()));
} }
