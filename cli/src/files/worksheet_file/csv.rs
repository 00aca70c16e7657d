//! Reads a worksheet in CSV: comments, a header, and a line for each value.

use std::ops::Range;

use rne_model::{Robot, did_you_mean};

use crate::files::csv_table::{self, Line, Mistakes, OPEN_QUOTE, Row, quoted};
use crate::files::worksheet_file::{Head, MOST, NEEDED, SheetRow, is_of_format, is_of_robot, too_many};
use crate::files::worksheet_text::COLUMNS;

/// Reads the rows of the table without its header; none if the header has mistakes. `head` is filled from a comment.
pub(super) fn rows<'a>(
    text: &'a str,
    robot: &Robot,
    head: &mut Head,
    mistakes: &mut Mistakes<'_>,
) -> Vec<SheetRow<'a>> {
    let mut lines = Vec::new();
    for line in csv_table::lines(text) {
        match line {
            Line::Row(row) if lines.len() > MOST * robot.dof() => {
                too_many(&row.span, robot, mistakes);
                break;
            }
            Line::Row(row) => lines.push(row),
            Line::OpenQuote(span) => mistakes.push(span, OPEN_QUOTE, None),
            Line::Comment(comment, span) => {
                if let Some(about) = comment.strip_prefix("rne worksheet") {
                    *head = Head::of(about, &span, robot, mistakes);
                }
            }
        }
    }
    let help = format!("the header is `{}`; each line below it contains one value", COLUMNS.join(","));
    let Some((header, lines)) = lines.split_first() else {
        if !mistakes.are_there() {
            mistakes.push(0..0, "the file is empty: there is no header", Some(&help));
        }
        return Vec::new();
    };
    let columns = columns(header, &help, mistakes);
    if mistakes.are_there() {
        return Vec::new();
    }
    let mut rows = Vec::new();
    for row in lines {
        if row.cells.len() > columns.len() {
            let message =
                format!("the line has {} cells, but the header has {} columns", row.cells.len(), columns.len());
            let help = "write numbers with a decimal point, or separate the columns with semicolons; put a text with a \
                        comma in quotes";
            mistakes.push(row.span.clone(), message, Some(help));
        }
        let cells = columns.iter().zip(&row.cells).filter_map(|(column, cell)| Some(((*column)?, cell.clone())));
        rows.push((cells.collect(), row.span.clone()));
    }
    rows
}

/// Returns for each column its name, or `None` if a worksheet has no such column.
fn columns(header: &Row<'_>, help: &str, mistakes: &mut Mistakes<'_>) -> Vec<Option<&'static str>> {
    let mut columns = Vec::new();
    for cell in &header.cells {
        let column = COLUMNS.into_iter().find(|column| column.eq_ignore_ascii_case(&cell.text));
        if column.is_some() && columns.contains(&column) {
            mistakes.push(cell.span.clone(), format!("the column {} occurs twice", quoted(&cell.text)), None);
        }
        // an additional column is no mistake, but a misspelt one is
        if let Some(near) = did_you_mean(&cell.text, COLUMNS).filter(|_| column.is_none()) {
            let message = format!("there is no column {}; did you mean `{near}`?", quoted(&cell.text));
            mistakes.push(cell.span.clone(), message, Some(help));
        }
        columns.push(column);
    }
    for needed in NEEDED {
        if !columns.contains(&Some(needed)) && !mistakes.are_there() {
            let help = csv_table::other_separator(header).unwrap_or(help);
            mistakes.push(header.span.clone(), format!("there is no column `{needed}`"), Some(help));
        }
    }
    columns
}

impl Head {
    /// Reads a comment such as `format 1, robot planar2, steps 1 2 7`, and checks that it is about this robot.
    fn of(about: &str, span: &Range<usize>, robot: &Robot, mistakes: &mut Mistakes<'_>) -> Self {
        // a spreadsheet may change the separators, add those of the other columns at the end of a line, and put each
        // part in quotes
        let word = |key: &str| {
            let mut parts = about.split([',', ';']).map(|part| part.trim_matches(['"', ' ']));
            parts.find_map(|part| part.strip_prefix(key).map(str::trim))
        };
        if let Some(format) = word("format ") {
            is_of_format(format, span, mistakes);
        }
        if let Some(name) = word("robot ") {
            is_of_robot(name, span, robot, mistakes);
        }
        let [steps, cells] = ["steps ", "cells "].map(word);
        let head = Self {
            student: word("student ").map(str::to_owned),
            steps: steps.and_then(steps_of),
            cells: cells.and_then(cells_of),
        };
        if steps.is_some() && head.steps.is_none() {
            let help = "write numbers from 1 to 7 with blanks between them, such as `steps 1 2 7`";
            mistakes.push(span.clone(), "the steps in this line are not steps", Some(help));
        }
        if cells.is_some() && head.cells.is_none() {
            let help = "write joint and step of each cell with blanks between cells, such as `cells 1.4 2.4`";
            mistakes.push(span.clone(), "the cells in this line are not cells", Some(help));
        }
        head
    }
}

/// Reads steps from a text such as `1 2 7`.
fn steps_of(text: &str) -> Option<Vec<u8>> {
    text.split_whitespace().map(|step| step.parse().ok().filter(|step| (1..=7).contains(step))).collect()
}

/// Reads cells, joint and step, from a text such as `1.4 2.4`.
fn cells_of(text: &str) -> Option<Vec<(usize, u8)>> {
    let cell = |text: &str| {
        let (joint, step) = text.split_once('.')?;
        Some((joint.parse().ok()?, step.parse().ok().filter(|step| (1..=7).contains(step))?))
    };
    text.split_whitespace().map(cell).collect()
}
