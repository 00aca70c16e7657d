//! `rne ops`: what the functions of a robot cost.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use rne_codegen::{Form, Function, Operations, compile};
use rne_model::Robot;
use serde::Serialize;

use crate::layout::{Align, columns};
use crate::outcome::{Failure, Outcome};
use crate::robot_file;
use crate::terminal::{QUIET, TITLE};

/// Count the operations of every function, before folding and in the generated code
#[derive(Args)]
#[command(after_help = "\
Example:
  rne ops robots/puma560.yaml robots/scara_cobra600.yaml
  rne ops robots/*.yaml --json

A subtraction counts as an addition, a negation is free, x·x is one multiplication, and sincos counts the
angles whose sine or cosine is used. Before folding: the recursion as a loop over 3-vectors performs it.")]
pub(crate) struct Arguments {
    /// Robot files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// A list of {robot, function, form, mul, add, div, sincos, statements}
    #[arg(long)]
    json: bool,
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
    let mut failures: Vec<Failure> = Vec::new();
    for path in &arguments.files {
        match robot_file::robot(path).and_then(|robot| Ok((counts(&path.display().to_string(), &robot)?, robot))) {
            Ok((counts, robot)) => counted.push((robot.name, counts)),
            Err(failure) => failures.push(failure),
        }
    }
    let complaints: Vec<&str> = failures.iter().map(|failure| failure.text.as_str()).collect();
    match failures.first() {
        Some(first) => Err(Failure { text: complaints.join("\n\n"), status: first.status }),
        None if arguments.json => Outcome::json(&entries(&counted)),
        None => Ok(Outcome::text(table(&counted))),
    }
}

/// Counts every function of a robot in every form.
pub(crate) fn counts(file: &str, robot: &Robot) -> Result<Vec<Count>, Failure> {
    let pairs = Function::ALL.into_iter().flat_map(|function| Form::ALL.map(|form| (function, form)));
    pairs
        .map(|(function, form)| {
            let program = compile(robot, function, form).map_err(|error| Failure::compile(file, &error))?;
            Ok(Count { function, form, before: program.ledger.before(), after: program.operations() })
        })
        .collect()
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
    let titles =
        ["", "form", "mul", "add", "total", "", "mul", "add", "total", "sincos", "statements"].map(str::to_owned);
    let mut lines = vec![titles];
    for (_, counts) in counted {
        for Count { function, form, before: (products, sums), after } in counts {
            lines.push([
                format!(" {function}"),
                form.to_string(),
                products.to_string(),
                sums.to_string(),
                (products + sums).to_string(),
                "→".to_owned(),
                after.mul.to_string(),
                after.add.to_string(),
                after.total().to_string(),
                after.sincos.to_string(),
                after.statements.to_string(),
            ]);
        }
    }
    let alignment = [Left, Left, Right, Right, Right, Left, Right, Right, Right, Right, Right];
    let mut lines = columns(alignment, &lines).into_iter();
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
