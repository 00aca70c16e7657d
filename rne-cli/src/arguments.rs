//! The grammar of the command line, and the values that several commands take.

use std::fmt;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand};
use rne_codegen::plan::Trick;
use rne_codegen::{Form, Function, Step};
use rne_model::Convention;

use crate::terminal::{HELP_STYLES, TITLE, TYPED};
use crate::{
    check, convert, diagnose, emit, eval, example, excite, explain, export, firmware, identify, import, list, log, new,
    ops, plot, report, search, shell, show, watch,
};

/// The dynamics compiler for robot arms.
#[derive(Parser)]
#[command(name = "rne", version, styles = HELP_STYLES)]
#[command(about = "The dynamics compiler for robot arms: a DH table in, straight-line code out")]
#[command(max_term_width = 80, help_template = page())]
#[command(after_help = "\
Examples:
  rne check robots/*.yaml                   are the files in order?
  rne show robots/puma560.yaml --joint 2    the code of joint 2, step by step
  rne emit robots/puma560.yaml --lang c     C99 without a library; or Rust

FILE: a robot file or a name of `rne list`. Exits: `rne explain exit-status`.
Without a command, a tour: the PUMA 560 from its table to its torques.")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

/// The help of rne itself: the usual one, but that its two options share a line. A page has 40.
fn page() -> String {
    // the parser's own text, as its styles are
    let (title, typed) = (TITLE.0, TYPED.0);
    format!(
        "{{about}}\n\n{{usage-heading}} {{usage}}\n\n{title}Commands:{title:#}\n{{subcommands}}\n\n\
         {title}Options:{title:#} {typed}-h{typed:#}, {typed}--help{typed:#}  Print help   \
         {typed}-V{typed:#}, {typed}--version{typed:#}  Print version{{after-help}}"
    )
}

#[derive(Subcommand)]
pub(crate) enum Command {
    Check(check::Arguments),
    Show(show::Arguments),
    Emit(emit::Arguments),
    Ops(ops::Arguments),
    Report(report::Arguments),
    Eval(eval::Arguments),
    Diagnose(diagnose::Arguments),
    Plot(plot::Arguments),
    Log(log::Arguments),
    Identify(identify::Arguments),
    Watch(watch::Arguments),
    Excite(excite::Arguments),
    Search(search::Arguments),
    New(new::Arguments),
    List(list::Arguments),
    Example(example::Arguments),
    Import(import::Arguments),
    Convert(convert::Arguments),
    Export(export::Arguments),
    Firmware(firmware::Arguments),
    Explain(explain::Arguments),
    Completions(shell::Completions),
    Man(shell::Man),
}

/// Reads the name of a function; help and messages list them all.
pub(crate) fn function() -> impl TypedValueParser<Value = Function> {
    let value = |function: Function| PossibleValue::new(function.name()).help(function.summary());
    PossibleValuesParser::new(Function::ALL.map(value)).try_map(|name| name.parse::<Function>())
}

/// One function, or all that a robot has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FunctionOrAll {
    All,
    One(Function),
}

impl fmt::Display for FunctionOrAll {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("all"),
            Self::One(function) => function.fmt(f),
        }
    }
}

/// Reads the name of a function, or `all`.
pub(crate) fn function_or_all() -> impl TypedValueParser<Value = FunctionOrAll> {
    let value = |function: Function| PossibleValue::new(function.name()).help(function.summary());
    let all = PossibleValue::new("all").help("Every function that there is");
    PossibleValuesParser::new(Function::ALL.map(value).into_iter().chain([all])).try_map(|name| match name.as_str() {
        "all" => Ok(FunctionOrAll::All),
        name => name.parse::<Function>().map(FunctionOrAll::One),
    })
}

/// Reads the name of a form.
pub(crate) fn form() -> impl TypedValueParser<Value = Form> {
    let value = |form: Form| match form {
        Form::SevenSteps => PossibleValue::new(form.name()).help("Every intermediate is the lecture's"),
        Form::Reduced => PossibleValue::new(form.name()).help("Fewest operations; only the torques keep a meaning"),
    };
    PossibleValuesParser::new(Form::ALL.map(value)).try_map(|name| name.parse::<Form>())
}

/// Reads the name of a trick of the reduced form.
pub(crate) fn trick() -> impl TypedValueParser<Value = Trick> {
    let value = |trick: Trick| PossibleValue::new(trick.name()).help(trick.formula());
    PossibleValuesParser::new(Trick::ALL.map(value)).try_map(|name| name.parse::<Trick>())
}

/// Reads a convention.
pub(crate) fn convention() -> impl TypedValueParser<Value = Convention> {
    // docs/robot-file.md says what they are
    PossibleValuesParser::new(["standard", "modified"])
        .map(|word| if word == "modified" { Convention::Modified } else { Convention::Standard })
}

/// Reads the name of a robot.
pub(crate) fn robot_name(text: &str) -> Result<String, String> {
    let starts_well = text.starts_with(|c: char| c.is_ascii_lowercase());
    if starts_well && text.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_') {
        return Ok(text.to_owned());
    }
    Err("a robot's name has small letters, digits and underscores, and starts with a letter: my_arm".to_owned())
}

/// Reads the number of a joint; which numbers there are, the robot says.
pub(crate) fn joint(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "a joint is given by its number, counted from 1 at the base".to_owned())
}

/// Reads the number of a step.
pub(crate) fn step(text: &str) -> Result<Step, String> {
    let step = Step::ALL.into_iter().find(|step| step.number().to_string() == text);
    step.ok_or_else(|| {
        let steps: Vec<String> = Step::ALL.iter().map(|step| format!("{} {}", step.number(), step.title())).collect();
        format!("the steps are {}", steps.join(", "))
    })
}
