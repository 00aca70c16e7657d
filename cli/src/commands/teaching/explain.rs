//! `rne explain`: prints explanations that are too long for a `--help`: functions, tricks, quantities, exit statuses,
//! and the meaning of a name in the code of a robot.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rne_codegen::plan::Trick;
use rne_codegen::{Argument, Compiler, Form, Function};
use rne_inspection::Inspection;
use rne_model::did_you_mean;

use crate::files::plan_file;
use crate::files::robot_file::{self, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::TYPED;
use crate::render::equations;
use crate::render::equations::View;
use crate::render::layout::{PAGE, wrap};
use crate::render::letters::Letters;
use crate::render::link_parameter::LinkParameter;
use crate::terminal;
use crate::values::choice;
use crate::values::choice::Kept;
use crate::values::state;

/// Explain functions, options, exit statuses, or names in the code
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne explain functions     functions of a robot, the values of --function
  rne explain mass_matrix   what one function computes, and its options
  rne explain arguments     options of `rne eval` for each function
  rne explain tricks        simplifications of code, the values of --without
  rne explain quantities    quantities that `rne show --keep` can keep
  rne explain exit-status   meaning of the exit statuses of all commands
  rne explain hold-out      what `rne identify --hold-out` does
  rne explain Jzz3          meaning of the name of a link parameter
  rne explain w2_z puma560  meaning of w2_z in the code of the PUMA 560")]
pub(crate) struct Arguments {
    /// Topic: functions, arguments, tricks, quantities, exit-status, hold-out, a function, a link parameter such as
    /// Jzz3, or a name in the code of FILE
    #[arg(value_name = "TOPIC")]
    topic: String,
    /// Robot file or name of a robot from `rne list`; needed only if TOPIC is a variable of the code
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// If TOPIC is a variable: the function whose code is read
    #[arg(long, value_name = "F", value_parser = choice::function(), hide_possible_values = true,
        default_value = Function::InverseDynamics.name(), requires = "file")]
    function: Function,
    /// If TOPIC is a variable: the form of the code that is read, seven_steps or reduced
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
    HoldOut,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if let Some(file) = &arguments.file {
        return name_in_code(arguments, file);
    }
    let text = of_any_robot(&arguments.topic).ok_or_else(|| {
        let topics: Vec<_> = Topic::value_variants().iter().filter_map(ValueEnum::to_possible_value).collect();
        let topics: Vec<&str> = topics.iter().map(clap::builder::PossibleValue::get_name).collect();
        let word = &arguments.topic;
        let functions = Function::ALL.iter().map(|function| function.name());
        let meant = did_you_mean(word, topics.iter().copied().chain(functions))
            .map_or_else(String::new, |meant| format!(" (did you mean {TYPED}{meant}{TYPED:#}?)"));
        usage_error!(
            "there is no topic `{word}`{meant}; expected {}, a function such as mass_matrix, a link parameter such as \
             Jzz3, or a name in the code of a robot and its file, as in {TYPED}rne explain w2_z puma560{TYPED:#}",
            topics.join(", ")
        )
    })?;
    Ok(Outcome::text(arguments.letters.page(&text, PAGE)))
}

/// Returns an explanation that needs no robot: that of a link parameter, a function or a topic.
fn of_any_robot(name: &str) -> Option<String> {
    let of_parameter = LinkParameter::parse(name).map(|parameter| parameter.explained());
    of_parameter.or_else(|| of_function(name)).or_else(|| Topic::from_str(name, false).ok().map(of_topic))
}

fn of_topic(topic: Topic) -> String {
    match topic {
        Topic::Functions => entries(Function::ALL.map(|function| (function.name(), function.summary().to_owned()))),
        Topic::Arguments => of_eval(),
        Topic::Tricks => {
            let tricks = Trick::ALL.map(|trick| (trick.name(), trick.formula().to_owned()));
            wrap(OF_TRICKS, terminal::width(PAGE), "") + "\n\n" + &entries(tricks)
        }
        Topic::Quantities => quantities(),
        Topic::ExitStatus => EXIT_STATUS.to_owned(),
        Topic::HoldOut => wrap(HOLD_OUT, terminal::width(PAGE), "") + "\n",
    }
}

/// Explains a name in the code of a robot.
fn name_in_code(arguments: &Arguments, path: &Path) -> Result<Outcome, Failure> {
    let (name, function, form) = (&arguments.topic, arguments.function, arguments.form);
    let robot = robot_file::robot(path, Shape::Coupled).map_err(|failure| swapped(name, path).unwrap_or(failure))?;
    let program = match form {
        Form::SevenSteps => Compiler::new(&robot)
            .with_equations()
            .compile(function, form)
            .map_err(|error| Failure::compile(&path.display().to_string(), &error))?,
        Form::Reduced => plan_file::Compiler::new(path, &robot).compile(function, form)?,
    };
    let inspection = Inspection::new(&robot, &program);
    let view = View { inspection: &inspection, letters: arguments.letters };
    // written as in the code: the lecture's ω̇3_z is dw3_z there
    let spelt = rne_emit::ascii(name);
    if let Some(mut text) = equations::of_name(view, &spelt) {
        // only for units with m, N or kg, because the remark is on lengths, forces and masses
        if inspection.unit(&spelt).contains(['m', 'N', 'k']) {
            let evidence = program.proof.iter().flat_map(|proof| rne_emit::evidence(&program, proof));
            for scaled in evidence.filter(|line| line.starts_with("Scaled values")) {
                let _ = writeln!(text, "\n{}", wrap(&scaled, terminal::width(PAGE), ""));
            }
        }
        return Ok(Outcome::text(text));
    }
    if let Some(text) = of_any_robot(name) {
        return Ok(Outcome::text(arguments.letters.page(&text, PAGE)));
    }
    // if the name is that of a vector, explain its components; only then look for similar names
    let components = ["x", "y", "z", "xx", "xy", "xz", "yy", "yz", "zz"]
        .map(|axis| format!("{}_{axis}", code_name(name).unwrap_or_else(|| spelt.clone())));
    let components: Vec<&str> =
        components.iter().map(String::as_str).filter(|name| inspection.names.contains_key(*name)).collect();
    let texts: Vec<String> = components.iter().filter_map(|name| equations::of_name(view, name)).collect();
    if !texts.is_empty() {
        return Ok(Outcome::text(texts.join("\n")));
    }
    let meant = did_you_mean(&spelt, inspection.names.keys().map(String::as_str))
        .map_or_else(String::new, |meant| format!(" (did you mean {TYPED}{meant}{TYPED:#}?)"));
    let number = name.split(|c: char| !c.is_ascii_digit()).find_map(|digits| digits.parse::<usize>().ok());
    let beyond = number.is_some_and(|joint| joint > robot.dof());
    let joints = if robot.dof() == 1 { "1 joint".to_owned() } else { format!("{} joints", robot.dof()) };
    let meant = if beyond { format!(", which has {joints}") } else { meant };
    Err(usage_error!(
        "there is no name `{name}` in {function}, form {form}, of {}{meant}; {TYPED}rne show{TYPED:#} prints the \
         code, {TYPED}--form{TYPED:#} and {TYPED}--function{TYPED:#} choose another",
        robot.name
    ))
}

/// Explains a function by its name: its result, and the options of `rne eval` for its arguments.
fn of_function(name: &str) -> Option<String> {
    let Some(function) = Function::named(name) else {
        return choice::composed(name).map(|text| wrap(&text, terminal::width(PAGE), "") + "\n");
    };
    let call = format!(
        "`rne eval FILE --function {function}` takes the options {}. `rne explain arguments` says how they are given.",
        state::options(function)
    );
    let words = [function.summary(), function.details(), &call].map(|words| wrap(words, terminal::width(PAGE) - 4, ""));
    let lines = words.iter().flat_map(|words| words.lines()).map(|line| format!("    {line}\n"));
    Some(format!("{TYPED}{function}{TYPED:#}\n{}", lines.collect::<String>()))
}

/// Returns the name that the code gives to a vector whose name is spelt out, such as w1 for omega1.
fn code_name(name: &str) -> Option<String> {
    let words = [
        ("omega_dot", "dw"),
        ("omegadot", "dw"),
        ("domega", "dw"),
        ("omega", "w"),
        ("acceleration", "ddc"),
        ("velocity", "dc"),
        ("gravity", "g"),
        ("force", "f"),
        ("moment", "n"),
    ];
    words.iter().find_map(|(word, letter)| {
        let joint = name.strip_prefix(word)?.trim_start_matches('_');
        let is_joint = !joint.is_empty() && joint.bytes().all(|byte| byte.is_ascii_digit());
        is_joint.then(|| format!("{letter}{joint}"))
    })
}

const EXIT_STATUS: &str = "\
0    The command succeeded. `rne check`: no file has an error; files may have
     warnings and notes. `rne emit --check`: the file is up to date.
1    The input has a fault, or the answer of the command is negative:
     - A robot file or a plan has an error, cannot be read, or changes during a
       search.
     - The result of one state is not finite.
     - `rne check --physics`: an arm violates a law of mechanics.
     - `rne emit --check`, `rne certify --check`: the file is out of date.
     - `rne certify`: the code branches, computes in double precision, or has
       other results in QEMU; or a tool is not installed.
     - `rne diagnose`: torques differ, and rne does not find the reason.
     - `rne eval --trace --compare`: a value differs.
     - `rne watch`: there is an event, a log cannot be compared, or the model
       does not explain the torques of a joint.
     - `rne log`: rne cannot find the units or the noise of a log.
     - `rne identify`: a log determines no link and no friction.
     - The output cannot be written.
2    The command line has a fault: a wrong option; a joint, parameter or link
     that the robot does not have; a list of a wrong length; a file or folder
     that rne does not overwrite.
130  Ctrl-C ended the command. `rne search` and `rne excite`: the second Ctrl-C.
129, 143  The signal SIGHUP (129) or SIGTERM (143) ended the command.

If a signal ends a command, rne changes no file and leaves no temporary file.

rne writes errors to standard error. If there is an error, standard output is
empty, with two exceptions. First, the results of an answer with status 1, such
as events, are on standard output. Second, `rne eval --states` prints the
results of all states before a mistake.

rne writes a file of -o completely or not at all. With --states, a result that
is not finite is NaN or inf in its row; rne prints a note and exits with status
0. It is not an error if a reader closes the pipe, as in `rne show … | head`.
";

const HOLD_OUT: &str = "\
`rne identify FILE LOG --hold-out 0.3` identifies the robot from the first 70 % of the log. The last 30 % of the log \
is held out: the identification does not use it. rne then computes the torques of the held-out part with the \
identified robot and compares these torques with the measured torques. The error on the held-out part shows how well \
the robot predicts data that it was not fitted to. A held-out error that is much larger than the fitted error means: \
the fitted part determines too few parameters, or the two parts contain different motions. Record a longer log, or \
design a better motion with `rne excite`. --csv writes the measured, predicted and residual torques of both parts; \
its column held_out is 1 in the held-out part.";

/// Writes a list of names, each with text below it.
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

/// Makes the error for arguments in the wrong order, with the robot before the name: `rne explain puma560 w2_z`.
fn swapped(name: &str, path: &Path) -> Option<Failure> {
    let is_robot = rne_convert::shipped_at(Path::new(name)).is_some() || Path::new(name).is_file();
    (is_robot && !path.exists()).then(|| {
        let asked = path.display();
        usage_error!("the name comes first, then the robot: {TYPED}rne explain {asked} {name}{TYPED:#}")
    })
}

/// The explanation of the formulas of tricks.
const OF_TRICKS: &str = "\
A trick is a simplification that saves operations in the reduced form. The number in brackets after a formula is the \
section of docs/teaching/reduced-form.md that explains the formula.";

/// The explanation of how to write arguments.
const OF_EVAL: &str = "\
Give each function all of its options and no others. Some may be missing: --qd, --qdd and the options --base-… are \
zero by default, --base-rotation is the identity, --gravity is the gravity of the robot file, and nothing acts at a \
tip without --tip-wrench. A LIST has one number per joint, base to tip: \
rad for a revolute joint, m for a prismatic joint. pi/2 and 'deg(30)' are numbers, too. --wrench is the force and the \
moment that the last link exerts at the tip, N and N m, in tip axes. --payload is in kg, m and kg m², in tip axes. \
The options --base-… are in frame 0. rne rounds the tables that it prints; --json prints every digit, in the shape \
that the Rust function returns. Without --function rne computes inverse_dynamics, or its variant with a wrench or \
payload if --wrench or --payload is given.";

/// Returns a table of functions, each with its options of `rne eval`.
fn of_eval() -> String {
    let mut text = String::new();
    let mut row = |options: &str, functions: &str| {
        let indent = " ".repeat(18);
        let words = wrap(functions, terminal::width(PAGE) - indent.len(), "").replace('\n', &format!("\n{indent}"));
        // options that are longer than the column begin a line of their own
        let options = if options.len() < 18 { format!("{options:<18}") } else { format!("{options}\n{indent}") };
        let _ = writeln!(text, "{TYPED}{options}{TYPED:#}{words}");
    };
    let of_joints = Function::ALL.into_iter().filter(|function| !is_of_base_or_tips(*function));
    let mut rows: Vec<(String, Vec<&str>)> = Vec::new();
    for (options, name) in of_joints.map(|function| (state::options(function), function.name())) {
        match rows.iter_mut().find(|(other, _)| *other == options) {
            Some((_, names)) => names.push(name),
            None => rows.push((options, vec![name])),
        }
    }
    for (options, names) in rows {
        row(&options, &names.join(", "));
    }
    text + &entries(of_base_and_tips()) + "\n" + &wrap(OF_EVAL, terminal::width(PAGE), "") + "\n"
}

/// Returns whether a function with several arguments is one for a floating base, for several tips or for closed loops.
fn is_of_base_or_tips(function: Function) -> bool {
    let is_more =
        function.is_of_floating_base() || function.takes(Argument::Wrenches) || function.takes(Argument::Passive);
    is_more && function.arguments().len() > 1
}

/// Returns the functions for a floating base, for several tips or for closed loops, each with its options.
fn of_base_and_tips() -> impl Iterator<Item = (&'static str, String)> {
    let functions = Function::ALL.into_iter().filter(|function| is_of_base_or_tips(*function));
    functions.map(|function| (function.name(), state::options(function)))
}
