//! Reads the rows of a text table of any length. Endless lines and unclosed quotes are errors.

use std::io::{self, BufRead, ErrorKind, Read};

/// Largest number of bytes of a row, including line ends within quotes.
const LONGEST_LINE: u64 = 1 << 20;

/// The rows of a text table; `#` begins a comment.
pub struct CsvRows {
    /// The names of the columns, without blanks and quotes around them.
    pub header: Vec<String>,
    reader: csv::Reader<Bounded>,
    record: csv::ByteRecord,
}

/// A reader that returns at most the bytes of the longest row, because an unclosed quote would put the whole file into
/// memory.
struct Bounded {
    file: Box<dyn BufRead>,
    given: u64,
    /// Position up to which bytes may be returned.
    end: u64,
    quoting: bool,
    /// Whether the returned bytes end with a line end. If the last line has none, one is added.
    is_line: bool,
}

impl Read for Bounded {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.given >= self.end {
            let message = if self.quoting {
                "the line has more than a million characters, or a quote in it is not closed"
            } else {
                "a line has more than a million bytes"
            };
            return Err(io::Error::new(ErrorKind::InvalidData, message));
        }
        let mut count = self.file.read(buffer)?;
        if let (0, false, [first, ..]) = (count, self.is_line, &mut *buffer) {
            (*first, count) = (b'\n', 1);
        }
        let given = &buffer[..count];
        self.is_line = given.last().map_or(self.is_line, |last| *last == b'\n');
        if let Some(end) = given.iter().rposition(|byte| *byte == b'\n').filter(|_| !self.quoting) {
            self.end = self.given + end as u64 + 1 + LONGEST_LINE;
        }
        self.given += count as u64;
        Ok(count)
    }
}

impl CsvRows {
    /// Reads the header. With `quoting`, a cell in quotes may contain delimiters and line ends; without it, a line is
    /// always a row.
    ///
    /// # Errors
    /// If the header cannot be read: the reason in words.
    pub fn open(file: Box<dyn BufRead>, delimiter: u8, quoting: bool) -> Result<Self, String> {
        let file = Bounded { file, given: 0, end: LONGEST_LINE, quoting, is_line: true };
        let mut builder = csv::ReaderBuilder::new();
        let mut reader = builder.comment(Some(b'#')).delimiter(delimiter).quoting(quoting).from_reader(file);
        let header = reader.byte_headers().map_err(reason)?.iter();
        let name = |cell| String::from_utf8_lossy(inner(cell)).trim_start_matches('\u{feff}').trim().to_owned();
        Ok(Self { header: header.map(name).collect(), reader, record: csv::ByteRecord::new() })
    }

    /// Reads the next row; returns whether there is one.
    ///
    /// # Errors
    /// The number of the line, and what is wrong with it.
    pub fn read(&mut self) -> Result<bool, (u64, String)> {
        let first = self.reader.position().line();
        if self.reader.get_ref().quoting {
            // the limit counts from the start of this row, not from the bytes that were read ahead
            self.reader.get_mut().end = self.reader.position().byte().saturating_add(LONGEST_LINE);
        }
        self.reader.read_byte_record(&mut self.record).map_err(|error| {
            let is_open = self.record.iter().any(|cell| cell.contains(&b'\n'));
            let line = match (error.kind(), error.position()) {
                (csv::ErrorKind::UnequalLengths { .. }, _) if !is_open => self.line(),
                (_, Some(begin)) => begin.line(),
                (_, None) => first,
            };
            let hint = if is_open { "; a quote in it is not closed on its line" } else { "" };
            (line, reason(error) + hint)
        })
    }

    /// Returns the line on which the current row begins, from 1. The position in the record would be that of empty
    /// lines before it.
    #[must_use]
    pub fn line(&self) -> u64 {
        let inner: usize = self.record.iter().map(|cell| cell.split(|byte| *byte == b'\n').count() - 1).sum();
        self.reader.position().line().saturating_sub(1 + inner as u64).max(1)
    }

    /// Returns a cell of the current row, without spaces and quotes around it. A missing cell is empty.
    #[must_use]
    pub fn cell(&self, place: usize) -> &[u8] {
        inner(self.record.get(place).unwrap_or_default())
    }

    /// Returns the number of bytes of the file up to the end of the current row.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.reader.position().byte()
    }
}

/// Removes spaces and quotes around a cell.
fn inner(cell: &[u8]) -> &[u8] {
    let cell = cell.trim_ascii();
    cell.strip_prefix(b"\"").and_then(|cell| cell.strip_suffix(b"\"")).unwrap_or(cell).trim_ascii()
}

fn reason(error: csv::Error) -> String {
    match error.into_kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            let cells = if len == 1 { "cell" } else { "cells" };
            format!("the line has {len} {cells}, but the header has {expected_len}")
        }
        csv::ErrorKind::Io(error) => error.to_string(),
        kind => csv::Error::from(io::Error::other(format!("{kind:?}"))).to_string(),
    }
}
