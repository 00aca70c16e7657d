//! `rne watch`: what has changed about an arm, by its logs.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_identify::{ArmLogRemark, Identification, Part, Purpose};
use rne_logs::{LabelValue, Log};
use rne_model::{Robot, one_line};
use rne_watch::{Baseline, Changes, Report, Settings, Trend, TrendReply, WatchError, WatchReply, changes, svg, watch};

use crate::commands::logs::prediction_errors::{errors_table, prediction};
use crate::files::file_name::Format;
use crate::files::motion_log::{MotionLog, watch_failure};
use crate::files::output_file;
use crate::files::reading;
use crate::files::robot_file::{self, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{QUIET, TITLE, TYPED, WARNING};
use crate::render::layout::{PAGE, wrap};
use crate::render::watch_dates::{LogName, LogNames};
use crate::render::watch_report;
use crate::values::log_arguments::{self, LogArguments};
use crate::values::numbers::{above_zero, rounded};

/// Find changes of an arm in its logs: friction, payload, contacts
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne watch docs/desk_arm_identified.yaml docs/desk_arm_worn.csv \\
    --quiet docs/desk_arm_log.csv

The exit status is 1 if rne reports an event, or if the model does not explain
the torques of a joint. docs/control/watch.md describes the events.")]
#[allow(clippy::struct_excessive_bools)] // each is a flag of its own
pub(crate) struct Arguments {
    /// Robot file with friction, such as the output of `rne identify`
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Logs of the arm: ROS 2 bags, MCAP, Parquet, CSV, npy
    #[arg(value_name = "LOG", required = true)]
    logs: Vec<PathBuf>,
    /// Log of normal motion without contacts, to compare the other logs with; may be repeated
    #[arg(long, value_name = "LOG")]
    quiet: Vec<PathBuf>,
    /// Compare the logs with this file, which --save-baseline wrote, and not with --quiet logs
    #[arg(long, value_name = "YAML", conflicts_with_all = ["quiet", "save_baseline"])]
    baseline: Option<PathBuf>,
    /// Save a summary of the --quiet logs to this file, for --baseline
    #[arg(long, value_name = "YAML", requires = "quiet")]
    save_baseline: Option<PathBuf>,
    /// Compare groups of the data: log (each log), day (each day), or the name of a column
    #[arg(long, value_name = "GROUP")]
    by: Option<String>,
    /// Print all parameters and their event thresholds
    #[arg(long)]
    all: bool,
    /// Gain of the momentum observer that finds contacts, Hz
    #[arg(long, value_name = "HZ", default_value_t = 20.0, value_parser = above_zero("write a number above 0"))]
    gain: f64,
    /// Shortest duration of a contact to report, s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.005, value_parser = above_zero("write a number above 0"))]
    hold: f64,
    /// Permitted false contact reports per hour [default: 0.01]
    #[arg(long, value_name = "RATE", default_value_t = 0.01, hide_default_value = true,
        value_parser = above_zero("write a number above 0"))]
    false_alarms: f64,
    /// Plot residual torques and events to this SVG file; with --by, friction and payload of each group
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    /// Write the parameters with their thresholds as CSV, or with --by a row for each group; - is standard output
    #[arg(long, value_name = "CSV", conflicts_with = "json")]
    csv: Option<PathBuf>,
    /// Overwrite output files that exist
    #[arg(long)]
    force: bool,
    /// Print events and parameters as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    reading: LogArguments,
}

/// Whether a file is a log by the end of its name: a baseline file is YAML.
fn is_log(path: &Path) -> bool {
    let end = path.extension().map(|end| end.to_string_lossy().to_lowercase());
    end.is_some_and(|end| ["csv", "db3", "mcap", "npy", "parquet"].contains(&end.as_str()))
}

/// Whether two paths lead to one log: the same file, or a folder and what is inside.
fn is_within(a: &Path, b: &Path) -> bool {
    let (Ok(a), Ok(b)) = (a.canonicalize(), b.canonicalize()) else { return false };
    a.starts_with(&b) || b.starts_with(&a)
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let inputs = arguments.logs.iter().chain(&arguments.quiet).chain(&arguments.baseline).chain([&arguments.file]);
    let sources: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    check_places(arguments, &sources)?;
    let robot = robot_file::robot(&arguments.file, Shape::Coupled)?;
    let settings = Settings { gain: arguments.gain, hold: arguments.hold, false_alarms: arguments.false_alarms };
    let mut remark = String::new();
    let known = known_baseline(arguments, &robot, &settings, &sources, &mut remark)?;
    match &arguments.by {
        Some(by) => trend(arguments, &robot, known, by, &sources, remark),
        None => events(arguments, &robot, known, &settings, &sources, remark),
    }
}

/// A baseline, with the words for where it comes from.
struct Known {
    baseline: Baseline,
    words: String,
    name: LogName,
    /// Remarks that were printed already.
    remarks: Vec<ArmLogRemark>,
}

/// The baseline of quiet logs, or of a file.
fn known_baseline(
    arguments: &Arguments,
    robot: &Robot,
    settings: &Settings,
    sources: &[&Path],
    remark: &mut String,
) -> Result<Option<Known>, Failure> {
    if let Some(path) = &arguments.baseline {
        let shown = path.display().to_string();
        if path.is_dir() || is_log(path) {
            return Err(Failure::usage(format_args!(
                "{} is a log, and {TYPED}--baseline{TYPED:#} reads a file that {TYPED}--save-baseline{TYPED:#} wrote; \
                 give a log with {TYPED}--quiet{TYPED:#}",
                one_line(&shown)
            )));
        }
        let bytes = rne_model::read_file(path).map_err(|error| output_file::unreadable(path, &error))?;
        let text = String::from_utf8_lossy(&bytes);
        let baseline = Baseline::from_yaml(&shown, &text, robot).map_err(|report| Failure::from(&report))?;
        let words = format!("{} ({:.1} s)", one_line(&shown), baseline.duration);
        let name = LogName::several(format!("the logs of {}", one_line(&shown)));
        return Ok(Some(Known { baseline, words, name, remarks: Vec::new() }));
    }
    if arguments.quiet.is_empty() {
        return Ok(None);
    }
    let quiet = MotionLog::open(&arguments.quiet, robot, &arguments.reading, Purpose::Watch)?;
    *remark += &quiet.remark(PAGE);
    let bar = reading::bar("read", false);
    let baseline = Baseline::of_logs(robot, quiet.log(), settings, &mut |share| reading::show(&bar, share))
        .map_err(|error| watch_failure(&error, &quiet.words()))?;
    let joints = unexplained(robot, &prediction(robot, &quiet, Part::All)?);
    if !joints.is_empty() {
        warn(
            remark,
            &format!(
                "the model explains nothing of the torques of {} in the quiet log: {}",
                names(robot, &joints),
                doubt(robot, "is it a log of this arm?")
            ),
        );
    }
    if let Some(path) = &arguments.save_baseline {
        let text = baseline.to_yaml(robot, &quiet.words());
        *remark += &output_file::write_new(path, &text, sources, arguments.force)?;
    }
    let name = LogName::of(&arguments.quiet, "the quiet logs");
    Ok(Some(Known { baseline, words: quiet.words(), name, remarks: quiet.log().remarks().to_vec() }))
}

fn warn(remark: &mut String, what: &str) {
    let _ = writeln!(remark, "{WARNING}warning{WARNING:#}: {}", wrap(what, PAGE - 9, "         "));
}

/// Opens logs with the low-pass of a baseline.
fn open(arguments: &Arguments, group: &Group, robot: &Robot, known: Option<&Known>) -> Result<MotionLog, Failure> {
    let mut reading = arguments.reading.clone();
    if let Some((column, text)) = &group.rows {
        reading = reading.with_rows(column, text);
    }
    match known {
        Some(known) => MotionLog::open_beside(&group.paths, robot, &reading, known.baseline.cutoff),
        None => MotionLog::open(&group.paths, robot, &reading, Purpose::Watch),
    }
}

/// The baseline that is known, or that of the log itself against the robot file.
fn baseline_of(robot: &Robot, known: Option<Known>, log: &MotionLog) -> Result<Known, Failure> {
    if let Some(known) = known {
        return Ok(known);
    }
    let bar = reading::bar("read", false);
    let baseline =
        Baseline::of_file(robot, log.log(), &mut |share| reading::show(&bar, share)).map_err(|error| match error {
            WatchError::ShortBaseline { .. } => Failure::input(format_args!(
                "{}: {error}. A longer log of the arm without any fault, given with {TYPED}--quiet{TYPED:#}, can be \
                 its baseline",
                log.words()
            )),
            error => watch_failure(&error, &log.words()),
        })?;
    let name = LogName::several("the quiet logs".to_owned());
    Ok(Known { baseline, words: "the robot file".to_owned(), name, remarks: Vec::new() })
}

fn events(
    arguments: &Arguments,
    robot: &Robot,
    known: Option<Known>,
    settings: &Settings,
    sources: &[&Path],
    mut remark: String,
) -> Result<Outcome, Failure> {
    let all = Group { name: String::new(), paths: arguments.logs.clone(), rows: None };
    let log = open(arguments, &all, robot, known.as_ref())?;
    remark += &log.remark_beside(known.as_ref().map_or(&[], |known| &known.remarks), PAGE);
    let Known { baseline, words, name, .. } = baseline_of(robot, known, &log)?;
    let bar = reading::bar("read", false);
    let report =
        watch(robot, &baseline, log.log(), settings, arguments.plot.is_some(), &mut |share| reading::show(&bar, share))
            .map_err(|error| watch_failure(&error, &log.words()))?;
    drop(bar);
    if let Some(path) = &arguments.plot {
        remark += &draw(path, arguments, robot, &report, settings, &log.words(), sources)?;
    }
    let ratio = report.changes.effort_ratio;
    if !UNIT.contains(&ratio) {
        warn(
            &mut remark,
            &format!(
                "the efforts are {} times as large as in the quiet log: do they have another unit, or another torque \
                 constant? Then the events mean nothing",
                rounded(ratio, 2)
            ),
        );
    }
    if arguments.logs.len() > 1 && arguments.quiet.is_empty() && arguments.baseline.is_none() {
        warn(
            &mut remark,
            "the logs are joined to one, so a change between them can be hidden; --quiet names the log to compare \
             with, and --by log compares each with the first",
        );
    }
    let judged = log.judged()?;
    let errors = prediction(robot, &judged, Part::All)?;
    let mut unexplained = unexplained(robot, &errors);
    unexplained.retain(|joint| !has_faulty_channel(&report, *joint));
    if !unexplained.is_empty() {
        let names = names(robot, &unexplained);
        let what = doubt(robot, "does FILE describe this arm, with its friction?");
        warn(&mut remark, &format!("the model explains nothing of the torques of {names}: {what}"));
    }
    let at_fault = !(report.events.is_empty() && unexplained.is_empty());
    if let Some(path) = &arguments.csv {
        let table = watch_report::parameters_csv(robot, &baseline, &report.changes);
        if output_file::is_standard_output(path) {
            return Ok(Outcome { text: table, remark, at_fault, ..Outcome::default() });
        }
        remark += &output_file::write_new(path, &table, sources, arguments.force)?;
    }
    if arguments.json {
        let reply = WatchReply::of(robot, log.words(), log.read_to(), &words, &baseline, &report, &errors);
        return Ok(Outcome { remark, at_fault, ..Outcome::json(&reply)? });
    }
    let about = format!("{} from {}, low-pass {:.1} Hz", one_line(&robot.name), log.words(), baseline.cutoff);
    let mut text = format!("{TITLE}{}{TITLE:#}\n", wrap(&about, PAGE, "  "));
    let _ = writeln!(text, "{QUIET}{}{QUIET:#}", wrap(&format!("compared with: {words}"), PAGE, "  "));
    let names = LogNames { log: LogName::of(&arguments.logs, "the logs"), quiet: &name };
    text += &watch_report::events(robot, &baseline, &report, log.runs() > 1, &names);
    if arguments.all {
        text += &watch_report::parameters(robot, &baseline, &report.changes);
        text += &errors_table(robot, &judged, &errors, &Identification::not_excited(robot), "errors on the log");
    }
    Ok(Outcome { text, remark, at_fault, remark_last: true })
}

fn draw(
    path: &Path,
    arguments: &Arguments,
    robot: &Robot,
    report: &Report,
    settings: &Settings,
    about: &str,
    sources: &[&Path],
) -> Result<String, Failure> {
    let picture = svg(robot, report, settings, about);
    let mut remark = output_file::write_new(path, &picture, sources, arguments.force)?;
    if report.is_cut {
        let _ = writeln!(remark, "{TITLE}note{TITLE:#}: the picture ends where the time of the logs goes back");
    }
    Ok(remark)
}

/// Logs that are compared as one, or some rows of them.
struct Group {
    name: String,
    paths: Vec<PathBuf>,
    /// The column and the text of the rows that are read; all rows without.
    rows: Option<(String, String)>,
}

impl Group {
    /// `friday.mcap`, `the logs of 2026-11-27`, `the rows of pick`.
    fn log_name(&self) -> LogName {
        match &self.rows {
            Some(_) => LogName::several(format!("the rows of {}", one_line(&self.name))),
            None => LogName::of(&self.paths, &format!("the logs of {}", self.name)),
        }
    }
}

/// The groups of a trend, in the order of the logs.
fn groups(arguments: &Arguments, robot: &Robot, known: Option<&Known>, by: &str) -> Result<Vec<Group>, Failure> {
    if !["log", "day"].contains(&by) {
        let bar = reading::bar("read", false);
        let options = arguments.reading.options();
        let values = Log::values(&arguments.logs, by, &options, |share| reading::show(&bar, share))
            .map_err(|error| log_arguments::failure(&error, &[]))?;
        let group = |found: LabelValue| Group {
            paths: arguments.logs.clone(),
            rows: Some((by.to_owned(), found.value.clone())),
            name: found.value,
        };
        return Ok(values.into_iter().map(group).collect());
    }
    let mut groups: Vec<Group> = Vec::new();
    for path in &arguments.logs {
        let name = one_line(&path.file_name().unwrap_or(path.as_os_str()).to_string_lossy());
        let mut group = Group { name, paths: vec![path.clone()], rows: None };
        if by == "day" {
            let day = open(arguments, &group, robot, known)?.day();
            group.name = day.ok_or_else(|| {
                Failure::usage(format_args!(
                    "the times of {} are not dates, so it belongs to no day; {TYPED}--by log{TYPED:#} compares the \
                     logs one by one",
                    group.name
                ))
            })?;
        }
        match groups.iter_mut().find(|known| by == "day" && known.name == group.name) {
            Some(of) => of.paths.push(path.clone()),
            None => groups.push(group),
        }
    }
    Ok(groups)
}

/// The baseline of the first group, with which the others are compared if nothing else is known.
fn of_first(arguments: &Arguments, robot: &Robot, group: &Group) -> Result<Known, Failure> {
    let log = open(arguments, group, robot, None)?;
    let structure = Baseline::structure(robot, log.cutoff());
    let bar = reading::bar("read", false);
    let baseline = Baseline::of_parameters(&structure, log.log(), &mut |share| reading::show(&bar, share))
        .map_err(|error| watch_failure(&error, &log.words()))?;
    let (words, name) = (format!("the first, {}", group.name), group.log_name());
    Ok(Known { baseline, words, name, remarks: Vec::new() })
}

fn trend(
    arguments: &Arguments,
    robot: &Robot,
    known: Option<Known>,
    by: &str,
    sources: &[&Path],
    mut remark: String,
) -> Result<Outcome, Failure> {
    let groups = groups(arguments, robot, known.as_ref(), by)?;
    let mut known = if let Some(known) = known {
        known
    } else {
        let first = groups.first().ok_or_else(|| Failure::input("the logs have no rows"))?;
        of_first(arguments, robot, first)?
    };
    let structure = Baseline::structure(robot, known.baseline.cutoff);
    let mut trend = Trend::new(&structure, &known.baseline);
    let (mut events, mut names) = (Vec::new(), Vec::new());
    let mut first_failure = None;
    for group in groups {
        let mut compare = || -> Result<Changes, Failure> {
            let log = open(arguments, &group, robot, Some(&known))?;
            remark += &log.remark_beside(&known.remarks, PAGE);
            known.remarks.extend(log.log().remarks().iter().cloned());
            let bar = reading::bar("read", false);
            changes(&structure, &known.baseline, log.log(), &mut |share| reading::show(&bar, share))
                .map_err(|error| watch_failure(&error, &log.words()))
        };
        match compare() {
            Ok(found) => {
                names.push(group.log_name());
                trend.push(group.name, &found);
                events.push(found.events);
            }
            // one log of many, such as that of a morning on which the arm stood still
            Err(failure) if failure.is_of_input() => {
                trend.left_out.push((group.name, failure.sentence()));
                first_failure.get_or_insert(failure);
            }
            Err(failure) => return Err(failure),
        }
    }
    if let Some(failure) = first_failure.filter(|_| trend.rows.is_empty()) {
        return Err(failure);
    }
    for (name, reason) in &trend.left_out {
        warn(&mut remark, &format!("{name} is not compared: {reason}"));
    }
    let at_fault = events.iter().any(|events| !events.is_empty()) || !trend.left_out.is_empty();
    let what = if ["log", "day"].contains(&by) { by } else { "group" };
    let plural = if trend.rows.len() == 1 { "" } else { "s" };
    let about = format!("{} {what}{plural} compared with {}", trend.rows.len(), known.words);
    if let Some(path) = &arguments.plot {
        remark += &output_file::write_new(path, &trend.svg(robot, &about), sources, arguments.force)?;
    }
    if arguments.csv.as_deref().is_some_and(output_file::is_standard_output) {
        return Ok(Outcome { text: trend.csv(robot), remark, at_fault, ..Outcome::default() });
    }
    if let Some(path) = &arguments.csv {
        remark += &output_file::write_new(path, &trend.csv(robot), sources, arguments.force)?;
    }
    if arguments.json {
        return Ok(Outcome {
            remark,
            at_fault,
            ..Outcome::json(&TrendReply::of(robot, &known.words, &trend, &events))?
        });
    }
    let head = format!("{}: {about}", one_line(&robot.name));
    let mut text = format!("{TITLE}{}{TITLE:#}\n", wrap(&head, PAGE, "  "));
    let names: Vec<LogNames<'_>> = names.into_iter().map(|log| LogNames { log, quiet: &known.name }).collect();
    text += &watch_report::trend(robot, &trend, &events, &names);
    Ok(Outcome { text, remark, at_fault, remark_last: true })
}

/// Whether what is written can be, before any log is read.
fn check_places(arguments: &Arguments, sources: &[&Path]) -> Result<(), Failure> {
    let quiet = arguments.quiet.iter();
    if let Some(both) = quiet.clone().find(|quiet| arguments.logs.iter().any(|log| is_within(log, quiet))) {
        return Err(Failure::usage(format_args!(
            "{} is also watched: {TYPED}--quiet{TYPED:#} needs another log, without disturbances, so name one or leave \
             the option out",
            one_line(&both.display().to_string())
        )));
    }
    output_file::check_picture(arguments.plot.as_deref())?;
    let csv = arguments.csv.clone().filter(|path| !output_file::is_standard_output(path));
    let places = [
        (&arguments.plot, (Format::Svg, "<svg")),
        (&csv, (Format::Csv, if arguments.by.is_some() { "log," } else { watch_report::PARAMETERS })),
        (&arguments.save_baseline, (Format::RobotFile, "# A baseline of ")),
    ];
    for (path, kind) in places {
        if let Some(path) = path {
            output_file::check_place(path, kind, sources, arguments.force)?;
        }
    }
    Ok(())
}

/// The efforts of a log over those of the quiet log, where both have one unit: loads differ, and motions.
const UNIT: std::ops::Range<f64> = 0.2..5.0;

/// Why a robot file explains nothing: a file of the geometry alone predicts no torques.
fn doubt(robot: &Robot, question: &'static str) -> &'static str {
    if robot.joints.iter().all(|joint| joint.row.link.mass == 0.0) {
        "FILE contains no masses; `rne identify` computes them from a log"
    } else {
        question
    }
}

/// N m or N: what is left of an effort where nothing is.
const NOTHING: f64 = 1e-9;

/// Whether an event says already that a channel of a joint is wrong, so that the model cannot explain its torques.
fn has_faulty_channel(report: &Report, joint: usize) -> bool {
    report.events.iter().any(|event| match event.parameter {
        "frozen" => event.joint == Some(joint),
        "exchanged" => event.joint == Some(joint) || event.others.contains(&joint),
        // the model needs it for every joint
        "frozen_position" => true,
        _ => false,
    })
}

/// The joints whose torques are no better predicted than by their mean, or not at all; but those of which the file says
/// that nothing is known.
fn unexplained(robot: &Robot, errors: &[rne_identify::JointError]) -> Vec<usize> {
    let each = errors.iter().zip(Identification::not_excited(robot)).enumerate();
    // what is no number is no prediction
    let found = each.filter(|(_, (error, unknown))| {
        // an effort that does not change, and is what the model says, is explained
        let is_nothing = error.deviation == 0.0 && error.residual <= NOTHING;
        !unknown && !is_nothing && (error.error >= 1.0 || error.error.is_nan())
    });
    found.map(|(joint, _)| joint).collect()
}

fn names(robot: &Robot, joints: &[usize]) -> String {
    joints.iter().map(|joint| one_line(robot.coordinate_name(*joint))).collect::<Vec<_>>().join(", ")
}
