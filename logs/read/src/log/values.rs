//! Counts the texts in a column of a table, such as the names of arms.

use std::collections::HashMap;
use std::path::PathBuf;

use crate::columns::label;
use crate::formats::format::{self, Format};
use crate::formats::sample::Sample;
use crate::{Log, LogError, Options};

/// A text in a column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LabelValue {
    /// The text; empty for empty cells.
    pub value: String,
    /// Number of rows with this text.
    pub rows: u64,
}

impl Log {
    /// Counts the texts in a column of tables, in the order in which they occur. Numbers are treated as texts.
    /// `progress` is called with the fraction that was read, 0 to 1.
    ///
    /// # Errors
    /// If a file cannot be read to its end or is no table, or the column is missing or has more than a thousand texts.
    #[expect(clippy::cast_precision_loss, reason = "files are few")]
    pub fn values(
        paths: &[PathBuf],
        column: &str,
        options: &Options,
        mut progress: impl FnMut(f64),
    ) -> Result<Vec<LabelValue>, LogError> {
        let files = format::files(paths)?;
        let options = Options { select: Vec::new(), ..options.clone() };
        let mut found: Vec<LabelValue> = Vec::new();
        let mut places: HashMap<String, usize> = HashMap::new();
        for (index, path) in files.iter().enumerate() {
            let format = Format::of(path)?;
            let mut source = format.open(path, &options)?;
            let columns = source.label_columns();
            if columns.is_empty() {
                let what = format!("you named a column of a table, but the format of this file is {format}");
                return Err(LogError::request(path, what));
            }
            source.hold(label::find(path, &columns, column)?, None);
            let mut sample = Sample::default();
            let mut rows = 0_u64;
            while source.read(&mut sample)? {
                rows += 1;
                if rows.is_multiple_of(4096) {
                    progress((index as f64 + source.progress()) / files.len() as f64);
                }
                let Some(label) = source.labels().last() else { continue };
                if let Some(place) = places.get(&label.value) {
                    found[*place].rows += 1;
                } else if found.len() == label::MOST_VALUES {
                    let what = format!(
                        "the column {column} has more than {} different texts; name a column that gives the arm or the \
                         part for each row",
                        label::MOST_VALUES
                    );
                    return Err(LogError::request(path, what));
                } else {
                    places.insert(label.value.clone(), found.len());
                    found.push(LabelValue { value: label.value.clone(), rows: 1 });
                }
            }
        }
        Ok(found)
    }
}
