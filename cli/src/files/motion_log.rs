//! The logs of one arm. They are opened with the joints of its robot file, and a progress bar shows how far they were
//! read.

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

    /// Opens logs of a robot to compare them with a baseline, whose low-pass, Hz, they take.
    pub(crate) fn open_beside(
        paths: &[PathBuf],
        robot: &Robot,
        arguments: &LogArguments,
        cutoff: f64,
    ) -> Result<Self, Failure> {
        Self::opened(paths, robot, &arguments.with_cutoff(cutoff), Purpose::Watch).map_err(|error| match error {
            // another low-pass is no remedy
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

    /// The logs themselves.
    pub(crate) fn log(&self) -> &ArmLog {
        &self.0
    }

    /// The day of the first state, UTC, such as 2026-11-23; none where times do not count from 1970.
    pub(crate) fn day(&self) -> Option<String> {
        self.0.log().layout().utc(0.0).map(UtcTime::day)
    }

    /// The logs through the filter with which a robot file is judged; runs that are too short for it are included.
    pub(crate) fn judged(&self) -> Result<Self, Failure> {
        self.0.judged(&mut reading::progress(false)).map(Self).map_err(|error| failure(&error))
    }

    /// Hz: the low-pass of both sides of the equations of motion.
    pub(crate) fn cutoff(&self) -> f64 {
        self.0.cutoff()
    }

    /// Hz: the log's own filter.
    pub(crate) fn read_to(&self) -> f64 {
        self.0.read_to()
    }

    /// Remarks on the log.
    pub(crate) fn remark(&self) -> String {
        self.remark_beside(&[])
    }

    /// Remarks on the log that are not among others.
    pub(crate) fn remark_beside(&self, others: &[ArmLogRemark]) -> String {
        let new = self.0.remarks().iter().filter(|remark| !others.contains(remark));
        let line = |remark: &ArmLogRemark| {
            let styled = if remark.is_warning() { warning } else { note };
            styled(&one_line(&remark_sentence(remark)))
        };
        new.map(line).collect()
    }

    /// Summary of the log, in words.
    pub(crate) fn words(&self) -> String {
        self.0.summary()
    }

    /// How many states there are.
    pub(crate) fn states(&self) -> u64 {
        self.0.states()
    }

    /// How many runs there are.
    pub(crate) fn runs(&self) -> u64 {
        self.0.runs()
    }

    /// Hands the motions of a part to a function, up to the ends of runs.
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

/// The failure for logs that cannot be watched; `words` name them.
pub(crate) fn watch_failure(error: &WatchError, words: &str) -> Failure {
    match error {
        WatchError::Log(error) => failure(error),
        WatchError::TooFew { .. } => input_error!("{words} is too short to watch"),
        other => input_error!("{words}: {other}"),
    }
}

/// The failure for an error of the logs of an arm.
pub(crate) fn failure(error: &ArmLogError) -> Failure {
    let text = error_sentence(error);
    if error.is_of_request() { Failure::usage(text) } else { Failure::input(text) }
}
