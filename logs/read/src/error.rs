//! The errors of reading a log.

use std::fmt;
use std::path::Path;

use crate::remedy::{Remedy, Setting};

/// The reason why a log cannot be read, or not with these options: the file, the message, and remedies as data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogError {
    file: String,
    what: String,
    of_request: bool,
    remedies: Vec<Remedy>,
}

impl LogError {
    /// Makes an error for a mistake in the file.
    pub(crate) fn file(path: &Path, what: impl fmt::Display) -> Self {
        Self { file: path.display().to_string(), what: what.to_string(), of_request: false, remedies: Vec::new() }
    }

    /// Makes an error for a valid file that does not have what the options ask for, or that needs more options.
    pub(crate) fn request(path: &Path, what: impl fmt::Display) -> Self {
        Self { of_request: true, ..Self::file(path, what) }
    }

    /// Adds a remedy: to give this option.
    pub(crate) fn give(self, setting: Setting) -> Self {
        self.remedy(Remedy::Give(setting))
    }

    /// Adds a remedy: to leave out this option.
    pub(crate) fn leave_out(self, setting: Setting) -> Self {
        self.remedy(Remedy::LeaveOut(setting))
    }

    /// Adds a remedy.
    pub(crate) fn remedy(mut self, remedy: Remedy) -> Self {
        self.remedies.push(remedy);
        self
    }

    /// The changes of options that help. One of them may be enough, or each is needed in turn.
    #[must_use]
    pub fn remedies(&self) -> &[Remedy] {
        &self.remedies
    }

    /// Whether the file is valid but the options do not fit it: a topic or a joint that it does not have, or a unit
    /// that must be given.
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
