//! `rne show`: prints the generated code with explanations.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use rne_codegen::plan::Trick;
use rne_codegen::{self as codegen, Form, Function, Program, Quantity, Step};
use rne_emit::Selection;
use rne_inspection::Inspection;
use rne_model::Robot;

use crate::commands::teaching::closed_form::Wanted;
use crate::files::chosen_arm::Rotors;
use crate::files::plan_file::Compiler;
use crate::files::robot_file::Shape;
use crate::outcome::{Failure, Outcome};
use crate::palette::{QUIET, TYPED, WARNING};
use crate::render::base_parameters;
use crate::render::equations;
use crate::render::equations::View;
use crate::render::heading;
use crate::render::highlight;
use crate::render::layout::PAGE;
use crate::render::letters::Letters;
use crate::values::choice::{self, Kept};

/// Show the generated code step by step, and the terms that vanish
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne show robots/puma560.yaml --joint 2 --step 4
  rne show robots/planar2.yaml --step 3            velocities of step 3
  rne show robots/puma560.yaml --joint 1 --keep joint_force,joint_moment
  rne show robots/puma560.yaml --function mass_matrix --form reduced
  rne show robots/puma560.yaml --base-parameters   parameters in torques
  rne show puma560 --joint 2 --step 1 --equations  equations and code
  rne show puma560 --json                          JSON for programs
  rne show robots/planar2.yaml --symbolic          τ = M θ̈ + h + γ in symbols
  rne show robots/stanford.yaml --first 3 --latex > stanford.tex

`rne explain w2_z puma560` explains the name w2_z in the code of the PUMA 560.")]
pub(crate) struct Arguments {
    /// Robot file, or a name from `rne list`
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    rotors: Rotors,
    /// Show only this joint, by its number (1 is at the base) or its name
    #[arg(long, value_name = "JOINT")]
    joint: Option<String>,
    /// Show only one step of the algorithm: 1 angular velocity, 2 angular acceleration, 3 velocity, 4 acceleration, 5
    /// gravity, 6 force and moment, 7 torque
    #[arg(long, value_name = "S", value_parser = choice::step)]
    step: Option<Step>,
    /// Form of the code: seven_steps (default) or reduced (fewest operations)
    #[arg(long, value_name = "F", value_parser = choice::form(), default_value = Form::SevenSteps.name(),
        hide_possible_values = true, hide_default_value = true)]
    form: Form,
    /// Function to show [default: inverse_dynamics]; see `rne explain functions`
    #[arg(long, value_name = "F", value_parser = choice::function(), hide_possible_values = true,
        default_value = Function::InverseDynamics.name(), hide_default_value = true)]
    function: Function,
    /// Also compute this quantity, even if torques do not need it; see `rne explain quantities`
    #[arg(long, value_name = "QUANTITY", value_delimiter = ',', hide_possible_values = true)]
    keep: Vec<Kept>,
    /// Omit this simplification of the reduced form; see `rne explain tricks`
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = choice::trick(),
        hide_possible_values = true)]
    without: Vec<Trick>,
    /// Show each component as an equation, with the terms that vanish and the code
    #[arg(long, conflicts_with_all = ["keep", "without"])]
    equations: bool,
    /// Print equations and code as JSON, described in docs/teaching/inspection.md
    #[arg(long, conflicts_with_all = ["joint", "step", "keep", "without", "equations"])]
    json: bool,
    /// List the combinations of link parameters on which the torques depend
    #[arg(long, conflicts_with_all = ["joint", "step", "form", "function", "keep", "without", "equations",
        "json"])]
    base_parameters: bool,
    #[command(flatten)]
    closed_form: Wanted,
    #[command(flatten)]
    letters: Letters,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let letters = arguments.letters;
    if arguments.closed_form.is_asked_for() {
        return arguments.closed_form.run(&arguments.file, letters, |robot| arguments.rotors.of(robot));
    }
    let is_listing = !(arguments.base_parameters || arguments.json || arguments.equations);
    let shape = if is_listing { Shape::Closed } else { Shape::Coupled };
    let robot = arguments.rotors.robot(&arguments.file, shape)?;
    let function = choice::of_loops(arguments.function, &robot);
    if arguments.base_parameters {
        let text = heading::robot(&robot) + "\n" + &base_parameters::text(&robot);
        return Ok(Outcome::text(letters.page(&text, PAGE)));
    }
    let joint = choice::joint_of(&robot, arguments.joint.as_deref())?;
    if arguments.json || arguments.equations {
        return inspected(arguments, &robot, joint);
    }

    let keep = kept(arguments);
    let program = program(arguments, &robot, function, &keep)?;
    let mut text = letters.page(&heading::robot(&robot), PAGE);
    let _ = writeln!(text, "\n{}", heading::counts(&program));
    if program.outputs.len() > function.layout(rne_codegen::sizes_of(&robot)).len() {
        let words: Vec<&str> = keep.iter().map(|kept| kept.words()).collect();
        let line = format!("{QUIET}also computed, and counted above: {}{QUIET:#}\n", words.join(", "));
        text.push_str(&letters.page(&line, PAGE));
    }
    let refusals = rne_emit::refusals(&program);
    if program.form != arguments.form && refusals.is_empty() {
        let _ = writeln!(text, "{QUIET}{} has one form, the seven steps{QUIET:#}", program.function);
    }
    if program.is_rewritten && (joint.is_some() || arguments.step.is_some()) {
        let _ = writeln!(
            text,
            "{QUIET}a rewritten graph has no steps; {QUIET:#}{TYPED}--without rewriting{TYPED:#}{QUIET} shows the \
             recursion instead{QUIET:#}"
        );
    }
    if let Some(proof) = &program.proof {
        text.push('\n');
        for line in rne_emit::evidence(&program, proof) {
            let _ = writeln!(text, "{QUIET}{}{QUIET:#}", letters.of(&line));
        }
    }
    if !refusals.is_empty() {
        text.push('\n');
        for line in refusals {
            let _ = writeln!(text, "{WARNING}{}{WARNING:#}", letters.of(&line));
        }
    }
    let what = Selection { joint, step: arguments.step, explain: true, ..Selection::default() };
    text.push('\n');
    let listing = rne_emit::listing(&robot, &program, what);
    if listing.is_empty() {
        let _ = writeln!(text, "{QUIET}{} has no code in this selection{QUIET:#}", program.function);
    }
    text.push_str(&highlight::listing(&listing, letters));
    Ok(Outcome::text(text))
}

/// Returns the additional quantities to compute. Step 3, the velocity, is one of them, because torques do not need it.
fn kept(arguments: &Arguments) -> Vec<Kept> {
    let mut keep = arguments.keep.clone();
    if arguments.step == Some(Step::Velocity) && !keep.contains(&Kept::Velocity) {
        keep.push(Kept::Velocity);
    }
    keep
}

/// Compiles a function in the form that the command line asks for, and keeps the additional quantities.
fn program(arguments: &Arguments, robot: &Robot, function: Function, keep: &[Kept]) -> Result<Program, Failure> {
    let quantities: Vec<Quantity> = keep.iter().map(|kept| kept.quantity()).collect();
    if arguments.form == Form::SevenSteps && !arguments.without.is_empty() {
        return Err(usage_error!(
            "the seven steps use no tricks; use `--without` only with {TYPED}--form reduced{TYPED:#}"
        ));
    }
    match arguments.form {
        Form::SevenSteps => codegen::Compiler::new(robot)
            .with_intermediates(&quantities)
            .compile(function, arguments.form)
            .map_err(|error| Failure::compile(&arguments.file.display().to_string(), &error)),
        form @ Form::Reduced if keep.is_empty() => {
            Compiler::new(&arguments.file, robot).without(&arguments.without).compile(function, form)
        }
        form @ Form::Reduced => {
            Err(usage_error!("only the seven steps have {}; the form {form} computes only torques", keep[0].words()))
        }
    }
}

/// Prints the inspection as JSON or as text.
fn inspected(arguments: &Arguments, robot: &Robot, joint: Option<usize>) -> Result<Outcome, Failure> {
    let file = arguments.file.display().to_string();
    let (function, form) = (arguments.function, arguments.form);
    let program = match form {
        Form::SevenSteps => codegen::Compiler::new(robot)
            .with_equations()
            .compile(function, form)
            .map_err(|error| Failure::compile(&file, &error))?,
        Form::Reduced if arguments.json => Compiler::new(&arguments.file, robot).compile(function, form)?,
        Form::Reduced => {
            return Err(usage_error!(
                "only the seven steps have equations to fold; `rne explain tricks` explains the form {form}"
            ));
        }
    };
    let inspection = Inspection::new(robot, &program);
    if arguments.json {
        let outcome = Outcome::json_line(&inspection)?;
        return Ok(Outcome { text: arguments.letters.json(&outcome.text), ..outcome });
    }
    let letters = arguments.letters;
    let mut text = letters.page(&heading::robot(robot), PAGE);
    let _ = writeln!(text, "\n{}\n", heading::counts(&program));
    text.push_str(&equations::text(View { inspection: &inspection, letters }, joint, arguments.step.map(Step::number)));
    Ok(Outcome::text(text))
}
