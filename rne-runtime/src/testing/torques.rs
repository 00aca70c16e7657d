//! Torques, and what is made of them.

use core::array;

use super::RobotFile;
use super::comparison::{Allowed, are_finite, compare, largest};
use super::state::{State, states};
use crate::{
    Actuation, Arm, InverseDynamics, InverseDynamicsDerivatives, InverseDynamicsGradient, InverseDynamicsHessian,
    JointWrenches, MovingBase, PayloadDynamics, Regressor, Wrench,
};

/// Torques that vanish but for rounding are measured by this part of the forces and moments at the joints.
const LEAST: f64 = 1e-2;

/// Returns the scale of the torques of an arm at a state, which may be larger than the torques.
pub(super) fn scale<const DOF: usize>(arm: &Arm<DOF>, state: &State<DOF>) -> f64 {
    LEAST * largest(flat(&arm.joint_wrenches(&state.q, &state.qd, &state.qdd)).iter())
}

fn flat(wrenches: &[Wrench<f64>]) -> Vec<f64> {
    wrenches.iter().flat_map(|wrench| wrench.force.into_iter().chain(wrench.moment)).collect()
}

/// All methods of `InverseDynamics`.
pub fn torques_are_those_of_the_runtime<const DOF: usize, R: InverseDynamics<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, qdd, wrench, payload, .. } = &state;
        let (sin, cos) = (q.map(f64::sin), q.map(f64::cos));
        let allowed = file.same_operations(scale(&arm, &state));
        let compare = |what, found: [f64; DOF], expected: [f64; DOF]| compare(what, &state, allowed, &found, &expected);
        compare("inverse_dynamics", robot.inverse_dynamics(q, qd, qdd), arm.inverse_dynamics(q, qd, qdd));
        compare(
            "inverse_dynamics_with_wrench",
            robot.inverse_dynamics_with_wrench(q, qd, qdd, wrench),
            arm.inverse_dynamics_with_wrench(q, qd, qdd, wrench),
        );
        compare(
            "inverse_dynamics_with_payload",
            robot.inverse_dynamics_with_payload(q, qd, qdd, payload),
            arm.inverse_dynamics_with_payload(q, qd, qdd, payload),
        );
        compare(
            "inverse_dynamics_from_sin_cos",
            robot.inverse_dynamics_from_sin_cos(&sin, &cos, q, qd, qdd),
            arm.inverse_dynamics_from_sin_cos(&sin, &cos, q, qd, qdd),
        );
        compare("gravity_torques", robot.gravity_torques(q), arm.gravity_torques(q));
        compare("bias_torques", robot.bias_torques(q, qd), arm.bias_torques(q, qd));
    }
}

/// τ(q, q̇, a + b) - τ(q, q̇, b) = τ(q, q̇, a) - τ(q, q̇, 0).
pub fn torques_are_linear_in_accelerations<const DOF: usize, R: InverseDynamics<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, qdd: a, tau: b, .. } = &state;
        let torques = |qdd: &[f64; DOF]| robot.inverse_dynamics(q, qd, qdd);
        let (of_sum, of_a, of_b) = (torques(&array::from_fn(|i| a[i] + b[i])), torques(a), torques(b));
        let at_zero = torques(&[0.0; DOF]);
        let found: [f64; DOF] = array::from_fn(|i| of_sum[i] - of_b[i]);
        let expected: [f64; DOF] = array::from_fn(|i| of_a[i] - at_zero[i]);
        let scale = scale(&arm, &state).max(largest(&of_sum)).max(largest(&of_b)).max(largest(&of_a));
        let allowed = Allowed::Rounding { scale: scale.max(largest(&at_zero)) };
        compare("inverse_dynamics of a sum of accelerations", &state, allowed, &found, &expected);
    }
}

/// g(q) = τ(q, 0, 0), and C(q, q̇) q̇ + g(q) = τ(q, q̇, 0).
pub fn gravity_and_bias_are_torques_without_motion<const DOF: usize, R: InverseDynamics<DOF>>(
    robot: &R,
    file: &RobotFile,
) {
    let (arm, zero) = (file.arm::<DOF>(), [0.0; DOF]);
    for state in states() {
        let State { q, qd, .. } = &state;
        let allowed = Allowed::Rounding { scale: scale(&arm, &state) };
        let at_rest = robot.inverse_dynamics(q, &zero, &zero);
        compare("gravity_torques and τ(q, 0, 0)", &state, allowed, &robot.gravity_torques(q), &at_rest);
        let steady = robot.inverse_dynamics(q, qd, &zero);
        compare("bias_torques and τ(q, q̇, 0)", &state, allowed, &robot.bias_torques(q, qd), &steady);
    }
}

/// The one method of `MovingBase`.
pub fn torques_on_a_moving_base_are_those_of_the_runtime<const DOF: usize, R: MovingBase<DOF>>(
    robot: &R,
    file: &RobotFile,
) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, qdd, base, .. } = &state;
        let allowed = file.same_operations(scale(&arm, &state));
        let found = robot.inverse_dynamics_on_moving_base(q, qd, qdd, base);
        let expected = arm.inverse_dynamics_on_moving_base(q, qd, qdd, base);
        compare("inverse_dynamics_on_moving_base", &state, allowed, &found, &expected);
    }
}

/// ∂τ/∂q and ∂τ/∂q̇.
pub fn derivatives_are_those_of_the_runtime<const DOF: usize, R: InverseDynamicsDerivatives<DOF>>(
    robot: &R,
    file: &RobotFile,
) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, qdd, .. } = &state;
        let allowed = file.same_operations(scale(&arm, &state));
        let found = robot.inverse_dynamics_derivatives(q, qd, qdd);
        let expected = arm.inverse_dynamics_derivatives(q, qd, qdd);
        compare("∂τ/∂q", &state, allowed, found.dq.as_flattened(), expected.dq.as_flattened());
        compare("∂τ/∂q̇", &state, allowed, found.dqd.as_flattened(), expected.dqd.as_flattened());
    }
}

/// The gradient of λᵀτ, which generated code has in reverse mode.
pub fn gradient_is_that_of_the_runtime<const DOF: usize, R: InverseDynamicsGradient<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, qdd, tau: multipliers, .. } = &state;
        let allowed = Allowed::Rounding { scale: scale(&arm, &state) * largest(multipliers) };
        let found = robot.torque_gradient(q, qd, qdd, multipliers);
        let expected = arm.torque_gradient(q, qd, qdd, multipliers);
        compare("∂(λᵀτ)/∂q", &state, allowed, &found.dq, &expected.dq);
        compare("∂(λᵀτ)/∂q̇", &state, allowed, &found.dqd, &expected.dqd);
        compare("∂(λᵀτ)/∂q̈", &state, allowed, &found.dqdd, &expected.dqdd);
    }
}

/// The Hessian of λᵀτ, which generated code has from other formulas than dual numbers.
pub fn hessian_is_that_of_the_runtime<const DOF: usize, R: InverseDynamicsHessian<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, qdd, tau: multipliers, .. } = &state;
        let allowed = Allowed::Rounding { scale: scale(&arm, &state) * largest(multipliers) };
        let found = robot.torque_hessian(q, qd, qdd, multipliers);
        let expected = arm.torque_hessian(q, qd, qdd, multipliers);
        compare("∂²(λᵀτ)/∂q∂q", &state, allowed, found.dq_dq.as_flattened(), expected.dq_dq.as_flattened());
        compare("∂²(λᵀτ)/∂q∂q̇", &state, allowed, found.dq_dqd.as_flattened(), expected.dq_dqd.as_flattened());
        compare("∂²(λᵀτ)/∂q̇∂q̇", &state, allowed, found.dqd_dqd.as_flattened(), expected.dqd_dqd.as_flattened());
        compare("∂²(λᵀτ)/∂q∂q̈", &state, allowed, found.dq_dqdd.as_flattened(), expected.dq_dqdd.as_flattened());
    }
}

/// Force and moment at each joint.
pub fn joint_wrenches_are_those_of_the_runtime<const DOF: usize, R: JointWrenches<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, qdd, .. } = &state;
        let (found, expected) = (flat(&robot.joint_wrenches(q, qd, qdd)), flat(&arm.joint_wrenches(q, qd, qdd)));
        compare("joint_wrenches", &state, file.same_operations(0.0), &found, &expected);
    }
}

/// Y(q, q̇, q̈).
pub fn regressor_is_that_of_the_runtime<const DOF: usize, R: Regressor<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, qdd, .. } = &state;
        let (found, expected) = (robot.regressor(q, qd, qdd), arm.regressor(q, qd, qdd));
        let (found, expected) = (found.as_flattened().as_flattened(), expected.as_flattened().as_flattened());
        compare("regressor", &state, Allowed::Rounding { scale: 0.0 }, found, expected);
    }
}

/// Rotor inertia and friction.
pub fn actuator_torques_are_those_of_the_runtime<const DOF: usize, R: Actuation<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { qd, qdd, .. } = &state;
        let (found, expected) = (robot.actuator_torques(qd, qdd), arm.actuator_torques(qd, qdd));
        compare("actuator_torques", &state, file.same_operations(0.0), &found, &expected);
    }
}

/// The methods of `PayloadDynamics`. Accelerations are compared by the torques that they need.
pub fn payload_dynamics_are_those_of_the_runtime<const DOF: usize, R: PayloadDynamics<DOF>>(
    robot: &R,
    file: &RobotFile,
) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, qdd, tau, payload, .. } = &state;
        let torques = arm.inverse_dynamics_with_payload(q, qd, qdd, payload);
        let scale = scale(&arm, &state).max(largest(&torques));
        let compare = |what, found: &[f64], expected: &[f64]| {
            compare(what, &state, file.same_operations(scale), found, expected);
        };
        let (found, expected) =
            (robot.gravity_torques_with_payload(q, payload), arm.gravity_torques_with_payload(q, payload));
        compare("gravity_torques_with_payload", &found, &expected);
        let (found, expected) =
            (robot.bias_torques_with_payload(q, qd, payload), arm.bias_torques_with_payload(q, qd, payload));
        compare("bias_torques_with_payload", &found, &expected);
        let (found, expected) = (robot.mass_matrix_with_payload(q, payload), arm.mass_matrix_with_payload(q, payload));
        compare("mass_matrix_with_payload", found.as_flattened(), expected.as_flattened());
        let found = robot.inverse_dynamics_derivatives_with_payload(q, qd, qdd, payload);
        let expected = arm.inverse_dynamics_derivatives_with_payload(q, qd, qdd, payload);
        compare("∂τ/∂q with payload", found.dq.as_flattened(), expected.dq.as_flattened());
        compare("∂τ/∂q̇ with payload", found.dqd.as_flattened(), expected.dqd.as_flattened());
        let found = robot.momentum_and_rate_with_payload(q, qd, tau, payload);
        let expected = arm.momentum_and_rate_with_payload(q, qd, tau, payload);
        compare("momentum with payload", &found.momentum, &expected.momentum);
        let scale = scale.max(largest(tau)).max(largest(&expected.rate));
        super::comparison::compare(
            "its rate with payload",
            &state,
            Allowed::Rounding { scale },
            &found.rate,
            &expected.rate,
        );
        let accelerations = robot.forward_dynamics_with_payload(q, qd, tau, payload);
        if are_finite(&arm.forward_dynamics_with_payload(q, qd, tau, payload)) {
            let found = arm.inverse_dynamics_with_payload(q, qd, &accelerations, payload);
            let terms = largest(arm.mass_matrix_with_payload(q, payload).as_flattened()) * largest(&accelerations);
            let allowed = Allowed::Rounding { scale: terms.max(scale) };
            super::comparison::compare("torques of forward_dynamics_with_payload", &state, allowed, &found, tau);
        }
    }
}
