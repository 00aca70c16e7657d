//! The loop over states, in blocks that the compiler turns into vector registers.

use core::array::from_fn;

use super::Torques;
use super::scalar::{BatchScalar, Lane};
use super::unit::Task;

/// States of a block: one register of `f32` in AVX-512, two of `f64`.
pub(super) const BLOCK: usize = 16;

/// One number per state of a block, for each joint.
type Block<T, const DOF: usize> = [[T; BLOCK]; DOF];

/// States whose torques are to be computed: arrays of one length.
pub(super) struct States<'a, K, T, const DOF: usize> {
    pub(super) robot: &'a K,
    pub(super) states: usize,
    /// Positions, velocities, accelerations.
    pub(super) inputs: [[&'a [T]; DOF]; 3],
    pub(super) tau: [&'a mut [T]; DOF],
}

impl<K: Torques<DOF>, T: BatchScalar, const DOF: usize> Task for States<'_, K, T, DOF> {
    #[inline(always)]
    fn run<const FUSED: bool>(mut self) {
        let mut start = 0;
        while start < self.states {
            let end = self.states.min(start + BLOCK);
            let mut inputs = [[[T::zero(); BLOCK]; DOF]; 3];
            for (block, arrays) in inputs.as_flattened_mut().iter_mut().zip(self.inputs.as_flattened()) {
                read(block, &arrays[start..end]);
            }
            let (tau, is_nan) = torques::<K, T, FUSED, DOF>(self.robot, &inputs);
            let tau = if is_nan { repaired(self.robot, &inputs, tau) } else { tau };
            for (block, array) in tau.iter().zip(&mut self.tau) {
                write(block, &mut array[start..end]);
            }
            start = end;
        }
    }
}

/// Fills a block, the last one up with zeros: a state like any other.
#[inline(always)]
fn read<T: Copy>(block: &mut [T; BLOCK], numbers: &[T]) {
    match numbers.first_chunk() {
        Some(chunk) => *block = *chunk,
        None => block[..numbers.len()].copy_from_slice(numbers),
    }
}

#[inline(always)]
fn write<T: Copy>(block: &[T; BLOCK], numbers: &mut [T]) {
    match numbers.first_chunk_mut() {
        Some(chunk) => *chunk = *block,
        None => numbers.copy_from_slice(&block[..numbers.len()]),
    }
}

/// The torques of a block and whether one of them is NaN.
///
/// The loop's body is straight-line code, and what it reads and writes are local arrays: LLVM vectorises it without a
/// condition. The tests show the same bits for every unit; `cargo run --release --example batch_speed` shows whether it
/// still does.
#[inline(always)]
fn torques<K: Torques<DOF>, T: BatchScalar, const FUSED: bool, const DOF: usize>(
    robot: &K,
    inputs: &[Block<T, DOF>; 3],
) -> (Block<T, DOF>, bool) {
    let mut tau = [[T::zero(); BLOCK]; DOF];
    for state in 0..BLOCK {
        let [q, qd, qdd]: [[Lane<T, FUSED>; DOF]; 3] =
            from_fn(|input| from_fn(|joint| Lane(inputs[input][joint][state])));
        let torques = robot.torques(&q, &qd, &qdd);
        for (joint, torque) in torques.into_iter().enumerate() {
            tau[joint][state] = torque.0;
        }
    }
    let is_nan = tau.as_flattened().iter().fold(false, |any, torque| any | torque.is_nan());
    (tau, is_nan)
}

/// The same with the states that have a NaN computed again, one by one, as numbers.
#[cold]
#[inline(never)]
fn repaired<K: Torques<DOF>, T: BatchScalar, const DOF: usize>(
    robot: &K,
    inputs: &[Block<T, DOF>; 3],
    mut tau: Block<T, DOF>,
) -> Block<T, DOF> {
    for state in 0..BLOCK {
        if tau.iter().any(|torques| torques[state].is_nan()) {
            let [q, qd, qdd] = from_fn(|input| from_fn(|joint| inputs[input][joint][state]));
            let torques = robot.torques(&q, &qd, &qdd);
            for (joint, torque) in torques.into_iter().enumerate() {
                tau[joint][state] = torque;
            }
        }
    }
    tau
}
