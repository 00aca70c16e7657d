//! Logs of an arm, by the joints of its robot file: opened and read below a bar.

use std::fmt::{Display, Write as _};
use std::path::PathBuf;

use rne_identify::{ArmLog, ArmLogError, ArmLogOptions, Part, PassError, Purpose};
use rne_logs::Motion;
use rne_model::{Robot, one_line};

use crate::files::reading;
use crate::outcome::Failure;
use crate::palette::{TITLE, WARNING};
use crate::render::layout::wrap;
use crate::render::log_remark::{error_sentence, remark_sentence};
use crate::values::log_arguments::LogArguments;

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
        let options = ArmLogOptions { log: arguments.options(), purpose };
        let bar = reading::bar("read", false);
        let log = ArmLog::open_with_progress(paths, robot, &options, &mut |share| reading::show(&bar, share));
        log.map(Self).map_err(|error| failure(&error))
    }

    /// The logs through the filter with which a robot file is judged; runs that are too short for it are included.
    pub(crate) fn judged(&self) -> Result<Self, Failure> {
        let bar = reading::bar("read", false);
        self.0.judged(&mut |share| reading::show(&bar, share)).map(Self).map_err(|error| failure(&error))
    }

    /// Hz: the low-pass of both sides of the equations of motion.
    pub(crate) fn cutoff(&self) -> f64 {
        self.0.cutoff()
    }

    /// Hz: the log's own filter.
    pub(crate) fn read_to(&self) -> f64 {
        self.0.read_to()
    }

    /// Remarks on the log, in lines of a width.
    pub(crate) fn remark(&self, width: usize) -> String {
        let mut text = String::new();
        for remark in self.0.remarks() {
            let Some(line) = remark_sentence(remark) else { continue };
            let (word, style) = if remark.is_warning() { ("warning", WARNING) } else { ("note", TITLE) };
            let indent = " ".repeat(word.len() + 2);
            let wrapped = wrap(&one_line(&line), width - indent.len(), &indent);
            let _ = writeln!(text, "{style}{word}{style:#}: {wrapped}");
        }
        text
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
        let bar = reading::bar("read", false);
        self.0.pass_with_progress(part, take, &mut |share| reading::show(&bar, share)).map_err(stopped)
    }

    /// The same without the ends of runs, each motion with the number of its run, from 0.
    pub(crate) fn pass_runs<E: Display>(
        &self,
        part: Part,
        take: &mut dyn FnMut(u64, &Motion) -> Result<(), E>,
    ) -> Result<(), Failure> {
        let bar = reading::bar("read", false);
        self.0.pass_runs(part, take, &mut |share| reading::show(&bar, share)).map_err(stopped)
    }
}

fn stopped<E: Display>(error: PassError<E>) -> Failure {
    match error {
        PassError::Log(error) => failure(&error),
        PassError::Motion(error) => Failure::input(error),
    }
}

/// The failure for an error of the logs of an arm.
pub(crate) fn failure(error: &ArmLogError) -> Failure {
    let text = error_sentence(error);
    if error.is_of_request() { Failure::usage(text) } else { Failure::input(text) }
}
