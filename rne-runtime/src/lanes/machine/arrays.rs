//! Arrays of a caller, with numbers of many states.

use core::fmt;
use core::ops::Range;

/// The numbers of an input for all states.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a, T> {
    /// A slice with one number per state.
    Column(&'a [T]),
    /// A slice with one number per state, at this distance; the first number belongs to the first state. With a
    /// distance of 0, all states have the same number.
    Strided(&'a [T], usize),
}

impl<T: Copy> Source<'_, T> {
    /// Whether there is a number for each state.
    pub(super) fn holds(&self, states: usize) -> bool {
        match self {
            _ if states == 0 => true,
            Self::Column(numbers) => numbers.len() >= states,
            Self::Strided(numbers, stride) => {
                (states - 1).checked_mul(*stride).is_some_and(|last| last < numbers.len())
            }
        }
    }

    /// Returns the number of a state.
    #[inline(always)]
    pub(super) fn at(&self, state: usize) -> T {
        match *self {
            Self::Column(numbers) => numbers[state],
            Self::Strided(numbers, stride) => numbers[state * stride],
        }
    }
}

/// The array for the outputs of all states.
#[derive(Debug)]
pub enum Destination<'a, T> {
    /// One slice: all outputs of a state, then those of the next state.
    Rows(&'a mut [T]),
    /// One slice per output, with one number per state.
    Columns(Vec<&'a mut [T]>),
}

impl<T> Destination<'_, T> {
    /// Whether the arrays have exactly the size of these outputs for these states.
    pub(super) fn fits(&self, outputs: usize, states: usize) -> bool {
        match self {
            Self::Rows(numbers) => outputs.checked_mul(states) == Some(numbers.len()),
            Self::Columns(columns) => columns.len() == outputs && columns.iter().all(|column| column.len() == states),
        }
    }

    /// Splits the arrays into those of the first states and those of the others.
    #[cfg(feature = "rayon")]
    pub(super) fn split_at(self, states: usize, outputs: usize) -> (Self, Self) {
        match self {
            Self::Rows(numbers) => {
                let (first, second) = numbers.split_at_mut(states * outputs);
                (Self::Rows(first), Self::Rows(second))
            }
            Self::Columns(columns) => {
                let (first, second) = columns.into_iter().map(|column| column.split_at_mut(states)).unzip();
                (Self::Columns(first), Self::Columns(second))
            }
        }
    }
}

/// The error that arrays do not have the right size. Nothing has been computed then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WrongArrays {
    /// The number of inputs differs from that of the code.
    Inputs {
        /// The number of inputs of the code.
        expected: usize,
        /// The number of inputs that were given.
        found: usize,
    },
    /// The input with this index lacks numbers of some states.
    Input(usize),
    /// The destination does not have the size of the outputs.
    Outputs,
}

impl fmt::Display for WrongArrays {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Inputs { expected, found } => write!(f, "{found} inputs where the code has {expected}"),
            Self::Input(index) => write!(f, "input {index} has fewer numbers than there are states"),
            Self::Outputs => f.write_str("the room for the outputs is not one number per output and state"),
        }
    }
}

impl core::error::Error for WrongArrays {}

/// A range of states.
pub(super) type States = Range<usize>;
