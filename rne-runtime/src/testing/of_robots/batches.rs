//! Tests of batches, which compute all states in one call.

use core::array;

use rne_functions::Function;

use super::RobotFile;
use super::comparison::{Allowed, compare};
use super::laws::{are_accelerated, caused};
use super::runtime::terms;
use super::state::{State, states};
use crate::{BatchForwardDynamics, BatchInverseDynamics, BatchInverseDynamicsDerivatives, BatchMassMatrix, DynArm};

/// Runs a test on a stack of 256 MiB: a build without optimization keeps each intermediate register of a batch in
/// memory, and threads of tests have 2 MiB.
pub fn on_large_stack(test: impl FnOnce() + Send) {
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().stack_size(256 << 20);
        let done = builder.spawn_scoped(scope, test).unwrap_or_else(|error| panic!("{error}")).join();
        done.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    });
}

/// States of a robot, and the positions, velocities, accelerations and torques of each joint in all of them.
struct Motion<const DOF: usize> {
    arm: DynArm,
    states: Vec<State>,
    columns: [[Vec<f64>; DOF]; 4],
}

impl<const DOF: usize> Motion<DOF> {
    fn new(file: &RobotFile) -> Self {
        let (robot, arm) = file.robot();
        let states: Vec<State> = states(&robot, &arm).collect();
        let column =
            |part: usize, joint: usize| states.iter().map(|state| state.motion::<DOF>()[part][joint]).collect();
        let columns = array::from_fn(|part| array::from_fn(|joint| column(part, joint)));
        Self { arm, states, columns }
    }

    fn slices(&self) -> [[&[f64]; DOF]; 4] {
        self.columns.each_ref().map(|columns| columns.each_ref().map(Vec::as_slice))
    }

    /// Returns arrays of zeros for the results of a vector.
    fn vector(&self) -> [Vec<f64>; DOF] {
        array::from_fn(|_| vec![f64::NAN; self.states.len()])
    }

    /// Returns arrays of zeros for the results of a matrix.
    fn matrix(&self) -> [[Vec<f64>; DOF]; DOF] {
        array::from_fn(|_| self.vector())
    }

    /// Compares the results of a batch with the runtime, up to rounding: vector registers have another kernel of sine
    /// and cosine.
    #[track_caller]
    fn compare(&self, function: Function, found: impl Fn(usize) -> Vec<f64>) {
        for (index, state) in self.states.iter().enumerate() {
            let expected = self.arm.evaluate(function, &state.inputs()).unwrap_or_else(|error| panic!("{error}"));
            let allowed = Allowed::Rounding { scale: terms(&self.arm, function, &state.inputs()) };
            compare(&format!("{function} of a batch"), state, allowed, &found(index), &expected);
        }
    }
}

/// Returns the arrays of a vector as mutable slices.
fn written<const DOF: usize>(vector: &mut [Vec<f64>; DOF]) -> [&mut [f64]; DOF] {
    vector.each_mut().map(Vec::as_mut_slice)
}

/// Returns the vector in one state.
fn at<const DOF: usize>(vector: &[Vec<f64>; DOF], state: usize) -> Vec<f64> {
    vector.iter().map(|numbers| numbers[state]).collect()
}

/// Returns the matrix in one state, row after row.
fn matrix_at<const DOF: usize>(matrix: &[[Vec<f64>; DOF]; DOF], state: usize) -> Vec<f64> {
    matrix.iter().flat_map(|row| at(row, state)).collect()
}

/// Tests the torques of a batch.
pub fn batches_are_those_of_the_runtime<const DOF: usize, R: BatchInverseDynamics<DOF>>(robot: &R, file: &RobotFile) {
    let motion = Motion::new(file);
    let ([q, qd, qdd, _], mut tau) = (motion.slices(), motion.vector());
    robot.inverse_dynamics_batch(q, qd, qdd, written(&mut tau)).unwrap_or_else(|mismatch| panic!("{mismatch}"));
    motion.compare(Function::InverseDynamics, |state| at(&tau, state));
}

/// Tests the mass matrices of a batch.
pub fn mass_matrices_of_a_batch_are_those_of_the_runtime<const DOF: usize, R: BatchMassMatrix<DOF> + Sync>(
    robot: &R,
    file: &RobotFile,
) {
    let motion = Motion::new(file);
    let ([q, ..], mut mass) = (motion.slices(), motion.matrix());
    on_large_stack(|| {
        let done = robot.mass_matrix_batch(q, mass.each_mut().map(written));
        done.unwrap_or_else(|mismatch| panic!("{mismatch}"));
    });
    motion.compare(Function::MassMatrix, |state| matrix_at(&mass, state));
}

/// Tests the accelerations of a batch: the runtime's torques for these accelerations must be the given torques, as for
/// single calls.
pub fn accelerations_of_a_batch_need_the_torques_that_cause_them<
    const DOF: usize,
    R: BatchForwardDynamics<DOF> + Sync,
>(
    robot: &R,
    file: &RobotFile,
) {
    let motion = Motion::new(file);
    let ([q, qd, _, tau], mut qdd) = (motion.slices(), motion.vector());
    on_large_stack(|| {
        robot.forward_dynamics_batch(q, qd, tau, written(&mut qdd)).unwrap_or_else(|mismatch| panic!("{mismatch}"));
    });
    for (index, state) in motion.states.iter().enumerate() {
        if are_accelerated(&motion.arm, state) {
            caused(&motion.arm, state, &at(&qdd, index));
        }
    }
}

/// Tests the derivatives ∂τ/∂q and ∂τ/∂q̇ of a batch.
pub fn derivatives_of_a_batch_are_those_of_the_runtime<
    const DOF: usize,
    R: BatchInverseDynamicsDerivatives<DOF> + Sync,
>(
    robot: &R,
    file: &RobotFile,
) {
    let motion = Motion::new(file);
    let ([q, qd, qdd, _], mut dq, mut dqd) = (motion.slices(), motion.matrix(), motion.matrix());
    on_large_stack(|| {
        let [of_q, of_qd] = [&mut dq, &mut dqd].map(|matrix| matrix.each_mut().map(written));
        let done = robot.inverse_dynamics_derivatives_batch(q, qd, qdd, of_q, of_qd);
        done.unwrap_or_else(|mismatch| panic!("{mismatch}"));
    });
    motion.compare(Function::InverseDynamicsDerivatives, |state| {
        [matrix_at(&dq, state), matrix_at(&dqd, state)].concat()
    });
}
