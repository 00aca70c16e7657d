//! Batches: all states in one call.

use core::array;

use super::RobotFile;
use super::comparison::{Allowed, are_finite, compare, largest};
use super::state::{State, states};
use super::torques::scale;
use crate::{
    BatchForwardDynamics, BatchInverseDynamics, BatchInverseDynamicsDerivatives, BatchMassMatrix, ForwardDynamics,
    InverseDynamics, InverseDynamicsDerivatives, MassMatrix,
};

/// Runs a test on a stack of 256 MiB: a build without optimization keeps each intermediate register of a batch in
/// memory, and threads of tests have 2 MiB.
pub fn on_large_stack(test: impl FnOnce() + Send) {
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().stack_size(256 << 20);
        let done = builder.spawn_scoped(scope, test).unwrap_or_else(|error| panic!("{error}")).join();
        done.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    });
}

/// The states, and each joint's numbers of all of them: positions, velocities, accelerations and torques.
struct Motion<const DOF: usize> {
    states: Vec<State<DOF>>,
    columns: [[Vec<f64>; DOF]; 4],
}

impl<const DOF: usize> Motion<DOF> {
    fn new() -> Self {
        let states: Vec<State<DOF>> = states().collect();
        let parts = [|s: &State<DOF>| s.q, |s: &State<DOF>| s.qd, |s: &State<DOF>| s.qdd, |s: &State<DOF>| s.tau];
        let columns = parts.map(|part| array::from_fn(|joint| states.iter().map(|state| part(state)[joint]).collect()));
        Self { states, columns }
    }

    fn slices(&self) -> [[&[f64]; DOF]; 4] {
        self.columns.each_ref().map(|columns| columns.each_ref().map(Vec::as_slice))
    }

    /// Room for a vector.
    fn vector(&self) -> [Vec<f64>; DOF] {
        array::from_fn(|_| vec![f64::NAN; self.states.len()])
    }

    /// Room for a matrix.
    fn matrix(&self) -> [[Vec<f64>; DOF]; DOF] {
        array::from_fn(|_| self.vector())
    }
}

/// The slices of a vector.
fn written<const DOF: usize>(vector: &mut [Vec<f64>; DOF]) -> [&mut [f64]; DOF] {
    vector.each_mut().map(Vec::as_mut_slice)
}

/// The vector of a state.
fn at<const DOF: usize>(vector: &[Vec<f64>; DOF], state: usize) -> [f64; DOF] {
    vector.each_ref().map(|numbers| numbers[state])
}

/// The matrix of a state, row after row.
fn matrix_at<const DOF: usize>(matrix: &[[Vec<f64>; DOF]; DOF], state: usize) -> Vec<f64> {
    matrix.iter().flat_map(|row| at(row, state)).collect()
}

/// Torques.
pub fn batches_are_those_of_the_runtime<const DOF: usize, R: BatchInverseDynamics<DOF>>(robot: &R, file: &RobotFile) {
    let (arm, motion) = (file.arm::<DOF>(), Motion::new());
    let ([q, qd, qdd, _], mut tau) = (motion.slices(), motion.vector());
    robot.inverse_dynamics_batch(q, qd, qdd, written(&mut tau)).unwrap_or_else(|mismatch| panic!("{mismatch}"));
    for (index, state) in motion.states.iter().enumerate() {
        let expected = arm.inverse_dynamics(&state.q, &state.qd, &state.qdd);
        // vector registers have sines and cosines of their own
        let allowed = Allowed::Rounding { scale: scale(&arm, state) };
        compare("inverse_dynamics_batch", state, allowed, &at(&tau, index), &expected);
    }
}

/// M(q).
pub fn mass_matrices_of_a_batch_are_those_of_the_runtime<const DOF: usize, R: BatchMassMatrix<DOF> + Sync>(
    robot: &R,
    file: &RobotFile,
) {
    let (arm, motion) = (file.arm::<DOF>(), Motion::new());
    let ([q, ..], mut mass) = (motion.slices(), motion.matrix());
    on_large_stack(|| {
        let done = robot.mass_matrix_batch(q, mass.each_mut().map(written));
        done.unwrap_or_else(|mismatch| panic!("{mismatch}"));
    });
    for (index, state) in motion.states.iter().enumerate() {
        let (found, expected) = (matrix_at(&mass, index), arm.mass_matrix(&state.q));
        let allowed = Allowed::Rounding { scale: 0.0 };
        compare("mass_matrix_batch", state, allowed, &found, expected.as_flattened());
    }
}

/// The runtime's torques for the accelerations of τ are τ, as for single calls.
pub fn accelerations_of_a_batch_need_the_torques_that_cause_them<
    const DOF: usize,
    R: BatchForwardDynamics<DOF> + Sync,
>(
    robot: &R,
    file: &RobotFile,
) {
    let (arm, motion) = (file.arm::<DOF>(), Motion::new());
    let ([q, qd, _, tau], mut qdd) = (motion.slices(), motion.vector());
    on_large_stack(|| {
        robot.forward_dynamics_batch(q, qd, tau, written(&mut qdd)).unwrap_or_else(|mismatch| panic!("{mismatch}"));
    });
    for (index, state) in motion.states.iter().enumerate() {
        let State { q, qd, tau, .. } = state;
        if !are_finite(&arm.forward_dynamics(q, qd, tau)) {
            continue;
        }
        let qdd = at(&qdd, index);
        let terms = largest(arm.mass_matrix(q).as_flattened()) * largest(&qdd);
        let scale = terms.max(largest(&arm.bias_torques(q, qd))).max(scale(&arm, state));
        let found = arm.inverse_dynamics(q, qd, &qdd);
        compare("torques of forward_dynamics_batch", state, Allowed::Rounding { scale }, &found, tau);
    }
}

/// ∂τ/∂q and ∂τ/∂q̇.
pub fn derivatives_of_a_batch_are_those_of_the_runtime<
    const DOF: usize,
    R: BatchInverseDynamicsDerivatives<DOF> + Sync,
>(
    robot: &R,
    file: &RobotFile,
) {
    let (arm, motion) = (file.arm::<DOF>(), Motion::new());
    let ([q, qd, qdd, _], mut dq, mut dqd) = (motion.slices(), motion.matrix(), motion.matrix());
    on_large_stack(|| {
        let [of_q, of_qd] = [&mut dq, &mut dqd].map(|matrix| matrix.each_mut().map(written));
        let done = robot.inverse_dynamics_derivatives_batch(q, qd, qdd, of_q, of_qd);
        done.unwrap_or_else(|mismatch| panic!("{mismatch}"));
    });
    for (index, state) in motion.states.iter().enumerate() {
        let allowed = Allowed::Rounding { scale: scale(&arm, state) };
        let expected = arm.inverse_dynamics_derivatives(&state.q, &state.qd, &state.qdd);
        compare("∂τ/∂q of a batch", state, allowed, &matrix_at(&dq, index), expected.dq.as_flattened());
        compare("∂τ/∂q̇ of a batch", state, allowed, &matrix_at(&dqd, index), expected.dqd.as_flattened());
    }
}
