//! Logs of an arm, by the joints of its robot file: the input of identification and watching.

mod error;
mod joints;
mod low_pass;
mod remark;

use std::path::PathBuf;

use rne_logs::{Log, Motion, Motions, Options, Survey, UtcTime};
use rne_model::{Robot, one_line};

pub use self::error::{ArmLogError, Mismatch, PassError};
pub use self::joints::{JointMatch, check_units, joint_options, match_joints};
use self::low_pass::{PART, WIDER, check_cutoff, highest};
pub use self::remark::ArmLogRemark;

/// Number of states that are read at once. The memory is proportional to it and to the number of joints.
const PIECE: usize = 65_536;

/// Logs of an arm that were opened and surveyed; reading them costs memory that does not grow with them.
///
/// ```no_run
/// use rne_identify::{ArmLog, ArmLogOptions, MotionError, Part, PassError, identify};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let text = std::fs::read_to_string("arm.yaml")?;
/// let robot = rne_model::Robot::from_yaml(&text).map_err(|report| report.to_string())?;
/// let log = ArmLog::open(&["motion.csv".into()], &robot, &ArmLogOptions::default())?;
/// let mut options = rne_identify::Options::default();
/// options.cutoff = Some(log.cutoff());
/// let found = identify::<PassError<MotionError>>(&robot, options, 1.0, |take| log.pass(Part::All, take))?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct ArmLog {
    log: Log,
    /// The options with which the log was opened.
    options: Options,
    survey: Survey,
    cutoff: f64,
    read_to: f64,
    remarks: Vec<ArmLogRemark>,
}

/// Options for opening the logs of an arm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmLogOptions {
    /// Facts that the logs do not contain. [`Options::cutoff`] is the cut-off, Hz, of the low-pass filter of both sides
    /// of the equations of motion; without it, the spectrum of the motion determines it. [`Options::slides`] and
    /// [`Options::leave_out_spikes`] are overwritten: the robot and the purpose determine them.
    pub log: Options,
    /// The purpose for which the logs are read.
    pub purpose: Purpose,
}

/// The purpose for which logs of an arm are read. It determines the cut-off of the filter that smooths and
/// differentiates the positions (the log's own filter), and whether spikes are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Purpose {
    /// To fit a model: the cut-off of the log's own filter is four times that of the low-pass filter, and spikes of
    /// efforts are left out.
    #[default]
    Fit,
    /// To judge a model: the filter is that of [`Purpose::Fit`], and nothing is left out.
    Judge,
    /// To find sudden events: the cut-off of the log's own filter is as high as possible, and nothing is left out.
    Watch,
}

impl Purpose {
    /// Ratio of the cut-off of the log's own filter to that of the low-pass filter.
    fn wider(self) -> f64 {
        if self == Self::Watch { f64::INFINITY } else { WIDER }
    }
}

/// Part of the logs, by time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// All states.
    All,
    /// The states before this fraction of the whole duration, 0 to 1.
    Before(f64),
    /// The states from this fraction of the whole duration on, 0 to 1.
    From(f64),
}

impl ArmLog {
    /// Opens logs of a robot and surveys them.
    ///
    /// # Errors
    /// When a log cannot be read; when its joints or their units are not those of the robot; when it has no efforts or
    /// no states; when the low-pass filter is not possible.
    pub fn open(paths: &[PathBuf], robot: &Robot, options: &ArmLogOptions) -> Result<Self, ArmLogError> {
        Self::open_with_progress(paths, robot, options, &mut |_| ())
    }

    /// Opens logs like [`ArmLog::open`] and reports the fraction that was read, 0 to 1, of each of two surveys.
    ///
    /// # Errors
    /// The errors of [`ArmLog::open`].
    pub fn open_with_progress(
        paths: &[PathBuf],
        robot: &Robot,
        options: &ArmLogOptions,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Self, ArmLogError> {
        let wider = options.purpose.wider();
        let mut options = Options { leave_out_spikes: options.purpose == Purpose::Fit, ..options.log.clone() };
        // the first survey takes no cut-off, so that it determines one from the spectrum
        let asked = options.cutoff.take();
        let (mut options, by_order) = joint_options(paths, robot, options)?;
        let log = Log::open(paths, options.clone())?;
        check_units(robot, log.layout())?;
        check_efforts(&log)?;
        let survey = log.survey(&mut *progress)?;
        // refuses logs whose unit of angles or efforts is unknown
        if survey.may_be_degrees(&log).is_some() || !log.unsaid_currents().is_empty() {
            log.motions(&survey)?;
        }
        if survey.counts.states == 0 {
            return Err(ArmLogError::NoStates { left_out: log.left_out(&survey) });
        }
        let of_motion = || survey.cutoff.hertz().map(|hertz| PART * hertz);
        let cutoff = asked.or_else(of_motion).ok_or(ArmLogError::NoCutoff)?;
        let highest = highest(&log);
        let longest = survey.runs.iter().map(|run| run.duration).fold(0.0, f64::max);
        check_cutoff(&log, cutoff, longest, |cutoff| {
            // without a finite ratio, the filter is as wide as possible and runs are used up to their ends
            if wider.is_finite() { log.left(&survey, (wider * cutoff).min(highest)) } else { longest }
        })?;
        let read_to = (wider * cutoff).min(highest);
        options.cutoff = Some(read_to);
        let log = Log::open(paths, options.clone())?;
        let survey = log.survey(progress)?;
        let remarks = by_order.into_iter().chain(remarks(&log, &survey)).collect();
        Ok(Self { log, options, survey, cutoff, read_to, remarks })
    }

    /// Opens the same logs with the filter for judging a model ([`Purpose::Judge`]). Runs that are too short for it are
    /// included.
    ///
    /// # Errors
    /// When a log cannot be read to its end.
    pub fn judged(&self, progress: &mut dyn FnMut(f64)) -> Result<Self, ArmLogError> {
        let read_to = (WIDER * self.cutoff).min(self.read_to);
        let options = Options { cutoff: Some(read_to), ..self.options.clone() };
        let log = Log::open(self.log.files(), options.clone())?;
        let survey = log.survey(progress)?;
        Ok(Self { log, options, survey, cutoff: self.cutoff, read_to, remarks: Vec::new() })
    }

    /// The cut-off of the low-pass of both sides of the equations of motion, Hz.
    #[must_use]
    pub fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// The cut-off of the log's own filter, Hz.
    #[must_use]
    pub fn read_to(&self) -> f64 {
        self.read_to
    }

    /// Remarks on the logs, in the order in which a reader should see them.
    #[must_use]
    pub fn remarks(&self) -> &[ArmLogRemark] {
        &self.remarks
    }

    /// The number of states.
    #[must_use]
    pub fn states(&self) -> u64 {
        self.survey.counts.states
    }

    /// The number of runs.
    #[must_use]
    pub fn runs(&self) -> u64 {
        self.survey.run_count
    }

    /// The log that is read, with its joints, units and files.
    #[must_use]
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// The survey of the log, made with the log's own filter.
    #[must_use]
    pub fn survey(&self) -> &Survey {
        &self.survey
    }

    /// The beginning and the end of the logs. `None` where their times do not count from 1970, and where they have more
    /// runs than a survey lists.
    #[must_use]
    pub fn span(&self) -> Option<[UtcTime; 2]> {
        let Survey { runs, run_count, .. } = &self.survey;
        if runs.is_empty() || u64::try_from(runs.len()) != Ok(*run_count) {
            return None;
        }
        let start = runs.iter().fold(f64::INFINITY, |least, run| least.min(run.start));
        let end = runs.iter().fold(f64::NEG_INFINITY, |most, run| most.max(run.start + run.duration));
        let layout = self.log.layout();
        Some([layout.utc(start)?, layout.utc(end)?])
    }

    /// The names of the files, the number of states and their rate, in words.
    #[must_use]
    pub fn summary(&self) -> String {
        let name = |file: &PathBuf| one_line(&file.file_name().unwrap_or_default().to_string_lossy());
        let files: Vec<String> = self.log.files().iter().map(name).collect();
        let files = match files.as_slice() {
            [one, two, three, ..] if files.len() > 3 => format!("{one}, {two}, {three} and {} more", files.len() - 3),
            few => few.join(", "),
        };
        format!("{files} ({} states at {:.0} Hz)", self.states(), 1.0 / self.log.layout().step)
    }

    /// Passes the motions of a part to `take`, up to the ends of runs. Near an end, the log's own filter has samples on
    /// one side only, but the low-pass filter leaves out a longer time there.
    ///
    /// # Errors
    /// When a log cannot be read to its end, or the function returns an error.
    pub fn pass<E>(&self, part: Part, take: &mut dyn FnMut(&Motion) -> Result<(), E>) -> Result<(), PassError<E>> {
        self.pass_with_progress(part, take, &mut |_| ())
    }

    /// Passes motions to `take` like [`ArmLog::pass`] and reports the fraction that was read, 0 to 1.
    ///
    /// # Errors
    /// The errors of [`ArmLog::pass`].
    pub fn pass_with_progress<E>(
        &self,
        part: Part,
        take: &mut dyn FnMut(&Motion) -> Result<(), E>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(), PassError<E>> {
        self.hand_on(self.motions()?.with_ends(), part, &mut |_, motion| take(motion), progress)
    }

    /// Passes the motions of a part without the ends of runs to `take`, each with the number of its run, from 0, and
    /// reports the fraction that was read, 0 to 1.
    ///
    /// # Errors
    /// The errors of [`ArmLog::pass`].
    pub fn pass_runs<E>(
        &self,
        part: Part,
        take: &mut dyn FnMut(u64, &Motion) -> Result<(), E>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(), PassError<E>> {
        self.hand_on(self.motions()?, part, take, progress)
    }

    fn motions<E>(&self) -> Result<Motions<'_>, PassError<E>> {
        self.log.motions(&self.survey).map_err(|error| PassError::Log(error.into()))
    }

    fn hand_on<E>(
        &self,
        motions: Motions<'_>,
        part: Part,
        take: &mut dyn FnMut(u64, &Motion) -> Result<(), E>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(), PassError<E>> {
        let runs = &self.survey.runs;
        let total: f64 = runs.iter().map(|run| run.duration).sum();
        let edge = |run: usize, edge: f64| {
            let before: f64 = runs.iter().take(run).map(|run| run.duration).sum();
            // the survey lists only the first runs; all later ones count as after the edge
            runs.get(run).map_or(f64::NEG_INFINITY, |run| run.start + edge * total - before)
        };
        let mut motions = motions.with_length(PIECE);
        while let Some(piece) = motions.next() {
            let piece = piece.map_err(|error| PassError::Log(error.into()))?;
            progress(motions.progress());
            let run = usize::try_from(piece.run).unwrap_or(usize::MAX);
            let motion = match part {
                Part::All => piece.motion,
                Part::Before(part) => cut(&piece.motion, |time| time < edge(run, part)),
                Part::From(part) => cut(&piece.motion, |time| time >= edge(run, part)),
            };
            if !motion.is_empty() {
                take(piece.run, &motion)?;
            }
        }
        Ok(())
    }
}

/// Returns the states at whose times `is_in` is true. These times must be one interval.
fn cut(motion: &Motion, is_in: impl Fn(f64) -> bool) -> Motion {
    let start = motion.time.iter().position(|time| is_in(*time)).unwrap_or(motion.len());
    let end = motion.time.iter().rposition(|time| is_in(*time)).map_or(start, |last| last + 1);
    let cut = |list: &[Vec<f64>]| list.iter().map(|column| column[start..end].to_vec()).collect();
    Motion {
        time: motion.time[start..end].to_vec(),
        q: cut(&motion.q),
        qd: cut(&motion.qd),
        qdd: cut(&motion.qdd),
        tau: cut(&motion.tau),
        recorded: cut(&motion.recorded),
    }
}

/// Returns the remarks on a log that has efforts of all joints.
fn remarks(log: &Log, survey: &Survey) -> Vec<ArmLogRemark> {
    let mut remarks: Vec<ArmLogRemark> = log.remarks(survey).into_iter().map(ArmLogRemark::Log).collect();
    for (joint, (least, greatest)) in log.layout().joints.iter().zip(&survey.efforts) {
        if least == greatest {
            remarks.push(ArmLogRemark::ConstantEffort { joint: joint.clone(), effort: *least });
        }
    }
    remarks.extend(log.left_out(survey).into_iter().map(ArmLogRemark::LeftOut));
    remarks
}

/// Refuses a log without efforts of all joints.
fn check_efforts(log: &Log) -> Result<(), ArmLogError> {
    let layout = log.layout();
    let missing = &layout.without_efforts;
    if layout.has_efforts {
        Ok(())
    } else if missing.is_empty() || missing.len() == layout.joints.len() {
        Err(ArmLogError::NoEfforts { logged: layout.joints.clone(), unread: layout.unread.clone() })
    } else {
        Err(ArmLogError::MissingEfforts { logged: missing.clone() })
    }
}
