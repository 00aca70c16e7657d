//! Reads worksheets, CSV or JSON, with a row for each joint, step, quantity and component.
//!
//! `rne eval --trace` and `rne worksheet` write them with [`worksheet_text`](super::worksheet_text); a file may also
//! have only a part of the rows.

mod csv;
mod json;
mod values;

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;
use std::path::Path;

use rne_diagnose::worksheet::{Axes, GivenValue, Quantity, Situation};
use rne_model::Robot;

use crate::files::csv_table::{self, Cell, Mistakes, quoted};
use crate::files::worksheet_file::values::Reading;
use crate::files::worksheet_text::FORMAT;
use crate::outcome::Failure;

/// Largest size of a file, in bytes; a worksheet of 64 joints has half a megabyte.
const LONGEST: usize = 4 << 20;

/// Largest number of rows per joint, more than any worksheet has.
const MOST: usize = 200;

/// The columns that a worksheet must have.
const NEEDED: [&str; 3] = ["joint", "quantity", "value"];

/// A worksheet that a student filled in.
#[derive(Debug, Default)]
pub(crate) struct Filled {
    pub(crate) values: Vec<GivenValue>,
    /// The axes in which the file says that its vectors are.
    pub(crate) axes: Option<Axes>,
    /// The student named in the file.
    pub(crate) student: Option<String>,
    /// The steps that the student should fill in, if the file names them.
    pub(crate) steps: Option<Vec<u8>>,
    /// The cells that the student should fill in, as joint and step, if the file names them.
    pub(crate) cells: Option<Vec<(usize, u8)>>,
}

impl Filled {
    /// Returns the values of q, q̇ or q̈, a number for each joint; `None` if one of them is not given.
    pub(crate) fn given(&self, quantity: Quantity, dof: usize) -> Option<Vec<f64>> {
        let of_joint = |joint| self.values.iter().find(|given| given.quantity == quantity && given.joint == joint);
        (1..=dof).map(|joint| of_joint(joint).map(|given| given.value)).collect()
    }

    /// Returns whether the worksheet gives this state.
    pub(crate) fn is_at(&self, at: &Situation) -> bool {
        [(Quantity::Q, &at.q), (Quantity::Qd, &at.qd), (Quantity::Qdd, &at.qdd)].into_iter().all(|(quantity, own)| {
            let given = self.given(quantity, own.len());
            given.is_some_and(|given| given.iter().zip(own).all(|(a, b)| (a - b).abs() <= 1e-9))
        })
    }
}

/// Contents of the first line of a worksheet.
#[derive(Default)]
struct Head {
    student: Option<String>,
    steps: Option<Vec<u8>>,
    cells: Option<Vec<(usize, u8)>>,
}

/// The cells of a row, by the names of their columns.
type Cells<'a> = BTreeMap<&'static str, Cell<'a>>;

/// The cells of a row, and the bytes of the file that the row has.
type SheetRow<'a> = (Cells<'a>, Range<usize>);

/// Reads a worksheet of a robot. `axes` are those of the command line; if it gives none, those of the file are used.
pub(crate) fn read(path: &Path, robot: &Robot, axes: Option<Axes>) -> Result<Filled, Failure> {
    let (name, text) = &csv_table::read(path, "worksheet", LONGEST, ": is this a worksheet?")?;
    let keys = ["convention:", "joints:", "format:"];
    if keys.iter().filter(|key| text.lines().any(|line| line.starts_with(**key))).count() > 1 {
        return Err(input_error!("{name} is a robot file, not a worksheet; name the worksheets after the robot file"));
    }
    let mut mistakes = Mistakes::new(name, text);
    let is_json = text.trim_start().starts_with(['{', '[']);
    let mut head = Head::default();
    let rows = if is_json {
        json::rows(name, text, robot, &mut mistakes)?
    } else {
        csv::rows(text, robot, &mut head, &mut mistakes)
    };
    if mistakes.are_there() {
        return mistakes.finish(Filled::default());
    }
    let reading = Reading { robot, mistakes, axes, seen: HashMap::new(), values: Vec::new(), text };
    Ok(Filled { student: head.student, steps: head.steps, cells: head.cells, ..reading.rows(&rows)? })
}
fn too_many(span: &Range<usize>, robot: &Robot, mistakes: &mut Mistakes<'_>) {
    let message = format!("there are more rows than a worksheet of {} has", robot.name);
    mistakes.push(span.clone(), message, Some("give each component of each joint only once"));
}

/// Refuses a worksheet with another version of the format.
fn is_of_format(format: &str, span: &Range<usize>, mistakes: &mut Mistakes<'_>) {
    if format != FORMAT.to_string() {
        let message = format!("this worksheet has format {format}; this rne reads format {FORMAT}");
        mistakes.push(span.clone(), message, None);
    }
}

/// Refuses a worksheet for another robot.
fn is_of_robot(name: &str, span: &Range<usize>, robot: &Robot, mistakes: &mut Mistakes<'_>) {
    if name != robot.name {
        let message = format!("this worksheet is for {}, and the robot file is for {}", quoted(name), robot.name);
        mistakes.push(span.clone(), message, Some("compare it with the file of its own robot"));
    }
}

/// Lists the steps of which a file has no value, in words: `steps 3 and 5`.
pub(crate) fn steps_in_words(steps: &[u8]) -> Option<String> {
    let steps: BTreeSet<u8> = steps.iter().copied().collect();
    let words: Vec<String> = steps.iter().map(ToString::to_string).collect();
    match words.split_last() {
        None => None,
        Some((one, [])) => Some(format!("step {one}")),
        Some((last, others)) => Some(format!("steps {} and {last}", others.join(", "))),
    }
}
