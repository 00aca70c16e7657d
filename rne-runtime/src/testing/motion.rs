//! Mass, motion and energy.

use super::RobotFile;
use super::comparison::{Allowed, are_finite, compare, largest, product};
use super::state::{State, states};
use super::torques::scale;
use crate::{
    AccelerationDerivatives, CoriolisMatrix, Energy, EulerStep, EulerStepDerivatives, ForwardDynamics,
    ForwardDynamicsDerivatives, InverseDynamics, InverseDynamicsDerivatives, MassMatrix, MomentumObserver,
    TorqueDerivatives,
};

/// Masses times heights that cancel are measured by this part of them.
const LEAST: f64 = 1e-2;

/// M(q).
pub fn mass_matrix_is_that_of_the_runtime<const DOF: usize, R: MassMatrix<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let (found, expected) = (robot.mass_matrix(&state.q), arm.mass_matrix(&state.q));
        compare("mass_matrix", &state, file.same_operations(0.0), found.as_flattened(), expected.as_flattened());
        let accelerations = robot.inverse_mass_matrix_times_torques(&state.q, &state.tau);
        if are_finite(&arm.inverse_mass_matrix_times_torques(&state.q, &state.tau)) {
            let scale = largest(expected.as_flattened()) * largest(&accelerations);
            let found = product(&expected, &accelerations);
            compare("M M⁻¹ τ", &state, Allowed::Rounding { scale }, &found, &state.tau);
        }
    }
}

/// M = Mᵀ, to the last bit.
pub fn mass_matrix_is_symmetric<const DOF: usize, R: MassMatrix<DOF>>(robot: &R, _: &RobotFile) {
    for state in states() {
        let mass: [[f64; DOF]; DOF] = robot.mass_matrix(&state.q);
        let transposed: [[f64; DOF]; DOF] = core::array::from_fn(|i| core::array::from_fn(|j| mass[j][i]));
        let what = "mass_matrix and its transpose";
        compare(what, &state, Allowed::Nothing, mass.as_flattened(), transposed.as_flattened());
    }
}

/// C(q, q̇), and C(q, q̇) q̇ by a recursion of its own.
pub fn coriolis_matrix_is_that_of_the_runtime<const DOF: usize, R: CoriolisMatrix<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, .. } = &state;
        let (found, expected) = (robot.coriolis_matrix(q, qd), arm.coriolis_matrix(q, qd));
        // differences of masses at unit rates
        let allowed = Allowed::Rounding { scale: largest(arm.mass_matrix(q).as_flattened()) };
        compare("coriolis_matrix", &state, allowed, found.as_flattened(), expected.as_flattened());
        let (found, expected) = (robot.coriolis_torques(q, qd), arm.coriolis_torques(q, qd));
        compare("coriolis_torques", &state, file.same_operations(largest(&expected)), &found, &expected);
    }
}

/// The bits of the seven steps. In the reduced form accelerations are as far from the runtime as the mass matrix is
/// from a singular one; [`accelerations_need_the_torques_that_cause_them`] measures them without it.
pub fn accelerations_are_those_of_the_runtime<const DOF: usize, R: ForwardDynamics<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states().filter(|_| file.seven_steps) {
        let State { q, qd, tau, .. } = &state;
        let (found, expected) = (robot.forward_dynamics(q, qd, tau), arm.forward_dynamics(q, qd, tau));
        if are_finite(&expected) {
            compare("forward_dynamics", &state, Allowed::Nothing, &found, &expected);
        }
    }
}

/// The runtime's torques for the accelerations of τ are τ, where the accelerations are finite: those of a singular mass
/// matrix are not.
pub fn accelerations_need_the_torques_that_cause_them<const DOF: usize, R: ForwardDynamics<DOF>>(
    robot: &R,
    file: &RobotFile,
) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, tau, .. } = &state;
        if !are_finite(&arm.forward_dynamics(q, qd, tau)) {
            continue;
        }
        let accelerations = robot.forward_dynamics(q, qd, tau);
        let found = arm.inverse_dynamics(q, qd, &accelerations);
        // of the terms of M q̈: of an arm that is nearly singular they are larger than their sum
        let terms = largest(arm.mass_matrix(q).as_flattened()) * largest(&accelerations);
        let scale = terms.max(largest(&arm.bias_torques(q, qd))).max(scale(&arm, &state));
        compare("torques of forward_dynamics", &state, Allowed::Rounding { scale }, &found, tau);
    }
}

/// M ∂q̈/∂q = -∂τ/∂q at the accelerations of τ, in the same way ∂q̈/∂q̇, and M ∂q̈/∂τ = 1, where the accelerations are
/// finite: with M and the derivatives of the torques of the runtime.
pub fn derivatives_of_accelerations_are_those_of_the_runtime<const DOF: usize, R: ForwardDynamicsDerivatives<DOF>>(
    robot: &R,
    file: &RobotFile,
) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, tau, .. } = &state;
        let accelerations = arm.forward_dynamics(q, qd, tau);
        if !are_finite(&accelerations) {
            continue;
        }
        let (mass, torques) = (arm.mass_matrix(q), arm.inverse_dynamics_derivatives(q, qd, &accelerations));
        let found = robot.forward_dynamics_derivatives(q, qd, tau);
        belong_to(&state, &found, &mass, &torques);
    }
}

/// M ∂q̈/∂q = -∂τ/∂q, in the same way ∂q̈/∂q̇, and M ∂q̈/∂τ = 1.
#[track_caller]
fn belong_to<const DOF: usize>(
    state: &State<DOF>,
    found: &AccelerationDerivatives<DOF, f64>,
    mass: &[[f64; DOF]; DOF],
    torques: &TorqueDerivatives<DOF, f64>,
) {
    let one = core::array::from_fn(|i| core::array::from_fn(|j| if i == j { -1.0 } else { 0.0 }));
    for (what, found, expected) in
        [("M ∂q̈/∂q", found.dq, torques.dq), ("M ∂q̈/∂q̇", found.dqd, torques.dqd), ("M ∂q̈/∂τ", found.dtau, one)]
    {
        let column = |j: usize| product(mass, &core::array::from_fn(|i| found[i][j]));
        let columns: [[f64; DOF]; DOF] = core::array::from_fn(column);
        let expected: [[f64; DOF]; DOF] = core::array::from_fn(|j| core::array::from_fn(|i| -expected[i][j]));
        // of the terms: of an arm that is nearly singular they are larger than their sum
        let scale = largest(mass.as_flattened()) * largest(found.as_flattened());
        compare(what, state, Allowed::Rounding { scale }, columns.as_flattened(), expected.as_flattened());
    }
}

/// The duration of a step, s.
const STEP: f64 = 0.5;

/// A step of the semi-implicit Euler method, where the accelerations are finite.
pub fn euler_step_is_that_of_the_runtime<const DOF: usize, R: EulerStep<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, tau, .. } = &state;
        let accelerations = arm.forward_dynamics(q, qd, tau);
        if !are_finite(&accelerations) {
            continue;
        }
        let (found, expected) = (robot.euler_step(q, qd, tau, STEP), arm.euler_step(q, qd, tau, STEP));
        // as the torques that cause the accelerations (q̇' - q̇) / h, for which the mass matrix need not be regular
        let accelerations = core::array::from_fn(|i| (found.qd[i] - qd[i]) / STEP);
        let torques = arm.inverse_dynamics(q, qd, &accelerations);
        let terms = largest(arm.mass_matrix(q).as_flattened()) * (largest(&accelerations) + largest(qd) / STEP);
        let scale = terms.max(largest(&arm.bias_torques(q, qd))).max(scale(&arm, &state));
        compare("torques of euler_step", &state, Allowed::Rounding { scale }, &torques, tau);
        let moved: [f64; DOF] = core::array::from_fn(|i| q[i] + STEP * found.qd[i]);
        let allowed = Allowed::Rounding { scale: largest(q).max(largest(&expected.q)) };
        compare("positions of euler_step", &state, allowed, &found.q, &moved);
    }
}

/// Derivatives of this step: those of the velocities are 1 + h times those of the accelerations, with the mass matrix
/// and the derivatives of the torques of the runtime, and those of the positions 1 + h times those of the velocities.
pub fn derivatives_of_the_euler_step_are_those_of_the_runtime<const DOF: usize, R: EulerStepDerivatives<DOF>>(
    robot: &R,
    file: &RobotFile,
) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, tau, .. } = &state;
        let accelerations = arm.forward_dynamics(q, qd, tau);
        if !are_finite(&accelerations) {
            continue;
        }
        let found = robot.euler_step_derivatives(q, qd, tau, STEP);
        let matrix = |element: &dyn Fn(usize, usize) -> f64| -> [[f64; DOF]; DOF] {
            core::array::from_fn(|i| core::array::from_fn(|j| element(i, j)))
        };
        let one = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        let of_accelerations = AccelerationDerivatives {
            dq: matrix(&|i, j| found.qd.dq[i][j] / STEP),
            dqd: matrix(&|i, j| (found.qd.dqd[i][j] - one(i, j)) / STEP),
            dtau: matrix(&|i, j| found.qd.dtau[i][j] / STEP),
        };
        let (mass, torques) = (arm.mass_matrix(q), arm.inverse_dynamics_derivatives(q, qd, &accelerations));
        belong_to(&state, &of_accelerations, &mass, &torques);
        for (what, found, expected) in [
            ("∂q'/∂q", found.q.dq, matrix(&|i, j| one(i, j) + STEP * found.qd.dq[i][j])),
            ("∂q'/∂q̇", found.q.dqd, matrix(&|i, j| STEP * found.qd.dqd[i][j])),
            ("∂q'/∂τ", found.q.dtau, matrix(&|i, j| STEP * found.qd.dtau[i][j])),
        ] {
            let allowed = Allowed::Rounding { scale: 1.0 };
            compare(what, &state, allowed, found.as_flattened(), expected.as_flattened());
        }
    }
}

/// Kinetic and potential energy.
pub fn energies_are_those_of_the_runtime<const DOF: usize, R: Energy<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    let model = arm.model();
    let reach: f64 = model.rows.iter().map(|row| row.dh.a.abs() + row.dh.d.abs()).sum();
    let mass: f64 = model.rows.iter().map(|row| row.link.mass).sum();
    for state in states() {
        let State { q, qd, .. } = &state;
        let [found, expected] = [robot.kinetic_energy(q, qd), arm.kinetic_energy(q, qd)];
        compare("kinetic_energy", &state, file.same_operations(0.0), &[found], &[expected]);
        let [found, expected] = [robot.potential_energy(q), arm.potential_energy(q)];
        let scale = LEAST * mass * largest(&model.gravity) * (reach + largest(q));
        compare("potential_energy", &state, Allowed::Rounding { scale }, &[found], &[expected]);
    }
}

/// T = ½ q̇ᵀ M q̇, with the runtime's M.
pub fn kinetic_energy_is_that_of_the_mass_matrix<const DOF: usize, R: Energy<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, .. } = &state;
        let mass = arm.mass_matrix(q);
        let momentum = product(&mass, qd);
        let expected: f64 = momentum.iter().zip(qd).map(|(p, v)| 0.5 * p * v).sum();
        let scale = LEAST * largest(mass.as_flattened()) * largest(qd) * largest(qd);
        let found = robot.kinetic_energy(q, qd);
        compare("kinetic_energy and ½ q̇ᵀ M q̇", &state, Allowed::Rounding { scale }, &[found], &[expected]);
    }
}

/// M q̇ and its rate.
pub fn momenta_are_those_of_the_runtime<const DOF: usize, R: MomentumObserver<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, tau, .. } = &state;
        let (found, expected) = (robot.momentum_and_rate(q, qd, tau), arm.momentum_and_rate(q, qd, tau));
        let of_mass = LEAST * largest(arm.mass_matrix(q).as_flattened()) * largest(qd);
        compare("momentum", &state, file.same_operations(of_mass), &found.momentum, &expected.momentum);
        let scale = scale(&arm, &state).max(LEAST * largest(tau));
        compare("rate of the momentum", &state, file.same_operations(scale), &found.rate, &expected.rate);
    }
}

/// p = M q̇ and rate = τ + Cᵀ q̇ - g, with the runtime's M, C and g.
pub fn momentum_is_that_of_the_mass_matrix<const DOF: usize, R: MomentumObserver<DOF>>(robot: &R, file: &RobotFile) {
    let arm = file.arm::<DOF>();
    for state in states() {
        let State { q, qd, tau, .. } = &state;
        let (mass, coriolis) = (arm.mass_matrix(q), arm.coriolis_matrix(q, qd));
        let found = robot.momentum_and_rate(q, qd, tau);
        let size = largest(mass.as_flattened());
        let scale = size * largest(qd);
        compare("momentum and M q̇", &state, Allowed::Rounding { scale }, &found.momentum, &product(&mass, qd));
        let transposed: [[f64; DOF]; DOF] = core::array::from_fn(|i| core::array::from_fn(|j| coriolis[j][i]));
        let (turned, gravity) = (product(&transposed, qd), arm.gravity_torques(q));
        let expected: [f64; DOF] = core::array::from_fn(|i| tau[i] + turned[i] - gravity[i]);
        let scale = (scale * largest(qd)).max(largest(&gravity)).max(largest(tau));
        compare("rate of the momentum", &state, Allowed::Rounding { scale }, &found.rate, &expected);
    }
}
