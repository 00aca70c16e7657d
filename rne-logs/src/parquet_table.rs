//! Tables in Parquet, with a column per number, or with lists.

use std::fs::File;
use std::path::{Path, PathBuf};

use parquet::basic::{ConvertedType, LogicalType, TimeUnit as OfStamp, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use crate::column_name::time;
use crate::columns::Columns;
use crate::csv_table::{no_time, two_times};
use crate::guard::guarded;
use crate::list_columns::ListColumns;
use crate::sample::{Sample, Source};
use crate::unit::FileUnits;
use crate::{LogError, Options, TimeUnit, columns};

/// Rows that are taken from a column at once.
const BATCH: usize = 1024;

/// Numbers of a list that are read: more joints than any arm has.
const LONGEST_LIST: usize = 1024;

/// A table, read by groups of rows.
pub(crate) struct ParquetTable {
    path: PathBuf,
    file: SerializedFileReader<File>,
    group: usize,
    /// Rows of this group that were not taken from its columns.
    left: usize,
    columns: Vec<Column>,
    roles: Roles,
    clock: Clock,
    /// Of this batch.
    row: usize,
    rows: usize,
    read: u64,
    all: u64,
    names: Vec<String>,
    units: FileUnits,
    unread: Vec<String>,
    notes: Vec<String>,
}

/// A column of the file that is read.
struct Column {
    leaf: usize,
    name: String,
    /// The level of definition that a number has.
    defined: i16,
    is_list: bool,
    /// What its numbers are multiplied by, of a unit that its name says.
    factor: f64,
    reader: Option<ColumnReader>,
    /// The numbers of this batch, as numbers and as the integers of stamps.
    numbers: Vec<f64>,
    integers: Vec<i64>,
    texts: Vec<String>,
    /// By row, where its list ends; empty of a column without lists.
    ends: Vec<usize>,
}

/// What columns are, by their places among those that are read.
enum Roles {
    Scalars { position: Vec<usize>, velocity: Vec<Option<usize>>, effort: Vec<Option<usize>> },
    Lists { names: Option<usize>, position: usize, velocity: Option<usize>, effort: Option<usize> },
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
        let file = guarded(|| SerializedFileReader::new(file)).unwrap_or_else(|| Err(corrupt()));
        let file = file.map_err(|error| LogError::file(path, reason(&error)))?;
        let schema = file.metadata().file_metadata().schema_descr_ptr();
        let leaves: Vec<Leaf> = schema.columns().iter().map(|leaf| Leaf::of(leaf)).collect();
        let mut table = Self {
            path: path.to_owned(),
            group: 0,
            left: 0,
            columns: Vec::new(),
            roles: Roles::Scalars { position: Vec::new(), velocity: Vec::new(), effort: Vec::new() },
            clock: Clock::Step(0.0),
            row: 0,
            rows: 0,
            read: 0,
            all: file.metadata().row_groups().iter().map(|group| u64::try_from(group.num_rows()).unwrap_or(0)).sum(),
            names: Vec::new(),
            units: FileUnits::default(),
            unread: Vec::new(),
            notes: Vec::new(),
            file,
        };
        table.assign(&leaves, options)?;
        Ok(table)
    }

    /// Finds out what columns are: lists where there is one of positions, else single columns.
    fn assign(&mut self, leaves: &[Leaf], options: &Options) -> Result<(), LogError> {
        let prefix = options.topic.as_deref().map(|prefix| prefix.trim_matches('/'));
        let is_list = |leaf: &Leaf| {
            leaf.is_list && leaf.kind.is_number() && prefix.is_none_or(|prefix| leaf.name.starts_with(prefix))
        };
        let lists = leaves.iter().enumerate().filter(|(_, leaf)| is_list(leaf));
        let lists = ListColumns::of(&self.path, lists.map(|(place, leaf)| (place, leaf.name.as_str())), options)?;
        if let Some((position, factor)) = lists.position {
            let is_names = |leaf: &Leaf| leaf.is_list && leaf.kind == Kind::Text && leaf.name.ends_with("name");
            let names = leaves.iter().position(is_names);
            self.roles = Roles::Lists {
                names: names.map(|leaf| self.column(leaves, leaf, 1.0)),
                position: self.column(leaves, position, factor),
                velocity: lists.velocity.map(|(leaf, factor)| self.column(leaves, leaf, factor)),
                effort: lists.effort.map(|(leaf, factor)| self.column(leaves, leaf, factor)),
            };
            self.units.others = lists.units;
            let of_leaf = |leaf: &Leaf| time(&leaf.name).filter(|_| !leaf.is_list);
            let time = leaves.iter().enumerate().find_map(|(place, leaf)| Some((place, of_leaf(leaf)?.ok()?)));
            let mut converted = lists.converted;
            let is_other = |unit: Option<TimeUnit>| unit.is_some_and(|unit| unit != TimeUnit::Seconds);
            if let Some((place, _)) = time.filter(|(place, unit)| is_other(*unit) && leaves[*place].kind.is_number()) {
                converted.insert(0, leaves[place].name.clone());
            }
            self.notes.extend(columns::converted(&converted));
            return self.tell_time(leaves, time, options);
        }
        let scalars: Vec<usize> = (0..leaves.len()).filter(|leaf| !leaves[*leaf].is_list).collect();
        let header: Vec<String> = scalars.iter().map(|leaf| leaves[*leaf].name.clone()).collect();
        let mut columns = Columns::of(&self.path, &header, options)?;
        let mut column = |column: columns::Column| -> Result<usize, LogError> {
            let leaf = &leaves[scalars[column.place]];
            if leaf.kind.is_number() {
                return Ok(self.column(leaves, scalars[column.place], column.factor));
            }
            let what = format!("the column {} has {}, not numbers", leaf.name, leaf.words);
            Err(LogError::file(&self.path, what))
        };
        let position = columns.position.iter().map(|place| column(*place)).collect::<Result<_, _>>()?;
        let mut optional = |found: &[Option<columns::Column>]| -> Result<Vec<Option<usize>>, LogError> {
            found.iter().map(|found| found.map(&mut column).transpose()).collect()
        };
        let velocity = optional(&columns.velocity)?;
        let effort = optional(&columns.effort)?;
        self.roles = Roles::Scalars { position, velocity, effort };
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

    /// Which column has times, with the unit that its name says: what the type says is surer.
    fn tell_time(
        &mut self,
        leaves: &[Leaf],
        time: Option<(usize, Option<TimeUnit>)>,
        options: &Options,
    ) -> Result<(), LogError> {
        self.clock = match (time, options.rate) {
            (None, Some(rate)) => Clock::Step(1.0 / rate),
            (None, None) => return Err(no_time(&self.path, leaves.iter().map(|leaf| leaf.name.as_str()))),
            (Some((leaf, _)), Some(_)) => return Err(two_times(&self.path, &leaves[leaf].name)),
            (Some((leaf, said)), None) => {
                let unit = match leaves[leaf].kind {
                    Kind::Stamp(unit) => unit,
                    Kind::Real | Kind::Integer => said.or(options.time_unit).unwrap_or_default(),
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
        let Leaf { name, defined, is_list, .. } = &leaves[leaf];
        self.columns.push(Column {
            leaf,
            name: name.clone(),
            defined: *defined,
            is_list: *is_list,
            factor,
            reader: None,
            numbers: Vec::new(),
            integers: Vec::new(),
            texts: Vec::new(),
            ends: Vec::new(),
        });
        self.columns.len() - 1
    }

    /// Takes the next rows of all columns; false at the end.
    fn fill(&mut self) -> Result<bool, LogError> {
        let wrong = |path: &Path, read: u64, error: &ParquetError| {
            LogError::file(path, format_args!("{}, behind {read} rows", reason(error)))
        };
        while self.left == 0 {
            if self.group == self.file.num_row_groups() {
                return Ok(false);
            }
            let group = guarded(|| self.file.get_row_group(self.group)).unwrap_or_else(|| Err(corrupt()));
            let group = group.map_err(|error| wrong(&self.path, self.read, &error))?;
            self.left = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
            for column in &mut self.columns {
                let reader = guarded(|| group.get_column_reader(column.leaf)).unwrap_or_else(|| Err(corrupt()));
                column.reader = Some(reader.map_err(|error| wrong(&self.path, self.read, &error))?);
            }
            self.group += 1;
        }
        self.row = 0;
        self.rows = self.left.min(BATCH);
        for column in &mut self.columns {
            let filled = guarded(|| column.fill(self.rows)).unwrap_or_else(|| Err(corrupt()));
            filled.map_err(|error| wrong(&self.path, self.read, &error))?;
            if column.rows() != self.rows {
                let (path, name, read) = (&self.path, &column.name, self.read);
                let what = format!("the file is corrupt: the column {name} ends behind {read} rows or soon after");
                return Err(LogError::file(path, what));
            }
        }
        self.left -= self.rows;
        Ok(true)
    }
}

impl Source for ParquetTable {
    fn read(&mut self, sample: &mut Sample) -> Result<bool, LogError> {
        if self.row == self.rows && !self.fill()? {
            return Ok(false);
        }
        let row = self.row;
        let columns = &self.columns;
        sample.measured = match self.clock {
            Clock::Step(step) => TimeUnit::step(self.read, step),
            Clock::Column(place, unit) => columns[place].time(row, unit).ok_or_else(|| {
                let (name, unit) = (&columns[place].name, unit.name());
                let what = format!(
                    "row {}: {name} is missing, no number, or beyond the year 2262 in {unit}; --time-unit s, ms, us or \
                     ns says what times are",
                    self.read
                );
                LogError::file(&self.path, what)
            })?,
        };
        sample.recorded = sample.measured;
        for list in [&mut sample.position, &mut sample.velocity, &mut sample.effort] {
            list.clear();
        }
        match &self.roles {
            Roles::Scalars { position, velocity, effort } => {
                if sample.names != self.names {
                    sample.names.clone_from(&self.names);
                }
                sample.position.extend(position.iter().map(|place| columns[*place].numbers[row]));
                let number = |place: &Option<usize>| place.map_or(f64::NAN, |place| columns[place].numbers[row]);
                sample.velocity.extend(velocity.iter().map(number));
                sample.effort.extend(effort.iter().map(number));
            }
            Roles::Lists { names, position, velocity, effort } => {
                let position = columns[*position].list(row);
                sample.position.extend_from_slice(position);
                for (list, place) in [(&mut sample.velocity, velocity), (&mut sample.effort, effort)] {
                    list.extend_from_slice(place.map_or(&[], |place| columns[place].list(row)));
                }
                let texts = names.map(|place| columns[place].texts_of(row));
                match texts {
                    Some(texts) if sample.names != texts => sample.names = texts.to_vec(),
                    None if sample.names.len() != position.len() => {
                        sample.names = (1..=position.len()).map(|joint| joint.to_string()).collect();
                    }
                    _ => {}
                }
            }
        }
        self.row += 1;
        self.read += 1;
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
}

impl Column {
    /// Takes the next rows.
    fn fill(&mut self, rows: usize) -> Result<(), ParquetError> {
        self.numbers.clear();
        self.integers.clear();
        self.texts.clear();
        self.ends.clear();
        let Some(reader) = &mut self.reader else { return Ok(()) };
        let levels = (self.defined, self.is_list, &mut self.ends);
        let filled = match reader {
            ColumnReader::DoubleColumnReader(reader) => {
                take(reader, rows, levels, |number| self.numbers.push(number.copied().unwrap_or(f64::NAN)))
            }
            ColumnReader::FloatColumnReader(reader) => {
                take(reader, rows, levels, |number| self.numbers.push(number.map_or(f64::NAN, |x| f64::from(*x))))
            }
            ColumnReader::Int32ColumnReader(reader) => take(reader, rows, levels, |number| {
                self.numbers.push(number.map_or(f64::NAN, |x| f64::from(*x)));
                self.integers.push(number.map_or(i64::MIN, |x| i64::from(*x)));
            }),
            #[expect(clippy::cast_precision_loss, reason = "an integer in the place of a real number")]
            ColumnReader::Int64ColumnReader(reader) => take(reader, rows, levels, |number| {
                self.numbers.push(number.map_or(f64::NAN, |x| *x as f64));
                self.integers.push(number.copied().unwrap_or(i64::MIN));
            }),
            ColumnReader::ByteArrayColumnReader(reader) => take(reader, rows, levels, |text| {
                let text = text.and_then(|text| text.as_utf8().ok()).unwrap_or_default();
                self.texts.push(text.to_owned());
            }),
            _ => Err(ParquetError::General(format!("the column {} has no numbers", self.name))),
        };
        self.numbers.iter_mut().for_each(|number| *number *= self.factor);
        filled
    }

    /// How many rows were taken.
    fn rows(&self) -> usize {
        if self.is_list { self.ends.len() } else { self.numbers.len() }
    }

    fn span(&self, row: usize) -> std::ops::Range<usize> {
        let begin = if row == 0 { 0 } else { self.ends[row - 1] };
        begin..self.ends[row].min(begin + LONGEST_LIST)
    }

    fn list(&self, row: usize) -> &[f64] {
        &self.numbers[self.span(row)]
    }

    fn texts_of(&self, row: usize) -> &[String] {
        &self.texts[self.span(row)]
    }

    /// The time of a row, ns.
    fn time(&self, row: usize, unit: TimeUnit) -> Option<i64> {
        match self.integers.get(row) {
            Some(&i64::MIN) => None,
            Some(time) => time.checked_mul(unit.nanoseconds()),
            None => unit.number(self.numbers[row]),
        }
    }
}

/// Takes rows of a column: `push` gets each number of each row, or none where it is missing; `ends` where lists end.
fn take<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    (defined, is_list, ends): (i16, bool, &mut Vec<usize>),
    mut push: impl FnMut(Option<&T::T>),
) -> Result<(), ParquetError> {
    let (mut definitions, mut repetitions, mut values) = (Vec::new(), Vec::new(), Vec::new());
    let mut taken = 0;
    while taken < rows {
        let (records, ..) =
            reader.read_records(rows - taken, Some(&mut definitions), Some(&mut repetitions), &mut values)?;
        if records == 0 {
            break;
        }
        taken += records;
    }
    let mut values = values.iter();
    if defined == 0 {
        values.for_each(|value| push(Some(value)));
        return Ok(());
    }
    let mut count = 0;
    for (place, definition) in definitions.iter().enumerate() {
        if is_list && repetitions.get(place) == Some(&0) && place > 0 {
            ends.push(count);
        }
        // of a list that is empty or missing there is one level, and no number
        let is_there = *definition == defined;
        if is_there || !is_list {
            push(if is_there { values.next() } else { None });
            count += 1;
        } else if *definition + 1 == defined && repetitions.get(place) != Some(&0) {
            push(None);
            count += 1;
        }
    }
    if is_list && !definitions.is_empty() {
        ends.push(count);
    }
    Ok(())
}

/// A column of the schema.
struct Leaf {
    /// Its path without what only makes a list.
    name: String,
    kind: Kind,
    /// Its type, for people.
    words: String,
    defined: i16,
    is_list: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Real,
    Integer,
    Stamp(TimeUnit),
    Text,
    Other,
}

impl Kind {
    fn is_number(self) -> bool {
        matches!(self, Self::Real | Self::Integer)
    }
}

impl Leaf {
    fn of(leaf: &ColumnDescriptor) -> Self {
        let is_list = leaf.max_rep_level() == 1;
        let mut parts: Vec<&str> = leaf.path().parts().iter().map(String::as_str).collect();
        // three levels, position.list.element, or two, position.array
        while is_list
            && parts.len() > 1
            && matches!(parts[parts.len() - 1], "list" | "element" | "item" | "array" | "bag" | "array_element")
        {
            parts.pop();
        }
        let stamp = match (leaf.logical_type_ref(), leaf.converted_type()) {
            (Some(LogicalType::Timestamp(stamp)), _) => Some(match stamp.unit {
                OfStamp::MILLIS => TimeUnit::Milliseconds,
                OfStamp::MICROS => TimeUnit::Microseconds,
                OfStamp::NANOS => TimeUnit::Nanoseconds,
            }),
            (_, ConvertedType::TIMESTAMP_MILLIS) => Some(TimeUnit::Milliseconds),
            (_, ConvertedType::TIMESTAMP_MICROS) => Some(TimeUnit::Microseconds),
            _ => None,
        };
        let is_plain = matches!(leaf.logical_type_ref(), None | Some(LogicalType::Integer(_)))
            && !matches!(leaf.converted_type(), ConvertedType::DECIMAL);
        let kind = match (leaf.physical_type(), stamp) {
            _ if leaf.max_rep_level() > 1 => Kind::Other,
            (Physical::INT64, Some(unit)) => Kind::Stamp(unit),
            (Physical::DOUBLE | Physical::FLOAT, _) => Kind::Real,
            (Physical::INT32 | Physical::INT64, None) if is_plain => Kind::Integer,
            (Physical::BYTE_ARRAY, _) => Kind::Text,
            _ => Kind::Other,
        };
        let words = match kind {
            Kind::Text => "texts".to_owned(),
            _ => leaf.physical_type().to_string(),
        };
        Self { name: parts.join("."), kind, words, defined: leaf.max_def_level(), is_list }
    }
}

/// What is said where the library asserted something.
fn corrupt() -> ParquetError {
    ParquetError::General("a page is not what its head says".to_owned())
}

/// What the library says, in a sentence.
fn reason(error: &ParquetError) -> String {
    let error = error.to_string();
    let what = error.split_once(": ").map_or(error.as_str(), |(_, what)| what);
    let what = what.lines().next().unwrap_or_default().trim_end_matches('.');
    format!("the file is corrupt, cut off or encrypted: {what}")
}
