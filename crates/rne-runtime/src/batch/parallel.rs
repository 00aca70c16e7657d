//! The states divided among threads.

use core::array::from_fn;

use super::Torques;
use super::blocks::{BLOCK, States};
use super::scalar::BatchScalar;
use super::unit::VectorUnit;

/// States that are worth a task of their own: some ten microseconds of work, against one to hand it over.
const TASK: usize = 4096;

/// Halves the states until they are few, at the edge of a block: each state is computed as it would be without threads.
pub(super) fn run<K: Torques<DOF>, T: BatchScalar, const DOF: usize>(unit: VectorUnit, states: States<'_, K, T, DOF>) {
    if states.states < 2 * TASK {
        return unit.run(states);
    }
    let (first, second) = halves(states);
    rayon::join(|| run(unit, first), || run(unit, second));
}

fn halves<K, T, const DOF: usize>(all: States<'_, K, T, DOF>) -> (States<'_, K, T, DOF>, States<'_, K, T, DOF>) {
    let middle = (all.states / 2).next_multiple_of(BLOCK);
    let inputs = all.inputs.map(|arrays| arrays.map(|array| array.split_at(middle)));
    let mut rest = all.tau;
    let tau = from_fn(|joint| rest[joint].split_off_mut(..middle).unwrap_or_default());
    let first =
        States { robot: all.robot, states: middle, inputs: inputs.map(|arrays| arrays.map(|halves| halves.0)), tau };
    let second = States {
        robot: all.robot,
        states: all.states - middle,
        inputs: inputs.map(|arrays| arrays.map(|halves| halves.1)),
        tau: rest,
    };
    (first, second)
}
