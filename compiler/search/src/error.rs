//! Why a search has no result.

use std::fmt;

use rne_codegen::{CompileError, Function};
use rne_model::Report;

/// Why a search has no result.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum SearchError {
    /// An arm with run-time parameters has no plan.
    RunTimeParameters,
    /// A function that should be rewritten has no form but the seven steps.
    Irreducible(Function),
    /// The plan that was found, or the plan that was given, cannot be compiled or proved.
    Compile(CompileError),
    /// The plan that was found differs from the one that is read back from its text.
    NotWritten,
    /// The plan that was found cannot be read again.
    NotRead(Report),
}

impl From<CompileError> for SearchError {
    fn from(error: CompileError) -> Self {
        Self::Compile(error)
    }
}

impl fmt::Display for SearchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RunTimeParameters => f.write_str(
                "a search needs an arm without run-time parameters; give these parameters their values, then search \
                 again",
            ),
            Self::Irreducible(function) => {
                write!(f, "`{function}` has no reduced form, so a search cannot reduce its operations")
            }
            Self::Compile(error) => error.fmt(f),
            Self::NotWritten => f.write_str("the plan that was found cannot be written. Please report this robot"),
            Self::NotRead(report) => report.fmt(f),
        }
    }
}

impl std::error::Error for SearchError {}
