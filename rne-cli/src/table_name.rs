//! Names of tables that are written: the end of a name says the format, and no other is written into it.

use std::path::Path;

use crate::outcome::Failure;
use crate::terminal::TYPED;

/// A format that is written.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Format {
    Csv,
    Npy,
}

impl Format {
    fn end(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Npy => "npy",
        }
    }
}

/// The format that a name says, of those that can be written.
pub(crate) fn format(path: &Path, written: &[Format]) -> Result<Format, Failure> {
    let end = path.extension().map(|end| end.to_string_lossy().to_lowercase());
    if let Some(format) = written.iter().find(|format| end.as_deref() == Some(format.end())) {
        return Ok(*format);
    }
    let ends: Vec<String> = written.iter().map(|format| format!("{TYPED}.{}{TYPED:#}", format.end())).collect();
    let shown = path.display();
    let has = match end {
        Some(end) => format!("{shown} ends with .{end}, which is not written"),
        None => format!("the name {shown} does not say its format"),
    };
    Err(Failure::usage(format_args!("{has}; name a file that ends with {}", ends.join(" or "))))
}
