//! Computes many states, in blocks of several registers.

use super::arrays::{Destination, Source, States};
use super::code::{Code, NOWHERE, Turn};
use super::execution::{Port, execute, slots};
use crate::lanes::batch::BatchScalar;
use crate::lanes::batch::vector::{Vector, Work};
use crate::number::sin_cos::{Float, kernel};

/// Number of registers in a block. Each instruction is decoded once for all of them. For arms of seven joints, their
/// slots fit in the first-level cache.
pub(super) const BLOCK: usize = 8;

/// The largest number of lanes of a register.
pub(super) const WIDEST: usize = 16;

/// Returns how many numbers of memory some code needs on the widest unit.
pub(super) const fn memory(code: &Code) -> usize {
    super::execution::memory(code, WIDEST, BLOCK)
}

/// The states of one task, and their arrays.
pub(super) struct Many<'a, T> {
    pub(super) code: &'a Code,
    pub(super) memory: &'a mut [T],
    pub(super) sources: &'a [Source<'a, T>],
    pub(super) states: States,
    pub(super) destination: Destination<'a, T>,
}

impl<T: BatchScalar> Work<T> for Many<'_, T> {
    #[inline(always)]
    fn run<V: Vector<Element = T>>(self, unit: V::Unit) {
        let Self { code, memory, sources, states, destination } = self;
        let slots = slots::<V, BLOCK>(memory);
        let outputs = code.outputs;
        let mut arrays =
            Arrays { unit, sources, destination, outputs, start: states.start, first: states.start, count: 0 };
        let width = size_of::<[V::Numbers; BLOCK]>() / size_of::<T>();
        while arrays.start < states.end {
            arrays.count = width.min(states.end - arrays.start);
            execute::<V, _, BLOCK>(unit, &code.angles, slots, &mut arrays);
            turns::<V, BLOCK>(unit, &code.turns, slots);
            execute::<V, _, BLOCK>(unit, &code.rest, slots, &mut arrays);
            arrays.start += width;
        }
    }
}

/// Computes the sines and cosines of a block.
#[inline(always)]
pub(super) fn turns<V: Vector<Element: BatchScalar>, const N: usize>(
    unit: V::Unit,
    turns: &[Turn],
    slots: &mut [[V::Numbers; N]],
) {
    let mut squares = V::splat(V::Element::ZERO);
    for &Turn { angle, sine, cosine } in turns {
        for i in 0..N {
            let angle = V::load(unit, &slots[angle as usize][i]);
            squares = squares.plus_product(angle, angle);
            let (of_sine, of_cosine) = kernel(angle);
            if sine != NOWHERE {
                slots[sine as usize][i] = of_sine.store();
            }
            if cosine != NOWHERE {
                slots[cosine as usize][i] = of_cosine.store();
            }
        }
    }
    // Also false for NaN and infinities.
    let squares = squares.store();
    if !V::each(&squares).iter().fold(true, |all, sum| all & sum.is_square_within_limit()) {
        beyond_limit::<V, N>(turns, slots);
    }
}

/// Computes, one by one, the sines and cosines of angles that are too large for the kernel, infinite or NaN.
#[cold]
#[inline(never)]
fn beyond_limit<V: Vector<Element: BatchScalar>, const N: usize>(turns: &[Turn], slots: &mut [[V::Numbers; N]]) {
    for &Turn { angle, sine, cosine } in turns {
        for register in 0..N {
            for lane in 0..V::each(&slots[0][0]).len() {
                let angle = V::each(&slots[angle as usize][register])[lane];
                if angle.is_within_limit() {
                    continue;
                }
                let (of_sine, of_cosine) = angle.std_sin_cos();
                for (slot, value) in [(sine, of_sine), (cosine, of_cosine)] {
                    if slot != NOWHERE {
                        V::each_mut(&mut slots[slot as usize][register])[lane] = value;
                    }
                }
            }
        }
    }
}

/// The arrays, and the block that is computed.
struct Arrays<'a, V: Vector> {
    unit: V::Unit,
    sources: &'a [Source<'a, V::Element>],
    destination: Destination<'a, V::Element>,
    outputs: usize,
    /// The first state of the block.
    start: usize,
    /// The state at which the destination begins.
    first: usize,
    /// How many states of the block exist; the last block may be incomplete.
    count: usize,
}

impl<V: Vector<Element: BatchScalar>, const N: usize> Port<V, N> for Arrays<'_, V> {
    #[inline(always)]
    fn input(&mut self, index: usize) -> [V; N] {
        let zero = V::splat(V::Element::ZERO);
        if let Source::Column(numbers) = self.sources[index] {
            let block = V::split(&numbers[self.start..]).0;
            if let Some(block) = block.first_chunk::<N>() {
                let mut values = [zero; N];
                for i in 0..N {
                    values[i] = V::load(self.unit, &block[i]);
                }
                return values;
            }
        }
        // An incomplete block is filled with zeros, which are valid states.
        let mut registers = [zero.store(); N];
        gather::<V, N>(&self.sources[index], self.start, self.count, &mut registers);
        let mut values = [zero; N];
        for i in 0..N {
            values[i] = V::load(self.unit, &registers[i]);
        }
        values
    }

    #[inline(always)]
    fn output(&mut self, index: usize, values: &[V; N]) {
        let start = self.start - self.first;
        match &mut self.destination {
            Destination::Columns(columns) => {
                let column = &mut columns[index][start..];
                if let Some(block) = V::split_mut(column).0.first_chunk_mut::<N>() {
                    for i in 0..N {
                        block[i] = values[i].store();
                    }
                    return;
                }
                scatter::<V, N>(&stored(values), column, 1, self.count);
            }
            Destination::Rows(rows) => {
                let rows = &mut rows[start * self.outputs + index..];
                scatter::<V, N>(&stored(values), rows, self.outputs, self.count);
            }
        }
    }
}

/// Stores registers to memory one by one. If the address of the accumulator were taken, it would be kept in memory.
#[inline(always)]
fn stored<V: Vector, const N: usize>(values: &[V; N]) -> [V::Numbers; N] {
    let mut numbers = [values[0].store(); N];
    for i in 1..N {
        numbers[i] = values[i].store();
    }
    numbers
}

#[inline(never)]
fn gather<V: Vector<Element: BatchScalar>, const N: usize>(
    source: &Source<'_, V::Element>,
    start: usize,
    count: usize,
    registers: &mut [V::Numbers; N],
) {
    let (numbers, stride) = match *source {
        Source::Strided(numbers, 0) => {
            for register in registers {
                V::each_mut(register).fill(numbers[0]);
            }
            return;
        }
        Source::Column(numbers) => (&numbers[start..], 1),
        Source::Strided(numbers, stride) => (&numbers[start * stride..], stride),
    };
    let mut numbers = numbers.iter().step_by(stride).take(count);
    for register in registers {
        for (lane, number) in V::each_mut(register).iter_mut().zip(&mut numbers) {
            *lane = *number;
        }
    }
}

#[inline(never)]
fn scatter<V: Vector<Element: BatchScalar>, const N: usize>(
    values: &[V::Numbers; N],
    room: &mut [V::Element],
    stride: usize,
    count: usize,
) {
    let mut room = room.iter_mut().step_by(stride).take(count);
    for numbers in values {
        for (number, room) in V::each(numbers).iter().zip(&mut room) {
            *room = *number;
        }
    }
}
