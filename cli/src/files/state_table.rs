//! Reads tables of states from files, CSV or numpy arrays, in parts.

use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::path::Path;

use rne_logs::{CsvRows, Npy};
use rne_machine::OutOfRange;
use rne_model::{did_you_mean, open_file};

use crate::files::csv_table::quoted;
use crate::files::input_file::{self, is_standard_input, is_stream};
use crate::outcome::Failure;
use crate::palette::TITLE;
use crate::terminal::remark;

/// Number of states in a part: some megabytes, however large the file is.
pub(crate) const PART: usize = 16_384;

/// A table of numbers that is read in parts.
pub(crate) struct Table {
    /// The number of states, if the file says it.
    pub(crate) states: Option<u64>,
    name: String,
    rows: Rows,
    restricted: Restricted,
}

/// The arguments whose numbers are restricted in range, each with the index of its first column.
#[derive(Clone, Default)]
pub(crate) struct Restricted(pub(crate) Vec<(&'static str, usize)>);

impl Restricted {
    /// Returns the message for a number of a row that is not allowed; `name` gives the names of the columns.
    fn mistake(&self, row: &[f64], name: impl Fn(usize) -> String) -> Option<String> {
        self.0.iter().find_map(|&(argument, first)| {
            let number = |element: usize| row.get(first + element).copied();
            let mistake = OutOfRange::check(argument, number).err()?;
            // the mistake is in the inertia of a payload, which comes after its mass and its centre of mass, 4 columns
            let first = if matches!(mistake, OutOfRange::Moment(_)) { first + 4 } else { first };
            Some(format!("{}: {mistake}", name(first)))
        })
    }
}

enum Rows {
    Csv {
        rows: Box<CsvRows>,
        columns: Vec<(usize, String)>,
    },
    Npy {
        numbers: Box<dyn Iterator<Item = io::Result<f64>>>,
        width: usize,
        /// The number of states that were read.
        read: usize,
    },
}

impl Table {
    /// Opens a file that must have these columns: by name in CSV, in this order in an array. In CSV a column may have
    /// its other name instead.
    pub(crate) fn open(
        path: &Path,
        columns: &[String],
        others: &[Option<String>],
        restricted: Restricted,
    ) -> Result<Self, Failure> {
        let name = input_file::name(path);
        let unreadable = |error: io::Error| input_error!("the states {name} cannot be read: {error}");
        if path.is_dir() {
            return Err(input_error!("{name} is a folder; name a file of states, CSV or .npy"));
        }
        let file: Box<dyn Read> = if is_standard_input(path) {
            Box::new(io::stdin())
        } else if is_stream(path) {
            Box::new(File::open(path).map_err(unreadable)?)
        } else {
            Box::new(open_file(path).map_err(unreadable)?)
        };
        let mut file: Box<dyn BufRead> = Box::new(BufReader::with_capacity(1 << 18, file));
        // a pipe may return only a few bytes at first
        let first = file.fill_buf().map_err(unreadable)?;
        if first.starts_with(&[0xFF, 0xFE]) || first.starts_with(&[0xFE, 0xFF]) {
            return Err(input_error!("{name} looks like UTF-16; save the file as UTF-8"));
        }
        if first.starts_with(&Npy::MAGIC[..Npy::MAGIC.len().min(first.len())]) && !first.is_empty() {
            return Ok(Self { restricted, ..Self::npy(name, file, columns)? });
        }
        Ok(Self { restricted, ..Self::csv(name, file, columns, others)? })
    }

    fn csv(
        name: String,
        file: Box<dyn BufRead>,
        wanted: &[String],
        others: &[Option<String>],
    ) -> Result<Self, Failure> {
        let rows = CsvRows::open(file, b',', true).map_err(|what| input_error!("{name}: {what}"))?;
        let header = &rows.header;
        if header.is_empty() {
            let needed = wanted.join(",");
            return Err(input_error!("{name} is empty; its header is {needed}, in any order"));
        }
        let mut columns = Vec::new();
        for (at, column) in wanted.iter().enumerate() {
            let other = others.get(at).and_then(Option::as_ref).filter(|other| header.contains(other));
            let column = if header.contains(column) { column } else { other.unwrap_or(column) };
            let places: Vec<usize> = (0..header.len()).filter(|&place| header[place] == *column).collect();
            match places[..] {
                [place] => columns.push((place, column.clone())),
                [] => {
                    let near = instead(column, header);
                    let needed = wanted.join(", ");
                    return Err(input_error!(
                        "{name}: the header has no column `{column}`{near}; the required columns are {needed}; \
                         others are ignored"
                    ));
                }
                _ => {
                    return Err(input_error!("{name}: the column `{column}` occurs twice"));
                }
            }
        }
        // such as `q3` when only `q1` and `q2` are needed: the table is probably that of another robot
        let beyond = |column: &str| {
            let stem = column.trim_end_matches(|c: char| c.is_ascii_digit());
            let is_wanted = |other: &String| other.trim_end_matches(|c: char| c.is_ascii_digit()) == stem;
            let is_known = wanted.iter().chain(others.iter().flatten()).any(|other| other == column);
            stem.len() < column.len() && !is_known && wanted.iter().any(is_wanted)
        };
        if let Some(column) = header.iter().find(|column| beyond(column)) {
            remark(format_args!(
                "{TITLE}note{TITLE:#}: {name}: the column {} belongs to no joint of this robot, and is not read; the \
                 required columns are {}\n",
                quoted(column),
                wanted.join(", ")
            ));
        }
        let rows = Rows::Csv { rows: Box::new(rows), columns };
        Ok(Self { states: None, name, rows, restricted: Restricted::default() })
    }

    fn npy(name: String, file: Box<dyn BufRead>, wanted: &[String]) -> Result<Self, Failure> {
        let wrong = |what: &dyn std::fmt::Display| input_error!("{name}: {what}");
        let npy = Npy::open(file).map_err(|error| wrong(&error))?;
        let [states, width] = npy.shape[..] else {
            let axes = npy.shape.len();
            let axes = if axes == 1 { "1 axis".to_owned() } else { format!("{axes} axes") };
            return Err(wrong(&format_args!("the array has {axes}; its shape is (states, {})", wanted.len())));
        };
        if width != wanted.len() as u64 {
            let (numbers, needed) = (wanted.len(), wanted.join(", "));
            return Err(wrong(&format_args!("the array has {width} columns, but {numbers} are needed: {needed}")));
        }
        let rows = Rows::Npy { numbers: npy.numbers, width: wanted.len(), read: 0 };
        Ok(Self { states: Some(states), name, rows, restricted: Restricted::default() })
    }

    /// Appends the rows of the next part; returns their number.
    pub(crate) fn read(&mut self, rows: &mut Vec<f64>) -> Result<usize, Failure> {
        let (name, restricted) = (&self.name, &self.restricted);
        match &mut self.rows {
            Rows::Csv { rows: table, columns } => {
                let mut count = 0;
                while count < PART {
                    let is_there = table.read().map_err(|(line, what)| input_error!("{name}:{line}: {what}"))?;
                    if !is_there {
                        break;
                    }
                    let begin = rows.len();
                    for (place, column) in &*columns {
                        let cell = table.cell(*place);
                        let number = std::str::from_utf8(cell).ok().and_then(|cell| cell.parse::<f64>().ok());
                        let misfit = number.and_then(|number| misfit(number, cell));
                        rows.push(number.filter(|_| misfit.is_none()).ok_or_else(|| {
                            let line = table.line();
                            let shown = quoted(&String::from_utf8_lossy(cell));
                            let what = match (cell, misfit) {
                                ([], _) => "empty".to_owned(),
                                (_, Some(misfit)) => format!("{shown}, which is too {misfit} for a 64-bit float"),
                                _ => format!("{shown}, which is not a number"),
                            };
                            input_error!("{name}:{line}: `{column}` is {what}")
                        })?);
                    }
                    let column = |at: usize| format!("`{}`", columns[at].1);
                    if let Some(mistake) = restricted.mistake(&rows[begin..], column) {
                        return Err(input_error!("{name}:{}: {mistake}", table.line()));
                    }
                    count += 1;
                }
                Ok(count)
            }
            Rows::Npy { numbers, width, read } => {
                for number in numbers.by_ref().take(PART * *width) {
                    let number = number.map_err(|error| {
                        let all = self.states.unwrap_or_default();
                        Failure::input(match error.kind() {
                            ErrorKind::UnexpectedEof => {
                                format!("{name}: the file ends before the last of {all} states")
                            }
                            _ => format!("{name} cannot be read: {error}"),
                        })
                    })?;
                    rows.push(number);
                }
                for row in rows.chunks_exact((*width).max(1)) {
                    *read += 1;
                    if let Some(mistake) = restricted.mistake(row, |at| format!("in column {}", at + 1)) {
                        return Err(input_error!("{name}: state {read}: {mistake}"));
                    }
                }
                Ok(rows.len() / (*width).max(1))
            }
        }
    }
}

/// Returns columns of a header that may mean the missing column.
fn instead(column: &str, header: &[String]) -> String {
    let only = match header {
        [only] => only.as_str(),
        _ => "",
    };
    match [(';', "semicolons"), ('\t', "tabs")].into_iter().find(|(separator, _)| only.contains(*separator)) {
        Some((_, separators)) => format!(" (it has {separators}; columns are separated by commas)"),
        None => did_you_mean(column, header.iter().map(String::as_str))
            .map_or(String::new(), |near| format!(" (there is {})", quoted(near))),
    }
}

/// Returns a message for digits whose number becomes infinite or zero by rounding. The word `inf` is accepted as a
/// number, because a log may contain it where nothing was measured.
fn misfit(number: f64, cell: &[u8]) -> Option<&'static str> {
    let mut mantissa = cell.split(|byte| matches!(byte, b'e' | b'E')).next().unwrap_or_default().iter();
    if number.is_infinite() && mantissa.clone().any(u8::is_ascii_digit) {
        return Some("large");
    }
    (number == 0.0 && mantissa.any(|byte| matches!(byte, b'1'..=b'9'))).then_some("small")
}
