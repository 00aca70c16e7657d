//! The result of a command: text for the reader, or an error.

use rne_codegen::{CompileError, Remedy};
use rne_model::Report;
use serde::Serialize;

use crate::palette::{ERROR, coloured};
use crate::remedy;

/// Exit status for an error in a file or its contents.
pub(crate) const INPUT: u8 = 1;

/// Exit status for an error in the command line.
pub(crate) const USAGE: u8 = 2;

/// The result of a command that did its work.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    /// Text for standard output, with styles.
    pub(crate) text: String,
    /// Remarks for standard error, with styles; they are no part of the answer.
    pub(crate) remark: String,
    /// Whether the remarks are printed after the text, because the text begins with a verdict.
    pub(crate) remark_last: bool,
    /// Whether the exit status must say that the input is wrong, although the command did its work.
    pub(crate) at_fault: bool,
}

impl Outcome {
    pub(crate) fn text(text: String) -> Self {
        Self { text, ..Self::default() }
    }

    pub(crate) fn json(value: &impl Serialize) -> Result<Self, Failure> {
        let text = serde_json::to_string_pretty(value).map_err(Failure::input)?;
        Ok(Self::text(text + "\n"))
    }

    /// Returns JSON on one line: with deep nesting, lines of one bracket each would not help a reader.
    pub(crate) fn json_line(value: &impl Serialize) -> Result<Self, Failure> {
        let text = serde_json::to_string(value).map_err(Failure::input)?;
        Ok(Self::text(text + "\n"))
    }

    pub(crate) fn remark(remark: String) -> Self {
        Self { remark, ..Self::default() }
    }
}

/// Makes a failure for an error in a file or its contents, from the arguments of `format!`.
macro_rules! input_error {
    ($($message:tt)*) => { $crate::outcome::Failure::input(format_args!($($message)*)) };
}

/// Makes a failure for an error in the command line, from the arguments of `format!`.
macro_rules! usage_error {
    ($($message:tt)*) => { $crate::outcome::Failure::usage(format_args!($($message)*)) };
}

/// The failure of a command that could not do its work.
#[derive(Debug)]
pub(crate) struct Failure {
    /// The message with the mistake and the remedy, with styles.
    pub(crate) text: String,
    pub(crate) status: u8,
}

impl Failure {
    /// Makes a failure for an error in a file or its contents.
    pub(crate) fn input(message: impl std::fmt::Display) -> Self {
        Self { text: headed(message), status: INPUT }
    }

    /// Returns whether the error is in a file or its contents, and not in the command line.
    pub(crate) fn is_of_input(&self) -> bool {
        self.status == INPUT
    }

    /// Returns the message without its beginning, such as `error:`, and without styles.
    pub(crate) fn sentence(&self) -> String {
        let text = anstream::adapter::strip_str(&self.text).to_string();
        text.strip_prefix("error: ").unwrap_or(&text).to_owned()
    }

    /// Makes a failure for an error in the command line.
    pub(crate) fn usage(message: impl std::fmt::Display) -> Self {
        Self { text: headed(message), status: USAGE }
    }

    /// Makes a failure for a name on the command line that a file without errors does not have.
    pub(crate) fn unknown_name(report: &Report) -> Self {
        Self { status: USAGE, ..Self::from(report) }
    }

    /// Makes a failure for a valid robot that cannot be compiled.
    pub(crate) fn compile(file: &str, error: &CompileError) -> Self {
        Self::input(format_args!("{file}: {}", remedy::of_compiler(error)))
    }

    /// Makes a failure for a mistake in a plan file, with a remedy.
    pub(crate) fn plan(report: Report, remedy: Remedy) -> Self {
        Self::from(&remedy::of_plan(report, remedy))
    }
}

/// Converts errors of a motion.
impl From<rne_identify::MotionError> for Failure {
    fn from(error: rne_identify::MotionError) -> Self {
        Self::input(error)
    }
}

/// Converts errors of a robot file, which the compiler shows in the same form.
impl From<&Report> for Failure {
    fn from(report: &Report) -> Self {
        Self { text: rendered(report), status: INPUT }
    }
}

/// Renders a report with colours.
pub(crate) fn rendered(report: &Report) -> String {
    let report = remedy::worded(report);
    coloured(&report.render(false), &report.render(true))
}

fn headed(message: impl std::fmt::Display) -> String {
    format!("{ERROR}error{ERROR:#}: {message}")
}
