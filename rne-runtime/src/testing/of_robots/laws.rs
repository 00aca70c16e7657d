//! Tests of laws of mechanics that the functions of a robot must obey.

use core::array;

use super::RobotFile;
use super::comparison::{Allowed, are_finite, compare, largest, product};
use super::state::{State, states};
use crate::{DynArm, Energy, ForwardDynamics, InverseDynamics, Kinematics, MassMatrix, MomentumObserver, Pose};

/// Calls `law` at each state with its positions, velocities, accelerations and torques.
#[track_caller]
fn at_each_state<const DOF: usize>(file: &RobotFile, law: impl Fn(&DynArm, &State, [[f64; DOF]; 4])) {
    let (robot, arm) = file.robot();
    for state in states(&robot, &arm) {
        law(&arm, &state, state.motion());
    }
}

/// Returns the mass matrix of the runtime.
fn mass(arm: &DynArm, q: &[f64]) -> Vec<Vec<f64>> {
    arm.mass_matrix(q).unwrap_or_else(|error| panic!("{error}"))
}

/// Tests τ(q, q̇, a + b) - τ(q, q̇, b) = τ(q, q̇, a) - τ(q, q̇, 0).
pub fn torques_are_linear_in_accelerations<const DOF: usize, R: InverseDynamics<DOF>>(robot: &R, file: &RobotFile) {
    at_each_state(file, |_, state, [q, qd, a, b]| {
        let torques = |qdd: &[f64; DOF]| robot.inverse_dynamics(&q, &qd, qdd);
        let sides = [torques(&array::from_fn(|i| a[i] + b[i])), torques(&b), torques(&a), torques(&[0.0; DOF])];
        let scale = largest(sides.as_flattened());
        let [found, expected]: [[f64; DOF]; 2] =
            [[sides[0], sides[1]], [sides[2], sides[3]]].map(|[x, y]| array::from_fn(|i| x[i] - y[i]));
        let what = "inverse_dynamics of a sum of accelerations";
        compare(what, state, Allowed::Rounding { scale }, &found, &expected);
    });
}

/// Tests g(q) = τ(q, 0, 0), and C(q, q̇) q̇ + g(q) = τ(q, q̇, 0).
pub fn gravity_and_bias_are_torques_without_motion<const DOF: usize, R: InverseDynamics<DOF>>(
    robot: &R,
    file: &RobotFile,
) {
    at_each_state(file, |_, state, [q, qd, qdd, _]| {
        let zero = [0.0; DOF];
        let allowed = Allowed::Rounding { scale: 1e-2 * largest(&robot.inverse_dynamics(&q, &qd, &qdd)) };
        let at_rest = robot.inverse_dynamics(&q, &zero, &zero);
        compare("gravity_torques and τ(q, 0, 0)", state, allowed, &robot.gravity_torques(&q), &at_rest);
        let steady = robot.inverse_dynamics(&q, &qd, &zero);
        compare("bias_torques and τ(q, q̇, 0)", state, allowed, &robot.bias_torques(&q, &qd), &steady);
    });
}

/// Tests M = Mᵀ, to the last bit.
pub fn mass_matrix_is_symmetric<const DOF: usize, R: MassMatrix<DOF>>(robot: &R, file: &RobotFile) {
    at_each_state(file, |_, state, [q, ..]| {
        let mass: [[f64; DOF]; DOF] = robot.mass_matrix(&q);
        let transposed: [[f64; DOF]; DOF] = array::from_fn(|i| array::from_fn(|j| mass[j][i]));
        let what = "mass_matrix and its transpose";
        compare(what, state, Allowed::Nothing, mass.as_flattened(), transposed.as_flattened());
    });
}

/// Tests that the runtime's torques for the accelerations of τ are τ, if the accelerations are finite: those of a
/// singular mass matrix are not.
pub fn accelerations_need_the_torques_that_cause_them<const DOF: usize, R: ForwardDynamics<DOF>>(
    robot: &R,
    file: &RobotFile,
) {
    at_each_state(file, |arm, state, [q, qd, _, tau]| {
        if are_accelerated(arm, state) {
            caused(arm, state, &robot.forward_dynamics(&q, &qd, &tau));
        }
    });
}

/// Whether the runtime finds finite accelerations.
pub(super) fn are_accelerated(arm: &DynArm, State { q, qd, tau, .. }: &State) -> bool {
    arm.forward_dynamics(q, qd, tau).is_ok_and(|accelerations| are_finite(&accelerations))
}

/// Asserts that the runtime's torques for accelerations are those of the state.
#[track_caller]
pub(super) fn caused(arm: &DynArm, state: &State, accelerations: &[f64]) {
    let State { q, qd, tau, .. } = state;
    let torques = arm.inverse_dynamics(q, qd, accelerations).unwrap_or_else(|error| panic!("{error}"));
    // compared with the terms of M q̈, which are larger than their sum if M is nearly singular
    let terms = largest(mass(arm, q).iter().flatten()) * largest(accelerations);
    let bias = arm.bias_torques(q, qd).map_or(0.0, |bias| largest(&bias));
    compare("torques of forward_dynamics", state, Allowed::Rounding { scale: terms.max(bias) }, &torques, tau);
}

/// Tests R Rᵀ = 1 for the tip and the links.
pub fn rotations_are_orthonormal<const DOF: usize, R: Kinematics<DOF>>(robot: &R, file: &RobotFile) {
    let identity = Pose::<f64>::identity().rotation;
    at_each_state(file, |_, state, [q, ..]| {
        for Pose { rotation: rows, .. } in [robot.forward_kinematics(&q)].into_iter().chain(robot.link_poses(&q)) {
            let products = rows.map(|a| rows.map(|b| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
            let allowed = Allowed::Rounding { scale: 1.0 };
            let what = "products of the rows of a rotation";
            compare(what, state, allowed, products.as_flattened(), identity.as_flattened());
        }
    });
}

/// Tests T = ½ q̇ᵀ M q̇, with the runtime's M.
pub fn kinetic_energy_is_that_of_the_mass_matrix<const DOF: usize, R: Energy<DOF>>(robot: &R, file: &RobotFile) {
    at_each_state(file, |arm, state, [q, qd, ..]| {
        let mass = mass(arm, &q);
        let expected: f64 = product(&mass, &qd).iter().zip(&qd).map(|(p, v)| 0.5 * p * v).sum();
        let scale = 1e-2 * largest(mass.iter().flatten()) * largest(&qd) * largest(&qd);
        let found = robot.kinetic_energy(&q, &qd);
        compare("kinetic_energy and ½ q̇ᵀ M q̇", state, Allowed::Rounding { scale }, &[found], &[expected]);
    });
}

/// Tests p = M q̇ and rate = τ + Cᵀ q̇ - g, with the runtime's M, C and g.
pub fn momentum_is_that_of_the_mass_matrix<const DOF: usize, R: MomentumObserver<DOF>>(robot: &R, file: &RobotFile) {
    at_each_state(file, |arm, state, [q, qd, _, tau]| {
        let (mass, found) = (mass(arm, &q), robot.momentum_and_rate(&q, &qd, &tau));
        let scale = largest(mass.iter().flatten()) * largest(&qd);
        compare("momentum and M q̇", state, Allowed::Rounding { scale }, &found.momentum, &product(&mass, &qd));
        let coriolis = arm.coriolis_matrix(&q, &qd).unwrap_or_else(|error| panic!("{error}"));
        let gravity = arm.gravity_torques(&q).unwrap_or_else(|error| panic!("{error}"));
        let turned = |i: usize| coriolis.iter().zip(&qd).map(|(row, rate)| row[i] * rate).sum::<f64>();
        let expected: [f64; DOF] = array::from_fn(|i| tau[i] + turned(i) - gravity[i]);
        let scale = (scale * largest(&qd)).max(largest(&gravity)).max(largest(&tau));
        compare("rate of the momentum", state, Allowed::Rounding { scale }, &found.rate, &expected);
    });
}
