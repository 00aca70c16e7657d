//! `rne watch`: finds from logs what has changed about an arm.

mod trend;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_identify::{ArmLogRemark, Identification, Part, Purpose};
use rne_model::{Robot, one_line};
use rne_watch::{Baseline, Report, Settings, WatchError, WatchReply, svg, watch};

use crate::commands::logs::prediction_errors::{errors_table, prediction};
use crate::files::file_name::Format;
use crate::files::motion_log::{MotionLog, watch_failure};
use crate::files::output_file;
use crate::files::reading;
use crate::files::robot_file::{self, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{QUIET, TITLE, TYPED};
use crate::render::layout::{PAGE, note, warning, wrap};
use crate::render::watch_dates::{LogName, LogNames};
use crate::render::watch_report;
use crate::values::log_arguments::LogArguments;
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

/// Returns whether a file is a log, by its extension; a baseline file is YAML.
fn is_log(path: &Path) -> bool {
    let end = path.extension().map(|end| end.to_string_lossy().to_lowercase());
    end.is_some_and(|end| ["csv", "db3", "mcap", "npy", "parquet"].contains(&end.as_str()))
}

/// Returns whether two paths mean the same log: the same file, or a folder and a file in it.
fn is_within(a: &Path, b: &Path) -> bool {
    let (Ok(a), Ok(b)) = (a.canonicalize(), b.canonicalize()) else { return false };
    a.starts_with(&b) || b.starts_with(&a)
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let inputs = arguments.logs.iter().chain(&arguments.quiet).chain(&arguments.baseline).chain([&arguments.file]);
    let sources: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    check_places(arguments, &sources)?;
    let robot = &robot_file::robot(&arguments.file, Shape::Coupled)?;
    let settings = &Settings { gain: arguments.gain, hold: arguments.hold, false_alarms: arguments.false_alarms };
    let mut task = Task { arguments, sources: &sources, robot, settings, remark: String::new() };
    let known = task.known()?;
    match &arguments.by {
        Some(by) => task.trend(known, by),
        None => task.events(known),
    }
}

/// The robot file and the logs of one call of the command, with the remarks on them.
struct Task<'a> {
    arguments: &'a Arguments,
    /// Files that the command reads, so that no result may overwrite them.
    sources: &'a [&'a Path],
    robot: &'a Robot,
    settings: &'a Settings,
    remark: String,
}

/// A baseline, and words that say where it is from.
struct Known {
    baseline: Baseline,
    words: String,
    name: LogName,
    /// Remarks that have been printed already.
    remarks: Vec<ArmLogRemark>,
}

impl Task<'_> {
    /// Makes the baseline from quiet logs, or reads it from a file.
    fn known(&mut self) -> Result<Option<Known>, Failure> {
        let Self { arguments, robot, .. } = *self;
        if let Some(path) = &arguments.baseline {
            let shown = path.display().to_string();
            if path.is_dir() || is_log(path) {
                return Err(usage_error!(
                    "{} is a log, and {TYPED}--baseline{TYPED:#} reads a file that {TYPED}--save-baseline{TYPED:#} \
                     wrote; give a log with {TYPED}--quiet{TYPED:#}",
                    one_line(&shown)
                ));
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
        self.remark += &quiet.remark();
        let baseline = Baseline::of_logs(robot, quiet.log(), self.settings, &mut reading::progress(false))
            .map_err(|error| watch_failure(&error, &quiet.words()))?;
        let joints = unexplained(robot, &prediction(robot, &quiet, Part::All)?);
        if !joints.is_empty() {
            self.remark += &warning(&format!(
                "the model explains nothing of the torques of {} in the quiet log: {}",
                names(robot, &joints),
                doubt(robot, "is it a log of this arm?")
            ));
        }
        if let Some(path) = &arguments.save_baseline {
            self.write(path, &baseline.to_yaml(robot, &quiet.words()))?;
        }
        let name = LogName::of(&arguments.quiet, "the quiet logs");
        Ok(Some(Known { baseline, words: quiet.words(), name, remarks: quiet.log().remarks().to_vec() }))
    }

    /// Writes a file, but never over a file that the command reads.
    fn write(&mut self, path: &Path, text: &str) -> Result<(), Failure> {
        self.remark += &output_file::write_new(path, text, self.sources, self.arguments.force)?;
        Ok(())
    }

    /// Finds the changes in all logs, joined to one, and prints them as text, JSON or CSV.
    fn events(mut self, known: Option<Known>) -> Result<Outcome, Failure> {
        let Self { arguments, robot, settings, .. } = self;
        let log = match &known {
            Some(known) => MotionLog::open_beside(&arguments.logs, robot, &arguments.reading, known.baseline.cutoff)?,
            None => MotionLog::open(&arguments.logs, robot, &arguments.reading, Purpose::Watch)?,
        };
        self.remark += &log.remark_beside(known.as_ref().map_or(&[], |known| &known.remarks));
        let known = known.map_or_else(|| of_robot_file(robot, &log), Ok)?;
        let report =
            watch(robot, &known.baseline, log.log(), settings, arguments.plot.is_some(), &mut reading::progress(false))
                .map_err(|error| watch_failure(&error, &log.words()))?;
        if let Some(path) = &arguments.plot {
            self.write(path, &svg(robot, &report, settings, &log.words()))?;
            if report.is_cut {
                self.remark += &note("the picture ends where the time of the logs goes back");
            }
        }
        let judged = log.judged()?;
        let errors = prediction(robot, &judged, Part::All)?;
        let mut unexplained = unexplained(robot, &errors);
        unexplained.retain(|joint| !has_faulty_channel(&report, *joint));
        self.warn(&report, &unexplained);
        let at_fault = !(report.events.is_empty() && unexplained.is_empty());
        if let Some(path) = &arguments.csv {
            let table = watch_report::parameters_csv(robot, &known.baseline, &report.changes);
            if output_file::is_standard_output(path) {
                return Ok(Outcome { text: table, remark: self.remark, at_fault, ..Outcome::default() });
            }
            self.write(path, &table)?;
        }
        if arguments.json {
            let Known { baseline, words, .. } = &known;
            let reply = WatchReply::of(robot, log.words(), log.read_to(), words, baseline, &report, &errors);
            return Ok(Outcome { remark: self.remark, at_fault, ..Outcome::json(&reply)? });
        }
        let mut text = self.account(&known, &log, &report);
        if arguments.all {
            text += &watch_report::parameters(robot, &known.baseline, &report.changes);
            text += &errors_table(robot, &judged, &errors, &Identification::not_excited(robot), "errors on the log");
        }
        Ok(Outcome { text, remark: self.remark, at_fault, remark_last: true })
    }

    /// Warns of reasons to doubt the events.
    fn warn(&mut self, report: &Report, unexplained: &[usize]) {
        let Self { arguments, robot, .. } = *self;
        let ratio = report.changes.effort_ratio;
        if !UNIT.contains(&ratio) {
            self.remark += &warning(&format!(
                "the efforts are {} times as large as in the quiet log: do they have another unit, or another torque \
                 constant? Then the events mean nothing",
                rounded(ratio, 2)
            ));
        }
        if arguments.logs.len() > 1 && arguments.quiet.is_empty() && arguments.baseline.is_none() {
            self.remark += &warning(
                "the logs are joined to one, so a change between them can be hidden; --quiet names the log to compare \
                 with, and --by log compares each with the first",
            );
        }
        if !unexplained.is_empty() {
            let names = names(robot, unexplained);
            let what = doubt(robot, "does FILE describe this arm, with its friction?");
            self.remark += &warning(&format!("the model explains nothing of the torques of {names}: {what}"));
        }
    }

    /// Lists the events below a heading.
    fn account(&self, Known { baseline, words, name, .. }: &Known, log: &MotionLog, report: &Report) -> String {
        let robot = self.robot;
        let about = format!("{} from {}, low-pass {:.1} Hz", one_line(&robot.name), log.words(), baseline.cutoff);
        let mut text = format!("{TITLE}{}{TITLE:#}\n", wrap(&about, PAGE, "  "));
        let _ = writeln!(text, "{QUIET}{}{QUIET:#}", wrap(&format!("compared with: {words}"), PAGE, "  "));
        let names = LogNames { log: LogName::of(&self.arguments.logs, "the logs"), quiet: name };
        text + &watch_report::events(robot, baseline, report, log.runs() > 1, &names)
    }
}

/// Makes a baseline from the log itself and the robot file, if no other baseline is given.
fn of_robot_file(robot: &Robot, log: &MotionLog) -> Result<Known, Failure> {
    let baseline = Baseline::of_file(robot, log.log(), &mut reading::progress(false)).map_err(|error| match error {
        WatchError::ShortBaseline { .. } => input_error!(
            "{}: {error}. A longer log of the arm without any fault, given with {TYPED}--quiet{TYPED:#}, can be \
                 its baseline",
            log.words()
        ),
        error => watch_failure(&error, &log.words()),
    })?;
    let name = LogName::several("the quiet logs".to_owned());
    Ok(Known { baseline, words: "the robot file".to_owned(), name, remarks: Vec::new() })
}

/// Checks, before any log is read, that all output files can be written.
fn check_places(arguments: &Arguments, sources: &[&Path]) -> Result<(), Failure> {
    let quiet = arguments.quiet.iter();
    if let Some(both) = quiet.clone().find(|quiet| arguments.logs.iter().any(|log| is_within(log, quiet))) {
        return Err(usage_error!(
            "{} is also watched: {TYPED}--quiet{TYPED:#} needs another log, without disturbances, so name one or leave \
             the option out",
            one_line(&both.display().to_string())
        ));
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

/// Range of the ratio between efforts of a log and of the quiet log in which both have probably the same unit: loads
/// and motions may differ.
const UNIT: std::ops::Range<f64> = 0.2..5.0;

/// Returns why a robot file does not explain the torques: a file with geometry only predicts none.
fn doubt(robot: &Robot, question: &'static str) -> &'static str {
    if robot.joints.iter().all(|joint| joint.row.link.mass == 0.0) {
        "FILE contains no masses; `rne identify` computes them from a log"
    } else {
        question
    }
}

/// A residual up to this, N m or N, is a rounding error: the model reproduces the effort.
const ROUNDING: f64 = 1e-9;

/// Returns whether an event already reports a wrong channel of a joint, which is then the reason why the model does not
/// fit.
fn has_faulty_channel(report: &Report, joint: usize) -> bool {
    report.events.iter().any(|event| match event.parameter {
        "frozen" => event.joint == Some(joint),
        "exchanged" => event.joint == Some(joint) || event.others.contains(&joint),
        // the model needs the position of every joint
        "frozen_position" => true,
        _ => false,
    })
}

/// Returns the joints whose torques the model predicts no better than their mean does, or not at all; without joints of
/// which the file says that nothing is known.
fn unexplained(robot: &Robot, errors: &[rne_identify::JointError]) -> Vec<usize> {
    let each = errors.iter().zip(Identification::not_excited(robot)).enumerate();
    // an error that is not a number means that there is no prediction
    let found = each.filter(|(_, (error, unknown))| {
        // a constant effort that the model reproduces is explained
        let is_reproduced = error.deviation == 0.0 && error.residual <= ROUNDING;
        !unknown && !is_reproduced && (error.error >= 1.0 || error.error.is_nan())
    });
    found.map(|(joint, _)| joint).collect()
}

fn names(robot: &Robot, joints: &[usize]) -> String {
    joints.iter().map(|joint| one_line(robot.coordinate_name(*joint))).collect::<Vec<_>>().join(", ")
}
