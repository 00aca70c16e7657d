//! `rne explain`: what is too long for a `--help`: functions, tricks, quantities, exit statuses, and what a name in the
//! code of a robot is.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rne_codegen::plan::Trick;
use rne_codegen::{Argument, Compiler, Form, Function};
use rne_inspection::Inspection;
use rne_model::did_you_mean;

use crate::files::plan_file;
use crate::files::robot_file;
use crate::outcome::{Failure, Outcome};
use crate::palette::TYPED;
use crate::render::equations;
use crate::render::equations::View;
use crate::render::layout::{PAGE, wrap};
use crate::render::letters::Letters;
use crate::terminal;
use crate::values::choice;
use crate::values::choice::Kept;

/// Explain functions, options, exit statuses, or names in the code
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne explain functions     values of --function
  rne explain arguments     options of `rne eval` for each function
  rne explain tricks        values of --without: tricks of the reduced form
  rne explain quantities    values of `rne show --keep`
  rne explain exit-status   meaning of the exit statuses
  rne explain w2_z puma560  meaning of a name in the code of a robot")]
pub(crate) struct Arguments {
    /// Topic: functions, arguments, tricks, quantities, exit-status, or a name in the code of FILE
    #[arg(value_name = "TOPIC")]
    topic: String,
    /// Robot file
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// Function in which the name occurs, with FILE
    #[arg(long, value_name = "F", value_parser = choice::function(), hide_possible_values = true,
        default_value = Function::InverseDynamics.name(), requires = "file")]
    function: Function,
    /// Form of the function, seven_steps or reduced, with FILE
    #[arg(long, value_name = "F", value_parser = choice::form(), default_value = Form::SevenSteps.name(),
        hide_possible_values = true, requires = "file")]
    form: Form,
    #[command(flatten)]
    letters: Letters,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Topic {
    Functions,
    Arguments,
    Tricks,
    Quantities,
    ExitStatus,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if let Some(file) = &arguments.file {
        return name_in_code(arguments, file);
    }
    let topic = Topic::from_str(&arguments.topic, false).map_err(|_| {
        let topics: Vec<_> = Topic::value_variants().iter().filter_map(ValueEnum::to_possible_value).collect();
        let topics: Vec<&str> = topics.iter().map(clap::builder::PossibleValue::get_name).collect();
        let word = &arguments.topic;
        let meant = did_you_mean(word, topics.iter().copied())
            .map_or_else(String::new, |meant| format!(" (did you mean {TYPED}{meant}{TYPED:#}?)"));
        Failure::usage(format_args!(
            "there is no topic `{word}`{meant}; expected {}, or a name in the code of a robot and its file, as in \
             {TYPED}rne explain w2_z puma560{TYPED:#}",
            topics.join(", ")
        ))
    })?;
    let text = match topic {
        Topic::Functions => entries(Function::ALL.map(|function| (function.name(), function.summary().to_owned()))),
        Topic::Arguments => of_eval(),
        Topic::Tricks => entries(Trick::ALL.map(|trick| (trick.name(), trick.formula().to_owned()))),
        Topic::Quantities => quantities(),
        Topic::ExitStatus => EXIT_STATUS.to_owned(),
    };
    Ok(Outcome::text(arguments.letters.page(&text, PAGE)))
}

/// Explains a name in the code of a robot.
fn name_in_code(arguments: &Arguments, path: &Path) -> Result<Outcome, Failure> {
    let (name, function, form) = (&arguments.topic, arguments.function, arguments.form);
    let robot = robot_file::robot(path).map_err(|failure| swapped(name, path).unwrap_or(failure))?;
    let program = match form {
        Form::SevenSteps => Compiler::new(&robot)
            .with_equations()
            .compile(function, form)
            .map_err(|error| Failure::compile(&path.display().to_string(), &error))?,
        Form::Reduced => plan_file::Compiler::new(path, &robot).compile(function, form)?,
    };
    let inspection = Inspection::new(&robot, &program);
    if let Some(text) = equations::of_name(View { inspection: &inspection, letters: arguments.letters }, name) {
        return Ok(Outcome::text(text));
    }
    let meant = did_you_mean(name, inspection.names.keys().map(String::as_str))
        .map_or_else(String::new, |meant| format!(" (did you mean {TYPED}{meant}{TYPED:#}?)"));
    Err(Failure::usage(format_args!(
        "there is no name `{name}` in {function}, form {form}, of {}{meant}; {TYPED}rne show{TYPED:#} prints the \
         code, {TYPED}--form{TYPED:#} and {TYPED}--function{TYPED:#} choose another",
        robot.name
    )))
}

const EXIT_STATUS: &str = "\
0    success. `rne check`: no file has an error, with or without lints;
     `rne emit --check`: the file is up to date
1    the input is at fault: a robot file or a plan has an error, cannot be read
     or changes during a search; the result of one state is not finite; a file
     of `rne emit --check` is out of date; torques differ and `rne diagnose`
     does not find the reason; `rne eval --trace --compare` finds a difference;
     `rne watch` has events; `rne log` cannot find the units or the noise of a
     log; `rne identify` finds nothing in a log; the output cannot be written
2    the command line is at fault: an option, a joint, parameter or link that
     the robot does not have, a list of another length, or a file or folder that
     rne does not overwrite
130  Ctrl-C ended the command (`rne search` and `rne excite`: the second Ctrl-C)
129, 143  SIGHUP or SIGTERM ended the command

If a signal ends a command, files do not change and no temporary file is left.

Errors go to standard error, and standard output is then empty. Exceptions: the
results of an answer with status 1, such as events, are on standard output, and
so are the states that `rne eval --states` has printed before a mistake. A file
of -o is written completely or not at all. With --states, a result that is not
finite is NaN or inf in its row, with a note and status 0. A reader that closes
the pipe (`rne show … | head`) is not an error.
";

/// Names, each with words below it.
fn entries(entries: impl IntoIterator<Item = (&'static str, String)>) -> String {
    let mut text = String::new();
    for (name, words) in entries {
        let words = wrap(&words, terminal::width(PAGE) - 4, "").replace('\n', "\n    ");
        let _ = writeln!(text, "{TYPED}{name}{TYPED:#}\n    {words}");
    }
    text
}

fn quantities() -> String {
    let values: Vec<_> = Kept::value_variants().iter().filter_map(ValueEnum::to_possible_value).collect();
    let lines = values.iter().map(|value| {
        let words = value.get_help().map(ToString::to_string).unwrap_or_default();
        format!("{TYPED}{:<16}{TYPED:#}{words}\n", value.get_name())
    });
    lines.collect()
}

/// Error for swapped arguments: the robot comes before the name, `rne explain puma560 w2_z`.
fn swapped(name: &str, path: &Path) -> Option<Failure> {
    let is_robot = rne_convert::shipped_at(Path::new(name)).is_some() || Path::new(name).is_file();
    (is_robot && !path.exists()).then(|| {
        let asked = path.display();
        Failure::usage(format_args!("the name comes first, then the robot: {TYPED}rne explain {asked} {name}{TYPED:#}"))
    })
}

/// How arguments are given.
const OF_EVAL: &str = "\
Every function needs exactly its arguments; none has the default zero. A LIST has one number per joint, \
base to tip: rad for a revolute joint, m for a prismatic one; pi/2 and 'deg(30)' are numbers. A wrench, in N \
and N m, is exerted by the last link at the tip, in tip axes. A payload, in kg, m and kg m², is in tip axes \
too. The motion of a moving base is in frame 0. Tables are rounded for reading; --json prints every digit, in \
the shape that the Rust function returns. The default function is inverse_dynamics, or its variant with a wrench \
or payload if --wrench or --payload is given.";

/// The table of functions and the options of `rne eval` that each takes.
fn of_eval() -> String {
    use Argument::{Positions, Rates, Torques};
    let mut text = String::new();
    let mut row = |options: &str, functions: &str| {
        let indent = " ".repeat(18);
        let words = wrap(functions, terminal::width(PAGE) - indent.len(), "").replace('\n', &format!("\n{indent}"));
        let _ = writeln!(text, "{TYPED}{options:<18}{TYPED:#}{words}");
    };
    row("--q", &functions_of(&[Positions]));
    row("--q --qd", &functions_of(&[Positions, Rates]));
    row(
        "--q --qd --qdd",
        "inverse_dynamics, inverse_dynamics_from_sin_cos (sines and cosines of --q), regressor, \
         inverse_dynamics_derivatives, joint_wrenches; with --wrench inverse_dynamics_with_wrench, with --payload \
         inverse_dynamics_with_payload, with the --base-… options inverse_dynamics_on_moving_base",
    );
    row("--q --qd --tau", &functions_of(&[Positions, Rates, Torques]));
    row("--qd --qdd", "actuator_torques; zero where no joint has a motor");
    text + "\n" + &wrap(OF_EVAL, terminal::width(PAGE), "") + "\n"
}

/// The functions with exactly these arguments.
fn functions_of(arguments: &[Argument]) -> String {
    let functions = Function::ALL.iter().filter(|function| function.arguments() == arguments);
    functions.map(|function| function.name()).collect::<Vec<_>>().join(", ")
}
