//! The loop over states: a register of them at a time.

use core::ops::Range;

use super::scalar::Register;
use super::vector::{Vector, Work};
use super::{BatchFunction, BatchScalar};
use crate::Scalar;
use crate::sin_cos::{Float, kernel};

/// Registers in a block. Sines and cosines come first for all of a block, then results: each of the two loops is small
/// enough for the processor to work on two registers' states at once, and what they share stays in the first-level
/// cache.
const BLOCK: usize = 8;

/// The most numbers that a register has.
const WIDEST: usize = 16;

/// An element that is always zero, in [`BatchFunction::PLACES`].
pub const ZERO: u16 = u16::MAX;

/// Registers in memory, none across two lines of the cache.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Aligned<T>(T);

/// States whose results are to be computed: arrays of one length, of which some may be empty.
pub(super) struct States<'a, R, T, const ARGUMENTS: usize, const INPUTS: usize, const ELEMENTS: usize> {
    pub(super) robot: &'a R,
    pub(super) count: usize,
    /// The numbers of each argument.
    pub(super) inputs: [[&'a [T]; INPUTS]; ARGUMENTS],
    /// The numbers of the results.
    pub(super) elements: [&'a mut [T]; ELEMENTS],
}

/// The results of states, which depend on `ANGLES` angles, as `OUTPUTS` distinct numbers.
pub(super) struct OutputsOf<
    'a,
    R,
    T,
    const INPUTS: usize,
    const ANGLES: usize,
    const OUTPUTS: usize,
    const ELEMENTS: usize,
>(pub(super) States<'a, R, T, 1, INPUTS, ELEMENTS>);

/// An array of the results: full registers, and what is left.
type Element<'a, V> = (&'a mut [<V as Vector>::Numbers], &'a mut [<V as crate::sin_cos::Lanes>::Element]);

impl<R, T: BatchScalar, const INPUTS: usize, const ANGLES: usize, const OUTPUTS: usize, const ELEMENTS: usize> Work<T>
    for OutputsOf<'_, R, T, INPUTS, ANGLES, OUTPUTS, ELEMENTS>
where
    R: BatchFunction<INPUTS, ANGLES, OUTPUTS, ELEMENTS>,
{
    /// Writes the results, computed in registers `V`.
    #[inline(always)]
    fn run<V: Vector<Element = T>>(self, unit: V::Unit) {
        let States { robot, count, inputs: [inputs], elements } = self.0;
        let lanes = size_of::<V::Numbers>() / size_of::<T>();
        let (full, last) = (count / lanes, count % lanes);
        // The last register is filled up with zeros, which are states like any other.
        let mut padded = [[T::ZERO; WIDEST]; INPUTS];
        for (padded, numbers) in padded.iter_mut().zip(&inputs) {
            if let Some(numbers) = numbers.get(count - last..count) {
                padded[..last].copy_from_slice(numbers);
            }
        }
        let mut elements = elements.map(|numbers| {
            let (registers, last) = V::split_mut(numbers);
            if R::IS_WHOLE { (&mut registers[..full], last) } else { (registers, last) }
        });
        let (mut wanted, mut wanted_count) = ([0; ELEMENTS], 0);
        if !R::IS_WHOLE {
            for (index, (registers, last)) in elements.iter_mut().enumerate() {
                if R::PLACES[index] == ZERO {
                    registers.iter_mut().for_each(|register| V::each_mut(register).fill(T::ZERO));
                    last.fill(T::ZERO);
                } else if !registers.is_empty() || !last.is_empty() {
                    wanted[wanted_count] = index;
                    wanted_count += 1;
                }
            }
        }
        let wanted = &wanted[..wanted_count];
        // One loop for both, so that its code is there once.
        let parts =
            [(full, inputs, 0), (usize::from(last > 0), padded.each_ref().map(|numbers| &numbers[..]), last)];
        for (registers, inputs, last) in parts {
            let mut arrays: [&[V::Numbers]; INPUTS] = [&[]; INPUTS];
            for index in 0..INPUTS {
                let numbers = V::split(inputs[index]).0;
                arrays[index] = match numbers.get(..registers) {
                    Some(numbers) => numbers,
                    None if index < R::REQUIRED => &numbers[..registers],
                    None => &[],
                };
            }
            outputs::<R, V, INPUTS, ANGLES, OUTPUTS, ELEMENTS>(
                robot, unit, registers, arrays, &mut elements, wanted, last,
            );
        }
    }
}

/// The results of full registers, or of one whose first `last` numbers count.
#[inline(always)]
fn outputs<
    R: BatchFunction<INPUTS, ANGLES, OUTPUTS, ELEMENTS>,
    V: Vector<Element: BatchScalar>,
    const INPUTS: usize,
    const ANGLES: usize,
    const OUTPUTS: usize,
    const ELEMENTS: usize,
>(
    robot: &R,
    unit: V::Unit,
    count: usize,
    inputs: [&[V::Numbers]; INPUTS],
    elements: &mut [Element<'_, V>; ELEMENTS],
    wanted: &[usize],
    last: usize,
) {
    let zero = V::splat(V::Element::ZERO);
    let mut turns = [[[Aligned(zero.store()); ANGLES]; 2]; BLOCK];
    let mut results = [Register(zero); OUTPUTS];
    let mut start = 0;
    while start < count {
        let end = count.min(start + BLOCK);
        let mut squares = zero;
        for (at, [sines, cosines]) in (start..end).zip(&mut turns) {
            let angles = robot.angles(&loaded::<V, INPUTS>(unit, &inputs, at, R::REQUIRED));
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
            robot.outputs(&sines, &cosines, &loaded(unit, &inputs, at, R::REQUIRED), &mut results);
            if last > 0 {
                for index in 0..if R::IS_WHOLE { ELEMENTS } else { wanted.len() } {
                    let index = if R::IS_WHOLE { index } else { wanted[index] };
                    let numbers = results[usize::from(R::PLACES[index])].0.store();
                    elements[index].1.copy_from_slice(&V::each(&numbers)[..last]);
                }
            } else if R::IS_WHOLE {
                for index in 0..ELEMENTS {
                    elements[index].0[at] = results[usize::from(R::PLACES[index])].0.store();
                }
            } else {
                for &index in wanted {
                    elements[index].0[at] = results[usize::from(R::PLACES[index])].0.store();
                }
            }
        }
        // Not so for NaN and infinities either.
        let squares = squares.store();
        let are_small = V::each(&squares).iter().fold(true, |all, sum| all & sum.is_square_within_limit());
        if cfg!(feature = "std") && !are_small {
            repair::<R, V, INPUTS, ANGLES, OUTPUTS, ELEMENTS>(robot, start..end, &inputs, elements, last);
        }
        start = end;
    }
}

/// Writes the results of states that have an angle beyond the limit of the kernel of sine and cosine once more: those
/// of one state by itself.
#[cold]
#[inline(never)]
fn repair<
    R: BatchFunction<INPUTS, ANGLES, OUTPUTS, ELEMENTS>,
    V: Vector<Element: BatchScalar>,
    const INPUTS: usize,
    const ANGLES: usize,
    const OUTPUTS: usize,
    const ELEMENTS: usize,
>(
    robot: &R,
    block: Range<usize>,
    inputs: &[&[V::Numbers]; INPUTS],
    elements: &mut [Element<'_, V>; ELEMENTS],
    last: usize,
) {
    let mut results = [V::Element::ZERO; OUTPUTS];
    for at in block {
        let lanes = size_of::<V::Numbers>() / size_of::<V::Element>();
        for lane in 0..if last > 0 { last } else { lanes } {
            let inputs = inputs.map(|numbers| numbers.get(at).map_or(V::Element::ZERO, |numbers| V::each(numbers)[lane]));
            let angles = robot.angles(&inputs);
            if angles.iter().all(|angle| angle.is_within_limit()) {
                continue;
            }
            let (sines, cosines) = V::Element::sin_cos_array(angles);
            robot.outputs(&sines, &cosines, &inputs, &mut results);
            for (index, (registers, tail)) in elements.iter_mut().enumerate() {
                let Some(result) = results.get(usize::from(R::PLACES[index])) else { continue };
                let place = if last > 0 {
                    tail.get_mut(lane)
                } else {
                    registers.get_mut(at).and_then(|register| V::each_mut(register).get_mut(lane))
                };
                if let Some(place) = place {
                    *place = *result;
                }
            }
        }
    }
}

// Loops, for what `array::from_fn` writes stays in memory.

/// Zeros of arrays that are empty, as those from `required` on may be.
#[inline(always)]
fn loaded<V: Vector, const N: usize>(
    unit: V::Unit,
    numbers: &[&[V::Numbers]; N],
    at: usize,
    required: usize,
) -> [Register<V>; N] {
    let mut registers = [Register(V::splat(V::Element::ZERO)); N];
    for index in 0..N {
        if index < required || at < numbers[index].len() {
            registers[index] = Register(V::load(unit, &numbers[index][at]));
        }
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
pub(super) fn one_by_one<R, T: BatchScalar, const DOF: usize>(all: States<'_, R, T, 3, DOF, DOF>)
where
    R: crate::InverseDynamics<DOF>,
{
    let States { robot, count, inputs, mut elements } = all;
    for state in 0..count {
        let [q, qd, qdd] = inputs.map(|arrays| arrays.map(|numbers| numbers[state]));
        for (numbers, torque) in elements.iter_mut().zip(robot.inverse_dynamics(&q, &qd, &qdd)) {
            numbers[state] = torque;
        }
    }
}
