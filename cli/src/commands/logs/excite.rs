//! `rne excite`: finds a motion from which an identification learns the most.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use rne_identify::{
    AskedLimits, Excitation, ExcitationError, ExcitationOptions, ExcitationProgress, Fourier, JointUse, MotionLimits,
    excite,
};
use rne_model::{Robot, exact_digits, one_line};
use rne_plot::{Panel, PanelCurve, panels};

use crate::commands::logs::gravity_load::beyond_effort;
use crate::files::chosen_arm::{Carried, check_unknown_rotors};
use crate::files::file_name::{self, Format};
use crate::files::interruption;
use crate::files::output_file::{
    self, Replacement, check_new, check_picture, is_standard_output, unwritable, will_be_same,
};
use crate::files::robot_file::{self, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{GOOD, TITLE, WARNING};
use crate::remedy;
use crate::render::layout::{Align, PAGE, note, push_table, shortened, wrap};
use crate::values::numbers::{List, checked, rounded};

/// Largest number of samples in a trajectory: some hundred megabytes for an arm of six joints.
const MOST: f64 = 500_000.0;

/// Largest number of motions that a search tries: about a day.
const MOTIONS: u64 = 100_000_000;

/// Number of samples in a picture.
const DRAWN: u32 = 1000;

/// Find a motion for `rne identify` that excites the parameters well
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne excite docs/desk_arm.yaml --evaluations 200 -o trajectory.csv
  rne excite planar2 --evaluations 200 --velocity 1.5,2 --plot motion.svg

The motion is a Fourier series from rest to rest within the limits, with the
least condition number that the search finds. rne checks limits but no
collisions, so try the motion in a simulator or at low speed first. Ctrl-C ends
the search and keeps the best motion. The trajectory has the columns t, q1, …,
qd1, …, qdd1, … in s, rad or m, and per second.")]
pub(crate) struct Arguments {
    /// Robot file, or a name from `rne list`
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Duration of the motion, s
    #[arg(long, value_name = "S", default_value_t = 20.0, allow_negative_numbers = true,
        value_parser = checked(|s: &f64| (1e-3..=86_400.0).contains(s), "write a number of seconds, 0.001 to 86400"))]
    seconds: f64,
    /// Number of times that the motion repeats within --seconds
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    periods: u32,
    /// Harmonics in the Fourier series of each joint, 2 to 50
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = checked(|n: &usize| (2..=50).contains(n),
        "write 2 to 50 harmonics; a motion with fewer than two cannot start and end at rest"))]
    harmonics: usize,
    /// Largest distance of a joint from the middle of its limits, or from 0 if it has no limits; rad or m, one number
    /// or one per joint
    #[arg(long, value_name = "LIST")]
    range: Option<List>,
    /// Largest joint speed, rad/s or m/s, one number or one per joint; limits in FILE also apply
    #[arg(long, value_name = "LIST")]
    velocity: Option<List>,
    /// Largest joint acceleration, rad/s² or m/s², one number or one per joint [default: speed / 0.5 s]
    #[arg(long, value_name = "LIST")]
    acceleration: Option<List>,
    /// Design the motion for an arm without friction
    #[arg(long)]
    no_friction: bool,
    /// Also excite the rotor inertia of the motors
    #[arg(long)]
    rotors: bool,
    #[command(flatten)]
    carried: Carried,
    /// Number of motions that the search tries
    #[arg(long, value_name = "N", default_value_t = 5000, value_parser = clap::value_parser!(u64).range(1..=MOTIONS))]
    evaluations: u64,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Samples per second in the trajectory file, Hz
    #[arg(long, value_name = "HZ", default_value_t = 100.0, allow_negative_numbers = true,
        value_parser = checked(|hz: &f64| (1e-3..=1e6).contains(hz),
        "write a number of samples per second, 0.001 to 1000000"))]
    rate: f64,
    /// Plot the joint positions to this SVG file
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    /// Write the trajectory to this CSV file; - is standard output
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Overwrite output files that exist
    #[arg(long)]
    force: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = arguments.carried.of(robot_file::robot(&arguments.file, Shape::Coupled)?)?;
    check_unknown_rotors(&robot, arguments.rotors)?;
    if arguments.seconds * arguments.rate > MOST {
        return Err(usage_error!(
            "{} s at {} Hz are more than {MOST} samples; use a lower --rate",
            exact_digits(arguments.seconds),
            exact_digits(arguments.rate)
        ));
    }
    let sources = [arguments.file.as_path()];
    let out = arguments.output.as_deref();
    let is_shown = out.is_some_and(is_standard_output);
    if let (Some(out), Some(plot)) = (out, arguments.plot.as_deref())
        && will_be_same(out, plot)
    {
        return Err(Failure::usage("-o and --plot name the same file; give the trajectory and its picture two names"));
    }
    check_picture(arguments.plot.as_deref())?;
    let trajectory = out.filter(|_| !is_shown);
    let plot = arguments.plot.as_deref();
    for path in trajectory.into_iter().chain(plot) {
        check_new(path, None, &sources, arguments.force)?;
        // checked before the search, so that a wrong path wastes no time
        drop(Replacement::begin(path).map_err(|error| unwritable(path, &error))?);
    }
    trajectory.map(|path| file_name::format(path, &[Format::Csv])).transpose()?;
    plot.map(|path| file_name::check(path, Format::Svg)).transpose()?;
    let limits = MotionLimits::of(&robot, &asked(arguments)).map_err(|error| failure(&error))?;
    interruption::expect();
    let found = watched(&robot, &limits, &options(arguments)).map_err(|error| match &error {
        ExcitationError::Effort { .. } => beyond_effort(&robot, &limits, &error),
        _ => failure(&error),
    })?;
    let account = account(arguments, &robot, &found);
    let trajectory = || csv(&found.motion, robot.dof(), arguments);
    // either both files are written or none
    let mut files = Vec::new();
    if let Some(path) = &arguments.plot {
        files.push((path.as_path(), picture(arguments, &robot, &found)));
    }
    if let Some(path) = out.filter(|_| !is_shown) {
        files.push((path, trajectory()));
    }
    for (path, text) in &files {
        check_new(path, Some(text), &sources, arguments.force)?;
    }
    let remark = output_file::write_all(&files)?;
    Ok(if is_shown {
        Outcome { text: trajectory(), remark: account + &remark, ..Outcome::default() }
    } else {
        Outcome { text: account, remark, ..Outcome::default() }
    })
}

/// Makes the error for a motion that cannot be found.
pub(super) fn failure(error: &ExcitationError) -> Failure {
    let text = remedy::of_excitation(error);
    if error.is_of_request() { Failure::usage(text) } else { Failure::input(text) }
}

fn asked(arguments: &Arguments) -> AskedLimits {
    let list = |list: &Option<List>| list.as_ref().map(|List(numbers)| numbers.clone());
    let mut asked = AskedLimits::default();
    asked.range = list(&arguments.range);
    asked.velocity = list(&arguments.velocity);
    asked.acceleration = list(&arguments.acceleration);
    asked
}

fn options(arguments: &Arguments) -> ExcitationOptions {
    let mut options = ExcitationOptions::default();
    options.period = arguments.seconds / f64::from(arguments.periods);
    options.harmonics = arguments.harmonics;
    options.evaluations = arguments.evaluations;
    options.seed = arguments.seed;
    options.friction = !arguments.no_friction;
    options.rotors = arguments.rotors;
    options
}

/// Searches a motion, with a progress bar on a terminal.
fn watched(robot: &Robot, limits: &[MotionLimits], options: &ExcitationOptions) -> Result<Excitation, ExcitationError> {
    let bar = ProgressBar::new(options.evaluations);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {percent} % searched, {eta} to go, {msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    let mut shown = Instant::now();
    let found = excite(robot, limits, options, &mut |progress: &ExcitationProgress| {
        if shown.elapsed() > Duration::from_millis(100) {
            shown = Instant::now();
            bar.set_position(progress.evaluations);
            bar.set_message(format!("condition {}, {} excited", condition(progress.condition), progress.excited));
        }
        !interruption::is_wished()
    });
    bar.finish_and_clear();
    found
}

fn condition(condition: f64) -> String {
    if condition < 100.0 {
        format!("{condition:.1}")
    } else if condition < 1e6 {
        format!("{condition:.0}")
    } else {
        format!("{condition:.1e}")
    }
}

/// Writes the result as tables.
fn account(arguments: &Arguments, robot: &Robot, found: &Excitation) -> String {
    let friction = if arguments.no_friction { "without friction" } else { "with friction" };
    let period = found.motion.period();
    let times = if arguments.periods == 1 { String::new() } else { format!("{} times ", arguments.periods) };
    let about = format!(
        "{}: {times}{} s of {} harmonics, from rest to rest",
        one_line(&robot.name),
        exact_digits(period),
        arguments.harmonics
    );
    let mut text = format!("{TITLE}{}{TITLE:#}\n", wrap(&about, PAGE, "  "));
    let excited = found.bases.iter().filter(|base| base.is_excited()).count();
    let mark = if excited < found.bases.len() { WARNING } else { GOOD };
    let all = found.bases.len();
    let _ = writeln!(text, "{all} base parameters, {mark}{excited}{mark:#} of them would be excited");
    let _ = writeln!(
        text,
        "condition number {GOOD}{}{GOOD:#}, the best of {} motions (first: {}), {friction}",
        condition(found.condition),
        found.evaluations,
        condition(found.first_condition)
    );
    joints(&mut text, robot, found);
    if excited < found.bases.len() {
        not_excited(&mut text, found);
    }
    text + "\n"
        + &note(
            "the arm must stand at `start` first. Collisions are not checked, only these limits are, so try the \
             trajectory in a simulator or at low speed first",
        )
}

fn joints(text: &mut String, robot: &Robot, found: &Excitation) {
    let heading = ["  joint", "start", "from", "to", "", "range", "speed", "acceleration", "effort"];
    let mut cells = vec![heading.map(str::to_owned)];
    let percent = |used: f64, limit: f64| format!("{:.0} %", 100.0 * used / limit);
    for (joint, used) in robot.independent_joints().zip(&found.joints) {
        let JointUse { limits, start, bounds, effort, .. } = used;
        let unit = joint.row.kind.position_unit();
        let (lower, upper) = limits.position;
        cells.push([
            format!("  {}", shortened(&one_line(&joint.name), 14)),
            rounded(*start, 3),
            rounded(bounds.lower, 3),
            rounded(bounds.upper, 3),
            unit.to_owned(),
            percent(bounds.upper - bounds.lower, upper - lower),
            percent(bounds.velocity, limits.velocity),
            percent(bounds.acceleration, limits.acceleration),
            effort.zip(limits.effort).map_or_else(|| "-".to_owned(), |(used, limit)| percent(used, limit)),
        ]);
    }
    let mut align = [Align::Right; 9];
    (align[0], align[4]) = (Align::Left, Align::Left);
    push_table(text, "start and range of the joints, and the share of their limits that is used", &align, &cells);
}

fn not_excited(text: &mut String, found: &Excitation) {
    let mut cells = vec![["  parameter", "deviation", "plausible", "unit"].map(str::to_owned)];
    for base in found.bases.iter().filter(|base| !base.is_excited()) {
        let name = format!("  {}", base.name);
        cells.push([name, rounded(base.deviation, 4), rounded(base.plausible, 4), base.unit.to_owned()]);
    }
    let align = [Align::Left, Align::Right, Align::Right, Align::Left];
    push_table(text, "not excited: the deviation is more than half of the plausible value", &align, &cells);
}

/// Writes the states of the whole motion, including both ends, as CSV.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to half a million")]
fn csv(motion: &Fourier, dof: usize, arguments: &Arguments) -> String {
    let names = ["q", "qd", "qdd"].into_iter().flat_map(|name| (1..=dof).map(move |joint| format!("{name}{joint}")));
    let mut text = names.fold("t".to_owned(), |header, name| header + "," + &name);
    text.push('\n');
    // a whole number of steps, none longer than the rate asks for
    let steps = (arguments.seconds * arguments.rate * (1.0 - 1e-12)).ceil().max(1.0) as u32;
    for step in 0..=steps {
        let part = f64::from(step) / f64::from(steps);
        text.push_str(&exact_digits(arguments.seconds * part));
        for number in motion.after(part * f64::from(arguments.periods)).into_iter().flatten() {
            let _ = write!(text, ",{}", exact_digits(number));
        }
        text.push('\n');
    }
    text
}

/// Draws the positions of every joint between their limits.
fn picture(arguments: &Arguments, robot: &Robot, found: &Excitation) -> String {
    let parts: Vec<f64> = (0..=DRAWN).map(|sample| f64::from(sample) / f64::from(DRAWN)).collect();
    let time: Vec<f64> = parts.iter().map(|part| arguments.seconds * part).collect();
    let states: Vec<Vec<f64>> = parts
        .iter()
        .map(|part| {
            let [q, ..] = found.motion.after(part * f64::from(arguments.periods));
            q
        })
        .collect();
    let positions: Vec<Vec<f64>> = (0..robot.dof()).map(|joint| states.iter().map(|q| q[joint]).collect()).collect();
    let of_joint = robot.independent_joints().zip(&found.joints).zip(&positions).map(|((joint, used), values)| Panel {
        title: format!("{}, {}", joint.name, joint.row.kind.position_unit()),
        note: format!("starts at {}", rounded(used.start, 3)),
        curves: vec![PanelCurve { name: "position", values }],
        limits: vec![used.limits.position.0, used.limits.position.1],
        bounds: Vec::new(),
        bands: Vec::new(),
    });
    let title = robot.title.as_deref().unwrap_or(&robot.name);
    let about = format!("a motion that excites it; condition {}", condition(found.condition));
    panels(&format!("A motion of {}", robot.name), title, &about, &time, &of_joint.collect::<Vec<_>>())
}
