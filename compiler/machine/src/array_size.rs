//! The error of an array whose size a function does not accept.

use std::fmt;

use rne_runtime::machine::Destination;

use crate::arguments::Array;

/// How the size of an array differs from the size that a function needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WrongSize {
    /// The array has another number of numbers.
    Numbers {
        /// The number of numbers that the function needs; strided arrays may have more.
        needed: usize,
        /// The number of numbers that were given.
        given: usize,
    },
    /// The array has another number of columns.
    Columns {
        /// The number of columns that the function needs.
        needed: usize,
        /// The number of columns that were given.
        given: usize,
    },
    /// A column does not have one number for each state.
    Column {
        /// The first such column, counted from 1.
        column: usize,
        /// The number of numbers that the column needs: the number of states.
        needed: usize,
        /// The number of numbers in the column.
        given: usize,
    },
}

impl WrongSize {
    /// Returns the error for an argument that does not have this number of elements for each of these states.
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

    /// Returns the error for an array of results that has no room for these results of each state.
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
    /// Writes the second half of a sentence; the first half says what the array must have.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Numbers { needed, given } => write!(f, "{given} were given and {needed} are needed"),
            Self::Columns { needed, given } => write!(f, "{given} columns were given and {needed} are needed"),
            Self::Column { column, needed, given } => write!(f, "column {column} has {given} and {needed} are needed"),
        }
    }
}
