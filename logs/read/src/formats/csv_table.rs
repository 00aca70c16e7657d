//! Reads logs from text tables (CSV).

use std::fs::File;
use std::io::{self, BufRead as _, BufReader};
use std::path::{Path, PathBuf};

use crate::Options;
use crate::columns::label::Label;
use crate::columns::table::{Column, Columns};
use crate::columns::unit::FileUnits;
use crate::formats::csv_rows::CsvRows;
use crate::formats::sample::{Sample, Source};
use crate::remedy::Setting;
use crate::spelling::listed;
use crate::{LogError, TimeUnit};

/// A text table with one sample per line.
pub(crate) struct CsvTable {
    path: PathBuf,
    rows: CsvRows,
    columns: Columns,
    labels: Vec<Label>,
    /// The names of the columns that have words instead of numbers in the first row.
    words: Vec<String>,
    clock: Clock,
    is_time_unit_known: bool,
    size: u64,
    row: u64,
}

/// Source of the time of a row.
enum Clock {
    Column(usize, TimeUnit),
    /// The interval between rows, s, for a table without times.
    Step(f64),
}

impl CsvTable {
    pub(crate) fn open(path: &Path, options: &Options) -> Result<Self, LogError> {
        let wrong = |error: &io::Error| LogError::file(path, format_args!("the file cannot be read: {error}"));
        let file = File::open(path).map_err(|error| wrong(&error))?;
        let size = file.metadata().map_or(0, |metadata| metadata.len());
        let mut file = BufReader::with_capacity(1 << 16, file);
        let first = file.fill_buf().map_err(|error| wrong(&error))?;
        if first.starts_with(&[0xFF, 0xFE]) || first.starts_with(&[0xFE, 0xFF]) {
            return Err(LogError::file(path, "this looks like UTF-16; save the file as UTF-8"));
        }
        if first.iter().take(4096).any(|byte| *byte == 0) {
            return Err(LogError::file(
                path,
                "the file is not a bag of SQLite, MCAP, Parquet or an array of numpy, and not text either: it contains \
                 bytes with the value zero",
            ));
        }
        let delimiter = delimiter(first);
        // without quoting: an unclosed quote would make one row of the whole file
        let rows = CsvRows::open(Box::new(file), delimiter, false).map_err(|what| LogError::file(path, what))?;
        let header = &rows.header;
        check_header(path, header)?;
        let columns = Columns::of(path, header, options)?;
        let clock = match (columns.time, options.rate) {
            (Some((place, _)), Some(_)) => return Err(two_times(path, &header[place])),
            (Some((place, said)), None) => Clock::Column(place, said.or(options.time_unit).unwrap_or_default()),
            (None, Some(rate)) => Clock::Step(1.0 / rate),
            (None, None) => {
                let error = no_time(path, header);
                let error = error.give(Setting::TimeColumn(header.clone()));
                return Err(error.give(Setting::Rate));
            }
        };
        let is_time_unit_known = columns.time.is_none_or(|(_, said)| said.is_some()) || options.time_unit.is_some();
        Ok(Self {
            path: path.to_owned(),
            rows,
            columns,
            labels: Vec::new(),
            words: Vec::new(),
            clock,
            is_time_unit_known,
            size,
            row: 0,
        })
    }

    fn wrong(&self, what: impl std::fmt::Display) -> LogError {
        self.wrong_at(self.rows.line(), what)
    }

    fn wrong_at(&self, line: u64, what: impl std::fmt::Display) -> LogError {
        LogError::file(&self.path, format_args!("line {line}: {what}"))
    }

    fn number(&self, Column { place, factor }: Column) -> Result<f64, LogError> {
        let cell = self.rows.cell(place);
        if cell.is_empty() {
            return Ok(f64::NAN);
        }
        let number: Option<f64> = std::str::from_utf8(cell).ok().and_then(|cell| cell.parse().ok());
        number.map(|number| number * factor).ok_or_else(|| {
            let what = format!("{:?} is not a number{}", String::from_utf8_lossy(cell), of_comma(cell));
            self.wrong(what)
        })
    }

    /// Whether the texts of the row's labels are the selected ones.
    fn is_selected(&mut self) -> bool {
        let mut is_selected = true;
        for label in &mut self.labels {
            let cell = self.rows.cell(label.place);
            is_selected &= label.take(&String::from_utf8_lossy(cell));
        }
        is_selected
    }

    fn numbers(&self, columns: &[Option<Column>], numbers: &mut Vec<f64>) -> Result<(), LogError> {
        numbers.clear();
        for column in columns {
            numbers.push(column.map_or(Ok(f64::NAN), |column| self.number(column))?);
        }
        Ok(())
    }
}

impl Source for CsvTable {
    fn read(&mut self, sample: &mut Sample) -> Result<bool, LogError> {
        loop {
            if !self.rows.read().map_err(|(line, what)| self.wrong_at(line, what))? {
                return Ok(false);
            }
            if self.is_selected() {
                break;
            }
        }
        if self.row == 0 {
            let names = self.rows.header.iter().enumerate();
            let words = names.filter(|(place, _)| is_word(self.rows.cell(*place)));
            self.words = words.map(|(_, name)| name.clone()).collect();
        }
        sample.measured = match self.clock {
            Clock::Column(place, unit) => {
                let cell = self.rows.cell(place);
                let cell = std::str::from_utf8(cell).unwrap_or_default();
                unit.parse(cell).ok_or_else(|| {
                    let error = self.wrong(unit.refusal(cell) + of_comma(cell.as_bytes()));
                    if cell.parse().is_ok_and(f64::is_finite) { error.give(Setting::TimeUnit) } else { error }
                })?
            }
            Clock::Step(step) => TimeUnit::step(self.row, step),
        };
        self.row += 1;
        sample.recorded = sample.measured;
        if sample.names != self.columns.names {
            sample.names.clone_from(&self.columns.names);
        }
        sample.position.clear();
        for column in &self.columns.position {
            sample.position.push(self.number(*column)?);
        }
        self.numbers(&self.columns.velocity, &mut sample.velocity)?;
        self.numbers(&self.columns.effort, &mut sample.effort)?;
        self.numbers(&self.columns.acceleration, &mut sample.acceleration)?;
        Ok(true)
    }

    #[expect(clippy::cast_precision_loss, reason = "a bar of some hundred steps")]
    fn progress(&self) -> f64 {
        (self.rows.bytes() as f64 / self.size.max(1) as f64).min(1.0)
    }

    fn notes(&self) -> Vec<String> {
        self.columns.remarks()
    }

    fn unread(&self) -> Vec<String> {
        self.columns.unread.clone()
    }

    fn units(&self) -> FileUnits {
        self.columns.units.clone()
    }

    fn is_time_unit_known(&self) -> bool {
        self.is_time_unit_known
    }

    fn label_columns(&self) -> Vec<String> {
        self.rows.header.clone()
    }

    fn word_columns(&self) -> Vec<String> {
        self.words.clone()
    }

    fn hold(&mut self, column: usize, wanted: Option<&str>) {
        self.labels.push(Label::new(column, &self.rows.header[column], wanted));
    }

    fn labels(&self) -> &[Label] {
        &self.labels
    }
}

/// Returns the delimiter of the cells in the first line that is neither blank nor a comment.
fn delimiter(text: &[u8]) -> u8 {
    let header = text.split(|byte| *byte == b'\n').find(|line| !matches!(line.trim_ascii(), [] | [b'#', ..]));
    let header = header.unwrap_or_default();
    [b',', b';', b'\t'].into_iter().find(|byte| header.contains(byte)).unwrap_or(b',')
}

/// Refuses a first line that has no names of columns.
fn check_header(path: &Path, header: &[String]) -> Result<(), LogError> {
    if header.is_empty() {
        return Err(LogError::file(
            path,
            "the file is empty; its first line must have the names of the columns, as in time,q1,tau1",
        ));
    }
    if let [only] = header
        && only.split_whitespace().count() > 2
    {
        let what = "the cells of the first line are separated by blanks: separate the cells of all lines by commas";
        return Err(LogError::file(path, what));
    }
    if header.iter().all(|cell| cell.parse::<f64>().is_ok()) {
        let what = "the first line has numbers; it must have the names of the columns, as in time,q1,qd1,tau1";
        return Err(LogError::file(path, what));
    }
    Ok(())
}

/// Returns the error for a table without times.
pub(crate) fn no_time(path: &Path, names: impl IntoIterator<Item: AsRef<str>>) -> LogError {
    let what = format!(
        "no column has times: name the column of times time, t, stamp or timestamp; the columns of this file are {}",
        listed(names)
    );
    LogError::request(path, what)
}

/// Returns the error for a sampling rate in the options although the table has times.
pub(crate) fn two_times(path: &Path, name: &str) -> LogError {
    let what = format!("the column {name} has times, but a sampling rate can be given only for tables without times");
    LogError::request(path, what).leave_out(Setting::Rate)
}

/// Returns a hint if a cell looks like a number with a decimal comma.
fn of_comma(cell: &[u8]) -> &'static str {
    let is_like = cell.contains(&b',') && cell.iter().all(|byte| byte.is_ascii_digit() || b"+-,eE".contains(byte));
    if is_like { ": write a decimal point, not a decimal comma" } else { "" }
}

/// Whether a cell is not empty and not a number.
fn is_word(cell: &[u8]) -> bool {
    let cell = std::str::from_utf8(cell).unwrap_or_default();
    !cell.is_empty() && cell.parse::<f64>().is_err()
}
