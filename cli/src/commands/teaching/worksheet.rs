//! `rne worksheet`: writes worksheets for a class to fill in.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::Args;
use rne_codegen::Step;
use rne_diagnose::worksheet::Worksheet;

use crate::files::class_states::Chosen;
use crate::files::csv_table::quoted;
use crate::files::input_file;
use crate::files::output_file::unwritable;
use crate::files::output_folder;
use crate::files::robot_file::{self, Shape};
use crate::files::worksheet_text;
use crate::outcome::{Failure, Outcome};
use crate::palette::GOOD;
use crate::render::worksheet::Axes;
use crate::values::choice;

/// Write a worksheet of the seven steps for each student to fill in
#[derive(Args)]
#[command(override_usage = "rne worksheet [OPTIONS] --seed <N> -o <FOLDER> <FILE> [STUDENT]...")]
#[command(after_help = "\
Examples:
  rne worksheet planar2 --seed 7 -o sheets ada bob
  rne worksheet planar2 --seed 7 -o answers ada bob --answers
  rne worksheet planar2 --seed 7 -o comma ada --decimal-comma --step 1,2,7

A worksheet is a CSV file, STUDENT.csv, with the student's q, qd and qdd and
with a row for each number of steps 1 to 7. Students write their numbers in the
column value. `rne mark` with the same --seed or --states marks the files.")]
pub(crate) struct Arguments {
    /// Robot file, or a name from `rne list`
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Names of the students, with which the files are named
    #[arg(value_name = "STUDENT")]
    students: Vec<String>,
    /// Text file with the name of a student on each line; - is standard input
    #[arg(long, value_name = "FILE")]
    class: Option<PathBuf>,
    #[command(flatten)]
    states: Chosen,
    /// Folder for the worksheets; it must be empty or must not exist
    #[arg(short, long = "output", value_name = "FOLDER")]
    out: PathBuf,
    /// Only these steps, such as 1,2,7: 1 angular velocity, …, 7 torque
    #[arg(long = "step", value_name = "S", value_parser = choice::step, value_delimiter = ',')]
    steps: Vec<Step>,
    /// Axes of the vectors: link (default), joint, or base (frame 0)
    #[arg(long, value_enum, hide_possible_values = true, default_value = "link", hide_default_value = true)]
    axes: Axes,
    /// Fill in the right values, for the teacher
    #[arg(long)]
    answers: bool,
    /// Write 0,5 for 0.5, and semicolons between the columns
    #[arg(long)]
    decimal_comma: bool,
}

/// Returns the steps whose numbers count: the named steps, or all if none is named.
pub(crate) fn numbers_of(steps: &[Step]) -> Vec<u8> {
    let all =
        (1..=7_u8).filter(|number| steps.is_empty() || steps.iter().any(|step| step.number() == usize::from(*number)));
    all.collect()
}

/// Largest size of the text with the names of a class, in bytes.
const LONGEST: usize = 1 << 20;

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = robot_file::robot(&arguments.file, Shape::Chain)?;
    let states = arguments.states.read(&robot)?;
    let students = students(arguments, states.students())?;
    output_folder::is_free(&arguments.out, "a set of worksheets")?;
    let steps = numbers_of(&arguments.steps);
    let mut files = Vec::new();
    for student in &students {
        let at = states.of(student, &robot)?;
        let sheet = Worksheet::new(&robot, &at, arguments.axes.into()).map_err(Failure::usage)?;
        let text =
            worksheet_text::of_student(&robot, &sheet, student, &steps, arguments.answers, arguments.decimal_comma);
        files.push((PathBuf::from(format!("{student}.csv")), text));
    }
    output_folder::write(&arguments.out, &files).map_err(|(path, error)| unwritable(&path, &error))?;
    let (count, folder) = (files.len(), arguments.out.display());
    let worksheets = if count == 1 { "worksheet" } else { "worksheets" };
    Ok(Outcome::remark(format!("{GOOD}wrote{GOOD:#} {count} {worksheets} to {folder}\n")))
}

/// Returns the students of the command line and of the class file; those of the file of states if there are no others.
fn students(arguments: &Arguments, of_states: Vec<String>) -> Result<Vec<String>, Failure> {
    let mut students = arguments.students.clone();
    if let Some(path) = &arguments.class {
        let name = input_file::name(path);
        let unreadable = |error: &dyn std::fmt::Display| input_error!("the names {name} cannot be read: {error}");
        let bytes = input_file::read(path, LONGEST).map_err(|error| unreadable(&error))?;
        if bytes.len() > LONGEST {
            return Err(unreadable(&format_args!("the file has more than {LONGEST} bytes")));
        }
        let text = std::str::from_utf8(&bytes).map_err(|_| unreadable(&"save the file as UTF-8"))?;
        let lines = text.trim_start_matches('\u{feff}').lines().map(str::trim).filter(|line| !line.is_empty());
        students.extend(lines.map(str::to_owned));
    }
    if students.is_empty() {
        students = of_states;
    }
    if students.is_empty() {
        return Err(Failure::usage("no student is named; write the names after FILE, or name a file with --class"));
    }
    let mut seen = BTreeSet::new();
    for student in &students {
        let is_file_name = !student.is_empty()
            && student.chars().all(|c| c.is_alphanumeric() || "_-. ".contains(c))
            && !student.starts_with(['.', '-', ' '])
            && !student.ends_with(['.', ' '])
            && student.len() <= 100;
        if !is_file_name {
            return Err(usage_error!(
                "{} cannot be the name of a worksheet; a name has letters, digits, `_`, `-`, `.` and blanks, begins \
                 and ends with a letter, a digit or `_`, and has at most 100 bytes",
                quoted(student)
            ));
        }
        // some file systems do not distinguish ADA from ada
        if !seen.insert(student.to_lowercase()) {
            return Err(usage_error!("the student {} is named twice", quoted(student)));
        }
    }
    Ok(students)
}
