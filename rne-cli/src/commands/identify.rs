//! `rne identify`: links, rotors and friction from logs.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_identify::{Identification, JointError, MotionError, Options, Part, Prediction, Purpose, identify};
use rne_logs::Motion;
use rne_model::{FrictionTransition, JointKind, Robot, one_line};
use rne_plot::comparison_svg;

use crate::commands::prediction_errors::{errors_table, prediction};
use crate::files::file_name::Format;
use crate::files::motion_log::MotionLog;
use crate::files::output_file::{self, check_picture, check_place, is_standard_output, will_be_same};
use crate::files::robot_file;
use crate::outcome::{Failure, Outcome};
use crate::palette::{QUIET, TITLE, WARNING};
use crate::render::layout::{Align, PAGE, push_table, shortened, wrap};
use crate::values::log_arguments::LogArguments;
use crate::values::numbers::{checked, rounded};

/// States of a picture.
const DRAWN: u64 = 4000;

/// Identify link parameters and friction of an arm from its logs
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne identify docs/desk_arm.yaml docs/desk_arm_log.csv -o identified.yaml
  rne identify docs/desk_arm.yaml docs/desk_arm_log.csv --hold-out 0.3
  rne identify docs/desk_arm.yaml docs/desk_arm_log.csv --judge")]
#[allow(clippy::struct_excessive_bools)] // each is a flag of its own
pub(crate) struct Arguments {
    /// Robot file with the geometry of the arm
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Logs: ROS 2 bags, MCAP, Parquet, CSV, npy
    #[arg(value_name = "LOG", required = true)]
    logs: Vec<PathBuf>,
    /// Identify the rotor inertia of the motors, too
    #[arg(long)]
    rotors: bool,
    /// Assume no friction; ignore the friction of FILE
    #[arg(long)]
    no_friction: bool,
    /// Regularization to FILE's links
    #[arg(long, value_name = "G", default_value_t = 1.0,
        value_parser = checked(|pull: &f64| pull.is_finite() && *pull >= 1e-6,
        "a pull is a number of 1e-6 or more; 1 is as strong as one row of noise"))]
    pull: f64,
    /// Compute errors on this last fraction, such as 0.3
    #[arg(long, value_name = "PART", conflicts_with = "judge",
        value_parser = checked(|part: &f64| *part > 0.0 && *part < 1.0, "a part lies between 0 and 1, such as 0.3"))]
    hold_out: Option<f64>,
    /// Only compute the errors of FILE on the logs
    #[arg(long, conflicts_with_all = ["output", "rotors", "no_friction"])]
    judge: bool,
    /// Plot measured and predicted torques (SVG)
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    /// Robot file to write; - is standard output
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Overwrite existing files
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    reading: LogArguments,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let sources: Vec<&Path> = arguments.logs.iter().map(PathBuf::as_path).chain([arguments.file.as_path()]).collect();
    check_places(arguments, &sources)?;
    let robot = robot_file::robot(&arguments.file)?;
    // a file is judged by all that the log has
    let purpose = if arguments.judge { Purpose::Judge } else { Purpose::Fit };
    let log = MotionLog::open(&arguments.logs, &robot, &arguments.reading, purpose)?;
    let mut remark = log.remark(PAGE);
    let about = format!("{} from {}, low-pass {:.1} Hz", one_line(&robot.name), log.words(), log.cutoff());
    let mut text = format!("{TITLE}{}{TITLE:#}\n", wrap(&about, PAGE, "  "));
    if arguments.judge {
        text += &judged(&robot, &log, Part::All, &Identification::not_excited(&robot), "errors on the log")?;
        draw(arguments, &robot, &log, Part::All, &sources, &mut remark)?;
        return Ok(Outcome { text, remark, ..Outcome::default() });
    }
    let options = options(arguments, log.cutoff());
    let (training, held) = match arguments.hold_out {
        Some(part) => (Part::Before(1.0 - part), Some(Part::From(1.0 - part))),
        None => (Part::All, None),
    };
    let found = identify(&robot, options, arguments.pull, |take| log.pass(training, take))?;
    text += &account(&found, &log);
    if let Some(part) = held {
        text += &judged(&found.robot, &log, part, &unknown(&found), "errors on the held-out part of the log")?;
    }
    draw(arguments, &found.robot, &log, held.unwrap_or(Part::All), &sources, &mut remark)?;
    for what in warnings(&found) {
        let _ = writeln!(remark, "{WARNING}warning{WARNING:#}: {}", wrap(&what, PAGE - 9, "         "));
    }
    if !found.is_anything_excited() {
        let not_written = match &arguments.output {
            Some(path) => format!(", so {} is not written", one_line(&path.display().to_string())),
            None => String::new(),
        };
        let what = format!("nothing is excited: the log determines no link and no friction of this arm{not_written}");
        let _ = writeln!(remark, "{WARNING}warning{WARNING:#}: {}", wrap(&what, PAGE - 9, "         "));
        return Ok(Outcome { text, remark, at_fault: true });
    }
    if let Some(path) = &arguments.output {
        let file = found.robot_file(&log.words());
        if is_standard_output(path) {
            // what is not the file is a remark then
            return Ok(Outcome { text: file, remark: remark + &text, ..Outcome::default() });
        }
        remark += &output_file::write_new(path, &file, &sources, arguments.force)?;
    }
    Ok(Outcome { text, remark, ..Outcome::default() })
}

/// Warnings about a log.
fn warnings(found: &Identification) -> Vec<String> {
    let mut said = Vec::new();
    for (joint, report) in found.robot.joints.iter().zip(&found.joints) {
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

/// Whether what is written can be: nobody should wait for an identification whose result has no place.
fn check_places(arguments: &Arguments, sources: &[&Path]) -> Result<(), Failure> {
    let output = arguments.output.as_deref().filter(|path| !is_standard_output(path));
    let plot = arguments.plot.as_deref();
    if let (Some(output), Some(plot)) = (output, plot)
        && will_be_same(output, plot)
    {
        let shown = one_line(&plot.display().to_string());
        return Err(Failure::usage(format_args!("{shown} is both the robot file and the picture; name two files")));
    }
    check_picture(plot)?;
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

/// The joints that are not excited.
fn unknown(found: &Identification) -> Vec<bool> {
    found.joints.iter().map(|joint| !joint.is_excited()).collect()
}

/// The result as tables.
fn account(found: &Identification, log: &MotionLog) -> String {
    let of_links =
        found.structure.parameters().bases.iter().filter(|base| matches!(base.kept, rne_identify::Parameter::Link(..)));
    let of_links = of_links.count();
    let excited = found.bases.iter().filter(|base| base.is_excited()).count();
    let mut text = String::new();
    let rotors = match found.bases.len() - of_links {
        0 => String::new(),
        count => format!(" and {count} of rotors"),
    };
    let _ = writeln!(
        text,
        "{of_links} base parameters of the links{rotors}, {excited} of them excited; condition number {}",
        rounded(found.least_squares.condition, 0)
    );
    let certificate = &found.feasible.certificate;
    let _ = writeln!(
        text,
        "{QUIET}{} rows per joint over {:.1} s, {} segments; every link is a physical body, margin {:.1e}{QUIET:#}",
        found.rows, found.duration, found.least_squares.segments, certificate.margin
    );
    if let Some((delay, deviation)) = found.delay {
        let _ = writeln!(
            text,
            "{QUIET}torques lag {:.1} ± {:.1} ms behind the positions{QUIET:#}",
            1e3 * delay,
            1e3 * deviation
        );
    }
    let mut cells = vec![["  parameter", "value", "", "deviation", "", "written", "unit"].map(str::to_owned)];
    for (base, report) in found.structure.parameters().bases.iter().zip(&found.bases) {
        let unit = found.structure.unit(base.kept).to_owned();
        let (value, deviation, percent) = if report.is_excited() {
            let percent = 100.0 * report.deviation / report.value.abs();
            let percent = if percent < 1000.0 { format!("{percent:.1} %") } else { "> 999 %".to_owned() };
            (rounded(report.value, 4), rounded(report.deviation, 4), percent)
        } else {
            ("not excited".to_owned(), rounded(report.deviation, 4), String::new())
        };
        let name = format!("  {}", report.name);
        cells.push([name, value, "±".to_owned(), deviation, percent, rounded(report.written, 4), unit]);
    }
    let align = [Align::Left, Align::Right, Align::Left, Align::Right, Align::Right, Align::Right, Align::Left];
    push_table(&mut text, "base parameters: by least squares, and as written to the robot file", &align, &cells);
    friction(&mut text, found);
    inertia_of_rotors(&mut text, found);
    let errors: Vec<JointError> = found.joints.iter().map(|joint| joint.error).collect();
    text += &errors_table(&found.robot, log, &errors, &unknown(found), "errors on the log");
    text
}

fn friction(text: &mut String, found: &Identification) {
    let heading = ["  joint", "viscous", "Coulomb +", "Coulomb -", "transition"].map(str::to_owned);
    let mut cells = vec![heading];
    for (joint, report) in found.robot.joints.iter().zip(&found.joints) {
        let Some(friction) = report.friction else { return };
        let with = |(value, deviation): (f64, f64)| {
            if report.is_friction_excited() {
                format!("{} ± {}", rounded(value, 3), rounded(deviation, 3))
            } else {
                "not excited".to_owned()
            }
        };
        cells.push([
            format!("  {}", shortened(&one_line(&joint.name), 14)),
            with(friction[0]),
            with(friction[1]),
            with(friction[2]),
            report
                .transition
                .filter(|_| report.is_friction_excited())
                .map_or_else(String::new, |transition| turns(transition, joint.row.kind)),
        ]);
    }
    let align = [Align::Left, Align::Right, Align::Right, Align::Right, Align::Right];
    let kinds: Vec<JointKind> = found.robot.joints.iter().map(|joint| joint.row.kind).collect();
    let units = match (kinds.contains(&JointKind::Revolute), kinds.contains(&JointKind::Prismatic)) {
        (_, false) => "N m s/rad, N m",
        (false, true) => "N s/m, N",
        (true, true) => "N m s/rad, N m or N s/m, N",
    };
    let title = format!("friction at the joint, {units}; transition: speed or displacement");
    push_table(text, &title, &align, &cells);
}

/// The speed or the displacement in which friction changes its sign.
fn turns(transition: FrictionTransition, kind: JointKind) -> String {
    let unit = kind.position_unit();
    match transition {
        FrictionTransition::Speed(speed) => format!("{speed} {unit}/s"),
        FrictionTransition::Displacement(length) => format!("{length} {unit}"),
    }
}

/// The rotors, where they were asked for.
fn inertia_of_rotors(text: &mut String, found: &Identification) {
    let mut cells = vec![["  joint", "rotor", "", ""].map(str::to_owned)];
    let bases = || found.structure.parameters().bases.iter().zip(&found.bases);
    for (at, (joint, report)) in found.robot.joints.iter().zip(&found.joints).enumerate() {
        let Some(rotor) = report.rotor else { return };
        let [unit, link] = match joint.row.kind {
            JointKind::Revolute => ["kg m²", "inertia"],
            JointKind::Prismatic => ["kg", "mass"],
        };
        let known = bases().find(|(base, _)| base.kept == rne_identify::Parameter::Rotor(at)).map(|(_, of)| of);
        let said = match known {
            None => format!("not separable from the {link} of links"),
            Some(base) if base.is_excited() => String::new(),
            Some(_) => "not excited".to_owned(),
        };
        cells.push([format!("  {}", shortened(&one_line(&joint.name), 14)), rounded(rotor, 4), unit.to_owned(), said]);
    }
    push_table(
        text,
        "inertia of the rotors at the joint",
        &[Align::Left, Align::Right, Align::Left, Align::Left],
        &cells,
    );
}

/// How well a robot predicts a part of a log.
fn judged(robot: &Robot, log: &MotionLog, part: Part, unknown: &[bool], title: &str) -> Result<String, Failure> {
    Ok(errors_table(robot, log, &prediction(robot, log, part)?, unknown, title))
}

/// Draws a part of the log.
fn draw(
    arguments: &Arguments,
    robot: &Robot,
    log: &MotionLog,
    part: Part,
    sources: &[&Path],
    remark: &mut String,
) -> Result<(), Failure> {
    let Some(path) = &arguments.plot else { return Ok(()) };
    let mut states = 0;
    log.pass(part, &mut |motion| {
        states += motion.len() as u64;
        Ok::<(), MotionError>(())
    })?;
    let stride = usize::try_from(states.div_ceil(DRAWN)).unwrap_or(usize::MAX).max(1);
    let prediction = Prediction::new(robot, Some(log.cutoff()));
    let (mut time, mut pairs) = (Vec::new(), vec![Vec::new(); robot.dof()]);
    log.pass(part, &mut |motion: &Motion| {
        time.extend(motion.time.iter().step_by(stride));
        for (all, of) in pairs.iter_mut().zip(prediction.pairs(motion)?) {
            all.extend(of.into_iter().step_by(stride));
        }
        Ok::<(), MotionError>(())
    })?;
    let side = |of: fn(&(f64, f64)) -> f64| -> Vec<Vec<f64>> {
        pairs.iter().map(|pairs: &Vec<(f64, f64)>| pairs.iter().map(of).collect()).collect()
    };
    let about = format!("{}, both low-passed at {:.1} Hz", log.words(), log.cutoff());
    let svg = comparison_svg(robot, &time, &side(|pair| pair.0), &side(|pair| pair.1), &about);
    *remark += &output_file::write_new(path, &svg, sources, arguments.force)?;
    Ok(())
}
