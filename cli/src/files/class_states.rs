//! The states for which a class fills in worksheets: a file of states, or numbers of each student's own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use rne::testing::Random;
use rne_diagnose::worksheet::Situation;
use rne_model::{JointKind, Robot, did_you_mean};

use crate::files::csv_table::{self, Cell, Mistakes, OPEN_QUOTE, quoted, with_point};
use crate::outcome::Failure;

/// The choice of the states.
#[derive(Args)]
#[group(required = true, multiple = false)]
pub(crate) struct Chosen {
    /// CSV file with the columns q1, …, qd1, …, qdd1, …: one state for everybody, or a row for each student in the
    /// column name
    #[arg(long, value_name = "KEY")]
    pub(crate) states: Option<PathBuf>,
    /// A state for each student, computed from this number and the student's name
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
}

impl Chosen {
    pub(crate) fn read(&self, robot: &Robot) -> Result<ClassStates, Failure> {
        match (&self.states, self.seed) {
            (Some(path), _) => read(path, robot),
            (None, seed) => Ok(ClassStates::Seed(seed.unwrap_or_default())),
        }
    }
}

/// The states of the students of a class.
#[derive(Debug)]
pub(crate) enum ClassStates {
    Everybody(Box<Situation>),
    /// A state for each student, by name; and the name of the file.
    Each(BTreeMap<String, Situation>, String),
    Seed(u64),
}

impl ClassStates {
    /// Returns the state of a student.
    pub(crate) fn of(&self, student: &str, robot: &Robot) -> Result<Situation, Failure> {
        match self {
            Self::Everybody(state) => Ok(Situation::clone(state)),
            Self::Seed(seed) => Ok(by_seed(robot, *seed, student)),
            Self::Each(states, file) => states.get(student).cloned().ok_or_else(|| {
                let near = did_you_mean(student, states.keys().map(String::as_str));
                let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                input_error!("{file} has no row for the student {}{near}", quoted(student))
            }),
        }
    }

    /// Returns the students that the file of states names.
    pub(crate) fn students(&self) -> Vec<String> {
        match self {
            Self::Each(states, _) => states.keys().cloned().collect(),
            _ => Vec::new(),
        }
    }
}

/// Makes the situation of an arm without external wrench, on a base at rest.
fn at(q: Vec<f64>, qd: Vec<f64>, qdd: Vec<f64>) -> Situation {
    Situation { q, qd, qdd, base: None, wrench: None, payload: None }
}

/// Computes a state from a seed and a name: positions in steps of 0.05 rad or m within the limits of the file,
/// velocities and accelerations in steps of 0.1. None of these is zero, so that every term counts.
fn by_seed(robot: &Robot, seed: u64, student: &str) -> Situation {
    // FNV-1a hash of the seed and the name
    let bytes = seed.to_le_bytes().into_iter().chain(student.bytes());
    let hash =
        bytes.fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    let random = Random::new(hash, |number| number);
    // a random number from -1 to 1
    let number = || random.number(1.0);
    let step = |value: f64, per_unit: f64| (value * per_unit).round() / per_unit;
    let rate = |most: f64| {
        let value = number();
        step(value.signum() * (0.2 + (most - 0.2) * value.abs()), 10.0)
    };
    let q = robot.independent_joints().map(|joint| {
        let (low, high) = if joint.row.kind == JointKind::Revolute { (-1.5_f64, 1.5_f64) } else { (0.1, 0.5) };
        let (low, high) = match joint.limits.position {
            Some((lower, upper)) if lower.max(low) < upper.min(high) => (lower.max(low), upper.min(high)),
            Some(limits) => limits,
            None => (low, high),
        };
        let value = low + (high - low) * (number() + 1.0) / 2.0;
        // a position near 0 has a sine of nearly 0, which would hide the term with this sine
        let value = if value.abs() < 0.2 { 0.2_f64.copysign(value) } else { value };
        Some(step(value, 20.0)).filter(|value| (low..=high).contains(value)).unwrap_or(value.clamp(low, high))
    });
    let q = q.collect();
    let [qd, qdd] = [2.0, 3.0].map(|most| robot.independent_joints().map(|_| rate(most)).collect());
    at(q, qd, qdd)
}

/// Largest size of a file of states for a class, in bytes.
const LONGEST: usize = 4 << 20;

/// Contents of a column of the file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Column {
    Name,
    /// A number: the index of its list (0 to 2 for q, qd, qdd), and its joint, counted from 0.
    Number(usize, usize),
}

const LISTS: [&str; 3] = ["q", "qd", "qdd"];

fn read(path: &Path, robot: &Robot) -> Result<ClassStates, Failure> {
    let (name, text) = &csv_table::read(path, "states", LONGEST, ": are these states of a class?")?;
    let mut mistakes = Mistakes::new(name, text);
    let mut rows = Vec::new();
    for line in csv_table::lines(text) {
        match line {
            csv_table::Line::Row(row) => rows.push(row),
            csv_table::Line::OpenQuote(span) => mistakes.push(span, OPEN_QUOTE, None),
            csv_table::Line::Comment(..) => {}
        }
    }
    let dof = robot.dof();
    let help = format!(
        "the columns are q1 to q{dof}, qd1 to qd{dof} and qdd1 to qdd{dof}, and name if each student has a row; \
         without qd or qdd these numbers are 0"
    );
    let Some((header, rows)) = rows.split_first() else {
        mistakes.push(0..0, "the file is empty: there is no header", Some(&help));
        return mistakes.finish(ClassStates::Seed(0));
    };
    // a file for another robot is reported once, not for each column
    is_for_arm_of(dof, header)
        .map_err(|joints| input_error!("{name}: the key is for an arm of {joints}; {} has {dof}", robot.name))?;
    let columns = columns(header, dof, &help, &mut mistakes);
    if rows.is_empty() && !mistakes.are_there() {
        mistakes.push(header.span.clone(), "there is no state below the header", Some(&help));
    }
    let has_names = columns.contains(&Some(Column::Name));
    if let (false, [_, second, ..]) = (has_names, rows) {
        let help = "add a column `name` with the name of each student, or keep one row for everybody";
        mistakes.push(second.span.clone(), "there are several states, but no column `name`", Some(help));
    }
    let mut states = BTreeMap::new();
    for row in rows.iter().filter(|_| !columns.is_empty()) {
        let Some((student, state)) = of_row(row, &columns, dof, &mut mistakes) else { continue };
        if has_names && student.is_empty() {
            mistakes.push(row.span.clone(), "the name of the student is missing", None);
        }
        if states.insert(student.clone(), state).is_some() && has_names {
            mistakes.push(row.span.clone(), format!("the student {} occurs twice", quoted(&student)), None);
        }
    }
    let of_everybody = states.get("").cloned().filter(|_| !has_names).map(Box::new);
    mistakes.finish(of_everybody.map_or_else(|| ClassStates::Each(states, name.clone()), ClassStates::Everybody))
}

/// Checks that a header has columns for `dof` joints; the error says in words how many joints it has.
fn is_for_arm_of(dof: usize, header: &csv_table::Row<'_>) -> Result<(), String> {
    let joint = |cell: &Cell<'_>| -> Option<usize> {
        cell.text.to_ascii_lowercase().strip_prefix('q')?.trim_start_matches('d').parse().ok()
    };
    match header.cells.iter().filter_map(joint).max() {
        Some(1) if dof != 1 => Err("1 joint".to_owned()),
        Some(joints) if joints != dof => Err(format!("{joints} joints")),
        _ => Ok(()),
    }
}

/// Reads a row: the name of the student, empty if there is no such column, and the state. `None` if cells are missing
/// or too many.
fn of_row(
    row: &csv_table::Row<'_>,
    columns: &[Option<Column>],
    dof: usize,
    mistakes: &mut Mistakes<'_>,
) -> Option<(String, Situation)> {
    if row.cells.len() != columns.len() {
        let message = format!("{} cells, but {} columns in the header", row.cells.len(), columns.len());
        mistakes.push(row.span.clone(), message, Some("a decimal comma needs semicolons between the columns"));
        return None;
    }
    let mut student = String::new();
    let mut lists = [(); 3].map(|()| vec![0.0; dof]);
    for (column, cell) in columns.iter().zip(&row.cells) {
        match column {
            Some(Column::Name) => student = cell.text.to_string(),
            Some(Column::Number(list, joint)) => lists[*list][*joint] = number(cell, mistakes),
            None => {}
        }
    }
    let [q, qd, qdd] = lists;
    Some((student, at(q, qd, qdd)))
}

/// Reads the columns of a header; none if it has mistakes.
fn columns(header: &csv_table::Row<'_>, dof: usize, help: &str, mistakes: &mut Mistakes<'_>) -> Vec<Option<Column>> {
    let names = |list: usize| (1..=dof).map(move |joint| format!("{}{joint}", LISTS[list]));
    let all: Vec<(String, Column)> = std::iter::once(("name".to_owned(), Column::Name))
        .chain((0..3).flat_map(|list| names(list).enumerate().map(move |(at, name)| (name, Column::Number(list, at)))))
        .collect();
    let mut columns = Vec::new();
    for cell in &header.cells {
        let column = all.iter().find(|(name, _)| name.eq_ignore_ascii_case(&cell.text)).map(|(_, column)| *column);
        if column.is_some() && columns.contains(&column) {
            mistakes.push(cell.span.clone(), format!("the column {} occurs twice", quoted(&cell.text)), None);
        }
        columns.push(column);
    }
    for (list, symbol) in LISTS.into_iter().enumerate() {
        let missing: Vec<&str> = all
            .iter()
            .filter(|(_, column)| matches!(column, Column::Number(of, _) if *of == list))
            .filter(|(_, column)| !columns.contains(&Some(*column)))
            .map(|(name, _)| name.as_str())
            .collect();
        // columns of velocities or accelerations must be there for all joints or for none
        if let (Some(first), true) = (missing.first(), symbol == "q" || missing.len() < dof) {
            let help = csv_table::other_separator(header).unwrap_or(help);
            mistakes.push(header.span.clone(), format!("there is no column `{first}`"), Some(help));
        }
    }
    if mistakes.are_there() { Vec::new() } else { columns }
}

fn number(cell: &Cell<'_>, mistakes: &mut Mistakes<'_>) -> f64 {
    rne_model::number(&with_point(&cell.text)).unwrap_or_else(|mistake| {
        let help = mistake.help.as_deref().unwrap_or("write a number, such as -0.25 or pi/2");
        let message = format!("{} is not a number: {}", quoted(&cell.text), mistake.message);
        mistakes.push(cell.span.clone(), message, Some(help));
        f64::NAN
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_of_a_seed() {
        let robot = rne_robots::find("stanford").map(|shipped| Robot::from_yaml(shipped.yaml));
        let robot = robot.expect("a shipped robot").unwrap_or_else(|report| panic!("{report}"));
        let ada = by_seed(&robot, 7, "ada");
        assert_eq!(ada, by_seed(&robot, 7, "ada"));
        assert!(ada != by_seed(&robot, 8, "ada") && ada != by_seed(&robot, 7, "bob"));
        for student in 0..200 {
            let state = by_seed(&robot, 7, &student.to_string());
            for (joint, q) in robot.joints.iter().zip(&state.q) {
                assert!(joint.limits.position.is_none_or(|(low, high)| (low..=high).contains(q)), "{q}");
            }
            for rate in state.qd.iter().chain(&state.qdd) {
                assert!((0.2..=3.0).contains(&rate.abs()) && (rate * 10.0).fract() == 0.0, "{rate}");
            }
        }
    }
}
