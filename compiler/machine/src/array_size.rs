//! Arrays of another size than a function needs.

use std::fmt;

use rne_runtime::machine::Destination;

use crate::arguments::Array;

/// How the size of an array differs from the size that a function needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WrongSize {
    /// The array has another count of numbers.
    Numbers {
        /// How many a function needs; of strided numbers, at least.
        needed: usize,
        /// How many were given.
        given: usize,
    },
    /// There is another count of columns.
    Columns {
        /// How many a function needs.
        needed: usize,
        /// How many were given.
        given: usize,
    },
    /// A column does not have a number for each state.
    Column {
        /// The first such column, counted from 1.
        column: usize,
        /// How many numbers a function needs: the number of states.
        needed: usize,
        /// How many were given.
        given: usize,
    },
}

impl WrongSize {
    /// The size of an array that does not have that number of elements for each of these states.
    pub(crate) fn of_argument<T>(array: &Array<'_, T>, elements: usize, states: usize) -> Self {
        match *array {
            Array::Rows(numbers) => Self::Numbers { needed: elements.saturating_mul(states), given: numbers.len() },
            Array::Same(numbers) => Self::Numbers { needed: elements, given: numbers.len() },
            Array::Columns(columns) => Self::of_columns(elements, states, columns.iter().map(|column| column.len())),
            Array::Strided { numbers, state, element } => {
                let last = |count: usize, apart: usize| count.saturating_sub(1).saturating_mul(apart);
                let needed = last(states, state).saturating_add(last(elements, element)).saturating_add(1);
                Self::Numbers { needed, given: numbers.len() }
            }
        }
    }

    /// The size of memory that does not have room for these results of each state.
    pub(crate) fn of_results<T>(results: &Destination<'_, T>, outputs: usize, states: usize) -> Self {
        match results {
            Destination::Rows(numbers) => {
                Self::Numbers { needed: outputs.saturating_mul(states), given: numbers.len() }
            }
            Destination::Columns(columns) => {
                Self::of_columns(outputs, states, columns.iter().map(|column| column.len()))
            }
        }
    }

    fn of_columns(needed: usize, states: usize, lengths: impl ExactSizeIterator<Item = usize>) -> Self {
        let count = lengths.len();
        let wrong = lengths.enumerate().find(|&(_, length)| count == needed && length != states);
        wrong.map_or(Self::Columns { needed, given: count }, |(at, given)| Self::Column {
            column: at + 1,
            needed: states,
            given,
        })
    }
}

impl fmt::Display for WrongSize {
    /// The second half of a sentence, whose first half says what an array must have.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Numbers { needed, given } => write!(f, "{given} were given and {needed} are needed"),
            Self::Columns { needed, given } => write!(f, "{given} columns were given and {needed} are needed"),
            Self::Column { column, needed, given } => write!(f, "column {column} has {given} and {needed} are needed"),
        }
    }
}
