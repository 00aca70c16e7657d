//! The text that is read, and mistakes in it.

use std::ffi::OsStr;
use std::ops::Range;
use std::path::Path;

use rne_model::{Remedy, Report};

/// A text and what messages call it.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub(crate) file: String,
    pub(crate) text: String,
}

impl Source {
    /// The name of the file without its folders: where they are matters to messages alone.
    pub(crate) fn file_name(&self) -> &str {
        Path::new(&self.file).file_name().and_then(OsStr::to_str).unwrap_or(&self.file)
    }

    /// A mistake against which a choice of the caller helps.
    pub(crate) fn error_with(&self, span: &Range<usize>, message: String, help: String, remedy: &Remedy) -> Report {
        self.error(span, message, help).with_remedy(remedy)
    }

    /// A mistake at some bytes of the text.
    pub(crate) fn error(
        &self,
        span: &Range<usize>,
        message: impl Into<String>,
        help: impl Into<Option<String>>,
    ) -> Report {
        let help: Option<String> = help.into();
        Report::of_error(&self.file, &self.text, span.clone(), message, help.as_deref())
    }
}

/// Largest number of names in a message, which counts the others.
const NAMED: usize = 24;

/// Names for a message: `a`, `b` and 3 more.
pub(crate) fn names<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    some(names.into_iter().map(|name| quoted(name.as_ref())))
}

/// A list for a message, not too long.
pub(crate) fn some(items: impl IntoIterator<Item = String>) -> String {
    let items: Vec<String> = items.into_iter().collect();
    let shown = items[..items.len().min(NAMED)].join(", ");
    match items.len().saturating_sub(NAMED) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

/// A name of the file in a message: one line, not too long.
pub(crate) fn quoted(name: &str) -> String {
    const LONGEST: usize = 60;
    let line = rne_model::one_line(name);
    if line.chars().count() <= LONGEST {
        return format!("`{line}`");
    }
    format!("`{}…`", line.chars().take(LONGEST).collect::<String>())
}
