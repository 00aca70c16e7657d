//! Opens a log: chooses its files, joints and quantities.

pub(crate) mod chain;
pub(crate) mod frozen_position;
pub(crate) mod joints;
pub(crate) mod layout;
pub(crate) mod motion;
pub(crate) mod motions;
pub(crate) mod pass;
pub(crate) mod recorded;
pub(crate) mod remark;
pub(crate) mod step;
pub(crate) mod survey;
pub(crate) mod values;

use std::path::{Path, PathBuf};

use crate::LogError;
use crate::columns::unit::{Dimension, JointUnits};
use crate::formats::format;
use crate::formats::sample::Sample;
use crate::limits::{LONGEST_GAP, MOST_BYTES};
use crate::log::chain::Chain;
use crate::log::joints::{Joints, Presence};
use crate::log::layout::Layout;
use crate::log::step::{check_order, check_unit, median_step};
use crate::options::{Angles, Options};
use crate::remedy::Setting;
use crate::spelling::listed;

/// Number of first messages that determine the content of a log: joints, times, velocities, efforts and sampling
/// interval.
const HEAD: usize = 1024;

/// Stamps above this value, ns, count from 1970 or from the start of a machine; their times are given from the log's
/// first stamp on.
const FAR: i64 = 10_000_000_000_000_000;

/// An open log of one or more files. The memory for reading it does not grow with the log.
///
/// [`Log::survey`] reads the log once and reports its content. [`Log::motions`] reads it again and filters it.
#[derive(Debug)]
pub struct Log {
    pub(crate) files: Vec<PathBuf>,
    pub(crate) options: Options,
    pub(crate) joints: Joints,
    pub(crate) layout: Layout,
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
        // the first messages may come from several files
        let (topic, unread) = (chain.source.topic().map(str::to_owned), chain.source.unread());
        let mut notes = chain.source.notes();
        let is_time_unit_known = chain.source.is_time_unit_known();
        let head = head(&mut chain)?;
        // the topic of a bag may be known only after the first message
        let topic = topic.or_else(|| chain.source.topic().map(str::to_owned));
        let word_columns = chain.source.word_columns();
        if head.is_empty() {
            return Err(Self::without_states(&files, &options, topic)?);
        }
        let mut joints = Joints::of(path, &head, options.joints.as_deref())?;
        if joints.names.is_empty() {
            return Err(LogError::file(path, "the messages name no joints"));
        }
        check_constants(path, &options, joints.names.len())?;
        let (states, [velocities, efforts, accelerations]) = whole(path, &mut joints, &head)?;
        let has = |count: usize| 2 * count > states.len();
        let same = states.windows(2).all(|pair| pair[0].measured == pair[1].measured);
        let recorded = options.recorded || same && states.len() > 1;
        let time = |sample: &&Sample| if recorded { sample.recorded } else { sample.measured };
        let times: Vec<i64> = states.iter().map(time).collect();
        let step = median_step(path, &times)?;
        if chain.format.has_rows() {
            check_order(path, &times)?;
        }
        notes.extend(if is_time_unit_known { None } else { check_unit(path, step)? });
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

    /// Returns the error for a log whose files have no joint states.
    fn without_states(files: &[PathBuf], options: &Options, topic: Option<String>) -> Result<LogError, LogError> {
        let path = &files[0];
        if let [(column, value)] = options.select.as_slice() {
            let there = Self::values(files, column, options, |_| ())?;
            let there = listed(there.iter().map(|found| &found.value));
            let what = format!("no row has {value} in the column {column}; the column has {there}");
            return Ok(LogError::request(path, what));
        }
        let of_topic = topic.map_or(String::new(), |topic| format!(" on {topic}"));
        Ok(LogError::file(path, format_args!("the log has no joint states{of_topic}")))
    }

    /// The content of the log.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Whether efforts are currents that are multiplied by torque constants.
    #[must_use]
    pub fn has_torque_constants(&self) -> bool {
        !self.options.torque_constants.is_empty()
    }

    /// The files, in the order in which they are read.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Makes an error for options that do not fit the log, with the name of the first file.
    pub(crate) fn request(&self, what: impl std::fmt::Display) -> LogError {
        LogError::request(&self.files[0], what)
    }

    /// Returns the joints whose efforts are currents by the names of columns, if the options have no torque constants.
    /// Such a log cannot be filtered.
    #[must_use]
    pub fn unsaid_currents(&self) -> Vec<&str> {
        let Layout { joints, units, has_efforts, .. } = &self.layout;
        let is_unsaid = *has_efforts && self.options.torque_constants.is_empty();
        let is_current = |units: &JointUnits| is_unsaid && units.effort == Some(Dimension::Current);
        joints.iter().zip(units).filter(|(_, units)| is_current(units)).map(|(name, _)| name.as_str()).collect()
    }

    /// Returns the factor of a joint's positions and velocities to SI units; `said` is their dimension, if the column's
    /// name gives it.
    pub(crate) fn of_angle(&self, joint: usize, said: Option<Dimension>) -> f64 {
        let is_degrees = self.options.angles == Angles::Degrees && said.is_none() && !self.options.is_slide(joint);
        if is_degrees { std::f64::consts::PI / 180.0 } else { 1.0 }
    }

    /// Returns the factor of a joint's effort: its torque constant, or 1.
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

/// Reads the first messages, up to a limit.
fn head(chain: &mut Chain) -> Result<Vec<Sample>, LogError> {
    let mut head: Vec<Sample> = Vec::new();
    let mut sample = Sample::default();
    let mut size = 0;
    while head.len() < HEAD && size < MOST_BYTES && chain.read(&mut sample)? {
        size += sample.size();
        head.push(sample.clone());
    }
    Ok(head)
}

/// Returns the samples that have all joints, and how many of them have velocities, efforts and accelerations of all
/// joints.
fn whole<'s>(
    path: &Path,
    joints: &mut Joints,
    samples: &'s [Sample],
) -> Result<(Vec<&'s Sample>, [usize; 3]), LogError> {
    let mut states = Vec::new();
    let mut whole = [0; 4];
    for sample in samples {
        if joints.find(sample) == Presence::All {
            states.push(sample);
            let lists = [&sample.position, &sample.velocity, &sample.effort, &sample.acceleration];
            for (count, numbers) in whole.iter_mut().zip(lists) {
                *count += usize::from(joints.are_whole(numbers, sample));
            }
        }
    }
    let [positions, others @ ..] = whole;
    if positions == 0 {
        let (count, names) = (samples.len(), joints.names.join(", "));
        return Err(LogError::file(path, format_args!("none of the first {count} messages has positions of {names}")));
    }
    Ok((states, others))
}

/// Returns the joints that have no effort in any of these samples.
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

/// Returns a note on prismatic joints, whose numbers are not converted from degrees.
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

/// Refuses options with numbers that are wrong for any log.
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

fn check_constants(path: &Path, options: &Options, joints: usize) -> Result<(), LogError> {
    let constants = options.torque_constants.len();
    if constants > 1 && constants != joints {
        let what = format!("{constants} torque constants for {joints} joints; give one, or one per joint");
        return Err(LogError::request(path, what));
    }
    Ok(())
}
