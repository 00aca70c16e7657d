//! The loop over states: a register of them at a time.

use core::ops::Range;

use super::scalar::Register;
use super::vector::{Vector, Work};
use super::{BatchFunction, BatchScalar};
use crate::Scalar;
use crate::number::sin_cos::{Float, kernel};

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

/// The arrays that are written.
struct Results<'r, 'a, T> {
    elements: &'r mut [&'a mut [T]],
    /// The output that each of them is.
    places: &'r [u16],
    /// How many numbers of the register count: 0 for all. It is the last one then.
    last: usize,
}

impl<T: BatchScalar> Results<'_, '_, T> {
    /// Writes the outputs of the states in register `at`.
    #[inline(always)]
    fn write<V: Vector<Element = T>>(&mut self, at: usize, outputs: &[Register<V>]) {
        let places = self.elements.iter_mut().zip(self.places);
        if self.last > 0 {
            for (numbers, &place) in places {
                let register = outputs[usize::from(place)].0.store();
                V::split_mut(numbers).1.copy_from_slice(&V::each(&register)[..self.last]);
            }
        } else {
            for (numbers, &place) in places {
                V::split_mut(numbers).0[at] = outputs[usize::from(place)].0.store();
            }
        }
    }
}

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
        let (mut elements, mut places, mut wanted) = (elements, R::PLACES, ELEMENTS);
        if R::IS_WHOLE {
            // of one length, as the compiler sees then
            elements = elements.map(|numbers| &mut numbers[..count]);
        } else {
            wanted = 0;
            for (index, &place) in R::PLACES.iter().enumerate() {
                if place == ZERO {
                    elements[index].fill(T::ZERO);
                } else if !elements[index].is_empty() {
                    elements.swap(index, wanted);
                    places[wanted] = place;
                    wanted += 1;
                }
            }
        }
        let mut results = Results { elements: &mut elements[..wanted], places: &places[..wanted], last: 0 };
        // One loop for both, so that its code is there once.
        let parts = [(full, inputs, 0), (usize::from(last > 0), padded.each_ref().map(|numbers| &numbers[..]), last)];
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
            results.last = last;
            outputs::<R, V, INPUTS, ANGLES, OUTPUTS, ELEMENTS>(robot, unit, registers, arrays, &mut results);
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
    written: &mut Results<'_, '_, V::Element>,
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
                ($($index:expr),*) => {
                    $(if $index < ANGLES {
                        let angle = angles[$index].0;
                        squares = squares.plus_product(angle, angle);
                        let (sine, cosine) = kernel(angle);
                        (sines[$index].0, cosines[$index].0) = (sine.store(), cosine.store());
                    })*
                };
            }
            each!(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
            for index in 16..ANGLES {
                each!(index);
            }
        }
        for (at, [sines, cosines]) in (start..end).zip(&turns) {
            let (sines, cosines) = (registers::<V, ANGLES>(unit, sines), registers::<V, ANGLES>(unit, cosines));
            robot.outputs(&sines, &cosines, &loaded(unit, &inputs, at, R::REQUIRED), &mut results);
            written.write(at, &results);
        }
        // Not so for NaN and infinities either.
        let squares = squares.store();
        let are_small = V::each(&squares).iter().fold(true, |all, sum| all & sum.is_square_within_limit());
        if cfg!(feature = "std") && !are_small {
            repair::<R, V, INPUTS, ANGLES, OUTPUTS, ELEMENTS>(robot, start..end, &inputs, written);
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
    written: &mut Results<'_, '_, V::Element>,
) {
    let mut results = [V::Element::ZERO; OUTPUTS];
    for at in block {
        let lanes = size_of::<V::Numbers>() / size_of::<V::Element>();
        for lane in 0..if written.last > 0 { written.last } else { lanes } {
            let inputs =
                inputs.map(|numbers| numbers.get(at).map_or(V::Element::ZERO, |numbers| V::each(numbers)[lane]));
            let angles = robot.angles(&inputs);
            if angles.iter().all(|angle| angle.is_within_limit()) {
                continue;
            }
            let (sines, cosines) = V::Element::sin_cos_array(angles);
            robot.outputs(&sines, &cosines, &inputs, &mut results);
            for (numbers, &place) in written.elements.iter_mut().zip(written.places) {
                let (registers, last) = V::split_mut(numbers);
                let lanes = if written.last > 0 { last } else { V::each_mut(&mut registers[at]) };
                lanes[lane] = results[usize::from(place)];
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
    // Not a loop, as for angles: a loop over the inputs of a large robot writes registers to memory in parts. Without
    // optimization each of them would have a place of its own on the stack, so it is a loop there.
    #[cfg(not(debug_assertions))]
    macro_rules! each {
        ($($index:literal)*) => {
            $(if $index < N && ($index < required || at < numbers[$index].len()) {
                registers[$index] = Register(V::load(unit, &numbers[$index][at]));
            })*
        };
    }
    #[cfg(not(debug_assertions))]
    each!(
        0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15
        16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31
        32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47
        48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63
        64 65 66 67 68 69 70 71 72 73 74 75 76 77 78 79
        80 81 82 83 84 85 86 87 88 89 90 91 92 93 94 95
        96 97 98 99 100 101 102 103 104 105 106 107 108 109 110 111
        112 113 114 115 116 117 118 119 120 121 122 123 124 125 126 127
    );
    for index in if cfg!(debug_assertions) { 0 } else { 128 }..N {
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
