//! `rne mark`: marks the worksheets of a class.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_codegen::Step;
use rne_diagnose::worksheet::{self, Worksheet};
use rne_model::Robot;

use crate::commands::eval::DIGITS_BY_HAND;
use crate::commands::teaching::worksheet::numbers_of;
use crate::files::class_states::{Chosen, ClassStates};
use crate::files::input_file::is_standard_input;
use crate::files::robot_file::{self, Shape};
use crate::files::worksheet_file::{self, Filled};
use crate::outcome::{Failure, Outcome};
use crate::render::marks::{self, Mark, Marked};
use crate::render::worksheet::Axes;
use crate::values::choice;

/// Mark the worksheets of a class: points and first errors
#[derive(Args)]
#[allow(clippy::struct_excessive_bools)] // switches of the command line
#[command(after_help = "\
Examples:
  rne mark planar1 --states docs/teaching/lecture/class/key.csv \\
    docs/teaching/lecture/class/*.csv
  rne mark planar2 --seed 7 sheets --csv > marks.csv
  rne mark planar2 --seed 7 sheets/ada.csv --hint

A point is a right value of a worksheet, as `rne eval --trace --csv` and
`rne worksheet` write it. A value that is zero in every state of the arm, such
as omega x of a planar arm, gives no point. With --carry, a value that is right
for the student's own earlier, wrong values gives a point, too, unless it is
zero. The steps that a worksheet asks for and the name of the student are in its
first line; without a name there, the name is that of the file. KEY itself is
not marked.

Exit status: 1 if a file cannot be read (the other files are marked), or if
every worksheet is for another state.")]
pub(crate) struct Arguments {
    /// Robot file, or a name from `rne list`
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Worksheets that the students filled in: CSV or JSON; of a folder all files .csv
    #[arg(value_name = "WORKSHEET", required = true)]
    worksheets: Vec<PathBuf>,
    #[command(flatten)]
    states: Chosen,
    /// Points only for these steps, such as 1,2,7: 1 angular velocity, …, 7 torque
    /// [default: the steps of the worksheet]
    #[arg(long = "step", value_name = "S", value_parser = choice::step, value_delimiter = ',')]
    steps: Vec<Step>,
    /// Points also for values that are right for the student's own earlier, wrong values
    #[arg(long)]
    carry: bool,
    /// Axes of worksheets that do not name their axes: link (default), joint, or base (frame 0)
    #[arg(long, value_enum, hide_possible_values = true)]
    axes: Option<Axes>,
    /// Significant digits that count
    #[arg(long, value_name = "N", default_value_t = DIGITS_BY_HAND,
        value_parser = clap::value_parser!(u8).range(1..=15))]
    digits: u8,
    /// Do not print the right values
    #[arg(long)]
    hint: bool,
    /// Print JSON, {"of": POINTS, "marks": […]}
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print a CSV table
    #[arg(long)]
    csv: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = robot_file::robot(&arguments.file, Shape::Chain)?;
    let states = arguments.states.read(&robot)?;
    let is_key = |path: &&PathBuf| arguments.states.states.as_deref().is_some_and(|key| key == path.as_path());
    let mut paths = Vec::new();
    for path in arguments.worksheets.iter().filter(|path| !is_key(path)) {
        paths.extend(if path.is_dir() { worksheets_in(path)? } else { vec![path.clone()] });
    }
    paths.retain(|path| !is_key(&path));
    if paths.is_empty() {
        return Err(Failure::usage("the only worksheet is KEY itself; name the files of the students"));
    }
    let steps = numbers_of(&arguments.steps);
    let (mut marked, mut sheets) = (Vec::new(), Vec::new());
    let mut remark = String::new();
    for path in &paths {
        let read = worksheet_file::read(path, &robot, arguments.axes.map(Into::into));
        match read.and_then(|sheet| Ok((mark(path, &sheet, &robot, &states, &steps, arguments)?, Some(sheet)))) {
            Ok((one, sheet)) => {
                marked.push(one);
                sheets.push(sheet);
            }
            Err(failure) => {
                let _ = writeln!(remark, "{}", failure.text.trim_end());
                marked.push(Marked { student: stem(path), file: path.display().to_string(), mark: Err(failure) });
                sheets.push(None);
            }
        }
    }
    let mut names = states.students();
    names.extend(marked.iter().map(|one| one.student.clone()));
    for (one, sheet) in marked.iter_mut().zip(&sheets).filter(|(one, _)| one.is_for_another_state()) {
        let has =
            |name: &&String| states.of(name, &robot).is_ok_and(|at| sheet.as_ref().is_some_and(|own| own.is_at(&at)));
        if let Some(owner) = names.iter().find(has) {
            one.name_owner(owner);
        }
    }
    remark += &several_files(&marked);
    let all_for_another = marked.iter().filter(|one| one.mark.is_ok()).all(Marked::is_for_another_state);
    if all_for_another && marked.iter().any(|one| one.mark.is_ok()) {
        let option = if arguments.states.seed.is_some() { "--seed" } else { "--states" };
        let _ = writeln!(remark, "error: every worksheet is for another state; is {option} that of the worksheets?");
    }
    let at_fault = all_for_another || marked.iter().any(|one| one.mark.is_err());
    let text = if arguments.json {
        Outcome::json(&marks::json(&marked, arguments.hint))?.text
    } else if arguments.csv {
        marks::csv(&marked, arguments.hint)?
    } else {
        marks::table(&marked, arguments.hint)
    };
    Ok(Outcome { text, remark, remark_last: true, at_fault })
}

/// Returns notes on students who have several files.
fn several_files(marked: &[Marked]) -> String {
    let mut remark = String::new();
    let mut files: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for one in marked.iter().filter(|one| one.mark.is_ok()) {
        files.entry(&one.student).or_default().push(&one.file);
    }
    for (student, files) in files.iter().filter(|(_, files)| files.len() > 1) {
        let _ =
            writeln!(remark, "note: {} has several files: {}", marks::shown(student), marks::shown(&files.join(", ")));
    }
    remark
}

/// Returns the worksheets in a folder: its files `.csv`, sorted by name.
fn worksheets_in(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let unreadable = |error| input_error!("the folder {} cannot be read: {error}", folder.display());
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>).map_err(unreadable)?;
    let is_sheet = |path: &PathBuf| path.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv"));
    let mut files: Vec<PathBuf> = entries.iter().map(std::fs::DirEntry::path).filter(is_sheet).collect();
    files.sort();
    if files.is_empty() {
        return Err(input_error!("the folder {} has no worksheet: no file .csv", folder.display()));
    }
    Ok(files)
}

/// Returns the file name without extension, as the name of a student whose worksheet gives none.
fn stem(path: &Path) -> String {
    if is_standard_input(path) {
        return "-".to_owned();
    }
    path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

fn mark(
    path: &Path,
    filled: &Filled,
    robot: &Robot,
    states: &ClassStates,
    steps: &[u8],
    arguments: &Arguments,
) -> Result<Marked, Failure> {
    let Filled { values, axes, student, steps: asked, cells } = filled;
    let student = student.clone().unwrap_or_else(|| stem(path));
    let at = states.of(&student, robot)?;
    let sheet = Worksheet::new(robot, &at, axes.unwrap_or(worksheet::Axes::Link)).map_err(Failure::usage)?;
    let comparison = sheet.compare(robot, &at, values, arguments.digits).map_err(Failure::usage)?;
    let always_zero = sheet.always_zero(robot, &at).map_err(Failure::usage)?;
    // steps of the command line are used first, else those that the worksheet asks for
    let is_free = arguments.steps.is_empty();
    let steps = asked.as_deref().filter(|_| is_free).unwrap_or(steps);
    let cells = cells.as_ref().filter(|_| is_free);
    let is_asked = |joint, step| steps.contains(&step) && cells.is_none_or(|cells| cells.contains(&(joint, step)));
    let mark = Mark::new(&sheet, comparison, is_asked, &always_zero, arguments.carry);
    Ok(Marked { student, file: path.display().to_string(), mark: Ok(mark) })
}
