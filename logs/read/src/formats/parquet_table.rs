//! Tables in Parquet, with a column per number, or with lists.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader as _, SerializedFileReader};

use crate::columns::label::Label;
use crate::columns::mapping::Mapped;
use crate::columns::table::{self, Columns, note};
use crate::columns::time_column::{TimeColumn, unread, within};
use crate::columns::unit::FileUnits;
use crate::formats::csv_table::{no_time, two_times};
use crate::formats::guard::guarded;
use crate::formats::list_columns::{self, ListColumns};
use crate::formats::parquet_column::{Column, Kind, Leaf};
use crate::formats::parquet_pages::{Refused, Room, column_reader};
use crate::formats::sample::{Sample, Source};
use crate::remedy::Setting;
use crate::{LogError, Options, Target, TimeUnit};

/// Rows that are taken from a column at once, and those of a column of lists: each may have a thousand numbers.
const BATCH: usize = 1024;
const BATCH_OF_LISTS: usize = 64;

/// Bytes of a file's end, which describes its columns and groups of rows: in memory it takes some ten times as many.
const LONGEST_FOOTER: u32 = 16 << 20;

/// A table, read by groups of rows.
pub(crate) struct ParquetTable {
    path: PathBuf,
    file: SerializedFileReader<File>,
    /// The same file, of which columns take their pages, and the room for these.
    source: Arc<File>,
    room: Arc<Room>,
    group: usize,
    /// Rows of this group that were not taken from its columns.
    left: usize,
    columns: Vec<Column>,
    roles: Roles,
    clock: Clock,
    is_time_unit_known: bool,
    /// Row of this batch.
    row: usize,
    rows: usize,
    read: u64,
    /// Number of rows that were read and are selected.
    selected: u64,
    all: u64,
    /// The columns by whose texts rows can be selected, and those whose texts are held.
    label_columns: Vec<(usize, Leaf)>,
    labels: Vec<Label>,
    names: Vec<String>,
    units: FileUnits,
    unread: Vec<String>,
    notes: Vec<String>,
}

/// Roles of columns, by their places among the columns that are read.
enum Roles {
    /// Velocities, efforts and accelerations are the others.
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

/// When a row was measured.
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

    /// Finds out what columns are: lists where there is one of positions, else single columns.
    fn assign(&mut self, leaves: &[Leaf], options: &Options) -> Result<(), LogError> {
        let is_list = |leaf: &Leaf| leaf.is_list && leaf.kind.is_number() && within(&leaf.name, options).is_some();
        let lists = leaves.iter().enumerate().filter(|(_, leaf)| is_list(leaf));
        let lists = ListColumns::of(&self.path, lists.map(|(place, leaf)| (place, leaf.name.as_str())), options)?;
        let is_mapped_by_time_alone = options.map.iter().all(|mapping| mapping.target == Target::Time);
        if let Some((position, factor)) = lists.position.filter(|_| is_mapped_by_time_alone) {
            let texts = leaves.iter().enumerate().filter(|(_, leaf)| leaf.is_list && leaf.kind == Kind::Text);
            let texts = texts.map(|(place, leaf)| (place, leaf.name.as_str()));
            let names = list_columns::names(&self.path, texts, &leaves[position].name, options)?;
            self.roles = Roles::Lists {
                names: names.map(|leaf| self.column(leaves, leaf, 1.0)),
                position: self.column(leaves, position, factor),
                velocity: lists.velocity.map(|(leaf, factor)| self.column(leaves, leaf, factor)),
                effort: lists.effort.map(|(leaf, factor)| self.column(leaves, leaf, factor)),
            };
            self.units.others = lists.units;
            let mut times = Vec::new();
            let scalars: Vec<usize> = (0..leaves.len()).filter(|leaf| !leaves[*leaf].is_list).collect();
            for place in &scalars {
                times.extend(TimeColumn::of(&self.path, *place, &leaves[*place].name, options)?);
            }
            let header: Vec<String> = scalars.iter().map(|leaf| leaves[*leaf].name.clone()).collect();
            for mapping in &options.map {
                let found = mapping.find(&header).map_err(|what| LogError::request(&self.path, what))?;
                if let (place, Mapped::Time(unit)) = found {
                    times = vec![TimeColumn::mapped(scalars[place], unit)];
                }
            }
            let name = |place: usize| leaves[place].name.as_str();
            let time = TimeColumn::choose(&self.path, &times, name, options)?;
            let mut converted = lists.converted;
            let is_other = |time: &TimeColumn| time.unit.is_some_and(|unit| unit != TimeUnit::Seconds);
            if let Some(time) = time.filter(|time| is_other(time) && leaves[time.place].kind.is_number()) {
                converted.insert(0, leaves[time.place].name.clone());
            }
            self.notes.extend(table::converted(&converted));
            note("other times that are not read", &unread(&times, time, name), &mut self.notes);
            return self.tell_time(leaves, time.map(|time| (time.place, time.unit)), options);
        }
        let scalars: Vec<usize> = (0..leaves.len()).filter(|leaf| !leaves[*leaf].is_list).collect();
        let header: Vec<String> = scalars.iter().map(|leaf| leaves[*leaf].name.clone()).collect();
        let mut columns = Columns::of(&self.path, &header, options)?;
        let mut column = |column: table::Column| -> Result<usize, LogError> {
            let leaf = &leaves[scalars[column.place]];
            if leaf.kind.is_number() {
                return Ok(self.column(leaves, scalars[column.place], column.factor));
            }
            let what = format!("the column {} has {}, not numbers", leaf.name, leaf.words);
            Err(LogError::file(&self.path, what))
        };
        let position = columns.position.iter().map(|place| column(*place)).collect::<Result<_, _>>()?;
        let mut optional = |found: &[Option<table::Column>]| -> Result<Vec<Option<usize>>, LogError> {
            found.iter().map(|found| found.map(&mut column).transpose()).collect()
        };
        let others = [optional(&columns.velocity)?, optional(&columns.effort)?, optional(&columns.acceleration)?];
        self.roles = Roles::Scalars { position, others };
        if let Some((place, _)) = columns.time
            && matches!(leaves[scalars[place]].kind, Kind::Stamp(_))
        {
            // by its type, not by its name
            columns.converted.retain(|name| *name != header[place]);
        }
        self.notes = columns.remarks();
        (self.names, self.units, self.unread) = (columns.names, columns.units, columns.unread);
        self.tell_time(leaves, columns.time.map(|(place, unit)| (scalars[place], unit)), options)
    }

    /// Sets the column of times, with the unit in its name. The unit of its type takes precedence.
    fn tell_time(
        &mut self,
        leaves: &[Leaf],
        time: Option<(usize, Option<TimeUnit>)>,
        options: &Options,
    ) -> Result<(), LogError> {
        self.clock = match (time, options.rate) {
            (None, Some(rate)) => Clock::Step(1.0 / rate),
            (None, None) => {
                let error = no_time(&self.path, leaves.iter().map(|leaf| &leaf.name));
                let columns = leaves.iter().map(|leaf| leaf.name.clone()).collect();
                let error = error.give(Setting::TimeColumn(columns));
                return Err(error.give(Setting::Rate));
            }
            (Some((leaf, _)), Some(_)) => return Err(two_times(&self.path, &leaves[leaf].name)),
            (Some((leaf, said)), None) => {
                let unit = match leaves[leaf].kind {
                    Kind::Stamp(unit) => unit,
                    Kind::Real | Kind::Integer { .. } => {
                        let unit = said.or(options.time_unit);
                        self.is_time_unit_known = unit.is_some();
                        unit.unwrap_or_default()
                    }
                    Kind::Text | Kind::Other => {
                        let Leaf { name, words, .. } = &leaves[leaf];
                        let what = format!("the column {name} has {words}, not times");
                        return Err(LogError::file(&self.path, what));
                    }
                };
                Clock::Column(self.column(leaves, leaf, 1.0), unit)
            }
        };
        Ok(())
    }

    /// Adds a column to those that are read; its place among them.
    fn column(&mut self, leaves: &[Leaf], leaf: usize, factor: f64) -> usize {
        self.columns.push(Column::new(leaf, &leaves[leaf], factor));
        self.columns.len() - 1
    }

    /// Takes the next rows of all columns; false at the end.
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
                // the pages of the last group give way
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
}

impl Source for ParquetTable {
    fn read(&mut self, sample: &mut Sample) -> Result<bool, LogError> {
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
                break;
            }
            self.row += 1;
            self.read += 1;
        }
        let row = self.row;
        let columns = &self.columns;
        sample.measured = match self.clock {
            Clock::Step(step) => TimeUnit::step(self.selected, step),
            Clock::Column(place, unit) => columns[place].time(row, unit).ok_or_else(|| {
                let (name, unit) = (&columns[place].name, unit.name());
                let what = format!(
                    "row {}: {name} is missing, is not a number, or is later than the year 2262 in {unit}",
                    self.read
                );
                LogError::file(&self.path, what).give(Setting::TimeUnit)
            })?,
        };
        sample.recorded = sample.measured;
        for list in [&mut sample.position, &mut sample.velocity, &mut sample.effort, &mut sample.acceleration] {
            list.clear();
        }
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

/// Bytes of what stands at the end of a file; none of one that is too short.
fn footer(mut file: &File) -> Option<u32> {
    let mut length = [0; 4];
    file.seek(SeekFrom::End(-8)).and_then(|_| file.read_exact(&mut length)).ok()?;
    Some(u32::from_le_bytes(length))
}

/// Error for an assertion that failed in the library.
fn corrupt() -> ParquetError {
    ParquetError::General("a part of the file (a page) contains other data than its header states".to_owned())
}

/// Message of the library as a sentence.
fn reason(error: &ParquetError) -> String {
    if let Some(refused) = Refused::of(error) {
        return refused.to_string();
    }
    let error = error.to_string();
    let what = error.split_once(": ").map_or(error.as_str(), |(_, what)| what);
    let what = what.lines().next().unwrap_or_default().trim_end_matches('.');
    format!("the file is corrupt, cut off or encrypted: {what}")
}
