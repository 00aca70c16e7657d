//! From the text of a robot file to a validated robot, or to a report of everything that is wrong with it.

use crate::decode::Context;
use crate::diagnostic::{Problems, Report};
use crate::{Robot, document, schema, source};

/// A valid robot file: the robot, and what is remarkable about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    /// The robot.
    pub robot: Robot,
    /// Lints: warnings only, often none.
    pub lints: Report,
}

/// Reads and checks the text of a robot file; `name` is what the messages call it, usually its path.
///
/// # Errors
///
/// Everything that is wrong with the file, with line, column and what is allowed.
pub fn check(name: &str, text: &str) -> Result<Checked, Report> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let problems = Problems::new();
    if !source::size_is_fine(text.len(), &problems) {
        return Err(problems.finish(name, ""));
    }
    let robot = source::is_printable(text, &problems)
        .then(|| document::parse(text, &problems))
        .flatten()
        .and_then(|root| schema::robot(&Context::new(text, &problems), &root));
    let report = problems.finish(name, text);
    match robot {
        Some(robot) if !report.has_errors() => Ok(Checked { robot, lints: report }),
        _ => Err(report),
    }
}

/// As [`check`], for bytes that may not be text.
///
/// # Errors
///
/// As [`check`]; bytes that are not UTF-8 are an error at the first of them.
pub fn check_bytes(name: &str, bytes: &[u8]) -> Result<Checked, Report> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let error = match std::str::from_utf8(bytes) {
        Ok(text) => return check(name, text),
        Err(error) => error,
    };
    let problems = Problems::new();
    if !source::size_is_fine(bytes.len(), &problems) {
        return Err(problems.finish(name, ""));
    }
    source::not_utf8(bytes, error, &problems);
    Err(problems.finish(name, &String::from_utf8_lossy(bytes)))
}

impl Robot {
    /// Reads a robot file that is at hand as text; lints are not reported. [`check`] reports them.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with the text.
    pub fn from_yaml(text: &str) -> Result<Self, Report> {
        check("<yaml>", text).map(|checked| checked.robot)
    }
}
