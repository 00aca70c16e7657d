//! `rne ops`: what the functions of a robot cost.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_codegen::plan::{self, PlanSet, Trick};
use rne_codegen::{CompileError, Form, Function, Operations};
use rne_model::Robot;
use serde::Serialize;

use crate::arm::Rotors;
use crate::layout::{Align, columns};
use crate::outcome::{Failure, Outcome};
use crate::plan_file::Compiler;
use crate::terminal::{QUIET, TITLE};
use crate::{arguments, functions, plan_file};

/// Count operations, before folding and in the generated code
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne ops robots/puma560.yaml robots/scara_cobra600.yaml
  rne ops robots/*.yaml --json --function mass_matrix,forward_dynamics
  rne ops robots/puma560.yaml --tricks             what each trick saves
  rne ops robots/puma560.yaml --without gyrostat   the reduced form without it

A subtraction counts as an addition, a negation is free, x·x is one
multiplication, and sincos counts the angles whose sine or cosine is used;
divisions have a column where there are any, and are not in the total. Before
folding: as a loop over 3-vectors performs it. actuator_torques is listed where
the robot has motors.")]
pub(crate) struct Arguments {
    /// Robot files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// These functions only; may be repeated: `rne explain functions`
    #[arg(long = "function", value_name = "F", value_delimiter = ',', value_parser = arguments::function(),
        hide_possible_values = true,
        conflicts_with = "tricks")]
    functions: Vec<Function>,
    #[command(flatten)]
    rotors: Rotors,
    /// A list of {robot, function, form, mul, add, div, sincos, statements}
    #[arg(long)]
    json: bool,
    /// What each trick of the reduced form saves in `inverse_dynamics`, with its formula
    #[arg(long, conflicts_with_all = ["json", "without"])]
    tricks: bool,
    /// Leave these tricks out of the reduced form: `rne explain tricks`; the other choices of its plan stay, but a
    /// graph that was rewritten with them is left out too
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = arguments::trick(),
        hide_possible_values = true)]
    without: Vec<Trick>,
}

/// The counts of one function of one robot, as JSON has them.
#[derive(Serialize)]
struct Entry {
    robot: String,
    function: &'static str,
    form: &'static str,
    mul: usize,
    add: usize,
    div: usize,
    sincos: usize,
    statements: usize,
}

/// The counts of one function of one robot.
pub(crate) struct Count {
    pub(crate) function: Function,
    pub(crate) form: Form,
    /// (products, sums) before folding.
    pub(crate) before: (usize, usize),
    pub(crate) after: Operations,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let mut counted = Vec::new();
    let mut remarks = String::new();
    let mut savings = String::new();
    let mut failures: Vec<Failure> = Vec::new();
    for path in plan_file::robots(&arguments.files) {
        let outcome = arguments.rotors.robot(path).and_then(|robot| {
            let compiler = Compiler::new(path, &robot).without(&arguments.without);
            if arguments.tricks {
                savings.push_str(&tricks(&robot, compiler.plans()?));
            } else {
                let functions: Vec<Function> = functions::of(&robot)
                    .filter(|function| arguments.functions.is_empty() || arguments.functions.contains(function))
                    .collect();
                let counts = counts(path, &compiler, &functions, arguments.without.is_empty(), &mut remarks)?;
                counted.push((robot.name.clone(), counts));
            }
            Ok(())
        });
        failures.extend(outcome.err());
    }
    let complaints: Vec<&str> = failures.iter().map(|failure| failure.text.as_str()).collect();
    match failures.first() {
        Some(first) => Err(Failure { text: complaints.join("\n\n"), status: first.status }),
        None if arguments.tricks => Ok(Outcome::text(savings)),
        None if arguments.json => Ok(Outcome { remark: remarks, ..Outcome::json(&entries(&counted))? }),
        None => Ok(Outcome { remark: remarks, ..Outcome::text(table(&counted)) }),
    }
}

/// Counts functions of a robot in the reduced form, and in the seven steps if `both`. What is too large to be compiled
/// is left out, with a line in `remarks`.
pub(crate) fn counts(
    file: &Path,
    compiler: &Compiler<'_>,
    functions: &[Function],
    both: bool,
    remarks: &mut String,
) -> Result<Vec<Count>, Failure> {
    let mut counts = Vec::new();
    let forms = if both { &Form::ALL[..] } else { &[Form::Reduced] };
    'functions: for &function in functions {
        for &form in forms {
            match compiler.compiled(function, form)? {
                Err(error @ CompileError::TooLarge { .. }) => {
                    let _ = writeln!(remarks, "{}: {error}", file.display());
                    continue 'functions;
                }
                program => {
                    let program = program.map_err(|error| compiler.failure(function, form, &error))?;
                    counts.push(Count { function, form, before: program.before(), after: program.operations() });
                }
            }
        }
    }
    Ok(counts)
}

/// What each trick of a plan saves.
fn tricks(robot: &Robot, plans: &PlanSet) -> String {
    let mut text = format!("{TITLE}{}{TITLE:#}\n", robot.name);
    let mut lines = vec![["trick", "saves", "what it is"].map(str::to_owned)];
    for (trick, saved) in plan::savings(robot, plans) {
        lines.push([format!(" {trick}"), saved.to_string(), trick.formula().to_owned()]);
    }
    for (index, line) in columns(&[Align::Left, Align::Right, Align::Left], &lines).iter().enumerate() {
        let _ = match index {
            0 => writeln!(text, "{QUIET}{line}{QUIET:#}"),
            _ => writeln!(text, "{line}"),
        };
    }
    text
}

fn entries(counted: &[(String, Vec<Count>)]) -> Vec<Entry> {
    let entry = |robot: &String, &Count { function, form, after, .. }: &Count| Entry {
        robot: robot.clone(),
        function: function.name(),
        form: form.name(),
        mul: after.mul,
        add: after.add,
        div: after.div,
        sincos: after.sincos,
        statements: after.statements,
    };
    counted.iter().flat_map(|(robot, counts)| counts.iter().map(move |count| entry(robot, count))).collect()
}

/// The counts of robots as a table: a line per robot, below it a line per function and form.
pub(crate) fn table(counted: &[(String, Vec<Count>)]) -> String {
    use Align::{Left, Right};
    let divides = counted.iter().flat_map(|(_, counts)| counts).any(|count| count.after.div > 0);
    let mut titles = vec!["", "form", "mul", "add", "total", "", "mul", "add", "total", "sincos", "lines"];
    let mut alignment = vec![Left, Left, Right, Right, Right, Left, Right, Right, Right, Right, Right];
    let division = 9; // its column, behind the total
    if divides {
        titles.insert(division, "div");
        alignment.insert(division, Right);
    }
    let mut lines: Vec<Vec<String>> = vec![titles.into_iter().map(str::to_owned).collect()];
    for (_, counts) in counted {
        let mut function_before = None;
        for &Count { function, form, before: (products, sums), after } in counts {
            let again = function_before.replace(function) == Some(function);
            // the forms of one function replace the same recursion
            let [before_mul, before_add, before] =
                [products, sums, products + sums].map(|count| if again { String::new() } else { count.to_string() });
            let mut line = vec![
                format!(" {function}"),
                form.to_string(),
                before_mul,
                before_add,
                before,
                "→".to_owned(),
                after.mul.to_string(),
                after.add.to_string(),
                after.total().to_string(),
                after.sincos.to_string(),
                after.statements.to_string(),
            ];
            if divides {
                line.insert(division, if after.div == 0 { String::new() } else { after.div.to_string() });
            }
            lines.push(line);
        }
    }
    let mut lines = columns(&alignment, &lines).into_iter();
    let titles = lines.next().unwrap_or_default();
    let (before, after) = (titles.find("mul"), titles.rfind("mul"));
    let mut text = String::new();
    if let (Some(before), Some(after)) = (before, after) {
        let _ = writeln!(text, "{QUIET}{:before$}{:<2$}generated{QUIET:#}", "", "before folding", after - before);
    }
    let _ = writeln!(text, "{QUIET}{titles}{QUIET:#}");
    for (robot, counts) in counted {
        let _ = writeln!(text, "{TITLE}{robot}{TITLE:#}");
        for line in lines.by_ref().take(counts.len()) {
            let _ = writeln!(text, "{line}");
        }
    }
    text
}
