//! `rne explain`: what is too long for a `--help`: functions, tricks, quantities, exit statuses.

use std::fmt::Write as _;

use clap::{Args, ValueEnum};
use rne_codegen::plan::Trick;
use rne_codegen::{Argument, Function};

use crate::layout::wrap;
use crate::outcome::Outcome;
use crate::show::Kept;
use crate::terminal::{self, TYPED};

/// More columns of prose are hard to read.
const WIDTH: usize = 80;

/// Explain the words that options take, and the exit statuses
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne explain functions     what an arm can compute: --function
  rne explain arguments     which function takes which options of `rne eval`
  rne explain tricks        the tricks of the reduced form: --without
  rne explain quantities    what `rne show --keep` keeps
  rne explain exit-status   what a script can rely on")]
pub(crate) struct Arguments {
    /// What to explain
    #[arg(value_enum, value_name = "TOPIC")]
    topic: Topic,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Topic {
    Functions,
    Arguments,
    Tricks,
    Quantities,
    ExitStatus,
}

pub(crate) fn run(arguments: &Arguments) -> Outcome {
    Outcome::text(match arguments.topic {
        Topic::Functions => entries(Function::ALL.map(|function| (function.name(), function.summary().to_owned()))),
        Topic::Arguments => of_eval(),
        Topic::Tricks => entries(Trick::ALL.map(|trick| (trick.name(), trick.formula().to_owned()))),
        Topic::Quantities => quantities(),
        Topic::ExitStatus => EXIT_STATUS.to_owned(),
    })
}

const EXIT_STATUS: &str = "\
0    fine. `rne check`: no file has an error, lints or not; `rne emit --check`:
     the file is what rne would write
1    the input is at fault: a robot file or a plan has an error or cannot be
     read, a result is not finite, a file that is checked is stale, torques
     differ and `rne diagnose` cannot say why, a value differs from that of
     `rne eval --trace --compare`, or the output cannot be written
2    the command line is at fault: an option, a joint that the robot does not
     have, a list of another length, or a file that rne does not overwrite
130  `rne search` was ended by a second Ctrl-C; the plan file is what it was

Errors go to standard error, and nothing to standard output then. A reader that
goes away (`rne show … | head`) is no error.
";

/// Names, each with words below it.
fn entries(entries: impl IntoIterator<Item = (&'static str, String)>) -> String {
    let mut text = String::new();
    for (name, words) in entries {
        let words = wrap(&words, terminal::width(WIDTH) - 4, "").replace('\n', "\n    ");
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

/// Which options of `rne eval` a function takes, exactly.
fn of_eval() -> String {
    use Argument::{Positions, Rates};
    let mut text = String::new();
    let mut row = |options: &str, functions: &str| {
        let indent = " ".repeat(18);
        let words = wrap(functions, terminal::width(WIDTH) - indent.len(), "").replace('\n', &format!("\n{indent}"));
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
    row("--q --qd --tau", "forward_dynamics");
    row("--qd --qdd", "actuator_torques; zero where no joint has a motor");
    text
}

/// The functions with exactly these arguments.
fn functions_of(arguments: &[Argument]) -> String {
    let functions = Function::ALL.iter().filter(|function| function.arguments() == arguments);
    functions.map(|function| function.name()).collect::<Vec<_>>().join(", ")
}
