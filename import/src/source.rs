//! The text of a description, and errors at places in it.

use std::ffi::OsStr;
use std::ops::Range;
use std::path::Path;

use rne_model::{Remedy, Report};

/// A text and its name in messages.
#[derive(Clone, Debug, Default)]
pub(crate) struct Source {
    pub(crate) file: String,
    /// The text of the file, followed by the texts of the files that it includes.
    pub(crate) text: String,
    /// The included files: where the text of each begins, and its name in messages.
    pub(crate) included: Vec<(usize, String)>,
}

/// The help for an error, if there is one.
#[derive(Debug)]
pub(crate) struct Help(Option<String>);

impl From<Option<String>> for Help {
    fn from(help: Option<String>) -> Self {
        Self(help)
    }
}

impl From<String> for Help {
    fn from(help: String) -> Self {
        Self(Some(help))
    }
}

impl From<&str> for Help {
    fn from(help: &str) -> Self {
        Self(Some(help.to_owned()))
    }
}

impl Source {
    pub(crate) fn new(file: &str, text: &str) -> Self {
        Self { file: file.to_owned(), text: text.to_owned(), included: Vec::new() }
    }

    /// Returns the name of the file without its folders, which only messages need.
    pub(crate) fn file_name(&self) -> &str {
        file_name(&self.file)
    }

    /// Makes an error that a choice of the caller solves.
    pub(crate) fn error_with(
        &self,
        span: &Range<usize>,
        message: impl Into<String>,
        help: impl Into<Help>,
        remedy: &Remedy,
    ) -> Report {
        self.error(span, message, help).with_remedy(remedy)
    }

    /// Makes an error at some bytes of the text.
    pub(crate) fn error(&self, span: &Range<usize>, message: impl Into<String>, help: impl Into<Help>) -> Report {
        let Help(help) = help.into();
        let next = self.included.partition_point(|(start, _)| *start <= span.start);
        let (start, file) =
            next.checked_sub(1).map_or((0, &self.file), |at| (self.included[at].0, &self.included[at].1));
        let end = self.included.get(next).map_or(self.text.len(), |(start, _)| *start);
        let text = self.text.get(start..end).unwrap_or_default();
        let within = |at: usize| at.saturating_sub(start).min(text.len());
        Report::of_error(file, text, within(span.start)..within(span.end), message, help.as_deref())
    }
}

/// Returns the name of a file without its folders.
pub(crate) fn file_name(path: &str) -> &str {
    Path::new(path).file_name().and_then(OsStr::to_str).unwrap_or(path)
}

/// Largest number of names that a message lists; it only counts the others.
const NAMED: usize = 24;

/// Lists names for a message: `a`, `b` and 3 more.
pub(crate) fn names<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    some(names.into_iter().map(|name| quoted(name.as_ref())))
}

/// Joins items to a list for a message, up to a largest number.
pub(crate) fn some(items: impl IntoIterator<Item = String>) -> String {
    let items: Vec<String> = items.into_iter().collect();
    let shown = items[..items.len().min(NAMED)].join(", ");
    match items.len().saturating_sub(NAMED) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

/// Formats a name from the file for a message: one line, not too long.
pub(crate) fn quoted(name: &str) -> String {
    const LONGEST: usize = 60;
    let line = rne_model::one_line(name);
    if line.chars().count() <= LONGEST {
        return format!("`{line}`");
    }
    format!("`{}…`", line.chars().take(LONGEST).collect::<String>())
}
