//! `rne ops`: counts the operations of a robot's functions.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_codegen::plan::{PlanSet, Trick};
use rne_codegen::{CompileError, Form, Function, Operations};
use rne_model::Robot;
use serde::Serialize;

use crate::files::chosen_arm::Rotors;
use crate::files::plan_file;
use crate::files::plan_file::Compiler;
use crate::files::robot_file::Shape;
use crate::outcome::{Failure, Outcome};
use crate::palette::{QUIET, TITLE};
use crate::render::layout::{Align, columns, width, wrap};
use crate::terminal;
use crate::values::choice;

/// Count the arithmetic operations of the generated code
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne ops robots/puma560.yaml robots/scara_cobra600.yaml
  rne ops robots/*.yaml --json --function mass_matrix,forward_dynamics
  rne ops robots/puma560.yaml --tricks             savings of each trick
  rne ops robots/puma560.yaml --without gyrostat   without one of them

rne counts a subtraction as an addition, and x·x as one multiplication. A
negation counts nothing. The column `sincos` counts the angles whose sine or
cosine the code uses. Divisions have a column of their own if there are any, and
are not in the total. The column `before folding` counts the operations of a
loop over 3-vectors, before rne simplifies the code. Functions of motors are
listed only if the robot has motors.")]
pub(crate) struct Arguments {
    /// Robot files, or names from `rne list`
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Count only this function; may be repeated; see `rne explain functions`
    #[arg(long = "function", value_name = "F", value_delimiter = ',', value_parser = choice::function(),
        hide_possible_values = true,
        conflicts_with = "tricks")]
    functions: Vec<Function>,
    #[command(flatten)]
    rotors: Rotors,
    /// Print the counts as JSON: a list of {robot, function, form, mul, add, div, sincos, statements}
    #[arg(long)]
    json: bool,
    /// Print formula and saved operations of each simplification of the reduced form of `inverse_dynamics`
    #[arg(long, conflicts_with_all = ["json", "without"])]
    tricks: bool,
    /// Omit this simplification of the reduced form (see `rne explain tricks`) and all results of `rne search
    /// --rewrite`
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = choice::trick(),
        hide_possible_values = true)]
    without: Vec<Trick>,
}

/// The counts of one function of one robot, in JSON.
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
    /// Products and sums before folding.
    pub(crate) before: (usize, usize),
    pub(crate) after: Operations,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let mut counted = Vec::new();
    let mut remarks = String::new();
    let mut savings = String::new();
    let mut failures: Vec<Failure> = Vec::new();
    for path in plan_file::robots(&arguments.files) {
        let outcome = arguments.rotors.robot(path, Shape::Closed).and_then(|robot| {
            remarks.push_str(&arguments.rotors.note(&robot));
            let compiler = Compiler::new(path, &robot).without(&arguments.without);
            if arguments.tricks {
                savings.push_str(&tricks(&robot, compiler.plans()?, terminal::room()));
            } else {
                let has_loops = !robot.closed.is_empty();
                if let Some(&other) = arguments.functions.iter().find(|it| it.is_of_closed_loops() != has_loops) {
                    compiler.compile(other, Form::SevenSteps)?;
                }
                let mut functions = Vec::new();
                if arguments.functions.is_empty() {
                    functions.extend(choice::functions_of(&robot));
                }
                // a named function is counted even if another one fits the robot better; if the robot cannot have it,
                // the compiler says why
                for asked in Function::ALL.into_iter().filter(|function| arguments.functions.contains(function)) {
                    match compiler.compiled(asked, Form::SevenSteps)? {
                        Ok(_) => functions.push(asked),
                        Err(error) => _ = writeln!(remarks, "{}: {error}", path.display()),
                    }
                }
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
        None if arguments.tricks => Ok(Outcome { remark: remarks, ..Outcome::text(savings) }),
        None if arguments.json => Ok(Outcome { remark: remarks, ..Outcome::json(&entries(&counted))? }),
        None => Ok(Outcome { remark: remarks, ..Outcome::text(table(&counted, terminal::room())) }),
    }
}

/// Counts functions of a robot in the reduced form, and in the seven steps if `both` is true. Functions that are too
/// large to compile are left out, with a line in `remarks`.
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

/// Lists the operations that each trick of a plan saves, in lines of at most `room` columns.
fn tricks(robot: &Robot, plans: &PlanSet, room: usize) -> String {
    let mut text = format!("{TITLE}{}{TITLE:#}\n", robot.name);
    let mut lines = vec![["trick", "saves", "what it is"].map(str::to_owned)];
    for (trick, saved) in rne_search::savings(robot, plans) {
        lines.push([format!(" {trick}"), saved.to_string(), trick.formula().to_owned()]);
    }
    let lines = columns(&[Align::Left, Align::Right, Align::Left], &lines);
    let before = lines.first().and_then(|titles| titles.find("what")).unwrap_or(0);
    for (index, line) in lines.iter().enumerate() {
        let _ = match index {
            0 => writeln!(text, "{QUIET}{line}{QUIET:#}"),
            _ => writeln!(text, "{}", wrap(line, room, &" ".repeat(before))),
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

/// Writes the counts of robots as a table: a line for each robot, and below it a line for each function and form. A
/// table that is wider than `room` columns loses, in this order, products and sums before folding, the numbers of
/// lines, and all other counts before folding; at last, functions get lines of their own above their forms.
pub(crate) fn table(counted: &[(String, Vec<Count>)], room: usize) -> String {
    const LEAST: [&[usize]; 4] = [&[2, 3], &[LINES], &[4, 5], &[FUNCTION]];
    let mut left_out = Vec::new();
    let mut table = with_columns(counted, &left_out);
    for columns in LEAST {
        if table.lines().all(|line| width(&anstream::adapter::strip_str(line).to_string()) <= room) {
            break;
        }
        left_out.extend(columns);
        table = with_columns(counted, &left_out);
    }
    table
}

/// The index of the column of functions.
const FUNCTION: usize = 0;

/// The index of the column with numbers of lines.
const LINES: usize = 11;

/// Writes the table without some of its columns; divisions are always shown.
fn with_columns(counted: &[(String, Vec<Count>)], left_out: &[usize]) -> String {
    use Align::{Left, Right};
    let divides = counted.iter().flat_map(|(_, counts)| counts).any(|count| count.after.div > 0);
    let titles = ["", "form", "mul", "add", "total", "", "mul", "add", "total", "div", "sincos", "lines"];
    let alignment = [Left, Left, Right, Right, Right, Left, Right, Right, Right, Right, Right, Right];
    let division = 9; // its column, behind the total
    let is_shown = |column: usize| !left_out.contains(&column) && (column != division || divides);
    let shown = |line: Vec<String>| -> Vec<String> {
        line.into_iter().enumerate().filter(|(column, _)| is_shown(*column)).map(|(_, cell)| cell).collect()
    };
    let alignment: Vec<Align> = (0..).zip(alignment).filter(|(at, _)| is_shown(*at)).map(|(_, to)| to).collect();
    let is_stacked = left_out.contains(&FUNCTION);
    let indent = if is_stacked { "   " } else { "" };
    let mut lines = vec![shown(titles.map(str::to_owned).into())];
    for (_, counts) in counted {
        let mut function_before = None;
        for &Count { function, form, before: (products, sums), after } in counts {
            let again = function_before.replace(function) == Some(function);
            // all forms of a function replace the same recursion, so they have the same counts before folding
            let [before_mul, before_add, before] =
                [products, sums, products + sums].map(|count| if again { String::new() } else { count.to_string() });
            lines.push(shown(vec![
                format!(" {function}"),
                format!("{indent}{form}"),
                before_mul,
                before_add,
                before,
                "→".to_owned(),
                after.mul.to_string(),
                after.add.to_string(),
                after.total().to_string(),
                if after.div == 0 { String::new() } else { after.div.to_string() },
                after.sincos.to_string(),
                after.statements.to_string(),
            ]));
        }
    }
    let mut lines = columns(&alignment, &lines).into_iter();
    let titles = lines.next().unwrap_or_default();
    let mut text = above(&titles);
    let _ = writeln!(text, "{QUIET}{titles}{QUIET:#}");
    for (robot, counts) in counted {
        let _ = writeln!(text, "{TITLE}{robot}{TITLE:#}");
        let mut function_before = None;
        for (count, line) in counts.iter().zip(lines.by_ref()) {
            if is_stacked && function_before.replace(count.function) != Some(count.function) {
                let _ = writeln!(text, " {}", count.function);
            }
            let _ = writeln!(text, "{line}");
        }
    }
    text
}

/// Returns the line above the titles: which columns are before folding, and which are of the generated code.
fn above(titles: &str) -> String {
    // the columns before folding end with their total
    let (total, after) = (titles.find("total").unwrap_or(0), titles.rfind("mul").unwrap_or(0));
    let line = match titles.find("mul").filter(|before| *before < after) {
        Some(before) => {
            format!("{:before$}{:<2$}generated", "", "before folding", after - before)
        }
        None if total < after => {
            let end = total + "total".len();
            format!("{:>end$}{:2$}generated", "before folding", "", after - end)
        }
        None => {
            format!("{:after$}generated", "")
        }
    };
    format!("{QUIET}{line}{QUIET:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_of_counts_fits_its_room() {
        let file = rne_robots::find("puma560").expect("shipped");
        let robot = Robot::from_yaml(file.yaml).expect("valid");
        let path = Path::new("puma560");
        let compiler = Compiler::built_in(path, &robot, file.plan.expect("a plan")).expect("valid");
        let functions = [Function::InverseDynamics, Function::InverseDynamicsOnMovingBase, Function::ForwardDynamics];
        let counts = counts(path, &compiler, &functions, true, &mut String::new()).expect("counted");
        let totals: Vec<String> = counts.iter().map(|count| count.after.total().to_string()).collect();
        let counted = [(robot.name.clone(), counts)];
        let lines = |room| {
            let text = anstream::adapter::strip_str(&table(&counted, room)).to_string();
            text.lines().map(str::to_owned).collect::<Vec<_>>()
        };
        let widest = |lines: &[String]| lines.iter().map(|line| width(line)).max().unwrap_or(0);
        assert!(widest(&lines(1000)) > 100, "the whole table is wide");
        // from 48 columns, the narrowest terminal in use, where functions are above their forms
        for room in 48..140 {
            let lines = lines(room);
            assert!(widest(&lines) <= room, "{room}: {lines:#?}");
            // the word "generated" is above the columns of generated code at every width
            let generated = lines[0].find("generated").expect("a title");
            let counted = lines[3..].iter().filter(|line| Form::ALL.iter().any(|form| line.contains(form.name())));
            for (line, total) in counted.zip(&totals) {
                let cells = line.chars().skip(generated).collect::<String>();
                assert!(cells.split_whitespace().any(|cell| cell == total), "{room}: no {total} in {line}");
            }
            assert_eq!(lines[0].contains("before folding"), lines[1].matches("total").count() == 2, "{lines:#?}");
        }
        let folded = tricks(&robot, compiler.plans().expect("plans"), 80);
        let folded = anstream::adapter::strip_str(&folded).to_string();
        assert!(folded.lines().all(|line| width(line) <= 80), "{folded}");
    }
}
