//! Reads logs from NumPy arrays, `*.npy`.

use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::formats::csv_table::no_time;
use crate::formats::sample::{Sample, Source};
use crate::limits::MOST_JOINTS;
use crate::remedy::Setting;
use crate::{LogError, Npy, Options, TimeUnit};

/// Quantities of an array, in their default order.
const QUANTITIES: [&str; 4] = ["time", "q", "qd", "tau"];

/// An array with one sample per row; its columns are the quantities of the joints.
pub(crate) struct NpyArray {
    path: PathBuf,
    numbers: Box<dyn Iterator<Item = io::Result<f64>>>,
    row: Vec<f64>,
    rows: u64,
    read: u64,
    unit: TimeUnit,
    is_time_unit_known: bool,
    step: Option<f64>,
    /// Indices of the first columns of times, positions, velocities and efforts.
    places: [Option<usize>; 4],
    names: Vec<String>,
}

impl NpyArray {
    pub(crate) fn open(path: &Path, options: &Options) -> Result<Self, LogError> {
        let wrong = |what: &dyn std::fmt::Display| LogError::file(path, what);
        let file = File::open(path).map_err(|error| wrong(&format_args!("the file cannot be read: {error}")))?;
        let size = file.metadata().map_or(0, |metadata| metadata.len());
        let npy = Npy::open(file).map_err(|error| wrong(&error))?;
        let [rows, width] = npy.shape[..] else {
            let axes = npy.shape.len();
            return Err(wrong(&format_args!(
                "the array has {axes} axes, but it must have 2: one for the states and one for the numbers of a state"
            )));
        };
        if size > npy.length {
            let (length, more) = (npy.length, size - npy.length);
            let what = format!(
                "the array ends at byte {length}, and {more} bytes follow: are they another array? A log is one array \
                 in a file"
            );
            return Err(wrong(&what));
        }
        let asked: Vec<&str> = match options.columns.as_slice() {
            [] => QUANTITIES.to_vec(),
            columns => columns.iter().map(String::as_str).collect(),
        };
        let (places, joints) = places(path, &asked, width)?;
        match (places[0], options.rate) {
            (None, None) => return Err(no_time(path, asked).give(Setting::Rate)),
            (Some(_), Some(_)) => {
                let others: Vec<&str> = asked.iter().copied().filter(|name| *name != QUANTITIES[0]).collect();
                let what = format!(
                    "the columns {} contain times, but a sampling rate can be given only for arrays without times, \
                     whose columns are {}",
                    asked.join(","),
                    others.join(",")
                );
                let error = LogError::request(path, what).leave_out(Setting::Rate);
                return Err(error.give(Setting::Columns));
            }
            _ => {}
        }
        Ok(Self {
            path: path.to_owned(),
            numbers: npy.numbers,
            row: Vec::new(),
            rows,
            read: 0,
            unit: options.time_unit.unwrap_or_default(),
            is_time_unit_known: options.time_unit.is_some() || places[0].is_none(),
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
            let cut = || LogError::file(&self.path, format_args!("the file is cut off after {read} of {rows} states"));
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
                    let error = LogError::file(&self.path, format_args!("state {}: {what}", self.read));
                    if time.is_finite() { error.give(Setting::TimeUnit) } else { error }
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

    fn is_time_unit_known(&self) -> bool {
        self.is_time_unit_known
    }
}

/// Returns the index of the first column of each quantity, and the number of joints.
fn places(path: &Path, columns: &[&str], width: u64) -> Result<([Option<usize>; 4], usize), LogError> {
    let mut order = Vec::new();
    for column in columns {
        let Some(quantity) = QUANTITIES.iter().position(|name| name == column) else {
            let what = format!("an array has no columns {column:?}: its columns can be time, q, qd and tau");
            return Err(LogError::request(path, what));
        };
        if order.contains(&quantity) {
            return Err(LogError::request(path, format_args!("columns {column} are named twice")));
        }
        order.push(quantity);
    }
    if !order.contains(&1) {
        return Err(LogError::request(path, "the array has no positions, q, so it is not a log"));
    }
    let of_time = usize::from(order.contains(&0));
    let per_joint = order.len() - of_time;
    let width = usize::try_from(width).unwrap_or(usize::MAX);
    let joints = width.saturating_sub(of_time) / per_joint;
    if joints == 0 || joints > MOST_JOINTS || joints * per_joint + of_time != width {
        let said = columns.join(",");
        let what =
            format!("the array has {width} columns, which does not fit the order {said} for any number of joints");
        return Err(LogError::request(path, what).give(Setting::Columns));
    }
    let mut places = [None; 4];
    let mut place = 0;
    for quantity in order {
        places[quantity] = Some(place);
        place += if quantity == 0 { 1 } else { joints };
    }
    Ok((places, joints))
}
