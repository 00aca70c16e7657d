//! Logs of an arm, by the joints of its robot file.

use std::fmt::{Display, Write as _};
use std::path::PathBuf;

use rne_logs::{
    Dimension, JointUnits, Layout, Log, LogError, Mapping, Motion, Motions, Options, Quantity, Survey, Target,
    suggested,
};
use rne_model::{JointKind, Robot, one_line};

use crate::files::reading;
use crate::outcome::Failure;
use crate::palette::{TITLE, TYPED, WARNING};
use crate::render::layout::wrap;
use crate::render::log_remedy;
use crate::render::log_report::{left_out, notes};
use crate::values::log_arguments::{self, LogArguments};
use crate::values::numbers::rounded;

/// States that are read at once: memory is this by the number of joints.
const PIECE: usize = 65_536;

/// Ratio of the cut-off of the log's own filter to that of the second filter. The first is wider, so that it does not
/// shape torques.
const WIDER: f64 = 4.0;

/// The low-pass of both sides, of the filter that the spectrum chooses: what moves passes, and most noise does not.
const PART: f64 = 0.5;

/// The names that a message lists at most.
const SHOWN: usize = 16;

/// Highest cut-off of the log's filter, as part of the sampling rate.
const HIGHEST: f64 = 0.3;

/// Logs that were opened and surveyed.
pub(crate) struct MotionLog {
    log: Log,
    /// How it was opened.
    options: Options,
    survey: Survey,
    /// Hz: what both sides pass.
    pub(crate) cutoff: f64,
    /// Hz: the log's own filter.
    pub(crate) read_to: f64,
    /// Remarks on the log, each with whether it is a warning.
    remarks: Vec<(String, bool)>,
}

/// Part of the logs, by time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part {
    All,
    /// Before this part of the whole, 0 to 1.
    Before(f64),
    From(f64),
}

impl MotionLog {
    /// Opens logs of a robot; the log's own filter passes what a motion may have, and efforts that no arm has had are
    /// left out.
    pub(crate) fn open(paths: &[PathBuf], robot: &Robot, arguments: &LogArguments) -> Result<Self, Failure> {
        let options = Options { leave_out_spikes: true, ..arguments.options() };
        Self::open_with(paths, robot, options, WIDER)
    }

    /// Opens logs that a robot file is judged by: the same, and nothing is left out.
    pub(crate) fn open_all(paths: &[PathBuf], robot: &Robot, arguments: &LogArguments) -> Result<Self, Failure> {
        Self::open_with(paths, robot, arguments.options(), WIDER)
    }

    /// Opens logs of a robot; the log's own filter passes all that it may, for what is sudden.
    pub(crate) fn open_wide(paths: &[PathBuf], robot: &Robot, arguments: &LogArguments) -> Result<Self, Failure> {
        Self::open_with(paths, robot, arguments.options(), f64::INFINITY)
    }

    fn open_with(paths: &[PathBuf], robot: &Robot, mut options: Options, wider: f64) -> Result<Self, Failure> {
        // the log's own filter is chosen here
        let asked = options.cutoff.take();
        options.slides = slides(robot);
        let mut remarks = Vec::new();
        let unnamed = || Log::open(paths, Options { joints: None, torque_constants: Vec::new(), ..options.clone() });
        if let Some(names) = &options.joints {
            // an empty name is refused with those that there are
            if names.len() != robot.dof() && names.iter().all(|name| !name.trim().is_empty()) {
                let logged = unnamed().map(|log| log.layout().joints.clone()).unwrap_or_default();
                return Err(miscounted(robot, names.len(), &logged));
            }
        } else {
            let log = unnamed().map_err(|error| log_arguments::failure(&error, &joint_names(robot)))?;
            options.joints = Some(matched(robot, &log.layout().joints, &mut remarks)?);
        }
        let log = Log::open(paths, options.clone()).map_err(failure)?;
        check_units(robot, log.layout())?;
        check_efforts(&log)?;
        let survey = reading::survey(&log, false).map_err(failure)?;
        let is_unsaid = survey.may_be_degrees(&log).is_some() || !log.unsaid_currents().is_empty();
        if let (true, Err(error)) = (is_unsaid, log.motions(&survey)) {
            return Err(failure(error));
        }
        if survey.counts.states == 0 {
            let why: Vec<String> = left_out(&log, &survey).map(|(count, why)| format!("{count} {why}")).collect();
            let what =
                format_args!("no message of the log contains a state of the arm: {}", why.join("; ")).to_string();
            return Err(Failure::input(one_line(&what)));
        }
        let of_motion = || survey.cutoff.hertz().map(|hertz| PART * hertz);
        let cutoff = asked.or_else(of_motion).ok_or_else(|| {
            Failure::input(format_args!(
                "no run is long enough to choose a low-pass; give one with {TYPED}--cutoff HZ{TYPED:#}"
            ))
        })?;
        let highest = HIGHEST / log.layout().step;
        let longest = survey.runs.iter().map(|run| run.duration).fold(0.0, f64::max);
        check_cutoff(&log, cutoff, longest, |cutoff| {
            // who reads all that there is may go to the ends of runs
            if wider.is_finite() { log.left(&survey, (wider * cutoff).min(highest)) } else { longest }
        })?;
        let read_to = (wider * cutoff).min(highest);
        options.cutoff = Some(read_to);
        let log = Log::open(paths, options.clone()).map_err(failure)?;
        let survey = reading::survey(&log, false).map_err(failure)?;
        remarks.extend(notes(&log, &survey));
        for (joint, (least, greatest)) in log.layout().joints.iter().zip(&survey.efforts) {
            if least == greatest {
                let what = format!("efforts of {joint} are {} throughout: are they measured?", rounded(*least, 3));
                remarks.push((what, true));
            }
        }
        for (messages, why) in left_out(&log, &survey) {
            remarks.push((format!("left out: {messages} messages {why}"), true));
        }
        Ok(Self { log, options, survey, cutoff, read_to, remarks })
    }

    /// The logs after the filter with which a robot file is judged; runs that are too short for it are included.
    pub(crate) fn judged(&self) -> Result<Self, Failure> {
        let read_to = (WIDER * self.cutoff).min(self.read_to);
        let options = Options { cutoff: Some(read_to), ..self.options.clone() };
        let log = Log::open(self.log.files(), options.clone()).map_err(failure)?;
        let survey = reading::survey(&log, false).map_err(failure)?;
        Ok(Self { log, options, survey, cutoff: self.cutoff, read_to, remarks: Vec::new() })
    }

    /// The log without the remarks that another log has, too.
    pub(crate) fn without_remarks_of(mut self, other: &Self) -> Self {
        self.remarks.retain(|remark| !other.remarks.contains(remark));
        self
    }

    /// Remarks on the log, in lines of a width.
    pub(crate) fn remark(&self, width: usize) -> String {
        let mut text = String::new();
        for (line, is_warning) in &self.remarks {
            let (word, style) = if *is_warning { ("warning", WARNING) } else { ("note", TITLE) };
            let indent = " ".repeat(word.len() + 2);
            let wrapped = wrap(&one_line(line), width - indent.len(), &indent);
            let _ = writeln!(text, "{style}{word}{style:#}: {wrapped}");
        }
        text
    }

    /// Summary of the log, in words.
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

    /// Hands the motions of a part to what takes them, to the ends of runs: of these the log's own filter sees one side
    /// alone, but the low-pass reaches farther than it.
    pub(crate) fn pass<E: Display>(
        &self,
        part: Part,
        take: &mut dyn FnMut(&Motion) -> Result<(), E>,
    ) -> Result<(), Failure> {
        let motions = self.log.motions(&self.survey).map_err(failure)?.with_ends();
        self.hand_on(motions, part, &mut |_, motion| take(motion))
    }

    /// The same without the ends, each motion with the number of its run, from 0.
    pub(crate) fn pass_runs<E: Display>(
        &self,
        part: Part,
        take: &mut dyn FnMut(u64, &Motion) -> Result<(), E>,
    ) -> Result<(), Failure> {
        self.hand_on(self.log.motions(&self.survey).map_err(failure)?, part, take)
    }

    fn hand_on<E: Display>(
        &self,
        motions: Motions<'_>,
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
        let bar = reading::bar("read", false);
        let mut motions = motions.with_length(PIECE);
        while let Some(piece) = motions.next() {
            let piece = piece.map_err(failure)?;
            reading::show(&bar, motions.progress());
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
        recorded: of(&motion.recorded),
    }
}

#[expect(clippy::needless_pass_by_value, reason = "it is what errors are mapped by")]
fn failure(error: LogError) -> Failure {
    log_arguments::failure(&error, &[])
}

/// Refuses a log without efforts of all joints.
fn check_efforts(log: &Log) -> Result<(), Failure> {
    let layout = log.layout();
    if layout.has_efforts {
        return Ok(());
    }
    let missing: Vec<String> = layout.without_efforts.iter().map(|name| one_line(name)).collect();
    if missing.is_empty() || missing.len() == layout.joints.len() {
        let unread: Vec<String> = layout.unread.iter().take(SHOWN).map(|name| one_line(name)).collect();
        let unread = if unread.is_empty() {
            String::new()
        } else {
            let efforts = suggested(&layout.unread, &layout.joints).into_iter();
            let is_effort = |target: &Target| matches!(target, Target::Joint { quantity: Quantity::Effort, .. });
            let efforts: Vec<Mapping> = efforts.filter(|mapping| is_effort(&mapping.target)).collect();
            format!(
                "; not read are {}, and names of efforts are tau1, … or effort and the joint: docs/logs.md; name the \
                 columns: {}",
                unread.join(", "),
                one_line(&log_remedy::map(&efforts))
            )
        };
        return Err(Failure::input(format_args!(
            "the log has no efforts, and a model is compared with torques{unread}"
        )));
    }
    Err(Failure::input(format_args!(
        "the log has no efforts of {}, and a model is compared with the torques of every joint",
        missing.join(", ")
    )))
}

/// Refuses a low-pass that samples are too far apart for, or that the longest run, s, has no room for: what is `left`
/// of it beside a low-pass.
fn check_cutoff(log: &Log, cutoff: f64, longest: f64, left: impl Fn(f64) -> f64) -> Result<(), Failure> {
    let rate = 1.0 / log.layout().step;
    let highest = HIGHEST * rate;
    let is_left = |cutoff: f64| left(cutoff) > 2.0 * rne_identify::Options::filter_reach(cutoff);
    if cutoff <= highest && is_left(cutoff) {
        return Ok(());
    }
    // what is left grows with the low-pass
    let (mut too_low, mut lowest) = (0.0, highest);
    while lowest - too_low > 1e-3 * lowest {
        let middle = f64::midpoint(too_low, lowest);
        *(if is_left(middle) { &mut lowest } else { &mut too_low }) = middle;
    }
    let said = format!(
        "{} Hz is not possible as a low-pass for samples at {rate:.4} Hz in runs of {} s at most",
        rounded(cutoff, 3),
        rounded(longest, 2)
    );
    if is_left(highest) {
        return Err(Failure::usage(format_args!(
            "{said}; {TYPED}--cutoff{TYPED:#} can be from {} to {} Hz here; a lower cut-off drops more of the ends of \
             runs",
            rounded((lowest * 1e3).ceil() * 1e-3, 3),
            rounded((highest * 1e3).floor() * 1e-3, 3)
        )));
    }
    Err(Failure::input(format_args!("{said}, and neither is any other: the runs are too short")))
}

/// Opens logs by the names of the robot's joints; where those of the logs are as many numbers, by these.
pub(crate) fn open_by_names(paths: &[PathBuf], robot: &Robot, options: Options) -> Result<Log, Failure> {
    let options = Options { slides: slides(robot), ..options };
    Log::open(paths, Options { joints: Some(joint_names(robot)), ..options.clone() }).or_else(|error| {
        let is_number = |name: &String| name.bytes().all(|byte| byte.is_ascii_digit());
        match Log::open(paths, options) {
            Ok(log) if log.layout().joints.len() == robot.dof() && log.layout().joints.iter().all(is_number) => Ok(log),
            _ => Err(log_arguments::failure(&error, &joint_names(robot))),
        }
    })
}

/// Whether each joint is prismatic: no option converts its lengths into angles.
fn slides(robot: &Robot) -> Vec<bool> {
    robot.joints.iter().map(|joint| joint.row.kind == JointKind::Prismatic).collect()
}

/// Advice for a log that has fewer joints than the robot.
const ALL_NEEDED: &str = "the positions and torques of all joints are needed, so use a log with all joints, or a robot \
    file of the logged joints";

/// Refuses names of another number than the robot has joints; those of the log, where it can be read without names.
fn miscounted(robot: &Robot, named: usize, logged: &[String]) -> Failure {
    let there = if logged.is_empty() { String::new() } else { format!(", which has {}", shown(logged)) };
    let advice = if (1..robot.dof()).contains(&logged.len()) {
        ALL_NEEDED
    } else {
        "say which joint of the log each of them is, base to tip"
    };
    Failure::usage(format_args!(
        "{TYPED}--joints{TYPED:#} names {} of the log{there}, and the robot has {}: {}; {advice}",
        of_joints(named),
        of_joints(robot.dof()),
        of_robot(robot)
    ))
}

/// Names of a log, the first of them.
fn shown(logged: &[String]) -> String {
    let names: Vec<String> = logged.iter().take(SHOWN).map(|name| one_line(name)).collect();
    let more = if logged.len() > SHOWN { ", …" } else { "" };
    names.join(", ") + more
}

/// The names of a robot's joints, base to tip.
fn joint_names(robot: &Robot) -> Vec<String> {
    robot.joints.iter().map(|joint| joint.name.clone()).collect()
}

fn of_robot(robot: &Robot) -> String {
    shown(&joint_names(robot))
}

fn of_joints(count: usize) -> String {
    if count == 1 { "1 joint".to_owned() } else { format!("{count} joints") }
}

/// The joints of the log that are those of the robot, base to tip.
fn matched(robot: &Robot, logged: &[String], remarks: &mut Vec<(String, bool)>) -> Result<Vec<String>, Failure> {
    let names = joint_names(robot);
    if names.iter().all(|name| logged.contains(name)) {
        return Ok(names);
    }
    let both = format!(
        "the log has {}, the robot {}: {} there and {} here",
        of_joints(logged.len()),
        names.len(),
        shown(logged),
        of_robot(robot)
    );
    if logged.len() < names.len() {
        return Err(Failure::usage(format_args!("{both}; {ALL_NEEDED}")));
    }
    let said = format!("{TYPED}--joints{TYPED:#} says which of the log's are the robot's, base to tip");
    if logged.len() > names.len() {
        return Err(Failure::usage(format_args!("{both}; {said}")));
    }
    // some names are those of the robot, and say another order
    let is_elsewhere = |(at, name): &(usize, &String)| logged.contains(name) && logged[*at] != **name;
    if let Some((_, name)) = names.iter().enumerate().find(is_elsewhere) {
        let name = one_line(name);
        return Err(Failure::usage(format_args!("{both}, and {name} has another place in them; {said}")));
    }
    remarks.push((format!("joints of the log are matched by their order: {}", shown(logged)), false));
    Ok(logged.to_vec())
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
