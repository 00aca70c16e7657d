//! `rne watch`: what happens to an arm, by its logs.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_identify::{Identification, Part, Purpose};
use rne_model::{Robot, one_line};
use rne_watch::{Baseline, Event, Report, Settings, Signals, WatchError, svg, watch};
use serde::Serialize;

use crate::commands::prediction_errors::{errors_table, prediction};
use crate::files::file_name::Format;
use crate::files::motion_log::MotionLog;
use crate::files::output_file;
use crate::files::robot_file;
use crate::outcome::{Failure, Outcome};
use crate::palette::{GOOD, QUIET, TITLE, TYPED, WARNING};
use crate::render::layout::{Align, PAGE, columns, shortened, wrap};
use crate::values::log_arguments::LogArguments;
use crate::values::numbers::{above_zero, rounded};

/// Events that are shown; the others are counted.
const SHOWN: usize = 40;

/// States of a picture.
const DRAWN: u64 = 20_000;

/// Find torques in logs that the robot file does not explain
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne watch docs/desk_arm_identified.yaml docs/desk_arm_log.csv

Exit status 1: events, or torques that are not explained. See docs/watch.md.")]
pub(crate) struct Arguments {
    /// Robot file with friction, from `rne identify`
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Logs: ROS 2 bags, MCAP, Parquet, CSV, npy
    #[arg(value_name = "LOG", required = true)]
    logs: Vec<PathBuf>,
    /// Log without disturbances; sets the thresholds
    #[arg(long, value_name = "LOG")]
    quiet: Vec<PathBuf>,
    /// Gain of the momentum observer, Hz
    #[arg(long, value_name = "HZ", default_value_t = 20.0, value_parser = above_zero("it is a number above 0"))]
    gain: f64,
    /// Shortest event to report, s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.005, value_parser = above_zero("it is a number above 0"))]
    hold: f64,
    /// Permitted false alarms per hour, all joints
    #[arg(long, value_name = "RATE", default_value_t = 0.01, value_parser = above_zero("it is a number above 0"))]
    false_alarms: f64,
    /// Plot residuals and events (SVG)
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, requires = "plot")]
    force: bool,
    /// Print events and errors as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    reading: LogArguments,
}

/// Whether two paths lead to one log: the same file, or a folder and what is inside.
fn is_within(a: &Path, b: &Path) -> bool {
    let (Ok(a), Ok(b)) = (a.canonicalize(), b.canonicalize()) else { return false };
    a.starts_with(&b) || b.starts_with(&a)
}

/// A result, or nothing for a motion that is too short for it.
fn unless_too_short<T>(found: Result<T, WatchError>) -> Result<Option<T>, WatchError> {
    match found {
        Ok(found) => Ok(Some(found)),
        Err(WatchError::TooFew { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let inputs = arguments.logs.iter().chain(&arguments.quiet).chain([&arguments.file]);
    let sources: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    if let Some(both) = arguments.quiet.iter().find(|quiet| arguments.logs.iter().any(|log| is_within(log, quiet))) {
        return Err(Failure::usage(format_args!(
            "{} is also watched: {TYPED}--quiet{TYPED:#} needs another log, without disturbances, so name one or leave \
             the option out",
            one_line(&both.display().to_string())
        )));
    }
    output_file::check_picture(arguments.plot.as_deref())?;
    if let Some(path) = &arguments.plot {
        output_file::check_place(path, (Format::Svg, "<svg"), &sources, arguments.force)?;
    }
    let robot = robot_file::robot(&arguments.file)?;
    let log = MotionLog::open(&arguments.logs, &robot, &arguments.reading, Purpose::Watch)?;
    let settings = Settings { gain: arguments.gain, hold: arguments.hold, false_alarms: arguments.false_alarms };
    let quiet = match &arguments.quiet[..] {
        [] => None,
        logs => {
            let reading = arguments.reading.with_cutoff(log.cutoff());
            Some(MotionLog::open(logs, &robot, &reading, Purpose::Watch)?)
        }
    };
    let mut remark = log.remark(PAGE);
    remark += &quiet.as_ref().map_or_else(String::new, |quiet| quiet.remark(PAGE));
    let baseline = match &quiet {
        Some(quiet) => silent(&robot, quiet, &settings)?,
        None => typical(&robot, &log, &settings)?,
    };
    let watched = Watched::of(&robot, &log, &baseline, &settings, arguments.plot.is_some())?;
    if let (Some(path), Some((signals, report))) = (&arguments.plot, &watched.drawn) {
        let picture = svg(&robot, signals, &baseline, report, &log.words());
        remark += &output_file::write_new(path, &picture, &sources, arguments.force)?;
        if watched.is_cut {
            let _ = writeln!(remark, "{TITLE}note{TITLE:#}: the picture ends where the time of the logs goes back");
        }
    }
    // behind the filter that `rne identify --judge` has, so that its errors are these
    let judged = log.judged()?;
    let errors = prediction(&robot, &judged, Part::All)?;
    let mut is_explained = true;
    let mut warn = |names: &[String], where_: &str| {
        if names.is_empty() {
            return;
        }
        is_explained = false;
        let what = format!("the model explains nothing of the torques of {}{where_}", names.join(", "));
        let _ = writeln!(remark, "{WARNING}warning{WARNING:#}: {}", wrap(&what, PAGE - 9, "         "));
    };
    warn(&unexplained(&robot, &errors), ": does FILE describe this arm, with its friction?");
    if let Some(quiet) = &quiet {
        let names = unexplained(&robot, &prediction(&robot, quiet, Part::All)?);
        warn(&names, " in the log of --quiet, which sets the thresholds: is it a log of this arm?");
    }
    let at_fault = !(watched.events.is_empty() && is_explained);
    if arguments.json {
        let reply = Reply::of(&robot, &log, &watched.events, &errors);
        return Ok(Outcome { remark, at_fault, ..Outcome::json(&reply)? });
    }
    let about = format!("{} from {}, low-pass {:.1} Hz", one_line(&robot.name), log.words(), log.read_to());
    let mut text = format!("{TITLE}{}{TITLE:#}\n", wrap(&about, PAGE, "  "));
    let usual = quiet.map_or("medians of the log itself".to_owned(), |quiet| quiet.words());
    let _ = writeln!(text, "{QUIET}{}{QUIET:#}", wrap(&format!("thresholds from: {usual}"), PAGE, "  "));
    text += &events_table(&robot, &watched.events, log.runs() > 1);
    text += &errors_table(&robot, &judged, &errors, &Identification::not_excited(&robot), "errors on the log");
    Ok(Outcome { text, remark, at_fault })
}

/// Hands the signals of a log to what takes them, piece by piece; how many pieces were long enough for it.
fn each_signals(
    robot: &Robot,
    log: &MotionLog,
    gain: f64,
    mut take: impl FnMut(u64, Signals) -> Result<Option<()>, WatchError>,
) -> Result<u64, Failure> {
    let mut taken = 0;
    log.pass_runs(Part::All, &mut |run, motion| {
        let signals = unless_too_short(Signals::new(robot, motion, gain))?;
        if let Some(signals) = signals {
            taken += u64::from(take(run, signals)?.is_some());
        }
        Ok::<(), WatchError>(())
    })?;
    Ok(taken)
}

/// The levels of each piece of a log that is long enough to have some.
fn levels(robot: &Robot, log: &MotionLog, gain: f64) -> Result<Vec<Baseline>, Failure> {
    let mut found = Vec::new();
    each_signals(robot, log, gain, |_, signals| {
        let baseline = unless_too_short(Baseline::of(&signals, 0..signals.time.len()))?;
        Ok(baseline.map(|baseline| found.push(baseline)))
    })?;
    Ok(found)
}

fn too_short(log: &MotionLog) -> Failure {
    Failure::input(format_args!("{} is too short to derive thresholds", log.words()))
}

/// Baseline of a log that may contain events.
fn typical(robot: &Robot, log: &MotionLog, settings: &Settings) -> Result<Baseline, Failure> {
    Baseline::typical(&levels(robot, log, settings.gain)?).ok_or_else(|| too_short(log))
}

/// Baseline of a log without events.
fn silent(robot: &Robot, quiet: &MotionLog, settings: &Settings) -> Result<Baseline, Failure> {
    let mut baseline = Baseline::covering(&levels(robot, quiet, settings.gain)?).ok_or_else(|| too_short(quiet))?;
    each_signals(robot, quiet, settings.gain, |_, signals| {
        baseline = baseline.clone().silent(&signals, settings)?;
        Ok(Some(()))
    })?;
    Ok(baseline.widened(ELSEWHERE[0], ELSEWHERE[1]))
}

/// A model is worse on motions that it has not seen. In another log, deviations are larger by the first factor, and the
/// error of the model's terms, which may have any sign there, by the second.
const ELSEWHERE: [f64; 2] = [1.5, 2.0];

/// N m or N: what is left of an effort where nothing is.
const NOTHING: f64 = 1e-9;

/// The joints whose torques are no better predicted than by their mean, or not at all; but those of which the file says
/// that nothing is known.
fn unexplained(robot: &Robot, errors: &[rne_identify::JointError]) -> Vec<String> {
    let each = robot.joints.iter().zip(errors).zip(Identification::not_excited(robot));
    // what is no number is no prediction
    let found = each.filter(|((_, error), unknown)| {
        // an effort that does not change, and is what the model says, is explained
        let is_nothing = error.deviation == 0.0 && error.residual <= NOTHING;
        !unknown && !is_nothing && (error.error >= 1.0 || error.error.is_nan())
    });
    found.map(|((joint, _), _)| one_line(&joint.name)).collect()
}

/// Result of a log.
struct Watched {
    /// Run by run; the number of the run, from 0.
    events: Vec<(u64, Event)>,
    /// For a picture: signals that are thinned, and their events.
    drawn: Option<(Signals, Report)>,
    /// Whether the picture leaves runs out, whose times are not behind those before.
    is_cut: bool,
}

impl Watched {
    fn of(
        robot: &Robot,
        log: &MotionLog,
        baseline: &Baseline,
        settings: &Settings,
        is_drawn: bool,
    ) -> Result<Self, Failure> {
        let stride = usize::try_from(log.states().div_ceil(DRAWN)).unwrap_or(usize::MAX).max(1);
        let (mut found, mut drawn) = (Vec::<(u64, Vec<Event>)>::new(), None::<(Signals, Report)>);
        let (mut is_cut, mut last_drawn) = (false, 0);
        let taken = each_signals(robot, log, settings.gain, |run, signals| {
            let report = watch(&signals, baseline, settings)?;
            match found.last_mut() {
                Some((last, events)) if *last == run => events.extend(report.events.iter().copied()),
                _ => found.push((run, report.events.clone())),
            }
            if is_drawn && !is_cut {
                let thin = signals.thinned(stride);
                if let Some((all, _)) = &mut drawn {
                    is_cut = all.time.last() >= thin.time.first();
                    if !is_cut {
                        all.append(thin);
                        last_drawn = run;
                    }
                } else {
                    (drawn, last_drawn) = (Some((thin, report)), run);
                }
            }
            Ok(Some(()))
        })?;
        if taken == 0 {
            return Err(Failure::input(format_args!("{} is too short to watch", log.words())));
        }
        let joined = |(run, events)| Event::joined(events, JOINED).into_iter().map(move |event| (run, event));
        let events: Vec<(u64, Event)> = found.into_iter().flat_map(joined).collect();
        if let Some((signals, report)) = &mut drawn {
            report.events = events.iter().filter(|(run, _)| *run <= last_drawn).map(|(_, event)| *event).collect();
            report.errors = (0..signals.dof()).map(|joint| signals.prediction_error(joint)).collect();
        }
        Ok(Self { events, drawn, is_cut })
    }
}

/// s: events that are closer are one, such as those on both sides of the border of two pieces.
const JOINED: f64 = 0.25;

fn events_table(robot: &Robot, events: &[(u64, Event)], has_runs: bool) -> String {
    if events.is_empty() {
        return format!("\n{GOOD}no events{GOOD:#}\n");
    }
    let mut cells = vec![["  from, s", "to, s", "joint", "", "peak", "", "possible cause"].map(str::to_owned)];
    for (run, event) in events.iter().take(SHOWN) {
        let joint = &robot.joints[event.joint];
        cells.push([
            if has_runs { format!("  run {}: {:.3}", run + 1, event.start) } else { format!("  {:.3}", event.start) },
            format!("{:.3}", event.end),
            shortened(&one_line(&joint.name), 20),
            event.test.name().to_owned(),
            rounded(event.peak, 3),
            joint.row.kind.effort_unit().to_owned(),
            event.test.meaning().to_owned(),
        ]);
    }
    let align = [Align::Right, Align::Right, Align::Left, Align::Left, Align::Right, Align::Left, Align::Left];
    let lines = columns(&align, &cells);
    let count = if events.len() == 1 { "1 event".to_owned() } else { format!("{} events", events.len()) };
    let mut text = format!("\n{WARNING}{count}{WARNING:#}\n{QUIET}{}{QUIET:#}\n", lines[0]);
    for line in &lines[1..] {
        let _ = writeln!(text, "{line}");
    }
    if events.len() > SHOWN {
        let _ = writeln!(text, "  and {} more; --json prints all of them", events.len() - SHOWN);
    }
    text
}

/// The result as JSON.
#[derive(Serialize)]
struct Reply {
    robot: String,
    log: String,
    /// Hz: of the errors; events are of the log as it was read.
    low_pass: f64,
    read_to: f64,
    events: Vec<OfEvent>,
    joints: Vec<OfJoint>,
}

#[derive(Serialize)]
struct OfEvent {
    run: u64,
    start: f64,
    end: f64,
    joint: usize,
    name: String,
    test: &'static str,
    peak: f64,
    unit: &'static str,
}

#[derive(Serialize)]
struct OfJoint {
    joint: usize,
    name: String,
    error: Option<f64>,
    unfiltered: Option<f64>,
}

impl Reply {
    fn of(robot: &Robot, log: &MotionLog, events: &[(u64, Event)], errors: &[rne_identify::JointError]) -> Self {
        let finite = |number: f64| number.is_finite().then_some(number);
        let of_event = |(run, event): &(u64, Event)| OfEvent {
            run: run + 1,
            start: event.start,
            end: event.end,
            joint: event.joint + 1,
            name: robot.joints[event.joint].name.clone(),
            test: event.test.name(),
            peak: event.peak,
            unit: robot.joints[event.joint].row.kind.effort_unit(),
        };
        let of_joint = |(at, error): (usize, &rne_identify::JointError)| OfJoint {
            joint: at + 1,
            name: robot.joints[at].name.clone(),
            error: finite(error.error),
            unfiltered: finite(error.unfiltered),
        };
        Self {
            robot: robot.name.clone(),
            log: log.words(),
            low_pass: log.cutoff(),
            read_to: log.read_to(),
            events: events.iter().map(of_event).collect(),
            joints: errors.iter().enumerate().map(of_joint).collect(),
        }
    }
}
