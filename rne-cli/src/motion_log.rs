//! Logs of an arm, by the joints of its robot file.

use std::fmt::Display;
use std::path::PathBuf;

use clap::Args;
use rne_logs::{Dimension, JointUnits, Layout, Log, LogError, Motion, Options, Survey};
use rne_model::{JointKind, Robot, one_line};

use crate::outcome::Failure;
use crate::terminal::TYPED;

/// States that are read at once: memory is this by the number of joints.
const PIECE: usize = 65_536;

/// The log's own filter passes so much more than the one behind it, so that it shapes no torque.
const WIDER: f64 = 4.0;

/// The low-pass of both sides, of the filter that the spectrum chooses: what moves passes, and most noise does not.
const PART: f64 = 0.5;

/// Of the rate: no filter of the log may be wider.
const HIGHEST: f64 = 0.3;

/// How a log is read.
#[derive(Args, Clone)]
pub(crate) struct LogArguments {
    /// Joints of the log, base to tip
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    joints: Vec<String>,
    /// The topic of a bag
    #[arg(long, value_name = "TOPIC")]
    topic: Option<String>,
    /// N m/A of each joint or of all: efforts are currents
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',')]
    torque_constants: Vec<f64>,
    /// The low-pass; by the spectrum, unless given
    #[arg(long, value_name = "HZ", value_parser = hertz)]
    cutoff: Option<f64>,
}

impl LogArguments {
    /// The same with this low-pass, Hz.
    pub(crate) fn with_cutoff(&self, cutoff: f64) -> Self {
        Self { cutoff: Some(cutoff), ..self.clone() }
    }
}

fn hertz(text: &str) -> Result<f64, String> {
    let hertz = text.parse().ok().filter(|hertz: &f64| hertz.is_finite() && *hertz > 0.0);
    hertz.ok_or_else(|| "a cut-off is a number of Hz above 0, such as 2".to_owned())
}

/// Logs that were opened and surveyed.
pub(crate) struct MotionLog {
    log: Log,
    survey: Survey,
    /// Hz: what both sides pass.
    pub(crate) cutoff: f64,
    /// Hz: the log's own filter.
    pub(crate) read_to: f64,
    /// What a reader should know of it.
    pub(crate) remarks: Vec<String>,
}

/// Which part of the logs, by time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part {
    All,
    /// Before this part of the whole, 0 to 1.
    Before(f64),
    From(f64),
}

impl MotionLog {
    /// Opens logs of a robot; the log's own filter passes what a motion may have.
    pub(crate) fn open(paths: &[PathBuf], robot: &Robot, arguments: &LogArguments) -> Result<Self, Failure> {
        Self::open_with(paths, robot, arguments, WIDER)
    }

    /// Opens logs of a robot; the log's own filter passes all that it may, for what is sudden.
    pub(crate) fn open_wide(paths: &[PathBuf], robot: &Robot, arguments: &LogArguments) -> Result<Self, Failure> {
        Self::open_with(paths, robot, arguments, f64::INFINITY)
    }

    fn open_with(paths: &[PathBuf], robot: &Robot, arguments: &LogArguments, wider: f64) -> Result<Self, Failure> {
        let mut options = Options {
            topic: arguments.topic.clone(),
            torque_constants: arguments.torque_constants.clone(),
            joints: (!arguments.joints.is_empty()).then(|| arguments.joints.clone()),
            ..Options::default()
        };
        let mut remarks = Vec::new();
        if options.joints.is_none() {
            let log = Log::open(paths, Options { torque_constants: Vec::new(), ..options.clone() }).map_err(failure)?;
            options.joints = Some(matched(robot, &log.layout().joints, &mut remarks)?);
        }
        let log = Log::open(paths, options.clone()).map_err(failure)?;
        check_units(robot, log.layout())?;
        if !log.layout().has_efforts {
            return Err(Failure::input("the log has no efforts, and torques are what a model is held against"));
        }
        let survey = log.survey(|_| ()).map_err(failure)?;
        let of_motion = || survey.cutoff.hertz().map(|hertz| PART * hertz);
        let cutoff = arguments.cutoff.or_else(of_motion).ok_or_else(|| {
            Failure::input(format_args!("no run is long enough to choose a low-pass; say {TYPED}--cutoff HZ{TYPED:#}"))
        })?;
        let rate = 1.0 / log.layout().step;
        let read_to = (wider * cutoff).min(HIGHEST * rate);
        let log = Log::open(paths, Options { cutoff: Some(read_to), ..options }).map_err(failure)?;
        let survey = log.survey(|_| ()).map_err(failure)?;
        remarks.extend(log.layout().notes.iter().map(|note| one_line(note)));
        Ok(Self { log, survey, cutoff, read_to, remarks })
    }

    /// What was read, in words.
    pub(crate) fn words(&self) -> String {
        let files: Vec<String> = self
            .log
            .files()
            .iter()
            .map(|file| one_line(&file.file_name().unwrap_or_default().to_string_lossy()))
            .collect();
        let files = match files.as_slice() {
            [one, two, three, ..] if files.len() > 3 => format!("{one}, {two}, {three} and {} more", files.len() - 3),
            few => few.join(", "),
        };
        format!("{files} ({} states at {:.0} Hz)", self.survey.counts.states, 1.0 / self.log.layout().step)
    }

    /// How many states there are.
    pub(crate) fn states(&self) -> u64 {
        self.survey.counts.states
    }

    /// How many runs there are.
    pub(crate) fn runs(&self) -> u64 {
        self.survey.run_count
    }

    /// Hands the motions of a part to what takes them.
    pub(crate) fn pass<E: Display>(
        &self,
        part: Part,
        take: &mut dyn FnMut(&Motion) -> Result<(), E>,
    ) -> Result<(), Failure> {
        self.pass_runs(part, &mut |_, motion| take(motion))
    }

    /// Hands the motions of a part to what takes them, each with the number of its run, from 0.
    pub(crate) fn pass_runs<E: Display>(
        &self,
        part: Part,
        take: &mut dyn FnMut(u64, &Motion) -> Result<(), E>,
    ) -> Result<(), Failure> {
        let runs = &self.survey.runs;
        let total: f64 = runs.iter().map(|run| run.duration).sum();
        let edge = |run: usize, edge: f64| {
            let before: f64 = runs.iter().take(run).map(|run| run.duration).sum();
            // of runs that are not listed nothing is known: they are behind
            runs.get(run).map_or(f64::NEG_INFINITY, |run| run.start + edge * total - before)
        };
        for piece in self.log.motions(&self.survey).map_err(failure)?.with_length(PIECE) {
            let piece = piece.map_err(failure)?;
            let run = usize::try_from(piece.run).unwrap_or(usize::MAX);
            let motion = match part {
                Part::All => piece.motion,
                Part::Before(part) => cut(&piece.motion, |time| time < edge(run, part)),
                Part::From(part) => cut(&piece.motion, |time| time >= edge(run, part)),
            };
            if !motion.is_empty() {
                take(piece.run, &motion).map_err(Failure::input)?;
            }
        }
        Ok(())
    }
}

/// The states at the times that are asked for: they follow each other.
fn cut(motion: &Motion, is_in: impl Fn(f64) -> bool) -> Motion {
    let start = motion.time.iter().position(|time| is_in(*time)).unwrap_or(motion.len());
    let end = motion.time.iter().rposition(|time| is_in(*time)).map_or(start, |last| last + 1);
    let of = |list: &[Vec<f64>]| list.iter().map(|column| column[start..end].to_vec()).collect();
    Motion {
        time: motion.time[start..end].to_vec(),
        q: of(&motion.q),
        qd: of(&motion.qd),
        qdd: of(&motion.qdd),
        tau: of(&motion.tau),
    }
}

/// The joints of the log that are those of the robot, base to tip.
fn matched(robot: &Robot, logged: &[String], remarks: &mut Vec<String>) -> Result<Vec<String>, Failure> {
    let names: Vec<String> = robot.joints.iter().map(|joint| joint.name.clone()).collect();
    if names.iter().all(|name| logged.contains(name)) {
        return Ok(names);
    }
    if logged.len() == names.len() {
        let logged: Vec<String> = logged.iter().map(|name| one_line(name)).collect();
        remarks.push(format!("joints of the log by their order: {}", logged.join(", ")));
        return Ok(logged);
    }
    let shown: Vec<String> = logged.iter().take(16).map(|name| one_line(name)).collect();
    Err(Failure::usage(format_args!(
        "the log has {} joints, the robot {}; {TYPED}--joints{TYPED:#} names those of the log, base to tip: {}",
        logged.len(),
        names.len(),
        shown.join(",")
    )))
}

/// Units that names of columns say are those of the robot's joints: what turns has no position in mm.
pub(crate) fn check_units(robot: &Robot, layout: &Layout) -> Result<(), Failure> {
    for ((joint, logged), units) in robot.joints.iter().zip(&layout.joints).zip(&layout.units) {
        let JointUnits { position, velocity, effort, .. } = *units;
        let kind = joint.row.kind;
        let (motion, force) = match kind {
            JointKind::Revolute => (Dimension::Angle, Dimension::Torque),
            JointKind::Prismatic => (Dimension::Length, Dimension::Force),
        };
        let is_other =
            |said: Option<Dimension>, own| said.is_some_and(|said| said != own && said != Dimension::Current);
        let quantity = if is_other(position, motion) {
            "positions"
        } else if is_other(velocity, motion) {
            "velocities"
        } else if is_other(effort, force) {
            "efforts"
        } else {
            continue;
        };
        let does = if kind == JointKind::Revolute { "turns" } else { "slides" };
        return Err(Failure::usage(format_args!(
            "the joint {} of the robot {does}, and by the names of the log's columns the {quantity} of its {} are not \
             of one that does",
            one_line(&joint.name),
            one_line(logged)
        )));
    }
    Ok(())
}

/// A log that cannot be read, or a request that it cannot serve.
pub(crate) fn failure(error: LogError) -> Failure {
    if error.is_of_request() { Failure::usage(error) } else { Failure::input(error) }
}
