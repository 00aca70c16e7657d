//! Arrays of numpy: `*.npy`.

use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};

use npyz::{DType, NpyFile, NpyHeader, Order};

use crate::csv_table::no_time;
use crate::sample::{Sample, Source};
use crate::{LogError, Options, TimeUnit};

/// What a file of numpy begins with.
const MAGIC: &[u8] = b"\x93NUMPY";

/// The longest header of an array, far more than one of numbers has.
const LONGEST_HEADER: usize = 1 << 16;

/// An array of states by columns, a sample a row.
pub(crate) struct NpyArray {
    path: PathBuf,
    numbers: Box<dyn Iterator<Item = io::Result<f64>>>,
    row: Vec<f64>,
    rows: u64,
    read: u64,
    unit: TimeUnit,
    step: Option<f64>,
    /// Where the first column of a quantity is: of times, positions, velocities, efforts.
    places: [Option<usize>; 4],
    names: Vec<String>,
}

impl NpyArray {
    pub(crate) fn open(path: &Path, options: &Options) -> Result<Self, LogError> {
        let wrong = |what: &dyn std::fmt::Display| LogError::file(path, what);
        let file = File::open(path).map_err(|error| wrong(&format_args!("the file cannot be read: {error}")))?;
        let mut file = BufReader::with_capacity(1 << 16, file);
        let header = header(&mut file).map_err(|error| {
            let reason = error.to_string();
            let reason = match error.kind() {
                ErrorKind::UnexpectedEof => "the file ends in its header",
                _ => reason.lines().next().unwrap_or_default(),
            };
            wrong(&format_args!("no array of numpy: {reason}"))
        })?;
        let [rows, width] = header.shape()[..] else {
            let axes = header.shape().len();
            return Err(wrong(&format_args!("the array has {axes} axes, not 2: states, and their numbers")));
        };
        if header.order() == Order::Fortran && rows > 1 && width > 1 {
            return Err(wrong(&"the array is in Fortran's order; save numpy.ascontiguousarray(states)"));
        }
        let (places, joints) = places(path, &options.columns, width)?;
        if places[0].is_none() && options.rate.is_none() {
            return Err(no_time(path));
        }
        let kind = match header.dtype() {
            DType::Plain(kind) => kind.to_string(),
            other => other.descr(),
        };
        let npy = NpyFile::with_header(header, file);
        let numbers: Box<dyn Iterator<Item = io::Result<f64>>> = match kind.trim_start_matches(['<', '>', '=', '|']) {
            "f8" => Box::new(npy.data::<f64>().map_err(|error| wrong(&error))?),
            "f4" => Box::new(npy.data::<f32>().map_err(|error| wrong(&error))?.map(|x| x.map(f64::from))),
            _ => return Err(wrong(&format_args!("the numbers are {kind:?}; save them as float64"))),
        };
        Ok(Self {
            path: path.to_owned(),
            numbers,
            row: Vec::new(),
            rows,
            read: 0,
            unit: options.time_unit,
            step: options.rate.map(|rate| 1.0 / rate),
            places,
            names: (1..=joints).map(|joint| joint.to_string()).collect(),
        })
    }
}

impl Source for NpyArray {
    fn read(&mut self, sample: &mut Sample) -> Result<bool, LogError> {
        if self.read == self.rows {
            return Ok(false);
        }
        let joints = self.names.len();
        let width = self.places.iter().enumerate().filter(|(_, place)| place.is_some());
        let width: usize = width.map(|(quantity, _)| if quantity == 0 { 1 } else { joints }).sum();
        self.row.clear();
        while self.row.len() < width {
            let (read, rows) = (self.read, self.rows);
            let cut = || LogError::file(&self.path, format_args!("the file is cut off behind {read} of {rows} states"));
            match self.numbers.next() {
                Some(Ok(number)) => self.row.push(number),
                None => return Err(cut()),
                Some(Err(error)) if error.kind() == ErrorKind::UnexpectedEof => return Err(cut()),
                Some(Err(error)) => {
                    return Err(LogError::file(&self.path, format_args!("the file cannot be read: {error}")));
                }
            }
        }
        sample.measured = match (self.places[0], self.step) {
            (Some(place), _) => {
                let time = self.row[place];
                self.unit.number(time).ok_or_else(|| {
                    let what = self.unit.refusal(&time.to_string());
                    LogError::file(&self.path, format_args!("state {}: {what}", self.read))
                })?
            }
            (None, step) => TimeUnit::step(self.read, step.unwrap_or_default()),
        };
        self.read += 1;
        sample.recorded = sample.measured;
        if sample.names != self.names {
            sample.names.clone_from(&self.names);
        }
        let lists = [&mut sample.position, &mut sample.velocity, &mut sample.effort];
        for (list, place) in lists.into_iter().zip(&self.places[1..]) {
            list.clear();
            if let Some(place) = place {
                list.extend_from_slice(&self.row[*place..place + joints]);
            }
        }
        Ok(true)
    }

    #[expect(clippy::cast_precision_loss, reason = "a bar of some hundred steps")]
    fn progress(&self) -> f64 {
        self.read as f64 / self.rows.max(1) as f64
    }
}

/// Where quantities stand in a row, and how many joints there are.
fn places(path: &Path, columns: &[String], width: u64) -> Result<([Option<usize>; 4], usize), LogError> {
    let mut order = Vec::new();
    for column in columns {
        let Some(quantity) = ["time", "q", "qd", "tau"].iter().position(|name| name == column) else {
            let what = format!("an array has no columns {column:?}: they are time, q, qd and tau");
            return Err(LogError::request(path, what));
        };
        if order.contains(&quantity) {
            return Err(LogError::request(path, format_args!("columns {column} are named twice")));
        }
        order.push(quantity);
    }
    if !order.contains(&1) {
        return Err(LogError::request(path, "an array without positions, q, is no log"));
    }
    let of_time = usize::from(order.contains(&0));
    let each = order.len() - of_time;
    let width = usize::try_from(width).unwrap_or(usize::MAX);
    let joints = width.saturating_sub(of_time) / each;
    if joints == 0 || joints > 1024 || joints * each + of_time != width {
        let said = columns.join(",");
        let what = format!(
            "the array has {width} columns, which is not {said} of some joints; --columns says what there is, as in \
             --columns time,q,tau"
        );
        return Err(LogError::request(path, what));
    }
    let mut places = [None; 4];
    let mut place = 0;
    for quantity in order {
        places[quantity] = Some(place);
        place += if quantity == 0 { 1 } else { joints };
    }
    Ok((places, joints))
}

/// The header of an array; the file stands before its numbers then.
fn header(file: &mut impl Read) -> io::Result<NpyHeader> {
    let invalid = |what: &str| io::Error::new(ErrorKind::InvalidData, what);
    let mut bytes = vec![0; MAGIC.len() + 2];
    file.read_exact(&mut bytes)?;
    // version 1 tells the length by two bytes, later ones by four
    let of_length = if bytes[MAGIC.len()] == 1 { 2 } else { 4 };
    let mut length = [0; 4];
    file.read_exact(&mut length[..of_length])?;
    bytes.extend_from_slice(&length[..of_length]);
    let length = u32::from_le_bytes(length) as usize;
    if length > LONGEST_HEADER {
        return Err(invalid("its header is too long"));
    }
    let start = bytes.len();
    bytes.resize(start + length, 0);
    file.read_exact(&mut bytes[start..])?;
    if !is_countable(&String::from_utf8_lossy(&bytes[start..])) {
        return Err(invalid("its shape is too large, or none"));
    }
    NpyHeader::from_reader(&bytes[..])
}

/// Whether the integers of a header are decimal and their product, in which a zero is as good as 1, is one too: so are
/// the number of elements, and the strides, that are computed from a shape.
fn is_countable(header: &str) -> bool {
    let words = header.split(|c: char| !c.is_alphanumeric() && c != '_');
    let mut numbers = words.filter(|word| word.starts_with(|c: char| c.is_ascii_digit()));
    let product = numbers.try_fold(1_u64, |product, word| product.checked_mul(word.parse::<u64>().ok()?.max(1)));
    product.is_some_and(|product| product < 1 << 60)
}
