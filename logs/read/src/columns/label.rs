//! Columns of a table that say of which arm, or of which part of a log, a row is.

use std::path::Path;

use crate::LogError;
use crate::spelling::{instead, listed};

/// Values of a label that are counted: more are no names of arms or of parts.
pub(crate) const MOST_VALUES: usize = 1000;

/// Words for an arm, as names of columns have them.
const ARMS: [&str; 6] = ["robot", "arm", "manipulator", "machine", "device", "asset"];

/// Words that may follow them.
const ENDS: [&str; 7] = ["", "id", "name", "number", "nr", "no", "serial"];

/// A column whose text is held, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Label {
    /// Where the reader has the column.
    pub(crate) place: usize,
    pub(crate) name: String,
    /// The text that a row must have to be read.
    wanted: Option<String>,
    /// The text of the last row that was read.
    pub(crate) value: String,
}

impl Label {
    pub(crate) fn new(place: usize, name: &str, wanted: Option<&str>) -> Self {
        Self { place, name: name.to_owned(), wanted: wanted.map(str::to_owned), value: String::new() }
    }

    /// Takes the text of a row; whether the row is one that is wanted.
    pub(crate) fn take(&mut self, text: &str) -> bool {
        if self.value != text {
            text.clone_into(&mut self.value);
        }
        self.wanted.as_deref().is_none_or(|wanted| wanted == text)
    }

    /// Whether rows are selected by the column.
    pub(crate) fn is_selecting(&self) -> bool {
        self.wanted.is_some()
    }
}

/// Whether a column has the name of one that names arms, such as `robot_id`.
pub(crate) fn names_arms(column: &str) -> bool {
    let last = column.rsplit(['/', '.']).next().unwrap_or_default();
    let word: String = last.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    // a column `serial` may count rows
    matches!(word.as_str(), "serialnumber" | "serialno" | "serialnr")
        || ARMS.iter().any(|arm| word.strip_prefix(arm).is_some_and(|end| ENDS.contains(&end)))
}

/// The place of a column among the names of a table.
pub(crate) fn find(path: &Path, names: &[String], column: &str) -> Result<usize, LogError> {
    names.iter().position(|name| name.trim() == column.trim()).ok_or_else(|| {
        let near = instead(column, names);
        let all = listed(names);
        LogError::request(path, format_args!("the table has no column `{column}`{near}; its columns are {all}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_arms_are_known_by_their_names() {
        for name in ["robot_id", "robot", "robotId", "Robot Name", "meta.robot_id", "arm", "serial_number", "device-id"]
        {
            assert!(names_arms(name), "{name}");
        }
        for name in
            ["q1", "run", "arm_temperature", "robot_mode", "identity", "unit", "warm", "name", "serial", "robot_q_1"]
        {
            assert!(!names_arms(name), "{name}");
        }
    }
}
