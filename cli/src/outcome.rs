//! Result of a command: text for the reader, or an error.

use rne_codegen::{CompileError, Remedy};
use rne_model::Report;
use serde::Serialize;

use crate::palette::{ERROR, coloured};
use crate::remedy;

/// Exit status when the input is at fault.
pub(crate) const INPUT: u8 = 1;

/// Exit status when the command line is at fault.
pub(crate) const USAGE: u8 = 2;

/// A command that did its work.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    /// For standard output, styled.
    pub(crate) text: String,
    /// Remarks for standard error, styled: not part of the answer.
    pub(crate) remark: String,
    /// Whether the remarks come after the text: a text that begins with a verdict comes first.
    pub(crate) remark_last: bool,
    /// Whether the answer is that the input is at fault.
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

    /// JSON without blanks: of what is nested deeply, lines of one bracket each are no help to a reader.
    pub(crate) fn json_line(value: &impl Serialize) -> Result<Self, Failure> {
        let text = serde_json::to_string(value).map_err(Failure::input)?;
        Ok(Self::text(text + "\n"))
    }

    pub(crate) fn remark(remark: String) -> Self {
        Self { remark, ..Self::default() }
    }
}

/// A failure where something is wrong with a file or its contents, with the arguments of `format!`.
macro_rules! input_error {
    ($($message:tt)*) => { $crate::outcome::Failure::input(format_args!($($message)*)) };
}

/// A failure where something is wrong with the command line, with the arguments of `format!`.
macro_rules! usage_error {
    ($($message:tt)*) => { $crate::outcome::Failure::usage(format_args!($($message)*)) };
}

/// A command that could not do its work.
#[derive(Debug)]
pub(crate) struct Failure {
    /// Message with the mistake and the remedy, with styles.
    pub(crate) text: String,
    pub(crate) status: u8,
}

impl Failure {
    /// Something is wrong with a file or its contents.
    pub(crate) fn input(message: impl std::fmt::Display) -> Self {
        Self { text: headed(message), status: INPUT }
    }

    /// Whether something is wrong with a file or its contents, and not with the command line.
    pub(crate) fn is_of_input(&self) -> bool {
        self.status == INPUT
    }

    /// The message without its head and without styles.
    pub(crate) fn sentence(&self) -> String {
        let text = anstream::adapter::strip_str(&self.text).to_string();
        text.strip_prefix("error: ").unwrap_or(&text).to_owned()
    }

    /// Something is wrong with the command line.
    pub(crate) fn usage(message: impl std::fmt::Display) -> Self {
        Self { text: headed(message), status: USAGE }
    }

    /// The command line names what the file, which is in order, does not have.
    pub(crate) fn unknown_name(report: &Report) -> Self {
        Self { status: USAGE, ..Self::from(report) }
    }

    /// The robot is valid but cannot be compiled.
    pub(crate) fn compile(file: &str, error: &CompileError) -> Self {
        Self::input(format_args!("{file}: {}", remedy::of_compiler(error)))
    }

    /// A mistake of a plan file, with what helps.
    pub(crate) fn plan(report: Report, remedy: Remedy) -> Self {
        Self::from(&remedy::of_plan(report, remedy))
    }
}

/// Errors of a motion.
impl From<rne_identify::MotionError> for Failure {
    fn from(error: rne_identify::MotionError) -> Self {
        Self::input(error)
    }
}

/// Errors of a robot file, as the compiler shows them too.
impl From<&Report> for Failure {
    fn from(report: &Report) -> Self {
        Self { text: rendered(report), status: INPUT }
    }
}

/// A report in colours.
pub(crate) fn rendered(report: &Report) -> String {
    let report = remedy::worded(report);
    coloured(&report.render(false), &report.render(true))
}

fn headed(message: impl std::fmt::Display) -> String {
    format!("{ERROR}error{ERROR:#}: {message}")
}
