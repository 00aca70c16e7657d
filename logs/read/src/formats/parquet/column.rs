//! Reads a column of a Parquet table, some rows at a time.

use std::borrow::Cow;

use parquet::basic::{ConvertedType, LogicalType, TimeUnit as OfStamp, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;
use parquet::schema::types::ColumnDescriptor;

use crate::TimeUnit;
use crate::formats::parquet::pages::Refused;
use crate::limits::LONGEST_NAME;

/// A column in the schema of the file.
pub(crate) struct Leaf {
    /// The path of the column, without the levels that only make a list.
    pub(crate) name: String,
    pub(crate) kind: Kind,
    /// The type in words, for messages.
    pub(crate) words: String,
    pub(crate) defined: i16,
    pub(crate) is_list: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    Real,
    Integer { is_signed: bool },
    Stamp(TimeUnit),
    Text,
    Other,
}

impl Kind {
    pub(crate) fn is_number(self) -> bool {
        matches!(self, Self::Real | Self::Integer { .. })
    }
}

impl Leaf {
    /// Whether rows can be selected by the texts of the column, or by its numbers written as texts.
    pub(crate) fn has_texts(&self) -> bool {
        !self.is_list && self.kind != Kind::Other
    }

    pub(crate) fn of(leaf: &ColumnDescriptor) -> Self {
        let is_list = leaf.max_rep_level() == 1;
        let mut parts: Vec<&str> = leaf.path().parts().iter().map(String::as_str).collect();
        // lists have three levels, position.list.element, or two, position.array
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
        let converted = leaf.converted_type();
        let is_signed = match leaf.logical_type_ref() {
            Some(LogicalType::Integer(integer)) => integer.is_signed,
            _ if converted == ConvertedType::UINT_32 || converted == ConvertedType::UINT_64 => false,
            // values of shorter unsigned types do not reach the sign bit
            _ => true,
        };
        let kind = match (leaf.physical_type(), stamp) {
            _ if leaf.max_rep_level() > 1 => Kind::Other,
            (Physical::INT64, Some(unit)) => Kind::Stamp(unit),
            (Physical::DOUBLE | Physical::FLOAT, _) => Kind::Real,
            (Physical::INT32 | Physical::INT64, None) if is_plain => Kind::Integer { is_signed },
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

/// A column that is read.
pub(crate) struct Column {
    pub(crate) leaf: usize,
    pub(crate) name: String,
    /// The definition level of a number that is not missing.
    defined: i16,
    pub(crate) is_list: bool,
    is_signed: bool,
    /// Factor from the unit in the column's name to the SI unit.
    factor: f64,
    pub(crate) reader: Option<ColumnReader>,
    /// The numbers of this batch: as floating-point numbers and as integers for time stamps.
    pub(crate) numbers: Vec<f64>,
    integers: Vec<i64>,
    texts: Vec<ByteArray>,
    /// For each row, the end of its list in `numbers` or `texts`; empty for a column without lists.
    ends: Vec<usize>,
}

impl Column {
    pub(crate) fn new(place: usize, leaf: &Leaf, factor: f64) -> Self {
        Self {
            leaf: place,
            name: leaf.name.clone(),
            defined: leaf.defined,
            is_list: leaf.is_list,
            is_signed: !matches!(leaf.kind, Kind::Integer { is_signed: false }),
            factor,
            reader: None,
            numbers: Vec::new(),
            integers: Vec::new(),
            texts: Vec::new(),
            ends: Vec::new(),
        }
    }

    /// Reads the next rows.
    pub(crate) fn fill(&mut self, rows: usize) -> Result<(), ParquetError> {
        self.numbers.clear();
        self.integers.clear();
        self.texts.clear();
        self.ends.clear();
        let Some(reader) = &mut self.reader else { return Ok(()) };
        let levels = (self.defined, self.is_list, &mut self.ends);
        let (numbers, integers, is_signed) = (&mut self.numbers, &mut self.integers, self.is_signed);
        // an unsigned integer is stored with the bits of a signed one
        #[expect(clippy::cast_precision_loss, reason = "an integer in the place of a real number")]
        let mut push = |number: Option<(i64, u64)>| {
            let (number, integer) = match number {
                Some((signed, _)) if is_signed => (signed as f64, signed),
                // an unsigned integer that is too large for i64 is no time; i64::MIN marks it
                Some((_, unsigned)) => (unsigned as f64, i64::try_from(unsigned).unwrap_or(i64::MIN)),
                None => (f64::NAN, i64::MIN),
            };
            numbers.push(number);
            integers.push(integer);
        };
        let filled = match reader {
            ColumnReader::DoubleColumnReader(reader) => {
                take(reader, rows, levels, |number| self.numbers.push(number.copied().unwrap_or(f64::NAN)))
            }
            ColumnReader::FloatColumnReader(reader) => {
                take(reader, rows, levels, |number| self.numbers.push(number.map_or(f64::NAN, |x| f64::from(*x))))
            }
            ColumnReader::Int32ColumnReader(reader) => take(reader, rows, levels, |number| {
                push(number.map(|x| (i64::from(*x), u64::from(x.cast_unsigned()))));
            }),
            ColumnReader::Int64ColumnReader(reader) => {
                take(reader, rows, levels, |number| push(number.map(|x| (*x, x.cast_unsigned()))))
            }
            // a text shares the memory of its page or dictionary and is not copied
            ColumnReader::ByteArrayColumnReader(reader) => {
                take(reader, rows, levels, |text| self.texts.push(text.cloned().unwrap_or_else(|| Vec::new().into())))
            }
            _ => Err(ParquetError::General(format!("the column {} has no numbers", self.name))),
        };
        self.numbers.iter_mut().for_each(|number| *number *= self.factor);
        if let Some(long) = self.texts.iter().find(|text| text.len() > LONGEST_NAME) {
            let (name, length) = (&self.name, long.len());
            let what = format!(
                "a text in the column {name} has {length} bytes; rne reads names of at most {LONGEST_NAME} bytes"
            );
            return Err(Refused::error(what));
        }
        filled
    }

    /// Number of rows that were read.
    pub(crate) fn rows(&self) -> usize {
        if self.is_list { self.ends.len() } else { self.numbers.len().max(self.texts.len()) }
    }

    /// Returns the text of a row of a column without lists, or its number as a text; empty if it is missing.
    pub(crate) fn text(&self, row: usize) -> Cow<'_, str> {
        if let Some(text) = self.texts.get(row) {
            return Cow::Borrowed(text.as_utf8().unwrap_or_default());
        }
        Cow::Owned(match (self.integers.get(row), self.numbers[row]) {
            (Some(&i64::MIN), _) => String::new(),
            (Some(integer), _) => integer.to_string(),
            (None, number) if number.is_nan() => String::new(),
            (None, number) => number.to_string(),
        })
    }

    fn span(&self, row: usize) -> std::ops::Range<usize> {
        let begin = if row == 0 { 0 } else { self.ends[row - 1] };
        begin..self.ends[row]
    }

    pub(crate) fn list(&self, row: usize) -> &[f64] {
        &self.numbers[self.span(row)]
    }

    /// Returns the texts of a row; a text that is missing or not UTF-8 is empty.
    pub(crate) fn texts_of(&self, row: usize) -> impl ExactSizeIterator<Item = &str> {
        self.texts[self.span(row)].iter().map(|text| text.as_utf8().unwrap_or_default())
    }

    /// Returns the time of a row, ns; `None` if it is not valid.
    pub(crate) fn time(&self, row: usize, unit: TimeUnit) -> Option<i64> {
        match self.integers.get(row) {
            Some(&i64::MIN) => None,
            Some(time) => time.checked_mul(unit.nanoseconds()),
            None => unit.number(self.numbers[row]),
        }
    }
}

/// Reads rows of a column. `push` gets each value of each row, or `None` if it is missing; `ends` gets the ends of
/// lists.
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
        // a list that is empty or missing has one level and no value
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
