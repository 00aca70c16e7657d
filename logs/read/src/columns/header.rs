//! The header of a table: what the name of each column means.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use crate::columns::guess::{Meaning, Named, meaning};
use crate::columns::mapping::{Mapped, Target};
use crate::columns::quantity::Quantity;
use crate::columns::table::Column;
use crate::columns::time_column::{TimeColumn, within};
use crate::columns::unit::{Dimension, Unit};
use crate::limits::work;
use crate::remedy::Setting;
use crate::spelling::{instead, listed};
use crate::{LogError, Options, TimeUnit};

/// The meaning of a column of a joint, and its index.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub(crate) named: Named,
    pub(crate) place: usize,
}

impl Found {
    pub(crate) fn column(&self) -> Column {
        Column { place: self.place, factor: self.named.unit.map_or(1.0, |unit| unit.factor) }
    }

    /// Returns the dimension of the numbers if the name of the column gives it.
    pub(crate) fn dimension(&self) -> Option<Dimension> {
        let of_word = self.named.is_current.then_some(Dimension::Current);
        self.named.unit.map(|unit| unit.dimension).or(of_word)
    }
}

/// The header of a table with the meaning of each name.
pub(crate) struct Header<'a> {
    pub(crate) path: &'a Path,
    names: &'a [String],
    prefix: Option<&'a str>,
    pub(crate) found: Vec<Found>,
    pub(crate) times: Vec<TimeColumn>,
    /// Indices of columns whose names resemble those of joints but have no known meaning.
    unread: Vec<usize>,
}

impl<'a> Header<'a> {
    pub(crate) fn read(path: &'a Path, names: &'a [String], options: &'a Options) -> Result<Self, LogError> {
        let prefix = options.topic.as_deref();
        let mut header = Self { path, names, prefix, found: Vec::new(), times: Vec::new(), unread: Vec::new() };
        let (places, targets) = header.map(options)?;
        for (place, name) in names.iter().enumerate() {
            work::add(1);
            if places.contains(&place) {
                continue;
            }
            if let Some(time) = TimeColumn::of(path, place, name, options)? {
                if !header.times.iter().any(|time| time.is_mapped) {
                    header.times.push(time);
                }
                continue;
            }
            let inner = within(name, options);
            match inner.map_or(Meaning::Nothing, |name| meaning(name, false)) {
                Meaning::Joint(named) if targets.contains(&Target::of(&named)) => header.unread.push(place),
                Meaning::Joint(named) => header.found.push(Found { named, place }),
                Meaning::Unknown { quantity, unit } => return Err(Unit::unknown(path, name, quantity, &unit)),
                Meaning::Like => header.unread.push(place),
                Meaning::Nothing => {}
            }
        }
        Ok(header)
    }

    /// Finds the columns of the options' map; returns their indices and meanings.
    fn map(&mut self, options: &Options) -> Result<(HashSet<usize>, HashSet<Target>), LogError> {
        let wrong = |what: String| LogError::request(self.path, what);
        let mut places = HashSet::new();
        let mut targets = HashSet::new();
        let (mut found, mut times) = (Vec::new(), Vec::new());
        for mapping in &options.map {
            let (place, mapped) = mapping.find(self.names).map_err(wrong)?;
            if !places.insert(place) {
                return Err(wrong(format!("the column `{}` is mapped twice", self.names[place])));
            }
            if !targets.insert(mapping.target.clone()) {
                return Err(wrong(format!("{} is mapped twice", mapping.target)));
            }
            match mapped {
                Mapped::Time(unit) => times.push(TimeColumn::mapped(place, unit)),
                Mapped::Joint(named) => found.push(Found { named, place }),
            }
        }
        (self.found, self.times) = (found, times);
        Ok((places, targets))
    }

    /// Refuses a map for a joint that has no column of positions, because such a joint would not be read.
    pub(crate) fn check_map(&self, positions: &[&Found], options: &Options) -> Result<(), LogError> {
        let joints = || positions.iter().map(|found| found.named.joint.as_str());
        for mapping in &options.map {
            let Target::Joint { joint, .. } = &mapping.target else { continue };
            if !joints().any(|known| known == joint) {
                let what = format!(
                    "{} is mapped, but no column has positions of a joint `{}`{}; the joints with positions are {}",
                    mapping.target,
                    joint,
                    instead(joint, joints()),
                    listed(joints())
                );
                return Err(LogError::request(self.path, what));
            }
        }
        Ok(())
    }

    pub(crate) fn of(&self, quantity: Quantity) -> Vec<&Found> {
        self.found.iter().filter(|found| found.named.quantity == quantity).collect()
    }

    pub(crate) fn name(&self, found: &Found) -> &'a str {
        &self.names[found.place]
    }

    pub(crate) fn without_positions(&self) -> LogError {
        let all = listed(self.names);
        let of_prefix = self.prefix.map_or(String::new(), |prefix| format!(" that begins with {prefix}"));
        let what = format!(
            "no column{of_prefix} has the position of a joint: rne knows names such as q1, q2, … and elbow/position, \
             position.elbow, elbow_position; the columns of this file are {all}"
        );
        LogError::file(self.path, what).give(Setting::Map(self.names.to_vec()))
    }

    /// Returns the names of the columns with units other than SI.
    pub(crate) fn converted(&self, time: Option<TimeColumn>, read: &[&Found]) -> Vec<String> {
        let is_other = |found: &&&Found| found.named.unit.is_some_and(|unit| !unit.is_si());
        let time = time.filter(|time| time.unit.is_some_and(|unit| unit != TimeUnit::Seconds));
        let places = time.map(|time| time.place).into_iter();
        let places = places.chain(read.iter().filter(is_other).map(|found| found.place));
        places.map(|place| self.names[place].clone()).collect()
    }

    /// Returns the names of the columns that are not read.
    pub(crate) fn unread(&self, joints: &[&Found], velocities: &[&Found], efforts: &[&Found]) -> Vec<String> {
        let of_joints = by_joint(joints);
        let has_position = |found: &&&Found| of_joints.contains_key(found.named.joint.as_str());
        let read: HashSet<usize> =
            [joints, velocities, efforts].into_iter().flatten().filter(has_position).map(|found| found.place).collect();
        let lacks = |found: &[&Found]| !found.iter().any(|found| has_position(&found));
        let is_any = lacks(velocities) || lacks(efforts);
        let like: HashSet<usize> =
            self.unread.iter().copied().chain(self.found.iter().map(|found| found.place)).collect();
        let times: HashSet<usize> = self.times.iter().map(|time| time.place).collect();
        let is_unread = |place: &usize| {
            let is_named = !self.names[*place].trim().is_empty();
            !read.contains(place) && !times.contains(place) && (like.contains(place) || is_any && is_named)
        };
        work::add(self.names.len());
        (0..self.names.len()).filter(is_unread).map(|place| self.names[place].clone()).collect()
    }
}

/// Makes a map from the names of joints to their columns.
pub(crate) fn by_joint<'f>(found: &[&'f Found]) -> HashMap<&'f str, &'f Found> {
    work::add(found.len());
    found.iter().map(|found| (found.named.joint.as_str(), *found)).collect()
}
