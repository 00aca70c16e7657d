//! Reads trajectories from CSV files with the columns t, q1, …, qd1, …, qdd1, ….

use std::ops::Range;
use std::path::Path;

use rne_logs::Heading;
use rne_model::{Robot, did_you_mean};
use rne_plot::{Trajectory, TrajectoryError};

use crate::files::csv_table::{self, Cell, Line, Mistakes, OPEN_QUOTE, Row, lines, other_separator, quoted};
use crate::outcome::Failure;

/// Largest size of a file, in bytes: enough for ten minutes of a six-joint arm at a hundred hertz, with all digits.
const LONGEST: usize = 24 << 20;

/// Largest number of samples, because a picture is only a thousand pixels wide.
const MOST: usize = 200_000;

/// A trajectory, and words on which parts were derived from others.
pub(crate) struct Given {
    pub(crate) trajectory: Trajectory,
    pub(crate) derived: &'static str,
}

/// The indices of the columns of a trajectory; for each quantity one per joint, base to tip.
struct Columns {
    time: usize,
    q: Vec<usize>,
    qd: Option<Vec<usize>>,
    qdd: Option<Vec<usize>>,
}

/// Reads the trajectory of a robot from a file.
pub(crate) fn read(path: &Path, robot: &Robot) -> Result<Given, Failure> {
    let (name, text) = &csv_table::read(path, "trajectory", LONGEST, "; give a file with a part of the samples")?;
    let mut mistakes = Mistakes::new(name, text);
    let given = given(text, robot, &mut mistakes);
    mistakes.finish(given)?.ok_or_else(|| Failure::input("this is not a trajectory"))
}

/// Reads the trajectory from a text; `None` if the text has mistakes.
fn given(text: &str, robot: &Robot, mistakes: &mut Mistakes<'_>) -> Option<Given> {
    let dof = robot.dof();
    let help =
        format!("the header is t,{}; columns qd and qdd are optional, others are ignored", names("q", dof).join(","));
    let mut table = lines(text).filter_map(|line| match line {
        Line::Row(row) => Some(Ok(row)),
        Line::OpenQuote(span) => Some(Err(span)),
        Line::Comment(..) => None,
    });
    let header = table.next().and_then(|line| line.map_err(|span| mistakes.push(span, OPEN_QUOTE, None)).ok());
    let Some(header) = header else {
        if !mistakes.are_there() {
            mistakes.push(0..0, "the file is empty: there is no header", Some(&help));
        }
        return None;
    };
    let joints: Vec<String> = robot.independent_joints().map(|joint| joint.name.clone()).collect();
    let columns = columns(&header, &joints, &help, mistakes)?;
    let (starts, samples) = samples(table, &header, &columns, mistakes);
    if mistakes.are_there() {
        return None;
    }
    let series = |columns: &[usize]| -> Vec<Vec<f64>> {
        samples.iter().map(|sample| columns.iter().map(|&column| sample[column]).collect()).collect()
    };
    let time = samples.iter().map(|sample| sample[columns.time]).collect();
    let (qd, qdd) = (columns.qd.as_deref().map(series), columns.qdd.as_deref().map(series));
    let derived = match (&qd, &qdd) {
        (Some(_), Some(_)) => "",
        (Some(_), None) => "accelerations derived from the velocities",
        (None, Some(_)) => "velocities derived from the positions",
        (None, None) => "velocities and accelerations derived from the positions",
    };
    let trajectory = Trajectory::new(time, series(&columns.q), qd, qdd).map_err(|error| {
        let (span, help) = match &error {
            TrajectoryError::Time(sample) => {
                let start = starts.get(*sample).copied().unwrap_or_default();
                (start..start + 1, None)
            }
            TrajectoryError::TooFew { .. } => (
                text.len()..text.len(),
                Some("a trajectory needs at least two samples, and at least three if rne must compute derivatives"),
            ),
            _ => (header.span.clone(), None),
        };
        mistakes.push(span, error.to_string(), help);
    });
    Some(Given { trajectory: trajectory.ok()?, derived })
}

/// Reads the lines below the header; returns for each where it starts, and its numbers.
fn samples<'a>(
    table: impl Iterator<Item = Result<Row<'a>, Range<usize>>>,
    header: &Row<'_>,
    columns: &Columns,
    mistakes: &mut Mistakes<'_>,
) -> (Vec<usize>, Vec<Vec<f64>>) {
    let asked = columns.asked(header.cells.len());
    let (mut starts, mut samples) = (Vec::new(), Vec::new());
    for line in table {
        match line {
            Ok(row) if samples.len() == MOST => {
                let message = format!("the file has more than {MOST} samples");
                mistakes.push(row.span, message, Some("give a file with a part of the samples, or with every tenth"));
                break;
            }
            _ if mistakes.are_enough() => break,
            Ok(row) => {
                starts.push(row.span.start);
                samples.push(numbers(header, &row, &asked, mistakes));
            }
            Err(span) => mistakes.push(span, OPEN_QUOTE, None),
        }
    }
    (starts, samples)
}

fn names(quantity: &str, dof: usize) -> Vec<String> {
    (1..=dof).map(|joint| format!("{quantity}{joint}")).collect()
}

/// Finds the columns of each quantity, for all joints or for none: by the numbers of the joints, or by their names as
/// `rne log` writes them.
fn columns(header: &Row<'_>, joints: &[String], help: &str, mistakes: &mut Mistakes<'_>) -> Option<Columns> {
    let dof = joints.len();
    let known: Vec<String> =
        std::iter::once("t".to_owned()).chain(["q", "qd", "qdd"].into_iter().flat_map(|q| names(q, dof))).collect();
    for (index, cell) in header.cells.iter().enumerate() {
        if header.cells[..index].iter().any(|other| other.text == cell.text && !cell.text.is_empty()) {
            mistakes.push(cell.span.clone(), format!("the column {} occurs twice", quoted(&cell.text)), None);
        }
        let is_of_another_joint = ["qdd", "qd", "q"].iter().find_map(|start| cell.text.strip_prefix(start));
        let joint = is_of_another_joint.and_then(|digits| digits.parse::<usize>().ok());
        if joint.is_some_and(|joint| joint == 0 || joint > dof) {
            let joints = if dof == 1 { "is 1 joint".to_owned() } else { format!("are joints 1 to {dof}") };
            mistakes.push(
                cell.span.clone(),
                format!("{} belongs to no joint: there {joints}", quoted(&cell.text)),
                Some(help),
            );
        }
    }
    let find = |name: &str| header.cells.iter().position(|cell| cell.text == name);
    let mut missing = |name: &str| {
        let near = header.cells.iter().filter(|cell| !known.iter().any(|name| *name == cell.text));
        let near = did_you_mean(name, near.map(|cell| cell.text.as_ref()));
        let meant = near.map_or_else(String::new, |near| format!("; is it {}?", quoted(near)));
        let help = other_separator(header).unwrap_or(help);
        mistakes.push(header.span.clone(), format!("there is no column `{name}`{meant}"), Some(help));
    };
    let Some(time) = find("t") else {
        missing("t");
        return None;
    };
    let mut all = |quantity: &str, needed: bool| -> Result<Option<Vec<usize>>, ()> {
        let mut names = names(quantity, dof);
        let named = Heading::quantity(quantity).map(|quantity| Heading::of(joints).columns(quantity));
        let is_there = |names: &[String]| names.iter().any(|name| find(name).is_some());
        if let Some(named) = named.filter(|named| !is_there(&names) && is_there(named)) {
            names = named;
        }
        if !needed && names.iter().all(|name| find(name).is_none()) {
            return Ok(None);
        }
        let found: Vec<usize> = names.iter().filter_map(|name| find(name)).collect();
        if let Some(name) = names.iter().find(|name| find(name).is_none()) {
            missing(name);
            return Err(());
        }
        Ok(Some(found))
    };
    let (q, qd, qdd) = (all("q", true), all("qd", false), all("qdd", false));
    let columns = Columns { time, q: q.ok()??, qd: qd.ok()?, qdd: qdd.ok()? };
    (!mistakes.are_there()).then_some(columns)
}

impl Columns {
    /// Returns for each column of the file whether it is used.
    fn asked(&self, columns: usize) -> Vec<bool> {
        let all = [Some(&self.q), self.qd.as_ref(), self.qdd.as_ref()];
        let mut asked = vec![false; columns];
        for &column in all.into_iter().flatten().flatten().chain([&self.time]) {
            asked[column] = true;
        }
        asked
    }
}

/// Reads the numbers of a line, column by column; 0 for a column that is not used, and for a cell without a number.
fn numbers(header: &Row<'_>, row: &Row<'_>, asked: &[bool], mistakes: &mut Mistakes<'_>) -> Vec<f64> {
    if row.cells.len() != header.cells.len() {
        let message =
            format!("the line has {} cells, but the header has {} columns", row.cells.len(), header.cells.len());
        mistakes.push(row.span.clone(), message, Some("write numbers with a decimal point, not with a comma"));
        return Vec::new();
    }
    let mut number = |(cell, name): (&Cell<'_>, &Cell<'_>)| {
        let number = cell.text.parse::<f64>().ok().filter(|number| number.is_finite());
        number.unwrap_or_else(|| {
            let message = if cell.text.is_empty() {
                format!("a number of column `{}` is missing", name.text)
            } else {
                format!("{} of column `{}` is not a finite number", quoted(&cell.text), name.text)
            };
            mistakes.push(cell.span.clone(), message, None);
            0.0
        })
    };
    let pairs = row.cells.iter().zip(&header.cells).zip(asked);
    pairs.map(|(pair, asked)| if *asked { number(pair) } else { 0.0 }).collect()
}
