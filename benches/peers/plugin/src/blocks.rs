//! Matrices of many states, a block of states after the other in the same memory, as Pinocchio writes each matrix to
//! the same `Data`.
#![cfg_attr(not(all(feature = "batch", feature = "functions")), allow(dead_code))]

use std::array::from_fn;
use std::ops::Range;
use std::slice::IterMut;

/// States of a block: many enough that a call costs little beside its work, few enough that the matrices stay in the
/// second-level cache.
const BLOCK: usize = 256;

/// Numbers between those of two elements, so that they do not share a set of the cache.
const GAP: usize = 8;

/// Element by element, in each the states.
#[derive(Default)]
pub(crate) struct Blocks {
    numbers: Vec<f64>,
    /// Elements that are not zero in all states that were checked. Pinocchio does not write the others either.
    is_zero: Vec<bool>,
    /// Whether all states are one block, with all elements.
    pub(crate) keeps_all: bool,
}

/// The arrays of the elements that are left.
pub(crate) struct Elements<'a>(IterMut<'a, &'a mut [f64]>);

impl<'a> Elements<'a> {
    /// The next matrix.
    pub(crate) fn matrix<const N: usize>(&mut self) -> [[&'a mut [f64]; N]; N] {
        from_fn(|_| from_fn(|_| self.0.next().map(|numbers| &mut **numbers).unwrap_or_default()))
    }
}

impl Blocks {
    /// Computes all states, a block at a time. `is_asked` says which elements are to be written.
    pub(crate) fn compute(
        &mut self,
        count: usize,
        elements: usize,
        is_asked: impl Fn(usize) -> bool,
        mut call: impl FnMut(Range<usize>, Elements<'_>),
    ) {
        let (block, stride) = if self.keeps_all { (count, count) } else { (BLOCK, BLOCK + GAP) };
        self.numbers.resize(elements * stride, 0.0);
        self.is_zero.resize(elements, false);
        for first in (0..count).step_by(block) {
            let states = first..(first + block).min(count);
            let arrays = self.numbers.chunks_mut(stride).zip(&self.is_zero).enumerate();
            let mut arrays: Vec<&mut [f64]> = arrays
                .map(|(element, (numbers, is_zero))| {
                    let is_written = self.keeps_all || !is_zero && is_asked(element);
                    if is_written { &mut numbers[..states.len()] } else { &mut [][..] }
                })
                .collect();
            call(states, Elements(arrays.iter_mut()));
        }
        if self.keeps_all {
            let of_elements = self.numbers.chunks(stride).map(|numbers| numbers.iter().all(|number| *number == 0.0));
            self.is_zero = of_elements.collect();
        }
    }

    /// One of several quantities.
    pub(crate) fn part(&self, place: usize, count: usize) -> &[f64] {
        &self.numbers[place * self.numbers.len() / count..]
    }
}
