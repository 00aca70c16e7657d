//! Reads a worksheet in JSON: an object with the list `rows`, or only the list.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use rne_model::{Report, Robot, did_you_mean};
use serde::Deserialize;
use serde_json::value::RawValue;

use crate::files::csv_table::{Cell, Mistakes, quoted};
use crate::files::worksheet_file::{Cells, MOST, NEEDED, SheetRow, is_of_format, is_of_robot, too_many};
use crate::files::worksheet_text::COLUMNS;
use crate::outcome::Failure;

/// The members of an object, each as the text in the file.
type Object<'a> = BTreeMap<String, &'a RawValue>;

/// Reads the rows of the list.
pub(super) fn rows<'a>(
    name: &str,
    text: &'a str,
    robot: &Robot,
    mistakes: &mut Mistakes<'_>,
) -> Result<Vec<SheetRow<'a>>, Failure> {
    let file = File { name, text };
    let Some(list) = file.list(robot, mistakes)? else { return Ok(Vec::new()) };
    let mut rows = Vec::new();
    for (index, raw) in file.parsed::<Vec<&RawValue>>(list)?.into_iter().enumerate() {
        if index > MOST * robot.dof() {
            too_many(&file.place(raw.get()), robot, mistakes);
            break;
        }
        rows.push((file.cells(raw.get(), mistakes)?, file.place(raw.get())));
    }
    Ok(rows)
}

/// A file whose parts are known by their places in its text.
struct File<'a, 'n> {
    name: &'n str,
    text: &'a str,
}

impl<'a> File<'a, '_> {
    /// Returns the bytes of the file that a part of its text has.
    fn place(&self, part: &str) -> Range<usize> {
        let start = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize);
        start..start + part.len()
    }

    /// Parses a part of the text.
    fn parsed<T: Deserialize<'a>>(&self, part: &'a str) -> Result<T, Failure> {
        serde_json::from_str(part).map_err(|error| {
            let before: usize = part.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
            let at = self.place(part).start + before + error.column().saturating_sub(1);
            let message = error.to_string();
            let message = message.split(" at line ").next().unwrap_or_default();
            let message = format!("this is not a worksheet: {message}");
            let help = "a worksheet is an object with `rows`, as `rne eval … --trace --json` prints it, or a list of \
                        rows; JSON has no NaN and no comma after the last element";
            Failure::from(&Report::of_error(self.name, self.text, at..at + 1, message, Some(help)))
        })
    }

    /// Returns the text of the list of rows.
    fn list(&self, robot: &Robot, mistakes: &mut Mistakes<'_>) -> Result<Option<&'a str>, Failure> {
        let text = self.text.trim();
        if !text.starts_with('{') {
            return Ok(Some(text));
        }
        let mut sheet: Object<'a> = self.parsed(text)?;
        if let Some(trace) = sheet.get("trace") {
            sheet = self.parsed(trace.get())?;
        }
        if let Some(format) = sheet.get("format").map(|raw| raw.get()) {
            is_of_format(format.trim_matches('"'), &self.place(format), mistakes);
        }
        if let Some(name) = sheet.get("robot").map(|raw| raw.get()) {
            is_of_robot(name.trim_matches('"'), &self.place(name), robot, mistakes);
        }
        let rows = sheet.get("rows").map(|raw| raw.get());
        if rows.is_none() {
            mistakes.push(0..1, "there is no key `rows`", Some("`rows` is a list of objects, one for each value"));
        }
        Ok(rows)
    }

    /// Reads the cells of a row.
    fn cells(&self, row: &'a str, mistakes: &mut Mistakes<'_>) -> Result<Cells<'a>, Failure> {
        let mut cells = Cells::new();
        for (key, value) in self.parsed::<Object<'a>>(row)? {
            let Some(column) = COLUMNS.into_iter().find(|column| *column == key) else {
                if let Some(near) = did_you_mean(&key, COLUMNS) {
                    let message = format!("there is no key {}; did you mean `{near}`?", quoted(&key));
                    mistakes.push(self.place(row), message, None);
                }
                continue;
            };
            let text = match value.get() {
                "null" => Cow::Borrowed(""),
                text if text.starts_with('"') => Cow::Owned(serde_json::from_str(text).unwrap_or_default()),
                text => Cow::Borrowed(text),
            };
            cells.insert(column, Cell { text, span: self.place(value.get()) });
        }
        for needed in NEEDED {
            if !cells.contains_key(needed) {
                mistakes.push(self.place(row), format!("this row has no `{needed}`"), None);
            }
        }
        Ok(cells)
    }
}
