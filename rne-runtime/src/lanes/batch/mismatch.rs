//! The error that arrays do not have the same length.

use core::error::Error;
use core::fmt;

/// An array has another length than the positions of the first joint, which determine the number of states.
///
/// Nothing has been computed then, and no result written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LengthMismatch {
    /// Name of the argument: `q`, `qd`, `qdd`, `tau`, `mass` and so on.
    pub argument: &'static str,
    /// Index of the joint's array in the argument, or of the row in a matrix, from 0.
    pub joint: usize,
    /// Index of the column in a matrix, from 0.
    pub column: Option<usize>,
    /// The length of that array.
    pub length: usize,
    /// The length of `q[0]`.
    pub states: usize,
    /// Whether the array may be empty, too.
    pub may_be_empty: bool,
}

impl fmt::Display for LengthMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { argument, joint, length, states, .. } = self;
        write!(f, "`{argument}[{joint}]")?;
        if let Some(column) = self.column {
            write!(f, "[{column}]")?;
        }
        write!(f, "` has length {length} and `q[0]` {states}: each holds one number per state")?;
        if self.may_be_empty { write!(f, ", or none") } else { Ok(()) }
    }
}

impl Error for LengthMismatch {}

/// An argument of a batch: its name and its arrays.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Argument {
    pub name: &'static str,
    pub rows: usize,
    /// The number of columns; 0 for a vector.
    pub columns: usize,
    pub may_be_empty: bool,
}

impl Argument {
    /// A vector, whose arrays have a number for each state.
    #[must_use]
    pub const fn vector(name: &'static str, rows: usize) -> Self {
        Self { name, rows, columns: 0, may_be_empty: false }
    }

    /// A vector, whose arrays may be empty.
    #[must_use]
    pub const fn optional_vector(name: &'static str, rows: usize) -> Self {
        Self { may_be_empty: true, ..Self::vector(name, rows) }
    }

    /// A matrix, whose arrays may be empty.
    #[must_use]
    pub const fn matrix(name: &'static str, rows: usize, columns: usize) -> Self {
        Self { name, rows, columns, may_be_empty: true }
    }
}

/// Returns the common length of all arrays of some arguments, which is that of the first array.
pub(super) fn common_length(
    arguments: [&[Argument]; 2],
    mut lengths: impl Iterator<Item = usize>,
) -> Result<usize, LengthMismatch> {
    let mut states = None;
    for &Argument { name: argument, rows, columns, may_be_empty } in arguments.into_iter().flatten() {
        for (index, length) in lengths.by_ref().take(rows * columns.max(1)).enumerate() {
            let states = *states.get_or_insert(length);
            if length != states && !(may_be_empty && length == 0) {
                let (joint, column) = match columns {
                    0 => (index, None),
                    _ => (index / columns, Some(index % columns)),
                };
                return Err(LengthMismatch { argument, joint, column, length, states, may_be_empty });
            }
        }
    }
    Ok(states.unwrap_or(0))
}
