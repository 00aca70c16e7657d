//! A log: its files, what is read of them and by which names.

pub(crate) mod chain;
pub(crate) mod frozen_position;
pub(crate) mod joints;
pub(crate) mod motion;
pub(crate) mod motions;
pub(crate) mod pass;
pub(crate) mod recorded;
pub(crate) mod remark;
pub(crate) mod survey;
pub(crate) mod values;

use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::columns::quantity::Quantity;
use crate::columns::unit::{Dimension, JointUnits};
use crate::formats::format::{self, Format};
use crate::formats::sample::Sample;
use crate::limits::{LONGEST_GAP, MOST_BYTES};
use crate::log::chain::Chain;
use crate::log::joints::Joints;
use crate::number::short;
use crate::options::{Angles, Options};
use crate::remedy::Setting;
use crate::spelling::listed;
use crate::{LogError, TimeUnit};

/// Messages by which it is decided what a log has: joints, times, velocities, efforts, its step.
const HEAD: usize = 1024;

/// Samples that are so far apart, s, or further, are rare: such times are in another unit, unless somebody says that
/// they are seconds.
const SLOWEST: f64 = 0.5;

/// Samples that are so far apart, s, or further, are taken for seconds, and a note says so: 0.1 may be ms at 10 kHz.
const SLOW: f64 = 0.0999;

/// Stamps this far from zero, ns, are since 1970 or the machine's start, and are shown since the log's first.
const FAR: i64 = 10_000_000_000_000_000;

/// A log of one or more files, opened; reading it costs memory that does not grow with it.
///
/// [`Log::survey`] reads it once and says what is there. [`Log::motions`] reads it again and filters.
#[derive(Debug)]
pub struct Log {
    pub(crate) files: Vec<PathBuf>,
    pub(crate) options: Options,
    pub(crate) joints: Joints,
    pub(crate) layout: Layout,
}

/// Content of a log, from its first thousand messages.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[expect(clippy::struct_excessive_bools, reason = "each is a quantity that the log has, or not")]
pub struct Layout {
    /// Format of the first file.
    pub format: Format,
    /// The topic of a bag.
    pub topic: Option<String>,
    /// The joints that are read, by the log's names.
    pub joints: Vec<String>,
    /// The joints of the log that are not read.
    pub ignored: Vec<String>,
    /// Times are those of recording: the messages' own are all equal, or the options say so.
    pub recorded: bool,
    /// Whether the log has velocities; states without them are left out then.
    pub has_velocities: bool,
    /// Whether the log has efforts; states without them are left out then.
    pub has_efforts: bool,
    /// Whether the log has accelerations, which only a [`Mapping`](crate::Mapping) names; else they are derived.
    pub has_accelerations: bool,
    /// Where it has none: the joints none of whose efforts is a number, of the first thousand messages.
    pub without_efforts: Vec<String>,
    /// The median interval, s.
    pub step: f64,
    /// The time of the log's first state, ns, which times are since; 0 where the log's own times begin near zero.
    pub origin: i64,
    /// The units that names of columns say, by joint.
    pub units: Vec<JointUnits>,
    /// The columns of a table that are not read: those like the columns of joints, and all others where no joint has a
    /// velocity, or none an effort.
    pub unread: Vec<String>,
    /// The columns of a table that have words and no numbers, which may say of which arm or part a row is.
    pub word_columns: Vec<String>,
    /// Remarks on what the file is.
    pub notes: Vec<String>,
}

impl Layout {
    /// Places of a quantity among the numbers of a state: positions, then velocities, efforts and accelerations as far
    /// as the log has them.
    pub(crate) fn places(&self, quantity: Quantity) -> Range<usize> {
        let has = |quantity| match quantity {
            Quantity::Position => true,
            Quantity::Velocity => self.has_velocities,
            Quantity::Effort => self.has_efforts,
            Quantity::Acceleration => self.has_accelerations,
        };
        let before = Quantity::ALL.into_iter().take_while(|other| *other != quantity).filter(|other| has(*other));
        let start = before.count() * self.joints.len();
        start..start + if has(quantity) { self.joints.len() } else { 0 }
    }

    /// How many numbers a state has.
    pub(crate) fn width(&self) -> usize {
        self.places(Quantity::Acceleration).end
    }
}

impl Log {
    /// Opens files, whose logs follow each other, and reads the first messages. For a folder, it opens the bags inside.
    ///
    /// # Errors
    ///
    /// If a file cannot be read, is of no known format, or does not have the topic or the joints.
    pub fn open(paths: &[PathBuf], options: Options) -> Result<Self, LogError> {
        let files = format::files(paths)?;
        let Some(path) = files.first() else {
            return Err(LogError::request(Path::new("log"), "no file is named"));
        };
        format::check_once(&files)?;
        check(path, &options)?;
        let mut chain = Chain::open(&files, &options)?;
        // the first messages may be of several files
        let (topic, unread) = (chain.source.topic().map(str::to_owned), chain.source.unread());
        let mut notes = chain.source.notes();
        let is_time_unit_known = chain.source.is_time_unit_known();
        let mut head: Vec<Sample> = Vec::new();
        let mut sample = Sample::default();
        let mut size = 0;
        while head.len() < HEAD && size < MOST_BYTES && chain.read(&mut sample)? {
            size += sample.size();
            head.push(sample.clone());
        }
        // a bag may name its topic with the first message
        let topic = topic.or_else(|| chain.source.topic().map(str::to_owned));
        let word_columns = chain.source.word_columns();
        if head.is_empty() {
            if let [(column, value)] = options.select.as_slice() {
                let there = Self::values(&files, column, &options, |_| ())?;
                let there = listed(there.iter().map(|found| &found.value));
                return Err(LogError::request(
                    path,
                    format_args!("no row has {value} in the column {column}; the column has {there}"),
                ));
            }
            let of_topic = topic.map_or(String::new(), |topic| format!(" on {topic}"));
            return Err(LogError::file(path, format_args!("the log has no joint states{of_topic}")));
        }
        let mut joints = Joints::of(path, &head, options.joints.as_deref())?;
        if joints.names.is_empty() {
            return Err(LogError::file(path, "the messages name no joints"));
        }
        let constants = options.torque_constants.len();
        if constants > 1 && constants != joints.names.len() {
            let what =
                format!("{constants} torque constants for {} joints; give one, or one per joint", joints.names.len());
            return Err(LogError::request(path, what));
        }
        let mut states: Vec<&Sample> = Vec::new();
        let mut whole = [0; 4];
        for sample in &head {
            if joints.find(sample) == crate::log::joints::Presence::All {
                states.push(sample);
                let lists = [&sample.position, &sample.velocity, &sample.effort, &sample.acceleration];
                for (count, numbers) in whole.iter_mut().zip(lists) {
                    *count += usize::from(joints.are_whole(numbers, sample));
                }
            }
        }
        let [positions, velocities, efforts, accelerations] = whole;
        if positions == 0 {
            let what =
                format!("none of the first {} messages has positions of {}", head.len(), joints.names.join(", "));
            return Err(LogError::file(path, what));
        }
        let has = |count: usize| 2 * count > states.len();
        let same = states.windows(2).all(|pair| pair[0].measured == pair[1].measured);
        let recorded = options.recorded || same && states.len() > 1;
        let time = |sample: &&Sample| if recorded { sample.recorded } else { sample.measured };
        let times: Vec<i64> = states.iter().map(time).collect();
        let step = median_step(&times).ok_or_else(|| no_step(path, &times))?;
        let back = times.windows(2).filter(|pair| pair[1] < pair[0]).count();
        if chain.format.has_rows() && 4 * back > times.len() {
            return Err(LogError::file(path, unsorted(back, times.len())));
        }
        if step >= SLOWEST && !is_time_unit_known {
            let error = LogError::request(path, unknown_unit(step)).give(Setting::TimeUnit);
            return Err(error.give(Setting::Rate));
        }
        if step >= SLOW && !is_time_unit_known {
            notes.push(format!(
                "the times have no unit, so rne reads them as seconds unless you give another unit: samples are at {}",
                rates(step)
            ));
        }
        let units: Vec<JointUnits> = joints.names.iter().map(|name| chain.units.of(name)).collect();
        notes.extend(slides_in_metres(&options, &joints.names, &units));
        let layout = Layout {
            format: chain.format,
            topic,
            ignored: joints.others(&head),
            joints: joints.names.clone(),
            recorded,
            has_velocities: has(velocities) && !options.derive_velocities,
            has_efforts: has(efforts),
            has_accelerations: has(accelerations),
            without_efforts: without_efforts(&mut joints.clone(), &states),
            step,
            origin: if times[0].saturating_abs() > FAR { times[0] } else { 0 },
            units,
            unread,
            word_columns,
            notes,
        };
        Ok(Self { files, options, joints, layout })
    }

    /// The content of the log.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Whether efforts are multiplied: they are currents.
    #[must_use]
    pub fn has_torque_constants(&self) -> bool {
        !self.options.torque_constants.is_empty()
    }

    /// The files, in the order in which they are read.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// An error of the request, with the name of the first file.
    pub(crate) fn request(&self, what: impl std::fmt::Display) -> LogError {
        LogError::request(&self.files[0], what)
    }

    /// The joints whose efforts are currents by the names of columns, where there are no torque constants: such a log
    /// is not filtered.
    #[must_use]
    pub fn unsaid_currents(&self) -> Vec<&str> {
        let Layout { joints, units, has_efforts, .. } = &self.layout;
        let is_unsaid = *has_efforts && self.options.torque_constants.is_empty();
        let is_current = |units: &JointUnits| is_unsaid && units.effort == Some(Dimension::Current);
        joints.iter().zip(units).filter(|(_, units)| is_current(units)).map(|(name, _)| name.as_str()).collect()
    }

    /// Factor of a joint's positions and velocities; `said` is their dimension, if a column's name gives it.
    pub(crate) fn of_angle(&self, joint: usize, said: Option<Dimension>) -> f64 {
        let is_degrees = self.options.angles == Angles::Degrees && said.is_none() && !self.options.is_slide(joint);
        if is_degrees { std::f64::consts::PI / 180.0 } else { 1.0 }
    }

    /// Factor of a joint's effort.
    pub(crate) fn torque_constant(&self, joint: usize) -> f64 {
        if matches!(self.layout.units[joint].effort, Some(Dimension::Torque | Dimension::Force)) {
            return 1.0;
        }
        match self.options.torque_constants[..] {
            [] => 1.0,
            [one] => one,
            ref each => each[joint],
        }
    }
}

/// The joints that have no effort in any of these samples.
fn without_efforts(joints: &mut Joints, samples: &[&Sample]) -> Vec<String> {
    let mut is_there = vec![false; joints.names.len()];
    let mut efforts = Vec::new();
    for sample in samples {
        joints.find(sample);
        efforts.clear();
        joints.take(&sample.effort, |_| 1.0, &mut efforts);
        for (is_there, effort) in is_there.iter_mut().zip(&efforts) {
            *is_there |= effort.is_finite();
        }
    }
    let missing = joints.names.iter().zip(is_there).filter(|(_, is_there)| !is_there);
    missing.map(|(name, _)| name.clone()).collect()
}

/// The median of the intervals between times that grow, s.
#[expect(clippy::cast_precision_loss, reason = "ns of a step")]
fn median_step(times: &[i64]) -> Option<f64> {
    let mut steps: Vec<i64> = times.windows(2).filter_map(|pair| pair[1].checked_sub(pair[0])).collect();
    steps.retain(|step| *step > 0);
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return None;
    }
    Some(*steps.select_nth_unstable(middle).1 as f64 * 1e-9)
}

/// Message for rows that are not in the order of time.
fn unsorted(back: usize, count: usize) -> String {
    format!(
        "the rows are not in the order of time: in the first {count} rows, time goes back {back} times; sort the rows \
         by their time"
    )
}

/// Message for times whose unit is not known.
fn unknown_unit(step: f64) -> String {
    format!(
        "the unit of the times is not known: the times are {} apart, so samples are at {}; if the times only count \
         rows, remove their column and give the sampling rate",
        short(step),
        rates(step)
    )
}

/// The rate of samples by the unit of their times.
fn rates(step: f64) -> String {
    let words = |unit: TimeUnit, rate: f64| {
        let (rate, prefix) = match rate {
            rate if rate >= 1e9 => (rate * 1e-9, "G"),
            rate if rate >= 1e6 => (rate * 1e-6, "M"),
            rate if rate >= 1e3 => (rate * 1e-3, "k"),
            rate => (rate, ""),
        };
        format!("{} {prefix}Hz in {}", short(rate), unit.name())
    };
    let units = [
        (TimeUnit::Seconds, 1.0),
        (TimeUnit::Milliseconds, 1e3),
        (TimeUnit::Microseconds, 1e6),
        (TimeUnit::Nanoseconds, 1e9),
    ];
    units.map(|(unit, each)| words(unit, each / step)).join(", ")
}

fn no_step(path: &Path, times: &[i64]) -> LogError {
    match times.len() {
        1 => LogError::file(path, "the log has one joint state; a motion needs many"),
        count => LogError::file(path, format_args!("the times of the first {count} joint states do not increase")),
    }
}

/// Note for prismatic joints, whose numbers are not converted from degrees.
fn slides_in_metres(options: &Options, names: &[String], units: &[JointUnits]) -> Option<String> {
    let stays = |joint: &usize| {
        let JointUnits { position, velocity, .. } = units[*joint];
        options.angles == Angles::Degrees && options.is_slide(*joint) && position.or(velocity).is_none()
    };
    let slides: Vec<&str> = (0..names.len()).filter(stays).map(|joint| names[joint].as_str()).collect();
    let plural = if slides.len() == 1 { ("slides", "is") } else { ("slide", "are") };
    (!slides.is_empty()).then(|| {
        let names = listed(slides);
        format!("degrees are only for joints that turn: {names} {}, and {} read in m and m/s", plural.0, plural.1)
    })
}

/// Numbers that make no sense in any log.
fn check(path: &Path, options: &Options) -> Result<(), LogError> {
    let positive = [("rate", options.rate), ("cut-off", options.cutoff)];
    for (name, number) in positive {
        if number.is_some_and(|number| !(number > 0.0 && number.is_finite())) {
            return Err(LogError::request(path, format_args!("the {name} must be a positive number of Hz")));
        }
    }
    if !(options.gap >= 1.5 && options.gap.is_finite()) {
        return Err(LogError::request(
            path,
            "the limit of gaps must be at least 1.5 steps, because otherwise intervals with jitter count as gaps",
        ));
    }
    if options.gap > LONGEST_GAP {
        let what = format!(
            "the limit of gaps must be at most {LONGEST_GAP} steps: rne interpolates each missing row of a shorter gap"
        );
        return Err(LogError::request(path, what).give(Setting::Gap));
    }
    if options.torque_constants.iter().any(|constant| !constant.is_finite() || *constant == 0.0) {
        return Err(LogError::request(path, "a torque constant is zero or not a number"));
    }
    Ok(())
}
