//! The loop over states, in blocks that the compiler turns into vector registers.

use core::array::from_fn;

use super::Torques;
use super::scalar::{BatchScalar, Lane};
use super::unit::Task;

/// Bytes of a block: the widest register there is.
const BYTES: usize = 64;

/// One number per state of a block, for each joint.
type Block<T, const DOF: usize, const STATES: usize> = [[T; STATES]; DOF];

/// States whose torques are to be computed: arrays of one length.
pub(super) struct States<'a, R, T, const DOF: usize> {
    pub(super) robot: &'a R,
    pub(super) count: usize,
    /// Positions, velocities, accelerations.
    pub(super) inputs: [[&'a [T]; DOF]; 3],
    pub(super) tau: [&'a mut [T]; DOF],
}

impl<R: Torques<DOF>, T: BatchScalar, const DOF: usize> Task for States<'_, R, T, DOF> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        // A number cannot be a type's constant and the length of an array, yet.
        if size_of::<T>() == size_of::<f32>() {
            self.in_blocks::<FUSED, { BYTES / size_of::<f32>() }>();
        } else {
            self.in_blocks::<FUSED, { BYTES / size_of::<f64>() }>();
        }
    }
}

impl<R: Torques<DOF>, T: BatchScalar, const DOF: usize> States<'_, R, T, DOF> {
    #[inline(always)]
    fn in_blocks<const FUSED: bool, const STATES: usize>(mut self) {
        let count = self.count;
        // All of one length, so that one comparison serves all of them.
        let arrays = self.inputs.map(|arrays| arrays.map(|numbers| &numbers[..count]));
        // The last block may not be full: zeros, or what the block before has left, are states like any other.
        let mut inputs = [[[T::zero(); STATES]; DOF]; 3];
        let mut start = 0;
        while start < count {
            let end = count.min(start + STATES);
            for (block, numbers) in inputs.as_flattened_mut().iter_mut().zip(arrays.as_flattened()) {
                read(block, &numbers[start..end]);
            }
            let (tau, is_nan) = torques::<R, T, FUSED, DOF, STATES>(self.robot, &inputs);
            let tau = if is_nan { repaired(self.robot, &inputs, tau) } else { tau };
            for (block, numbers) in tau.iter().zip(&mut self.tau) {
                write(block, &mut numbers[start..end]);
            }
            start = end;
        }
    }
}

/// The torques of each state by itself.
pub(super) fn one_by_one<R: Torques<DOF>, T: BatchScalar, const DOF: usize>(all: States<'_, R, T, DOF>) {
    let States { robot, count, inputs, mut tau } = all;
    for state in 0..count {
        let [q, qd, qdd] = inputs.map(|arrays| arrays.map(|numbers| numbers[state]));
        for (numbers, torque) in tau.iter_mut().zip(robot.torques(&q, &qd, &qdd)) {
            numbers[state] = torque;
        }
    }
}

/// Reads as many numbers into a block as there are.
#[inline(always)]
fn read<T: Copy, const STATES: usize>(block: &mut [T; STATES], numbers: &[T]) {
    match numbers.first_chunk() {
        Some(chunk) => *block = *chunk,
        None => block[..numbers.len()].copy_from_slice(numbers),
    }
}

#[inline(always)]
fn write<T: Copy, const STATES: usize>(block: &[T; STATES], numbers: &mut [T]) {
    match numbers.first_chunk_mut() {
        Some(chunk) => *chunk = *block,
        None => numbers.copy_from_slice(&block[..numbers.len()]),
    }
}

/// The torques of a block and whether one of them is NaN.
///
/// The body of the loop has neither a branch nor a call, and reads and writes local arrays alone: nothing keeps LLVM from
/// making it one over registers. Whether it still does shows in the times of
/// `cargo run --release --example batch_speed`.
#[inline(always)]
fn torques<R: Torques<DOF>, T: BatchScalar, const FUSED: bool, const DOF: usize, const STATES: usize>(
    robot: &R,
    inputs: &[Block<T, DOF, STATES>; 3],
) -> (Block<T, DOF, STATES>, bool) {
    let mut tau = [[T::zero(); STATES]; DOF];
    for state in 0..STATES {
        let [q, qd, qdd]: [[Lane<T, FUSED>; DOF]; 3] =
            from_fn(|input| from_fn(|joint| Lane(inputs[input][joint][state])));
        for (joint, torque) in robot.torques(&q, &qd, &qdd).into_iter().enumerate() {
            tau[joint][state] = torque.0;
        }
    }
    let is_nan = tau.as_flattened().iter().fold(false, |any, torque| any | torque.is_nan());
    (tau, is_nan)
}

/// The same with the torques of states that have a NaN computed again, as those of one state are.
#[cold]
#[inline(never)]
fn repaired<R: Torques<DOF>, T: BatchScalar, const DOF: usize, const STATES: usize>(
    robot: &R,
    inputs: &[Block<T, DOF, STATES>; 3],
    mut tau: Block<T, DOF, STATES>,
) -> Block<T, DOF, STATES> {
    for state in 0..STATES {
        if tau.iter().any(|torques| torques[state].is_nan()) {
            let [q, qd, qdd] = from_fn(|input| from_fn(|joint| inputs[input][joint][state]));
            for (joint, torque) in robot.torques(&q, &qd, &qdd).into_iter().enumerate() {
                tau[joint][state] = torque;
            }
        }
    }
    tau
}
