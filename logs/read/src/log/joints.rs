//! Finds the wanted joints in the samples of a log.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use crate::LogError;
use crate::formats::sample::Sample;
use crate::limits::work;
use crate::remedy::Setting;
use crate::spelling::{instead, listed};

/// The joints that are read, and their positions in samples.
#[derive(Clone, Debug, Default)]
pub(crate) struct Joints {
    /// The names of the joints in the log, in the wanted order.
    pub(crate) names: Vec<String>,
    /// The names in the last sample, which of the joints it has, and their indices; no indices if it lacks a joint.
    last: Vec<String>,
    presence: Presence,
    places: Option<Vec<usize>>,
}

/// Whether a sample has all of the joints, some, or none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Presence {
    All,
    Some,
    #[default]
    None,
}

impl Joints {
    /// Finds the joints to read by the first samples of a log: the wanted ones, or those of the log.
    pub(crate) fn of(path: &Path, samples: &[Sample], wanted: Option<&[String]>) -> Result<Self, LogError> {
        let has_positions = |sample: &&Sample| !sample.names.is_empty() && sample.position.len() == sample.names.len();
        let Some(wanted) = wanted else {
            let first = samples.iter().find(has_positions).or(samples.iter().find(|sample| !sample.names.is_empty()));
            let names = first.map(|sample| sample.names.clone()).unwrap_or_default();
            if let Some(twice) = twice(&names) {
                return Err(LogError::file(path, format_args!("the log has the joint {twice} twice in one message")));
            }
            return Ok(Self { names: by_number(names), ..Self::default() });
        };
        if let Some(twice) = twice(wanted).filter(|name| !name.trim().is_empty()) {
            return Err(LogError::request(path, format_args!("the list of joints names {twice} twice")));
        }
        let there = names(samples);
        let known: HashSet<&String> = there.iter().collect();
        let missing: Vec<&String> = wanted.iter().filter(|name| !known.contains(name)).collect();
        let Some(first) = missing.first() else {
            let joints = Self { names: wanted.to_vec(), ..Self::default() };
            let mut found = joints.clone();
            if samples.iter().all(|sample| found.find(sample) != Presence::All) {
                let what = "the joints that you named are in different messages, and no message has all of them";
                return Err(LogError::file(path, what));
            }
            return Ok(joints);
        };
        if first.trim().is_empty() {
            let all = listed(&there);
            let error =
                LogError::request(path, format_args!("a name of a joint is empty; the joints of the log are {all}"));
            return Err(error.give(Setting::Joints(Vec::new())));
        }
        let near = instead(first, &there);
        let all = listed(&there);
        let missing = listed(missing);
        let error = LogError::request(path, format_args!("the log has no joint {missing}{near}; its joints are {all}"));
        Err(error.give(Setting::Joints(Vec::new())))
    }

    /// Returns the joints of the log that are not read.
    pub(crate) fn others(&self, samples: &[Sample]) -> Vec<String> {
        let own: HashSet<&String> = self.names.iter().collect();
        names(samples).into_iter().filter(|name| !own.contains(name)).collect()
    }

    /// Finds the joints in a sample.
    pub(crate) fn find(&mut self, sample: &Sample) -> Presence {
        if sample.names == self.last {
            return self.presence;
        }
        self.last.clone_from(&sample.names);
        work::add(sample.names.len() + self.names.len());
        let mut places: HashMap<&str, usize> = HashMap::with_capacity(sample.names.len());
        for (place, name) in sample.names.iter().enumerate() {
            places.entry(name).or_insert(place);
        }
        let found: Vec<usize> = self.names.iter().filter_map(|name| places.get(name.as_str()).copied()).collect();
        self.presence = match found.len() {
            count if count == self.names.len() => Presence::All,
            0 => Presence::None,
            _ => Presence::Some,
        };
        self.places = (self.presence == Presence::All).then_some(found);
        self.presence
    }

    /// Whether there is a number for each joint of a sample, finite for those that were found.
    pub(crate) fn are_whole(&self, numbers: &[f64], sample: &Sample) -> bool {
        let is_finite = |place: &usize| numbers.get(*place).is_some_and(|number| number.is_finite());
        numbers.len() == sample.names.len() && self.places.as_ref().is_some_and(|places| places.iter().all(is_finite))
    }

    /// Appends the numbers of the joints that were found to `row`, multiplied by a factor for each joint.
    pub(crate) fn take(&self, numbers: &[f64], factor: impl Fn(usize) -> f64, row: &mut Vec<f64>) {
        for (joint, place) in self.places.iter().flatten().enumerate() {
            row.push(numbers.get(*place).copied().unwrap_or(f64::NAN) * factor(joint));
        }
    }
}

/// Sorts names that are one word with different numbers by these numbers, because some programs sort `joint_10` before
/// `joint_2`. Other names keep their order.
fn by_number(mut names: Vec<String>) -> Vec<String> {
    fn parts(name: &str) -> Option<(&str, u32)> {
        let word = name.trim_end_matches(|c: char| c.is_ascii_digit());
        Some((word, name[word.len()..].parse().ok()?))
    }
    let words: Option<Vec<&str>> = names.iter().map(|name| Some(parts(name)?.0)).collect();
    if words.is_some_and(|words| words.windows(2).all(|pair| pair[0] == pair[1])) {
        names.sort_by_key(|name| parts(name).map(|(_, number)| number));
    }
    names
}

fn twice(names: &[String]) -> Option<&String> {
    work::add(names.len());
    let mut seen = HashSet::with_capacity(names.len());
    names.iter().find(|name| !seen.insert(*name))
}

/// Returns the names of all joints in samples, in the order of their first occurrence.
fn names(samples: &[Sample]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let mut seen: HashSet<&str> = HashSet::new();
    let mut last: &[String] = &[];
    for sample in samples {
        if sample.names == last {
            continue;
        }
        last = &sample.names;
        work::add(sample.names.len());
        for name in &sample.names {
            if seen.insert(name) {
                names.push(name.clone());
            }
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns seventy messages, each with two joints that all have and with other joints of its own.
    fn samples(count: usize) -> Vec<Sample> {
        let values = |message: usize| {
            let others = (0..count).map(|joint| format!("other_{message}_{joint}"));
            let names: Vec<String> = others.chain(["a".to_owned(), "b".to_owned()]).collect();
            Sample { position: vec![0.0; names.len()], names, ..Sample::default() }
        };
        (0..70).map(values).collect()
    }

    fn survey(samples: &[Sample]) -> usize {
        let wanted = ["b".to_owned(), "a".to_owned()];
        let mut joints = Joints::of(Path::new("bag.mcap"), samples, Some(&wanted)).unwrap();
        assert!(samples.iter().all(|sample| joints.find(sample) == Presence::All));
        assert_eq!(joints.places.as_ref().unwrap()[1] + 1, joints.places.as_ref().unwrap()[0]);
        joints.others(samples).len()
    }

    #[test]
    fn the_work_on_names_grows_as_they_do() {
        let work = [200, 400].map(|count| {
            let samples = samples(count);
            work::of(|| assert_eq!(survey(&samples), 70 * count))
        });
        // a few steps for each name, and twice as many for twice as many names
        assert!(work[0] > 70 * 200 && work[0] < 70 * 203 * 6, "{work:?}");
        assert!(work[1] < 2 * work[0], "{work:?}");
    }

    #[test]
    fn a_sample_has_all_some_or_none_of_the_joints() {
        let mut joints = Joints { names: vec!["a".into(), "b".into()], ..Joints::default() };
        let sample = |names: &[&str]| Sample {
            names: names.iter().map(|name| (*name).to_owned()).collect(),
            ..Sample::default()
        };
        for (names, wanted, places) in [
            (&[][..], Presence::None, None),
            (&["c", "b", "a", "b"], Presence::All, Some(vec![2, 1])),
            (&["c"], Presence::None, None),
            (&["b"], Presence::Some, None),
        ] {
            assert_eq!((joints.find(&sample(names)), &joints.places), (wanted, &places), "{names:?}");
        }
    }
}
