//! Why a log cannot be read.

use std::fmt;
use std::path::Path;

/// Why a log cannot be read, or not as it was asked for: the file, what is wrong with it and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogError {
    file: String,
    what: String,
    of_request: bool,
}

impl LogError {
    /// Something is wrong with the file.
    pub(crate) fn file(path: &Path, what: impl fmt::Display) -> Self {
        Self { file: path.display().to_string(), what: what.to_string(), of_request: false }
    }

    /// The file is in order and does not have what was asked for, or more must be said.
    pub(crate) fn request(path: &Path, what: impl fmt::Display) -> Self {
        Self { of_request: true, ..Self::file(path, what) }
    }

    /// Whether the file is in order and the request is not: a topic or a joint that it does not have, a unit that must
    /// be said.
    #[must_use]
    pub fn is_of_request(&self) -> bool {
        self.of_request
    }
}

impl fmt::Display for LogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.file, self.what)
    }
}

impl std::error::Error for LogError {}
