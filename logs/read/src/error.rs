//! Why a log cannot be read.

use std::fmt;
use std::path::Path;

use crate::remedy::{Remedy, Setting};

/// Why a log cannot be read, or not as it was asked for: the file, the mistake, and remedies as data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogError {
    file: String,
    what: String,
    of_request: bool,
    remedies: Vec<Remedy>,
}

impl LogError {
    /// Something is wrong with the file.
    pub(crate) fn file(path: &Path, what: impl fmt::Display) -> Self {
        Self { file: path.display().to_string(), what: what.to_string(), of_request: false, remedies: Vec::new() }
    }

    /// The file is in order and does not have what was asked for, or more must be said.
    pub(crate) fn request(path: &Path, what: impl fmt::Display) -> Self {
        Self { of_request: true, ..Self::file(path, what) }
    }

    /// The error with an option to give as another remedy.
    pub(crate) fn give(self, setting: Setting) -> Self {
        self.remedy(Remedy::Give(setting))
    }

    /// The error with an option to leave out as another remedy.
    pub(crate) fn leave_out(self, setting: Setting) -> Self {
        self.remedy(Remedy::LeaveOut(setting))
    }

    /// The error with another remedy.
    pub(crate) fn remedy(mut self, remedy: Remedy) -> Self {
        self.remedies.push(remedy);
        self
    }

    /// Options that help: any of them, or each in turn.
    #[must_use]
    pub fn remedies(&self) -> &[Remedy] {
        &self.remedies
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
