//! The loop over states, which computes one register of states at a time.

use core::ops::Range;

use super::scalar::Register;
use super::vector::{Vector, Work};
use super::{BatchFunction, BatchScalar};
use crate::Scalar;
use crate::number::sin_cos::{Float, kernel};

/// Number of registers in a block. Sines and cosines of a whole block are computed first, then the results. Each of
/// these two loops is short enough for the processor to work on the states of two registers at once, and the numbers
/// that the loops share stay in the first-level cache.
const BLOCK: usize = 8;

/// The largest number of lanes of a register.
const WIDEST: usize = 16;

/// Marks an element that is always zero, in [`BatchFunction::PLACES`].
pub const ZERO: u16 = u16::MAX;

/// A register in memory, aligned so that it does not cross a cache line.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Aligned<T>(T);

/// The arrays of states whose results are to be computed. They have the same length, but some may be empty.
pub(super) struct States<'a, R, T, const ARGUMENTS: usize, const INPUTS: usize, const ELEMENTS: usize> {
    pub(super) robot: &'a R,
    pub(super) count: usize,
    /// The numbers of each argument.
    pub(super) inputs: [[&'a [T]; INPUTS]; ARGUMENTS],
    /// The numbers of the results.
    pub(super) elements: [&'a mut [T]; ELEMENTS],
}

/// Computes the results of states, which depend on `ANGLES` angles, as `OUTPUTS` distinct numbers.
pub(super) struct OutputsOf<
    'a,
    R,
    T,
    const INPUTS: usize,
    const ANGLES: usize,
    const OUTPUTS: usize,
    const ELEMENTS: usize,
>(pub(super) States<'a, R, T, 1, INPUTS, ELEMENTS>);

/// The arrays to which results are written.
struct Results<'r, 'a, T> {
    elements: &'r mut [&'a mut [T]],
    /// For each array, the index of its output.
    places: &'r [u16],
    /// How many numbers of the register are states, if it is the last, incomplete one; 0 for a full register.
    last: usize,
}

impl<T: BatchScalar> Results<'_, '_, T> {
    /// Writes the outputs of the states in the register with index `at`.
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
    /// Computes the results in registers `V` and writes them.
    #[inline(always)]
    fn run<V: Vector<Element = T>>(self, unit: V::Unit) {
        let States { robot, count, inputs: [inputs], elements } = self.0;
        let lanes = size_of::<V::Numbers>() / size_of::<T>();
        let (full, last) = (count / lanes, count % lanes);
        // An incomplete last register is filled with zeros, which are valid states.
        let mut padded = [[T::ZERO; WIDEST]; INPUTS];
        for (padded, numbers) in padded.iter_mut().zip(&inputs) {
            if let Some(numbers) = numbers.get(count - last..count) {
                padded[..last].copy_from_slice(numbers);
            }
        }
        let (mut elements, mut places, mut wanted) = (elements, R::PLACES, ELEMENTS);
        if R::IS_WHOLE {
            // the compiler then knows that all have the same length
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
        // One loop for full registers and for the last one, so that its code is compiled once.
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

/// Computes the results of full registers, or of one register of which only the first `last` numbers are states.
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
            // Written out and not a loop: an array that a loop indexes is first written to memory, perhaps in parts,
            // which causes waiting.
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
        // Also false for NaN and infinities.
        let squares = squares.store();
        let are_small = V::each(&squares).iter().fold(true, |all, sum| all & sum.is_square_within_limit());
        if cfg!(feature = "std") && !are_small {
            repair::<R, V, INPUTS, ANGLES, OUTPUTS, ELEMENTS>(robot, start..end, &inputs, written);
        }
        start = end;
    }
}

/// Computes again the states that have an angle beyond the limit of the kernel of sine and cosine, each state
/// separately, and overwrites their results.
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

// Loops are used below, because results of `array::from_fn` would stay in memory.

/// Loads the registers of all inputs. Arrays from `required` on may be empty; they give zeros.
#[inline(always)]
fn loaded<V: Vector, const N: usize>(
    unit: V::Unit,
    numbers: &[&[V::Numbers]; N],
    at: usize,
    required: usize,
) -> [Register<V>; N] {
    let mut registers = [Register(V::splat(V::Element::ZERO)); N];
    // Written out, as for angles: a loop over the inputs of a large robot writes registers to memory in parts. Without
    // optimization each of them would need stack of its own, so then it is a loop.
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
