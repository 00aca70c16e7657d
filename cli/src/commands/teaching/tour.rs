//! `rne` without a command: prints a tour of one robot, from its table to its torques. Every number is computed when it
//! is printed.

use std::fmt::Write as _;
use std::path::Path;

use rne::{DynArm, InverseDynamics as _};
use rne_codegen::{self as codegen, Form, Function, Program, Step};
use rne_emit::Selection;
use rne_model::{Reader, Robot, exact_digits};

use crate::commands::ops;
use crate::files::plan_file::Compiler;
use crate::outcome::{Failure, Outcome};
use crate::palette::{GOOD, QUIET, TITLE, TYPED};
use crate::render::heading;
use crate::render::highlight;
use crate::render::layout::{Align, PAGE, columns, wrap};
use crate::render::letters::Letters;
use crate::terminal;
use crate::values::numbers::at_the_point;

/// The shipped robot of the tour.
const NAME: &str = "puma560";

/// The robot [`NAME`], whose code the derive macro has compiled into this program.
#[derive(rne::InverseDynamics)]
#[robot(builtin = "puma560")]
struct Puma560;

const Q: [f64; 6] = [0.3, -0.8, 0.5, 1.1, -0.4, 0.6];
const QD: [f64; 6] = [0.9, -0.5, 0.4, 1.2, -0.3, 0.7];
const QDD: [f64; 6] = [-1.1, 0.6, 0.8, -0.9, 1.4, 0.35];

pub(crate) fn run() -> Result<Outcome, Failure> {
    let file = rne_convert::shipped(NAME).map_err(Failure::input)?;
    let robot = Reader::new(NAME).read(file.yaml).map_err(|report| Failure::from(&report))?.robot;
    let program = codegen::Compiler::new(&robot)
        .compile(Function::InverseDynamics, Form::SevenSteps)
        .map_err(|error| Failure::compile(NAME, &error))?;
    let arm = DynArm::from_robot(&robot);
    let runtime = arm.inverse_dynamics(&Q, &QD, &QDD).map_err(Failure::input)?;
    let generated = Puma560.inverse_dynamics(&Q, &QD, &QDD);

    let mut text = opening();
    chapter(&mut text, 1, "A robot is a table", &format!("This is the shipped robot {NAME}, read and checked."));
    text.push_str(&heading::robot(&robot));
    joints(&mut text, &robot, &program);
    chapter(
        &mut text,
        4,
        "What the whole robot costs",
        "Left: the recursion as a loop over 3-vectors. Right: the generated code. Functions without velocities \
         or accelerations are compiled separately.",
    );
    let path = Path::new(NAME);
    let compiler = Compiler::built_in(path, &robot, file.plan.unwrap_or_default())?;
    let counts = ops::counts(path, &compiler, &Function::TORQUES, true, &mut String::new())?;
    text.push_str(&ops::table(&[(robot.name.clone(), counts)], terminal::room()));
    chapter(
        &mut text,
        5,
        "The same torques, twice",
        "`generated` was compiled into this program by #[derive(InverseDynamics)]; `runtime` has just read the file \
         and loops over its links. They share no dynamics code.",
    );
    text.push_str(&torques(&robot, &generated, &runtime));
    text.push_str(&next());
    Ok(Outcome::text(text))
}

fn opening() -> String {
    let about = "The input is a robot's Denavit-Hartenberg table with the masses of its links. The output is recursive \
                 Newton-Euler, the seven steps of the lecture, written for this one robot: straight-line Rust without \
                 loops, branches or matrices, and without a single product by zero. This command computes all that \
                 follows.";
    format!("{TITLE}rne, the dynamics compiler for robot arms{TITLE:#}\n\n{}\n", wrap(about, terminal::width(PAGE), ""))
}

fn chapter(text: &mut String, number: usize, title: &str, about: &str) {
    let rule = "─".repeat(terminal::width(PAGE).saturating_sub(title.chars().count() + "── 1   ".chars().count()));
    let _ = writeln!(text, "\n\n{QUIET}──{QUIET:#} {TITLE}{number}  {title}{TITLE:#} {QUIET}{rule}{QUIET:#}\n");
    let _ = writeln!(text, "{}\n", wrap(about, terminal::width(PAGE), ""));
}

/// Shows the code of joint 1, where nearly all terms vanish, and of joint 2, where the formulas of the lecture remain.
fn joints(text: &mut String, robot: &Robot, program: &Program) {
    let left = |joint: usize| {
        let (products, sums) = program.fold_report.total(|line| line.place.joint == joint);
        let kept = program.statements.iter().filter(|statement| statement.place.joint == joint).count();
        (products + sums, kept)
    };
    let (operations, statements) = left(1);
    chapter(
        text,
        2,
        "Joint 1: nearly every term vanishes",
        &format!(
            "The base does not move and joint 1 is vertical: of {operations} operations {statements} statements \
             remain. Below each formula is what became of the rest."
        ),
    );
    code(text, robot, program, 1, &Step::ALL);
    let (operations, statements) = left(2);
    chapter(
        text,
        3,
        "Joint 2: the seven steps, component by component",
        &format!(
            "{operations} operations, {statements} statements: w is ω, dw is ω̇, ddc is c̈, f1_2 and n1_2 are what \
             link 1 exerts on link 2. Step 3, the velocity, is left out: no torque needs it."
        ),
    );
    let steps: Vec<Step> = Step::ALL.into_iter().filter(|&step| step != Step::Velocity).collect();
    code(text, robot, program, 2, &steps);
}

fn code(text: &mut String, robot: &Robot, program: &Program, joint: usize, steps: &[Step]) {
    let listings: Vec<String> = steps
        .iter()
        .map(|&step| Selection { joint: Some(joint), step: Some(step), explain: true, reasons: Some(2) })
        .map(|what| highlight::listing(&rne_emit::listing(robot, program, what), Letters::default()))
        .collect();
    text.push_str(&listings.join("\n"));
}

fn torques(robot: &Robot, generated: &[f64], runtime: &[f64]) -> String {
    let column = |title: &str, values: &[f64]| -> Vec<String> {
        let texts: Vec<String> = values.iter().copied().map(exact_digits).collect();
        std::iter::once(title.to_owned()).chain(at_the_point(&texts)).collect()
    };
    let difference: Vec<f64> = generated.iter().zip(runtime).map(|(a, b)| a - b).collect();
    let names = std::iter::once(String::new()).chain(robot.joints.iter().map(|joint| format!("  {}", joint.name)));
    let cells = [
        names.collect(),
        column("q", &Q),
        column("qd", &QD),
        column("qdd", &QDD),
        column("generated", generated),
        column("runtime", runtime),
        column("difference", &difference),
    ];
    let lines: Vec<[String; 7]> = (0..=robot.dof())
        .map(|line| cells.each_ref().map(|column: &Vec<String>| column.get(line).cloned().unwrap_or_default()))
        .collect();
    let mut text = String::new();
    for (index, line) in columns(&[Align::Left; 7], &lines).iter().enumerate() {
        let _ = match index {
            0 => writeln!(text, "{QUIET}{line}{QUIET:#}"),
            _ => writeln!(text, "{line}"),
        };
    }
    let equal = generated.iter().zip(runtime).filter(|(a, b)| a == b).count();
    let _ = writeln!(
        text,
        "\n{GOOD}{equal} of {} torques are equal to the last bit{GOOD:#} {QUIET}(rad, s, N m){QUIET:#}",
        robot.dof()
    );
    text
}

fn next() -> String {
    let lines = [
        ("show puma560 --joint 3", "any joint, with every reason"),
        ("show planar2", "a robot for the blackboard"),
        ("eval planar1 --q 0.6 --qd 1 --qdd 0 --trace", "a worksheet of numbers"),
        ("ops ur5", "operations of every function"),
        ("emit puma560", "a file without dependencies"),
        ("list", "the shipped robots"),
        ("--help", "all commands"),
    ];
    // in the repository the tour is started by `cargo run`, which sets this variable for the program
    let from_cargo = std::env::var_os("CARGO_PKG_NAME").is_some();
    let start = if from_cargo { "cargo run --" } else { "rne" };
    let mut lines = lines.map(|(command, what)| (format!("  {start} {command}"), what)).to_vec();
    if from_cargo {
        lines.push(("  cargo test".to_owned(), "all tests"));
    }
    let widest = lines.iter().map(|(command, _)| command.len()).max().unwrap_or(0);
    let mut text = format!("\n\n{TITLE}Next{TITLE:#}\n\n");
    for (command, what) in &lines {
        let _ = writeln!(text, "{TYPED}{command:widest$}{TYPED:#}  {QUIET}{what}{QUIET:#}");
    }
    text
}
