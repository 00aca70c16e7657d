//! Errors of reading an arm at run time, and of computing a function.

use std::error::Error;
use std::fmt;
use std::io;
use std::path::PathBuf;

use rne_codegen::{CompileError, Function};
use rne_model::Report;

use crate::{OutOfRange, WrongSize};

/// Why no arm could be read from a file.
#[derive(Debug)]
#[non_exhaustive]
pub enum ArmError {
    /// A file cannot be read.
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        error: io::Error,
    },
    /// The robot file or its plan is not valid; the report has the line, the column and what is allowed.
    Invalid(Report),
}

impl fmt::Display for ArmError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable { path, error } => write!(f, "cannot read {}: {error}", path.display()),
            Self::Invalid(report) => report.fmt(f),
        }
    }
}

impl Error for ArmError {
    /// Returns the error of the operating system. For a report, returns its source, because the report is displayed
    /// without words of this error.
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Unreadable { error, .. } => Some(error),
            Self::Invalid(report) => report.source(),
        }
    }
}

impl From<Report> for ArmError {
    fn from(report: Report) -> Self {
        Self::Invalid(report)
    }
}

/// Why a function computed nothing. In this case no result has been written.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum EvaluationError {
    /// The function cannot be compiled for this robot.
    Compile(CompileError),
    /// An argument that the function takes is missing.
    Missing {
        /// The function.
        function: Function,
        /// The argument.
        argument: &'static str,
    },
    /// An argument has another size.
    Argument {
        /// The argument.
        argument: &'static str,
        /// The number of elements that the argument has for each state.
        elements: usize,
        /// The number of states.
        states: usize,
        /// How the size of the array differs.
        size: WrongSize,
    },
    /// An argument has numbers that are not allowed.
    OutOfRange {
        /// The numbers and why they are not allowed.
        mistake: OutOfRange,
        /// The first state with such numbers, counted from 1.
        state: usize,
        /// The number of states.
        states: usize,
    },
    /// The array for the results has another size.
    Room {
        /// The number of results of the function for each state.
        outputs: usize,
        /// The number of states.
        states: usize,
        /// How the size of the array differs.
        size: WrongSize,
    },
}

impl fmt::Display for EvaluationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Compile(error) => error.fmt(f),
            Self::Missing { function, argument } => write!(f, "`{function}` needs the argument `{argument}`"),
            Self::Argument { argument, elements, states, size } => {
                let of_states = of_states(*states);
                write!(f, "`{argument}` must have {elements} numbers{of_states}, but {size}")
            }
            Self::OutOfRange { mistake, states: 1, .. } => mistake.fmt(f),
            Self::OutOfRange { mistake, state, states } => write!(f, "state {state} of {states}: {mistake}"),
            Self::Room { outputs, states, size } => {
                let of_states = of_states(*states);
                write!(f, "the memory for the result must hold {outputs} numbers{of_states}, but {size}")
            }
        }
    }
}

/// Returns the words that say for how many states numbers are needed; empty for one state.
fn of_states(states: usize) -> String {
    if states == 1 { String::new() } else { format!(" for each of {states} states") }
}

impl Error for EvaluationError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Compile(error) => error.source(),
            _ => None,
        }
    }
}

impl From<CompileError> for EvaluationError {
    fn from(error: CompileError) -> Self {
        Self::Compile(error)
    }
}
