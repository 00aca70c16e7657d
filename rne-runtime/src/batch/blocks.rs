//! The loop over states: a register of them at a time.

use core::ops::Range;

use super::scalar::Register;
use super::vector::{Vector, Work};
use super::{BatchScalar, Torques};
use crate::Scalar;
use crate::sin_cos::{Float, kernel};

/// Registers in a block. Sines and cosines come first for all of a block, then torques: each of the two loops is small
/// enough for the processor to work on two registers' states at once, and what they share stays in the first-level
/// cache.
const BLOCK: usize = 8;

/// The most numbers that a register has.
const WIDEST: usize = 16;

/// Registers in memory, none across two lines of the cache.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Aligned<T>(T);

/// States whose torques are to be computed: arrays of one length.
pub(super) struct States<'a, R, T, const DOF: usize> {
    pub(super) robot: &'a R,
    pub(super) count: usize,
    /// Positions, velocities, accelerations.
    pub(super) inputs: [[&'a [T]; DOF]; 3],
    pub(super) tau: [&'a mut [T]; DOF],
}

/// The torques of states, which depend on `ANGLES` angles.
pub(super) struct TorquesOf<'a, R, T, const DOF: usize, const ANGLES: usize>(pub(super) States<'a, R, T, DOF>);

impl<R, T: BatchScalar, const DOF: usize, const ANGLES: usize> Work<T> for TorquesOf<'_, R, T, DOF, ANGLES>
where
    R: Torques<DOF, ANGLES>,
{
    /// Writes the torques, computed in registers `V`.
    #[inline(always)]
    fn run<V: Vector<Element = T>>(self, unit: V::Unit) {
        let States { robot, count, inputs, tau } = self.0;
        let lanes = size_of::<V::Numbers>() / size_of::<T>();
        let (full, last) = (count / lanes, count % lanes);
        // The last register is filled up with zeros, which are states like any other.
        let mut padded = [[[T::ZERO; WIDEST]; DOF]; 3];
        for (padded, numbers) in padded.as_flattened_mut().iter_mut().zip(inputs.as_flattened()) {
            padded[..last].copy_from_slice(&numbers[count - last..count]);
        }
        let mut padded_tau = [[T::ZERO; WIDEST]; DOF];
        let mut tau = tau.map(|numbers| numbers[..count].split_at_mut(count - last));
        // One loop for both, so that its code is there once.
        let parts = [
            (full, inputs, tau.each_mut().map(|(numbers, _)| &mut **numbers)),
            (
                usize::from(last > 0),
                padded.each_ref().map(|arrays| arrays.each_ref().map(|numbers| &numbers[..])),
                padded_tau.each_mut().map(|numbers| &mut numbers[..]),
            ),
        ];
        for (registers, inputs, tau) in parts {
            let inputs = inputs.map(|arrays| arrays.map(|numbers| &V::split(numbers).0[..registers]));
            let tau = tau.map(|numbers| &mut V::split_mut(numbers).0[..registers]);
            torques::<R, V, DOF, ANGLES>(robot, unit, registers, inputs, tau);
        }
        for ((_, tau), padded) in tau.into_iter().zip(padded_tau) {
            tau.copy_from_slice(&padded[..last]);
        }
    }
}

/// The torques of full registers.
#[inline(always)]
fn torques<R: Torques<DOF, ANGLES>, V: Vector<Element: BatchScalar>, const DOF: usize, const ANGLES: usize>(
    robot: &R,
    unit: V::Unit,
    count: usize,
    inputs: [[&[V::Numbers]; DOF]; 3],
    mut tau: [&mut [V::Numbers]; DOF],
) {
    let [q, qd, qdd] = inputs;
    let zero = V::splat(V::Element::ZERO);
    let mut turns = [[[Aligned(zero.store()); ANGLES]; 2]; BLOCK];
    let mut start = 0;
    while start < count {
        let end = count.min(start + BLOCK);
        let mut squares = zero;
        for (at, [sines, cosines]) in (start..end).zip(&mut turns) {
            let angles = robot.angles(&loaded::<V, DOF>(unit, &q, at));
            // Not a loop: what one indexes is written to memory first, perhaps in parts, and waited for.
            macro_rules! each {
                ($($index:literal)*) => {
                    $(if $index < ANGLES {
                        let angle = angles[$index].0;
                        squares = squares.plus_product(angle, angle);
                        let (sine, cosine) = kernel(angle);
                        (sines[$index].0, cosines[$index].0) = (sine.store(), cosine.store());
                    })*
                };
            }
            each!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
            for index in 16..ANGLES {
                let angle = angles[index].0;
                squares = squares.plus_product(angle, angle);
                let (sine, cosine) = kernel(angle);
                (sines[index].0, cosines[index].0) = (sine.store(), cosine.store());
            }
        }
        for (at, [sines, cosines]) in (start..end).zip(&turns) {
            let (sines, cosines) = (registers::<V, ANGLES>(unit, sines), registers::<V, ANGLES>(unit, cosines));
            let torques =
                robot.torques(&sines, &cosines, &loaded(unit, &q, at), &loaded(unit, &qd, at), &loaded(unit, &qdd, at));
            for joint in 0..DOF {
                tau[joint][at] = torques[joint].0.store();
            }
        }
        // Not so for NaN and infinities either.
        let squares = squares.store();
        let are_small = V::each(&squares).iter().fold(true, |all, sum| all & sum.is_square_within_limit());
        if cfg!(feature = "std") && !are_small {
            repair::<R, V, DOF, ANGLES>(robot, start..end, &inputs, &mut tau);
        }
        start = end;
    }
}

/// Writes the torques of states that have an angle beyond the limit of the kernel of sine and cosine once more: those
/// of one state by itself.
#[cold]
#[inline(never)]
fn repair<R: Torques<DOF, ANGLES>, V: Vector<Element: BatchScalar>, const DOF: usize, const ANGLES: usize>(
    robot: &R,
    block: Range<usize>,
    inputs: &[[&[V::Numbers]; DOF]; 3],
    tau: &mut [&mut [V::Numbers]; DOF],
) {
    for at in block {
        for lane in 0..size_of::<V::Numbers>() / size_of::<V::Element>() {
            let [q, qd, qdd] = inputs.map(|arrays| arrays.map(|numbers| V::each(&numbers[at])[lane]));
            let angles = robot.angles(&q);
            if angles.iter().all(|angle| angle.is_within_limit()) {
                continue;
            }
            let (sines, cosines) = V::Element::sin_cos_array(angles);
            for (numbers, torque) in tau.iter_mut().zip(robot.torques(&sines, &cosines, &q, &qd, &qdd)) {
                V::each_mut(&mut numbers[at])[lane] = torque;
            }
        }
    }
}

// Loops, for what `array::from_fn` writes stays in memory.

#[inline(always)]
fn loaded<V: Vector, const N: usize>(unit: V::Unit, numbers: &[&[V::Numbers]; N], at: usize) -> [Register<V>; N] {
    let mut registers = [Register(V::splat(V::Element::ZERO)); N];
    for index in 0..N {
        registers[index] = Register(V::load(unit, &numbers[index][at]));
    }
    registers
}

#[inline(always)]
fn registers<V: Vector, const N: usize>(unit: V::Unit, numbers: &[Aligned<V::Numbers>; N]) -> [Register<V>; N] {
    let mut registers = [Register(V::splat(V::Element::ZERO)); N];
    for index in 0..N {
        registers[index] = Register(V::load(unit, &numbers[index].0));
    }
    registers
}

/// The torques of each state by itself.
#[cfg(feature = "arm")]
pub(super) fn one_by_one<R, T: BatchScalar, const DOF: usize>(all: States<'_, R, T, DOF>)
where
    R: crate::InverseDynamics<DOF>,
{
    let States { robot, count, inputs, mut tau } = all;
    for state in 0..count {
        let [q, qd, qdd] = inputs.map(|arrays| arrays.map(|numbers| numbers[state]));
        for (numbers, torque) in tau.iter_mut().zip(robot.inverse_dynamics(&q, &qd, &qdd)) {
            numbers[state] = torque;
        }
    }
}
