//! Numbers of many states in a caller's arrays.

use core::fmt;
use core::ops::Range;

/// Where an input of every state stands.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a, T> {
    /// One number per state, one after the other.
    Column(&'a [T]),
    /// One number per state, so far apart; the first is the first state's. A distance of 0: the same for all states.
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

    /// The number of a state.
    #[inline(always)]
    pub(super) fn at(&self, state: usize) -> T {
        match *self {
            Self::Column(numbers) => numbers[state],
            Self::Strided(numbers, stride) => numbers[state * stride],
        }
    }
}

/// Where the outputs of every state go.
#[derive(Debug)]
pub enum Destination<'a, T> {
    /// All of a state one after the other, then the next state's.
    Rows(&'a mut [T]),
    /// One slice per output, and in it one number per state.
    Columns(Vec<&'a mut [T]>),
}

impl<T> Destination<'_, T> {
    /// Whether there is room for exactly these outputs of these states.
    pub(super) fn fits(&self, outputs: usize, states: usize) -> bool {
        match self {
            Self::Rows(numbers) => outputs.checked_mul(states) == Some(numbers.len()),
            Self::Columns(columns) => columns.len() == outputs && columns.iter().all(|column| column.len() == states),
        }
    }

    /// The room of the first states, and that of the others.
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

/// Arrays that do not hold the numbers of all states. Nothing has been computed then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WrongArrays {
    /// There is another number of inputs than the code has.
    Inputs {
        /// How many it has.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// An input has no number for some states.
    Input(usize),
    /// The room is not that of the outputs.
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

/// Some of the states.
pub(super) type States = Range<usize>;
