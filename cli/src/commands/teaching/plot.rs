//! `rne plot`: draws the torques along a trajectory, and their parts.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_model::{Robot, exact_digits};
use rne_plot::{TorqueHistory, Trajectory, significant, svg};

use crate::files::chosen_arm::{ChosenArm, Setting};
use crate::files::input_file::is_standard_input;
use crate::files::output_file::{self, Output};
use crate::files::robot_file::Shape;
use crate::files::trajectory_file;
use crate::outcome::{Failure, Outcome};
use crate::palette::{QUIET, TYPED};
use crate::render::layout::{Align, columns};
use crate::values::numbers::{above_zero, rounded};

/// Plot torques over a motion: inertia, velocity and gravity parts
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne plot robots/puma560.yaml -o puma560.svg
  rne plot planar2 --duration 0.8 > planar2.svg
  rne plot planar2 --csv > torques.csv

The CSV file of --trajectory has the columns t, q1, …, qd1, …, qdd1, … in s, rad
or m, and per second. If qd and qdd are missing, rne computes them from the
parabola through a sample and its neighbours. Without --trajectory all joints
move from a quarter to three quarters of the way between their limits, from rest
to rest, in 2 s, or longer if speed limits require it. No wrench acts on the
tip. Torques do not include friction; they include rotors only with --rotors.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    arm: ChosenArm,
    /// CSV file with the motion [default: from one quarter to three quarters of the way between the joint limits]
    #[arg(long, value_name = "CSV", conflicts_with = "duration")]
    trajectory: Option<PathBuf>,
    /// Duration of the default motion, s [default: 2, or longer if speed limits require it]
    #[arg(long, value_name = "S", value_parser = above_zero("write a number of seconds above 0, such as 1.5"))]
    duration: Option<f64>,
    /// Write the torques as numbers (CSV) instead of a picture (SVG)
    #[arg(long)]
    csv: bool,
    #[command(flatten)]
    output: Output,
}

/// Duration of the default motion, s, unless speed limits require a longer one.
const DURATION: f64 = 2.0;

/// Number of samples of the default motion between two postures.
const SAMPLES: usize = 241;

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = arguments.arm.robot_with_payload(Shape::Coupled)?;
    let (trajectory, mut about) = motion(arguments, &robot)?;
    for Setting { name, value } in &arguments.arm.set {
        let _ = write!(about, ", {name} = {value}");
    }
    if arguments.arm.carried.payload.is_some() {
        about.push_str(", with a payload");
    }
    if robot.has_rotors() {
        about.push_str(", with rotors");
    }
    let history = TorqueHistory::new(&robot, &trajectory).map_err(Failure::usage)?;
    if let Some(sample) = history.overflows() {
        let time = exact_digits(trajectory.time[sample]);
        return Err(input_error!("a torque overflows at {time} s: the motion is too fast"));
    }
    let text =
        if arguments.csv { csv(&robot, &trajectory, &history) } else { svg(&robot, &trajectory, &history, &about) };
    match arguments.output.out.as_deref().filter(|path| !output_file::is_standard_output(path)) {
        None => Ok(Outcome::text(text)),
        Some(path) => {
            let sources: Vec<&Path> =
                arguments.trajectory.as_deref().into_iter().chain([arguments.arm.file()]).collect();
            if !sources.iter().any(|source| output_file::is_same(path, source)) {
                is_named_for(path, arguments.csv)?;
            }
            let written = output_file::write_new(path, &text, &sources, arguments.output.force)?;
            Ok(Outcome::text(written + &peaks(&robot, &history)))
        }
    }
}

/// Checks that the extension of a file fits what is written into it.
fn is_named_for(path: &Path, csv: bool) -> Result<(), Failure> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let shown = path.display();
    match (extension.as_str(), csv) {
        ("", _) | ("svg", false) | ("csv" | "txt", true) => Ok(()),
        ("csv", false) => {
            Err(usage_error!("{shown} has the name of a CSV file; add {TYPED}--csv{TYPED:#} to write numbers"))
        }
        (_, false) => Err(usage_error!(
            "{shown} does not have the name of an SVG, the only picture format; name it {TYPED}{}{TYPED:#}, and \
             convert it with a browser, Inkscape or LibreOffice",
            path.with_extension("svg").display()
        )),
        (_, true) => Err(usage_error!(
            "{shown} does not have the name of a CSV file, which --csv writes; name it {TYPED}{}{TYPED:#}",
            path.with_extension("csv").display()
        )),
    }
}

/// Returns the motion, and its description.
fn motion(arguments: &Arguments, robot: &Robot) -> Result<(Trajectory, String), Failure> {
    if let Some(path) = &arguments.trajectory {
        let trajectory_file::Given { trajectory, derived } = trajectory_file::read(path, robot)?;
        let name = match path.file_name() {
            Some(name) if !is_standard_input(path) => name.to_string_lossy().into_owned(),
            _ => "trajectory".to_owned(),
        };
        let samples = trajectory.time.len();
        let derived = if derived.is_empty() { String::new() } else { format!("; {derived}") };
        return Ok((trajectory, format!("{name}, {samples} samples{derived}")));
    }
    let [from, to] = Trajectory::postures(robot);
    let least = Trajectory::least_duration(robot, &from, &to);
    // rounded up to tenths of a second, so that speed limits are kept
    let seconds = arguments.duration.unwrap_or_else(|| DURATION.max((least * 10.0).ceil() / 10.0));
    let too_fast = |_| input_error!("in {seconds:e} s a speed overflows: the motion is too fast");
    let trajectory = Trajectory::quintic(&from, &to, seconds, SAMPLES).map_err(too_fast)?;
    let fast = if seconds < least {
        format!(", faster than speed limits allow ({} s)", rounded(least, 2))
    } else {
        String::new()
    };
    let about = format!(
        "all joints between two postures inside their limits in {} s, from rest to rest, quintic{fast}",
        exact_digits(seconds)
    );
    Ok((trajectory, about))
}

/// Lists the largest torque of each joint.
fn peaks(robot: &Robot, history: &TorqueHistory) -> String {
    let mut cells = vec![["  joint", "peak", "", "at", "velocity terms"].map(str::to_owned)];
    for (joint, peak) in robot.joints.iter().zip(&history.peaks) {
        let unit = joint.row.kind.effort_unit();
        cells.push([
            format!("  {}", joint.name),
            significant(peak.tau, 3).replace('\u{2212}', "-"),
            unit.to_owned(),
            format!("{} s", rounded(peak.time, 3)),
            format!("{:.0} %", 100.0 * peak.velocity_share),
        ]);
    }
    let lines = columns(&[Align::Left, Align::Right, Align::Left, Align::Right, Align::Right], &cells);
    format!("{QUIET}{}{QUIET:#}\n{}\n", lines[0], lines[1..].join("\n"))
}

/// Writes everything that the picture shows as numbers.
fn csv(robot: &Robot, trajectory: &Trajectory, history: &TorqueHistory) -> String {
    let names = ["tau", "inertia", "velocity", "gravity", "power"];
    let columns = |name: &&str| (1..=robot.dof()).map(|joint| format!("{name}{joint}")).collect::<Vec<_>>();
    let mut text = format!("t,{}\n", names.iter().flat_map(columns).collect::<Vec<_>>().join(","));
    for ((time, parts), powers) in trajectory.time.iter().zip(&history.parts).zip(&history.powers) {
        text.push_str(&exact_digits(*time));
        let numbers = [&parts.total, &parts.inertia, &parts.velocity, &parts.gravity, powers].into_iter().flatten();
        for number in numbers {
            let _ = write!(text, ",{}", exact_digits(*number));
        }
        text.push('\n');
    }
    text
}
