//! Columns of texts in a table that give the arm, or the part of a log, to which a row belongs.

use std::path::Path;

use crate::LogError;
use crate::spelling::{instead, listed};

/// Largest number of different texts that are counted; a column with more does not name arms or parts.
pub(crate) const MOST_VALUES: usize = 1000;

/// Words for an arm in names of columns.
const ARMS: [&str; 6] = ["robot", "arm", "manipulator", "machine", "device", "asset"];

/// Words that may follow a word for an arm.
const ENDS: [&str; 7] = ["", "id", "name", "number", "nr", "no", "serial"];

/// A column of texts, with the text of the latest row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Label {
    /// Index of the column in the reader.
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

    /// Stores the text of a row; returns whether the row is selected.
    pub(crate) fn take(&mut self, text: &str) -> bool {
        if self.value != text {
            text.clone_into(&mut self.value);
        }
        self.wanted.as_deref().is_none_or(|wanted| wanted == text)
    }

    /// Whether rows are selected by the texts of the column.
    pub(crate) fn is_selecting(&self) -> bool {
        self.wanted.is_some()
    }
}

/// Whether the name of a column shows that it names arms, such as `robot_id`.
pub(crate) fn names_arms(column: &str) -> bool {
    let last = column.rsplit(['/', '.']).next().unwrap_or_default();
    let word: String = last.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    // `serial` alone is not accepted, because it may be a row counter
    matches!(word.as_str(), "serialnumber" | "serialno" | "serialnr")
        || ARMS.iter().any(|arm| word.strip_prefix(arm).is_some_and(|end| ENDS.contains(&end)))
}

/// Returns the index of a column among the names of a table.
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
