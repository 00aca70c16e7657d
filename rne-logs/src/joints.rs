//! Joints of a log by the names that were asked for.

use std::path::Path;

use crate::LogError;
use crate::sample::Sample;
use crate::spelling::{instead, listed};

/// Where the joints stand in samples.
#[derive(Clone, Debug, Default)]
pub(crate) struct Joints {
    /// By the log's names, in the order of what is asked for.
    pub(crate) names: Vec<String>,
    /// The names of the last sample, and where the joints stand in it; none if it does not have them all.
    last: Vec<String>,
    places: Option<Vec<usize>>,
}

/// Whether a sample has the joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Presence {
    All,
    Some,
    None,
}

impl Joints {
    /// The joints of samples, the first of a log: those asked for, or the log's.
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
            return Err(LogError::request(path, format_args!("the joint {twice} is asked for twice")));
        }
        let there = names(samples);
        let missing: Vec<&String> = wanted.iter().filter(|name| !there.contains(name)).collect();
        let Some(first) = missing.first() else {
            let joints = Self { names: wanted.to_vec(), ..Self::default() };
            let together = samples.iter().any(|sample| wanted.iter().all(|name| sample.names.contains(name)));
            if !together {
                let what = "the joints that are asked for are in different messages, of which none has all";
                return Err(LogError::file(path, what));
            }
            return Ok(joints);
        };
        if first.trim().is_empty() {
            let all = listed(there.iter().map(String::as_str));
            let what =
                format!("a name of --joints is empty; the log has {all}, and base to tip they are --joints A,B,…");
            return Err(LogError::request(path, what));
        }
        let near = instead(first, there.iter().map(String::as_str));
        let all = listed(there.iter().map(String::as_str));
        let missing = listed(missing.iter().map(|name| name.as_str()));
        Err(LogError::request(
            path,
            format_args!(
                "the log has no joint {missing}{near}; it has {all}; --joints names those that are meant, base to tip"
            ),
        ))
    }

    /// The joints of the log that are none of these.
    pub(crate) fn others(&self, samples: &[Sample]) -> Vec<String> {
        names(samples).into_iter().filter(|name| !self.names.contains(name)).collect()
    }

    /// Finds the joints in a sample.
    pub(crate) fn find(&mut self, sample: &Sample) -> Presence {
        if sample.names != self.last || self.places.is_none() {
            self.last.clone_from(&sample.names);
            let place = |name: &String| sample.names.iter().position(|other| other == name);
            self.places = self.names.iter().map(place).collect();
        }
        if self.places.is_some() {
            Presence::All
        } else if self.names.iter().any(|name| sample.names.contains(name)) {
            Presence::Some
        } else {
            Presence::None
        }
    }

    /// Whether there is a number for each joint of a sample, finite for those that were found.
    pub(crate) fn are_whole(&self, numbers: &[f64], sample: &Sample) -> bool {
        let is_finite = |place: &usize| numbers.get(*place).is_some_and(|number| number.is_finite());
        numbers.len() == sample.names.len() && self.places.as_ref().is_some_and(|places| places.iter().all(is_finite))
    }

    /// The numbers of the joints that were found, appended.
    pub(crate) fn take(&self, numbers: &[f64], factor: impl Fn(usize) -> f64, row: &mut Vec<f64>) {
        for (joint, place) in self.places.iter().flatten().enumerate() {
            row.push(numbers.get(*place).copied().unwrap_or(f64::NAN) * factor(joint));
        }
    }
}

/// Names that are one word and different numbers, in the order of these: what sorts names puts `joint_10` before
/// `joint_2`. Others as they are.
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
    names.iter().enumerate().find(|(place, name)| names[..*place].contains(name)).map(|(_, name)| name)
}

/// Every joint of samples, in the order of their first mention.
fn names(samples: &[Sample]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let mut last: &[String] = &[];
    for sample in samples {
        if sample.names == last {
            continue;
        }
        last = &sample.names;
        for name in &sample.names {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
    }
    names
}
