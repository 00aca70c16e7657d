//! Reads logs from tables in Parquet, with one column per number, or with lists.

mod roles;

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader as _, SerializedFileReader};

use crate::columns::label::Label;
use crate::columns::unit::FileUnits;
use crate::formats::guard::guarded;
use crate::formats::parquet::column::{Column, Kind, Leaf};
use crate::formats::parquet::pages::{Refused, Room, column_reader};
use crate::formats::sample::{Sample, Source};
use crate::remedy::Setting;
use crate::{LogError, Options, TimeUnit};

/// Number of rows that are read from a column at once; fewer with lists, which may have a thousand numbers each.
const BATCH: usize = 1024;
const BATCH_OF_LISTS: usize = 64;

/// Largest number of bytes of the description of columns and groups of rows at the end of a file. In memory, it takes
/// about ten times as many.
const LONGEST_FOOTER: u32 = 16 << 20;

/// A table, read by groups of rows.
pub(crate) struct ParquetTable {
    path: PathBuf,
    file: SerializedFileReader<File>,
    /// A second handle of the file, from which columns read their pages.
    source: Arc<File>,
    /// The memory for pages.
    room: Arc<Room>,
    group: usize,
    /// Number of rows of this group that were not read yet.
    left: usize,
    columns: Vec<Column>,
    roles: Roles,
    clock: Clock,
    is_time_unit_known: bool,
    /// Index of the current row in this batch.
    row: usize,
    rows: usize,
    read: u64,
    /// Number of rows so far that were selected.
    selected: u64,
    all: u64,
    /// The columns by whose texts rows can be selected, and those whose texts are watched.
    label_columns: Vec<(usize, Leaf)>,
    labels: Vec<Label>,
    names: Vec<String>,
    units: FileUnits,
    unread: Vec<String>,
    notes: Vec<String>,
}

/// The quantities of the columns that are read, by their indices.
enum Roles {
    /// One column for each number. `others` are velocities, efforts and accelerations.
    Scalars {
        position: Vec<usize>,
        others: [Vec<Option<usize>>; 3],
    },
    Lists {
        names: Option<usize>,
        position: usize,
        velocity: Option<usize>,
        effort: Option<usize>,
    },
}

/// Source of the time of a row.
enum Clock {
    Column(usize, TimeUnit),
    Step(f64),
}

impl ParquetTable {
    pub(crate) fn open(path: &Path, options: &Options) -> Result<Self, LogError> {
        let wrong =
            |error: &dyn std::fmt::Display| LogError::file(path, format_args!("the file cannot be read: {error}"));
        let file = File::open(path).map_err(|error| wrong(&error))?;
        let source = file.try_clone().map_err(|error| wrong(&error))?;
        if let Some(length) = footer(&source).filter(|length| *length > LONGEST_FOOTER) {
            let what = format!(
                "the description of its columns and groups of rows has {length} bytes; rne reads at most \
                 {LONGEST_FOOTER}"
            );
            return Err(LogError::file(path, what));
        }
        let file = guarded(|| SerializedFileReader::new(file)).unwrap_or_else(|| Err(corrupt()));
        let file = file.map_err(|error| LogError::file(path, reason(&error)))?;
        let schema = file.metadata().file_metadata().schema_descr_ptr();
        let leaves: Vec<Leaf> = schema.columns().iter().map(|leaf| Leaf::of(leaf)).collect();
        let mut table = Self {
            path: path.to_owned(),
            source: Arc::new(source),
            room: Arc::default(),
            group: 0,
            left: 0,
            columns: Vec::new(),
            roles: Roles::Scalars { position: Vec::new(), others: Default::default() },
            clock: Clock::Step(0.0),
            is_time_unit_known: true,
            row: 0,
            rows: 0,
            read: 0,
            selected: 0,
            label_columns: Vec::new(),
            labels: Vec::new(),
            all: file.metadata().row_groups().iter().map(|group| u64::try_from(group.num_rows()).unwrap_or(0)).sum(),
            names: Vec::new(),
            units: FileUnits::default(),
            unread: Vec::new(),
            notes: Vec::new(),
            file,
        };
        table.assign(&leaves, options)?;
        table.label_columns = leaves.into_iter().enumerate().filter(|(_, leaf)| leaf.has_texts()).collect();
        Ok(table)
    }

    /// Adds a column to those that are read; returns its index among them.
    fn column(&mut self, leaves: &[Leaf], leaf: usize, factor: f64) -> usize {
        self.columns.push(Column::new(leaf, &leaves[leaf], factor));
        self.columns.len() - 1
    }

    /// Reads the next rows of all columns; returns false at the end.
    fn fill(&mut self) -> Result<bool, LogError> {
        let wrong = |path: &Path, read: u64, error: &ParquetError| {
            let behind = if Refused::of(error).is_some() { String::new() } else { format!(", after {read} rows") };
            LogError::file(path, reason(error) + &behind)
        };
        while self.left == 0 {
            if self.group == self.file.num_row_groups() {
                return Ok(false);
            }
            self.left = usize::try_from(self.file.metadata().row_group(self.group).num_rows()).unwrap_or(0);
            for column in &mut self.columns {
                // releases the pages of the previous group
                column.reader = None;
            }
            for column in &mut self.columns {
                let leaf = (column.leaf, column.name.as_str());
                let open = || column_reader(&self.file, &self.source, &self.room, self.group, leaf);
                let reader = guarded(open).unwrap_or_else(|| Err(corrupt()));
                column.reader = Some(reader.map_err(|error| wrong(&self.path, self.read, &error))?);
            }
            self.group += 1;
        }
        self.row = 0;
        let batch = if matches!(self.roles, Roles::Lists { .. }) { BATCH_OF_LISTS } else { BATCH };
        self.rows = self.left.min(batch);
        for column in &mut self.columns {
            let filled = guarded(|| column.fill(self.rows)).unwrap_or_else(|| Err(corrupt()));
            filled.map_err(|error| wrong(&self.path, self.read, &error))?;
            if column.rows() != self.rows {
                let (path, name, read) = (&self.path, &column.name, self.read);
                let what = format!("the file is corrupt: the column {name} ends after {read} rows or a little later");
                return Err(LogError::file(path, what));
            }
        }
        self.left -= self.rows;
        Ok(true)
    }

    /// Goes to the next selected row; returns false at the end.
    fn next_selected(&mut self) -> Result<bool, LogError> {
        loop {
            if self.row == self.rows && !self.fill()? {
                return Ok(false);
            }
            let (row, columns) = (self.row, &self.columns);
            let mut is_selected = true;
            for label in &mut self.labels {
                is_selected &= label.take(&columns[label.place].text(row));
            }
            if is_selected {
                return Ok(true);
            }
            self.row += 1;
            self.read += 1;
        }
    }

    /// Returns the time of this row, ns.
    fn time(&self) -> Result<i64, LogError> {
        Ok(match self.clock {
            Clock::Step(step) => TimeUnit::step(self.selected, step),
            Clock::Column(place, unit) => self.columns[place].time(self.row, unit).ok_or_else(|| {
                let (name, unit) = (&self.columns[place].name, unit.name());
                let what = format!(
                    "row {}: {name} is missing, is not a number, or is later than the year 2262 in {unit}",
                    self.read
                );
                LogError::file(&self.path, what).give(Setting::TimeUnit)
            })?,
        })
    }

    /// Copies the names and numbers of this row into a sample.
    fn numbers(&self, sample: &mut Sample) {
        let (row, columns) = (self.row, &self.columns);
        match &self.roles {
            Roles::Scalars { position, others } => {
                if sample.names != self.names {
                    sample.names.clone_from(&self.names);
                }
                sample.position.extend(position.iter().map(|place| columns[*place].numbers[row]));
                let number = |place: &Option<usize>| place.map_or(f64::NAN, |place| columns[place].numbers[row]);
                let lists = [&mut sample.velocity, &mut sample.effort, &mut sample.acceleration];
                for (list, places) in lists.into_iter().zip(others) {
                    list.extend(places.iter().map(number));
                }
            }
            Roles::Lists { names, position, velocity, effort } => {
                let position = columns[*position].list(row);
                sample.position.extend_from_slice(position);
                for (list, place) in [(&mut sample.velocity, velocity), (&mut sample.effort, effort)] {
                    list.extend_from_slice(place.map_or(&[], |place| columns[place].list(row)));
                }
                match names {
                    Some(place) => {
                        let texts = || columns[*place].texts_of(row);
                        if !texts().eq(sample.names.iter().map(String::as_str)) {
                            sample.names = texts().map(str::to_owned).collect();
                        }
                    }
                    None if sample.names.len() != position.len() => {
                        sample.names = (1..=position.len()).map(|joint| joint.to_string()).collect();
                    }
                    None => {}
                }
            }
        }
    }
}

impl Source for ParquetTable {
    fn read(&mut self, sample: &mut Sample) -> Result<bool, LogError> {
        if !self.next_selected()? {
            return Ok(false);
        }
        sample.measured = self.time()?;
        sample.recorded = sample.measured;
        for list in [&mut sample.position, &mut sample.velocity, &mut sample.effort, &mut sample.acceleration] {
            list.clear();
        }
        self.numbers(sample);
        self.row += 1;
        self.read += 1;
        self.selected += 1;
        Ok(true)
    }

    #[expect(clippy::cast_precision_loss, reason = "a bar of some hundred steps")]
    fn progress(&self) -> f64 {
        (self.read as f64 / self.all.max(1) as f64).min(1.0)
    }

    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    fn unread(&self) -> Vec<String> {
        self.unread.clone()
    }

    fn units(&self) -> FileUnits {
        self.units.clone()
    }

    fn is_time_unit_known(&self) -> bool {
        self.is_time_unit_known
    }

    fn label_columns(&self) -> Vec<String> {
        self.label_columns.iter().map(|(_, leaf)| leaf.name.clone()).collect()
    }

    fn word_columns(&self) -> Vec<String> {
        let words = self.label_columns.iter().filter(|(_, leaf)| leaf.kind == Kind::Text);
        words.map(|(_, leaf)| leaf.name.clone()).collect()
    }

    fn hold(&mut self, column: usize, wanted: Option<&str>) {
        let (place, leaf) = &self.label_columns[column];
        self.labels.push(Label::new(self.columns.len(), &leaf.name, wanted));
        self.columns.push(Column::new(*place, leaf, 1.0));
    }

    fn labels(&self) -> &[Label] {
        &self.labels
    }
}

/// Returns the number of bytes of the description at the end of a file; `None` if the file is too short.
fn footer(mut file: &File) -> Option<u32> {
    let mut length = [0; 4];
    file.seek(SeekFrom::End(-8)).and_then(|_| file.read_exact(&mut length)).ok()?;
    Some(u32::from_le_bytes(length))
}

/// Returns the error for a panic in the library.
fn corrupt() -> ParquetError {
    ParquetError::General("a part of the file (a page) contains other data than its header states".to_owned())
}

/// Returns the message for an error of the library.
fn reason(error: &ParquetError) -> String {
    if let Some(refused) = Refused::of(error) {
        return refused.to_string();
    }
    let error = error.to_string();
    let what = error.split_once(": ").map_or(error.as_str(), |(_, what)| what);
    let what = what.lines().next().unwrap_or_default().trim_end_matches('.');
    format!("the file is corrupt, cut off or encrypted: {what}")
}
