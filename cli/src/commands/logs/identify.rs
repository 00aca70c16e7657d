//! `rne identify`: identifies links, rotors and friction from logs.

use std::path::{Path, PathBuf};

use clap::Args;
use rne_identify::{
    Identification, IdentificationReply, JointError, Options, Part, Payload, Purpose, Verdict, identify,
};
use rne_model::{Robot, one_line};

use crate::commands::logs::judged::Judged;
use crate::commands::logs::prediction_errors::errors_table;
use crate::commands::logs::residuals;
use crate::files::chosen_arm::check_unknown_rotors;
use crate::files::file_name::Format;
use crate::files::motion_log::MotionLog;
use crate::files::output_file::{
    self, check_file, check_new_place, check_picture, check_place, is_standard_output, will_be_same,
};
use crate::files::robot_file::{self, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{TITLE, TYPED};
use crate::render::identified_parameters;
use crate::render::layout::{self, PAGE, note, wrap};
use crate::render::payload::{WordedPayload, link_with_tip};
use crate::render::verdict::{TIED, Worded};
use crate::values::log_arguments::LogArguments;
use crate::values::numbers::{checked, rounded};

/// Identify link parameters and friction of an arm from its logs
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne identify docs/desk_arm.yaml docs/desk_arm_log.csv -o identified.yaml
  rne identify docs/desk_arm.yaml docs/desk_arm_log.csv --hold-out 0.3
  rne identify docs/desk_arm.yaml docs/desk_arm_log.csv --judge
  rne identify docs/desk_arm_identified.yaml docs/desk_arm_loaded.csv --payload")]
#[allow(clippy::struct_excessive_bools)] // each is a flag of its own
pub(crate) struct Arguments {
    /// Robot file with the geometry of the arm
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Logs of the arm: ROS 2 bags, MCAP, Parquet, CSV, npy
    #[arg(value_name = "LOG", required = true)]
    logs: Vec<PathBuf>,
    /// Also identify the rotor inertia of the motors
    #[arg(long)]
    rotors: bool,
    /// Identify an arm without friction; ignore friction in FILE
    #[arg(long)]
    no_friction: bool,
    /// Weight that keeps unknown link parameters near the values in FILE; 1 is the weight of one row of the log
    #[arg(long, value_name = "G", default_value_t = 1.0,
        value_parser = checked(|pull: &f64| pull.is_finite() && *pull >= 1e-6,
        "write a number of at least 1e-6; 1 is the weight of one row of the log"))]
    pull: f64,
    /// Do not fit the last part of the data, such as 0.3 for 30 %; compute the errors on it
    #[arg(long, value_name = "PART", conflicts_with = "judge",
        value_parser = checked(|part: &f64| *part > 0.0 && *part < 1.0, "write a number between 0 and 1, such as 0.3"))]
    hold_out: Option<f64>,
    /// Identify nothing; compute how well FILE predicts the torques in the logs
    #[arg(long, conflicts_with_all = ["output", "rotors", "no_friction"])]
    judge: bool,
    /// Identify only a payload at the last link (in a tree: at the link with the tip), not the links
    #[arg(long, conflicts_with_all = ["judge", "rotors", "no_friction", "hold_out", "pull"])]
    payload: bool,
    /// Print every parameter, and the errors by joint speed
    #[arg(long, conflicts_with = "json")]
    all: bool,
    /// Print verdict, parameters and errors as JSON
    #[arg(long)]
    json: bool,
    /// Plot measured and predicted torques to this SVG file
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    /// Write measured, predicted and residual torques of every state to this CSV file
    #[arg(long, value_name = "CSV")]
    csv: Option<PathBuf>,
    /// Write the identified arm to this robot file; - is standard output
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Overwrite output files that exist
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    reading: LogArguments,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let sources: Vec<&Path> = arguments.logs.iter().map(PathBuf::as_path).chain([arguments.file.as_path()]).collect();
    check_places(arguments, &sources)?;
    let robot = &robot_file::robot(&arguments.file, Shape::Coupled)?;
    check_unknown_rotors(robot, arguments.rotors)?;
    // a file is judged on all data of the log
    let purpose = if arguments.judge { Purpose::Judge } else { Purpose::Fit };
    let log = &MotionLog::open(&arguments.logs, robot, &arguments.reading, purpose)?;
    let task = Task { arguments, sources: &sources, robot, log, remark: log.remark() };
    if arguments.judge {
        task.judge()
    } else if arguments.payload {
        task.payload()
    } else {
        task.identify()
    }
}

/// The robot file and the logs of one call of the command, with the remarks on them.
struct Task<'a> {
    arguments: &'a Arguments,
    /// Files that the command reads, so that no result may overwrite them.
    sources: &'a [&'a Path],
    robot: &'a Robot,
    log: &'a MotionLog,
    remark: String,
}

impl Task<'_> {
    /// Computes how well the robot file predicts the torques of the log.
    fn judge(mut self) -> Result<Outcome, Failure> {
        let Self { arguments, robot, log, .. } = self;
        let judged = Judged::of(robot, log, Part::All)?;
        let verdict = Verdict::of_file(robot, &judged.errors);
        let about = format!("{} on {}", one_line(&robot.name), log.words());
        self.draw(robot, &judged, &about, "the whole log")?;
        self.tabulate(robot, &[(Part::All, false)])?;
        if arguments.json {
            let reply = IdentificationReply::of_file(robot, &verdict, logs(arguments), log.cutoff(), judged.extent);
            return Ok(Outcome { remark: self.remark, ..Outcome::json(&reply)? });
        }
        let worded = Worded { verdict: &verdict, robot, file: &arguments.file, held_out: "", rows: 0 };
        let mut text = worded.below(&heading(robot, log));
        if arguments.all {
            text += &errors_table(robot, log, &judged.errors, &Identification::not_excited(robot), "errors on the log");
        } else {
            text += &worded.errors(log.cutoff());
        }
        Ok(Outcome { text, remark: self.remark, remark_last: true, at_fault: false })
    }

    /// Identifies links, rotors and friction.
    fn identify(mut self) -> Result<Outcome, Failure> {
        let Self { arguments, log, .. } = self;
        let (training, held) = match arguments.hold_out {
            Some(part) => (Part::Before(1.0 - part), Some(Part::From(1.0 - part))),
            None => (Part::All, None),
        };
        let found =
            identify(self.robot, options(arguments, log.cutoff()), arguments.pull, |take| log.pass(training, take))?;
        let robot = &found.robot;
        let held_out = held.map(|part| Judged::of(robot, log, part)).transpose()?;
        let verdict = Verdict::of(&found, held_out.as_ref().map(|held_out| &held_out.errors[..]));
        let place = held_out.as_ref().map_or_else(String::new, |held_out| held_out.words(log));
        let worded = Worded { verdict: &verdict, robot, file: &arguments.file, held_out: &place, rows: found.rows };
        if arguments.plot.is_some() {
            let title = format!("{} identified from {}", one_line(&robot.name), log.words());
            match &held_out {
                Some(held_out) => {
                    self.draw(robot, held_out, &title, &format!("held-out part of the log, {place}"))?;
                }
                None => {
                    self.draw(robot, &Judged::of(robot, log, Part::All)?, &title, "the data of the identification")?;
                }
            }
        }
        let parts: Vec<(Part, bool)> = [(training, false)].into_iter().chain(held.map(|held| (held, true))).collect();
        self.tabulate(robot, &parts)?;
        self.remark += &worded.offsets().map_or_else(String::new, |what| note(&what));
        for what in warnings(&found).into_iter().chain(worded.grown()) {
            self.remark += &warning(&what);
        }
        let text = if arguments.json {
            let held_out = held_out.as_ref().map(|held_out| held_out.extent);
            Outcome::json(&IdentificationReply::of(&found, &verdict, logs(arguments), log.cutoff(), held_out))?.text
        } else {
            account(arguments, &worded, &found, log, held_out.as_ref())
        };
        if !found.is_anything_excited() {
            let what = "nothing is excited: the log determines no link and no friction of this arm";
            return Ok(self.not_written(text, what, ", so "));
        }
        self.written(text, || found.robot_file(&log.words()))
    }

    /// Identifies the payload of a robot whose links are known.
    fn payload(mut self) -> Result<Outcome, Failure> {
        let Self { arguments, robot, log, .. } = self;
        if robot.joints.iter().all(|joint| joint.row.link.mass == 0.0) {
            let file = one_line(&arguments.file.display().to_string());
            return Err(input_error!(
                "no link of {file} has a mass, so a payload cannot be told from the links: identify the links from a \
                 log without payload first, {TYPED}rne identify {file} LOG -o identified.yaml{TYPED:#}"
            ));
        }
        let found = Payload::identify(robot, log.cutoff(), |take| log.pass(Part::All, take))?;
        let with = if found.is_there() { found.added_to(robot) } else { None };
        let without = Judged::of(robot, log, Part::All)?;
        let judged = with.as_ref().map(|with| Judged::of(with, log, Part::All)).transpose()?;
        let errors = judged.as_ref().map(|judged| &judged.errors[..]);
        let worded = WordedPayload { robot, payload: &found, errors: &without.errors, with: errors };
        let text = if arguments.json {
            Outcome::json(&worded.reply(logs(arguments), log.cutoff(), without.extent))?.text
        } else {
            let mut text = worded.below(&heading(robot, log));
            if arguments.all {
                let unknown = Identification::not_excited(robot);
                text += &errors_table(robot, log, &without.errors, &unknown, "errors of FILE on the log");
                if let Some(errors) = errors {
                    text += &errors_table(robot, log, errors, &unknown, "errors with the payload on the log");
                }
            }
            text
        };
        let drawn = with.as_ref().unwrap_or(robot);
        let title = format!("{} on {}", one_line(&robot.name), log.words());
        let about = if with.is_some() { "predicted with the payload" } else { "predicted without a payload" };
        self.draw(drawn, judged.as_ref().unwrap_or(&without), &title, about)?;
        self.tabulate(drawn, &[(Part::All, false)])?;
        if found.is_there() && with.is_none() {
            let what = format!(
                "according to the log, {} and the payload together have a negative mass, so FILE and the log are not \
                 from the same arm",
                link_with_tip(robot)
            );
            return Ok(self.not_written(text, &what, "; "));
        }
        if !found.mass.is_excited {
            let what = "the log does not determine the mass of a payload: record a motion in which gravity or \
                        accelerations load the joints";
            return Ok(self.not_written(text, what, "; "));
        }
        if arguments.output.is_some() && with.is_none() {
            self.remark += &warning("the log shows no payload, so the file is written with the links of FILE");
        }
        self.written(text, || found.robot_file(drawn, with.is_some(), &log.words()))
    }

    /// Draws the measured and the predicted torques of a part of the log, if the command line asks for a picture.
    fn draw(&mut self, robot: &Robot, judged: &Judged, title: &str, about: &str) -> Result<(), Failure> {
        if let Some(path) = &self.arguments.plot {
            let svg = judged.picture(robot, self.log, title, about)?;
            self.remark += &output_file::write_new(path, &svg, self.sources, self.arguments.force)?;
        }
        Ok(())
    }

    /// Writes the torques of parts of the log as a table; the flag of each part says whether it was held out.
    fn tabulate(&mut self, robot: &Robot, parts: &[(Part, bool)]) -> Result<(), Failure> {
        if let Some(path) = &self.arguments.csv {
            self.remark += &residuals::write(path, robot, self.log, parts)?;
        }
        Ok(())
    }

    /// Returns an outcome without a robot file; `why` is the reason.
    fn not_written(self, text: String, why: &str, before: &str) -> Outcome {
        let path = self.arguments.output.as_ref().map(|path| one_line(&path.display().to_string()));
        let not_written = path.map_or_else(String::new, |path| format!("{before}{path} is not written"));
        let remark = self.remark + &warning(&format!("{why}{not_written}"));
        Outcome { text, remark, remark_last: true, at_fault: true }
    }

    /// Returns the outcome, and writes the robot file if the command line asks for it.
    fn written(self, text: String, file: impl Fn() -> String) -> Result<Outcome, Failure> {
        let mut remark = self.remark;
        match &self.arguments.output {
            // standard output gets only the robot file, so all other text goes to the remarks
            Some(path) if is_standard_output(path) => {
                return Ok(Outcome { text: file(), remark: remark + &text, ..Outcome::default() });
            }
            Some(path) => remark += &output_file::write_new(path, &file(), self.sources, self.arguments.force)?,
            None => {}
        }
        Ok(Outcome { text, remark, remark_last: true, at_fault: false })
    }
}

/// Writes the verdict, the errors and, with `--all`, every number.
fn account(
    arguments: &Arguments,
    worded: &Worded<'_>,
    found: &Identification,
    log: &MotionLog,
    held_out: Option<&Judged>,
) -> String {
    let mut text = worded.below(&heading(&found.robot, log));
    if !arguments.all {
        return text + &worded.errors(log.cutoff());
    }
    let unknown: Vec<bool> = found.joints.iter().map(|joint| !joint.is_excited()).collect();
    let table = |errors: &[JointError], title: &str| errors_table(&found.robot, log, errors, &unknown, title);
    let fitted: Vec<JointError> = found.joints.iter().map(|joint| joint.error).collect();
    text += &identified_parameters::tables(found);
    let on_fitted = if held_out.is_some() { "errors on the fitted part of the log" } else { "errors on the log" };
    text += &table(&fitted, on_fitted);
    if let Some(held_out) = held_out {
        text += &table(&held_out.errors, "errors on the held-out part of the log");
    }
    text
}

/// Describes the robot and the log in a heading.
fn heading(robot: &Robot, log: &MotionLog) -> String {
    let about = format!("{} from {}, low-pass {:.1} Hz", one_line(&robot.name), log.words(), log.cutoff());
    format!("{TITLE}{}{TITLE:#}\n", wrap(&about, PAGE, "  "))
}

fn warning(what: &str) -> String {
    layout::warning(what).replace(TIED, " ")
}

fn logs(arguments: &Arguments) -> Vec<String> {
    arguments.logs.iter().map(|log| log.display().to_string()).collect()
}

/// Returns warnings about the log.
fn warnings(found: &Identification) -> Vec<String> {
    let mut said = Vec::new();
    for (joint, report) in found.robot.independent_joints().zip(&found.joints) {
        let (name, unit) = (one_line(&joint.name), joint.row.kind.effort_unit());
        if let Some(rejected) = report.rejected {
            said.push(format!(
                "{} of {} rows of {name} are outliers and are ignored, the first at {:.2} s: did somebody push the \
                 arm, or did a sensor fail?",
                rejected.rows, found.rows, rejected.time
            ));
        }
        if report.is_unexplained() {
            said.push(format!(
                "no model of the arm explains the efforts of {name}: are they noise, of opposite sign, or of another \
                 joint, and does FILE describe this arm?"
            ));
        } else if let Some((offset, coulomb)) = report.offset {
            said.push(format!(
                "{name} has an offset of {} {unit} (a spring, a counterweight or a sensor): a robot file cannot store \
                 more than Coulomb friction, which is {}, so predictions are wrong by the rest",
                rounded(offset, 3),
                rounded(coulomb, 3)
            ));
        }
    }
    said
}

/// Checks, before the long identification, that all output files can be written.
fn check_places(arguments: &Arguments, sources: &[&Path]) -> Result<(), Failure> {
    let output = arguments.output.as_deref().filter(|path| !is_standard_output(path));
    let plot = arguments.plot.as_deref();
    if let (Some(output), Some(plot)) = (output, plot)
        && will_be_same(output, plot)
    {
        let shown = one_line(&plot.display().to_string());
        return Err(usage_error!("{shown} is both the robot file and the picture; name two files"));
    }
    if arguments.json && arguments.output.as_deref().is_some_and(is_standard_output) {
        return Err(usage_error!(
            "{TYPED}--json{TYPED:#} and {TYPED}-o -{TYPED:#} both write to standard output; name a file for the robot"
        ));
    }
    let csv = arguments.csv.as_deref();
    for (other, kind) in [(output, "the robot file"), (plot, "the picture")] {
        if let (Some(csv), Some(other)) = (csv, other)
            && will_be_same(csv, other)
        {
            let shown = one_line(&csv.display().to_string());
            return Err(usage_error!("{shown} is both the table and {kind}; name two files"));
        }
    }
    check_picture(plot)?;
    check_file(csv, "--csv", "residuals.csv")?;
    if let Some(csv) = csv {
        check_new_place(csv, Format::Csv, sources, arguments.force)?;
    }
    for (path, kind) in [(output, (Format::RobotFile, "# Identified")), (plot, (Format::Svg, "<svg"))] {
        if let Some(path) = path {
            check_place(path, kind, sources, arguments.force)?;
        }
    }
    Ok(())
}

fn options(arguments: &Arguments, cutoff: f64) -> Options {
    let mut options = Options::default();
    options.friction = !arguments.no_friction;
    options.rotors = arguments.rotors;
    options.cutoff = Some(cutoff);
    options
}
