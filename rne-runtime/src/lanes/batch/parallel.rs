//! Divides the states among threads.

use core::array::from_fn;

use super::blocks::States;
use crate::lanes::threads::join;

/// The number of states for which a task of their own is worthwhile: tens of microseconds of work, compared with about
/// one to pass it to a thread. A multiple of the size of every block, so that threads divide states at the end of
/// blocks.
const TASK: usize = 4096;

/// Runs tasks of some thousand states each, on rayon's threads if the build is optimized. A few states are computed on
/// the calling thread.
pub(super) fn for_each_part<R: Sync, T: Send + Sync, const A: usize, const N: usize, const E: usize>(
    all: States<'_, R, T, A, N, E>,
    run: &(impl Fn(States<'_, R, T, A, N, E>) + Sync),
) {
    if all.count < 2 * TASK {
        return run(all);
    }
    let [first, second] = halves(all);
    let (first, second) = (|| for_each_part(first, run), || for_each_part(second, run));
    // A build without optimization keeps each intermediate register in memory: the function of a large robot then needs
    // more stack than the 2 MiB that a thread of rayon has.
    if cfg!(debug_assertions) {
        first();
        second();
    } else {
        join(first, second);
    }
}

/// Splits states into two halves. Each half of an empty array is empty.
fn halves<R, T, const A: usize, const N: usize, const E: usize>(
    all: States<'_, R, T, A, N, E>,
) -> [States<'_, R, T, A, N, E>; 2] {
    let States { robot, count, inputs, elements: mut rest } = all;
    let middle = count / 2 / TASK * TASK;
    let inputs = inputs.map(|arrays| arrays.map(|numbers| numbers.split_at_checked(middle).unwrap_or_default()));
    let elements = from_fn(|index| rest[index].split_off_mut(..middle).unwrap_or_default());
    let [first, second] =
        [inputs.map(|arrays| arrays.map(|halves| halves.0)), inputs.map(|arrays| arrays.map(|halves| halves.1))];
    [
        States { robot, count: middle, inputs: first, elements },
        States { robot, count: count - middle, inputs: second, elements: rest },
    ]
}
