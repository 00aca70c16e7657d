//! Opens the logs of one arm, with the joints of its robot file, and shows a progress bar while they are read.

use std::fmt::Display;
use std::path::PathBuf;

use rne_identify::{ArmLog, ArmLogError, ArmLogOptions, ArmLogRemark, Options, Part, PassError, Purpose};
use rne_logs::{Motion, UtcTime};
use rne_model::{Robot, one_line};

use crate::files::reading;
use crate::outcome::Failure;
use crate::render::layout::{note, warning};
use crate::render::log_remark::{error_sentence, remark_sentence};
use crate::values::log_arguments::LogArguments;
use rne_watch::WatchError;

fn names(paths: &[PathBuf]) -> String {
    let name = |path: &PathBuf| one_line(&path.file_name().unwrap_or_default().to_string_lossy());
    paths.iter().map(name).collect::<Vec<_>>().join(", ")
}

/// Logs of an arm.
pub(crate) struct MotionLog(ArmLog);

impl MotionLog {
    /// Opens logs of a robot for a purpose.
    pub(crate) fn open(
        paths: &[PathBuf],
        robot: &Robot,
        arguments: &LogArguments,
        purpose: Purpose,
    ) -> Result<Self, Failure> {
        Self::opened(paths, robot, arguments, purpose).map_err(|error| failure(&error))
    }

    /// Opens logs of a robot for comparison with a baseline; the low-pass filter gets the cut-off of the baseline, Hz.
    pub(crate) fn open_beside(
        paths: &[PathBuf],
        robot: &Robot,
        arguments: &LogArguments,
        cutoff: f64,
    ) -> Result<Self, Failure> {
        Self::opened(paths, robot, &arguments.with_cutoff(cutoff), Purpose::Watch).map_err(|error| match error {
            // the cut-off is that of the baseline, so the help must not propose another one
            ArmLogError::Cutoff { longest, possible: Some(_), .. } => input_error!(
                "{}: {}",
                names(paths),
                WatchError::ShortLog { duration: longest, needed: 2.0 * Options::filter_reach(cutoff), cutoff }
            ),
            error => failure(&error),
        })
    }

    fn opened(
        paths: &[PathBuf],
        robot: &Robot,
        arguments: &LogArguments,
        purpose: Purpose,
    ) -> Result<Self, ArmLogError> {
        let options = ArmLogOptions { log: arguments.options(), purpose };
        ArmLog::open_with_progress(paths, robot, &options, &mut reading::progress(false)).map(Self)
    }

    /// Returns the underlying logs.
    pub(crate) fn log(&self) -> &ArmLog {
        &self.0
    }

    /// Returns the day of the first state, UTC, such as 2026-11-23; `None` if times do not count from 1970.
    pub(crate) fn day(&self) -> Option<String> {
        self.0.log().layout().utc(0.0).map(UtcTime::day)
    }

    /// Returns the logs with the filter for judging a robot file; runs that are too short for the filter are included.
    pub(crate) fn judged(&self) -> Result<Self, Failure> {
        self.0.judged(&mut reading::progress(false)).map(Self).map_err(|error| failure(&error))
    }

    /// Returns the cut-off of the low-pass filter on both sides of the equations of motion, Hz.
    pub(crate) fn cutoff(&self) -> f64 {
        self.0.cutoff()
    }

    /// Returns the cut-off of the filter with which the log itself is read, Hz.
    pub(crate) fn read_to(&self) -> f64 {
        self.0.read_to()
    }

    /// Returns the remarks on the log.
    pub(crate) fn remark(&self) -> String {
        self.remark_beside(&[])
    }

    /// Returns the remarks on the log that are not among `others`.
    pub(crate) fn remark_beside(&self, others: &[ArmLogRemark]) -> String {
        let new = self.0.remarks().iter().filter(|remark| !others.contains(remark));
        let line = |remark: &ArmLogRemark| {
            let styled = if remark.is_warning() { warning } else { note };
            styled(&one_line(&remark_sentence(remark)))
        };
        new.map(line).collect()
    }

    /// Returns a summary of the log in words.
    pub(crate) fn words(&self) -> String {
        self.0.summary()
    }

    /// Returns the number of states.
    pub(crate) fn states(&self) -> u64 {
        self.0.states()
    }

    /// Returns the number of runs.
    pub(crate) fn runs(&self) -> u64 {
        self.0.runs()
    }

    /// Passes the motions of a part of the log to a function, one run after the other.
    pub(crate) fn pass<E: Display>(
        &self,
        part: Part,
        take: &mut dyn FnMut(&Motion) -> Result<(), E>,
    ) -> Result<(), Failure> {
        self.0.pass_with_progress(part, take, &mut reading::progress(false)).map_err(stopped)
    }
}

fn stopped<E: Display>(error: PassError<E>) -> Failure {
    match error {
        PassError::Log(error) => failure(&error),
        PassError::Motion(error) => Failure::input(error),
    }
}

/// Makes the error for logs that cannot be watched; `words` name the logs.
pub(crate) fn watch_failure(error: &WatchError, words: &str) -> Failure {
    match error {
        WatchError::Log(error) => failure(error),
        WatchError::TooFew { .. } => input_error!("{words} is too short to watch"),
        other => input_error!("{words}: {other}"),
    }
}

/// Makes the error for logs of an arm that cannot be used.
pub(crate) fn failure(error: &ArmLogError) -> Failure {
    let text = error_sentence(error);
    if error.is_of_request() { Failure::usage(text) } else { Failure::input(text) }
}
