//! `rne show`: the generated code, annotated for reading.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use rne_codegen::emit::{self, Selection};
use rne_codegen::plan::Trick;
use rne_codegen::{self as codegen, Form, Function, Quantity, Step};
use rne_inspection::Inspection;
use rne_model::Robot;

use crate::arm::Rotors;
use crate::outcome::{Failure, Outcome};
use crate::plan_file::Compiler;
use crate::terminal::{QUIET, TYPED};
use crate::{arguments, base_parameters, equations, heading, highlight};

/// Show the generated code step by step, what was folded, and why
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne show robots/puma560.yaml --joint 2 --step 4
  rne show robots/planar2.yaml --step 3            what no torque needs
  rne show robots/puma560.yaml --joint 1 --keep joint_force,joint_moment
  rne show robots/puma560.yaml --function mass_matrix --form reduced
  rne show robots/puma560.yaml --base-parameters   what the torques can see
  rne show puma560 --joint 2 --step 1 --equations  of what the code is left
  rne show puma560 --json                          all of it, for programs

`rne explain w2_z puma560` tells what a name in the code is.")]
pub(crate) struct Arguments {
    /// Robot file
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    rotors: Rotors,
    /// One joint only, counted from 1 at the base
    #[arg(long, value_name = "I", value_parser = arguments::joint)]
    joint: Option<usize>,
    /// One of the seven steps only
    #[arg(long, value_name = "S", value_parser = arguments::step)]
    step: Option<Step>,
    /// seven_steps, where every intermediate is the lecture's, or reduced, with the fewest operations
    #[arg(long, value_name = "F", value_parser = arguments::form(), default_value = Form::SevenSteps.name(),
        hide_possible_values = true)]
    form: Form,
    /// Which function of the robot: `rne explain functions`
    #[arg(long, value_name = "F", value_parser = arguments::function(), hide_possible_values = true,
        default_value = Function::InverseDynamics.name())]
    function: Function,
    /// Compute these for every link, even where no torque needs them: `rne explain quantities`; --step 3 keeps the
    /// velocity
    #[arg(long, value_name = "QUANTITY", value_delimiter = ',', hide_possible_values = true)]
    keep: Vec<Kept>,
    /// Leave these tricks out of the reduced form: `rne explain tricks`; rewriting leaves nothing to read
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = arguments::trick(),
        hide_possible_values = true)]
    without: Vec<Trick>,
    /// By component: its equation, this robot's, what is gone and why, the code left
    #[arg(long, conflicts_with_all = ["keep", "without"])]
    equations: bool,
    /// The same as JSON, with units, frames and counts: docs/inspection.md
    #[arg(long, conflicts_with_all = ["joint", "step", "keep", "without", "equations"])]
    json: bool,
    /// Instead of code: which combinations of link parameters the torques depend on, for identification
    #[arg(long, conflicts_with_all = ["joint", "step", "form", "function", "keep", "without", "equations",
        "json"])]
    base_parameters: bool,
}

/// A quantity of the lecture that may be folded away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub(crate) enum Kept {
    /// Angular velocity ω
    Omega,
    /// Angular acceleration ω̇
    OmegaDot,
    /// Velocity of the centre of mass ċ, step 3
    Velocity,
    /// Acceleration of the centre of mass c̈
    Acceleration,
    /// Acceleration of gravity g
    Gravity,
    /// f_i = m c̈ by itself
    InertiaForce,
    /// n_i, about the centre of mass
    InertiaMoment,
    /// f_{i-1,i}
    JointForce,
    /// n_{i-1,i}
    JointMoment,
}

impl Kept {
    const fn quantity(self) -> Quantity {
        match self {
            Self::Omega => Quantity::Omega,
            Self::OmegaDot => Quantity::OmegaDot,
            Self::Velocity => Quantity::Velocity,
            Self::Acceleration => Quantity::Acceleration,
            Self::Gravity => Quantity::Gravity,
            Self::InertiaForce => Quantity::InertiaForce,
            Self::InertiaMoment => Quantity::InertiaMoment,
            Self::JointForce => Quantity::JointForce,
            Self::JointMoment => Quantity::JointMoment,
        }
    }

    /// The quantity in words and with its letter.
    const fn words(self) -> &'static str {
        match self {
            Self::Omega => "angular velocities ω",
            Self::OmegaDot => "angular accelerations ω̇",
            Self::Velocity => "velocities ċ of step 3",
            Self::Acceleration => "accelerations c̈",
            Self::Gravity => "gravity g of every link",
            Self::InertiaForce => "inertia forces f",
            Self::InertiaMoment => "inertia moments n",
            Self::JointForce => "joint forces",
            Self::JointMoment => "joint moments",
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let file = arguments.file.display().to_string();
    let robot = arguments.rotors.robot(&arguments.file)?;
    if arguments.base_parameters {
        return Ok(Outcome::text(heading::robot(&robot) + "\n" + &base_parameters::text(&robot)));
    }
    check_joint(&robot, arguments.joint)?;
    if arguments.json || arguments.equations {
        return inspected(arguments, &robot);
    }

    let mut keep = arguments.keep.clone();
    if arguments.step == Some(Step::Velocity) && !keep.contains(&Kept::Velocity) {
        keep.push(Kept::Velocity);
    }
    let quantities: Vec<Quantity> = keep.iter().map(|kept| kept.quantity()).collect();
    if arguments.form == Form::SevenSteps && !arguments.without.is_empty() {
        return Err(Failure::usage(format_args!(
            "the seven steps use no tricks; `--without` goes with {TYPED}--form reduced{TYPED:#}"
        )));
    }
    let program = match arguments.form {
        Form::SevenSteps => codegen::Compiler::new(&robot)
            .with_intermediates(&quantities)
            .compile(arguments.function, arguments.form)
            .map_err(|error| Failure::compile(&file, &error))?,
        form @ Form::Reduced if keep.is_empty() => {
            Compiler::new(&arguments.file, &robot).without(&arguments.without).compile(arguments.function, form)?
        }
        form @ Form::Reduced => {
            return Err(Failure::usage(format_args!(
                "only the seven steps have {}; the form {form} keeps torques alone",
                keep[0].words()
            )));
        }
    };

    let mut text = heading::robot(&robot);
    let _ = writeln!(text, "\n{}", heading::counts(&program));
    if program.outputs.len() > arguments.function.layout(robot.dof()).len() {
        let words: Vec<&str> = keep.iter().map(|kept| kept.words()).collect();
        let _ = writeln!(text, "{QUIET}kept for reading, and counted: {}{QUIET:#}", words.join(", "));
    }
    if program.form != arguments.form {
        let _ = writeln!(text, "{QUIET}{} has one form, the seven steps{QUIET:#}", program.function);
    }
    if program.is_rewritten && (arguments.joint.is_some() || arguments.step.is_some()) {
        let _ = writeln!(
            text,
            "{QUIET}a rewritten graph has no steps; {QUIET:#}{TYPED}--without rewriting{TYPED:#}{QUIET} shows the \
             recursion behind it{QUIET:#}"
        );
    }
    if let Some(proof) = &program.proof {
        text.push('\n');
        for line in emit::evidence(&program, proof) {
            let _ = writeln!(text, "{QUIET}{line}{QUIET:#}");
        }
    }
    let what = Selection { joint: arguments.joint, step: arguments.step, explain: true, ..Selection::default() };
    text.push('\n');
    let listing = emit::listing(&robot, &program, what);
    if listing.is_empty() {
        let _ = writeln!(text, "{QUIET}nothing of {} stands there{QUIET:#}", program.function);
    }
    text.push_str(&highlight::listing(&listing));
    Ok(Outcome::text(text))
}

/// The inspection, as JSON or as lines.
fn inspected(arguments: &Arguments, robot: &Robot) -> Result<Outcome, Failure> {
    let file = arguments.file.display().to_string();
    let (function, form) = (arguments.function, arguments.form);
    let program = match form {
        Form::SevenSteps => codegen::Compiler::new(robot)
            .with_equations()
            .compile(function, form)
            .map_err(|error| Failure::compile(&file, &error))?,
        Form::Reduced if arguments.json => Compiler::new(&arguments.file, robot).compile(function, form)?,
        Form::Reduced => {
            return Err(Failure::usage(format_args!(
                "only the seven steps have equations to fold; `rne explain tricks` tells what the form {form} does"
            )));
        }
    };
    let inspection = Inspection::new(robot, &program);
    if arguments.json {
        return Outcome::json_line(&inspection);
    }
    let mut text = heading::robot(robot);
    let _ = writeln!(text, "\n{}\n", heading::counts(&program));
    text.push_str(&equations::text(&inspection, arguments.joint, arguments.step.map(Step::number)));
    Ok(Outcome::text(text))
}

fn check_joint(robot: &Robot, joint: Option<usize>) -> Result<(), Failure> {
    match joint {
        Some(joint) if joint == 0 || joint > robot.dof() => {
            let joints: Vec<String> = robot
                .joints
                .iter()
                .enumerate()
                .map(|(index, joint)| format!("{} ({})", index + 1, joint.name))
                .collect();
            let message = format!("{} has no joint {joint}; its joints are {}", robot.name, joints.join(", "));
            Err(Failure::usage(message))
        }
        _ => Ok(()),
    }
}
