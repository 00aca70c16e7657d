//! Efforts that no arm has had: a sample or two that stand far out of those about them.
//!
//! An effort is held against the median of five about it, which a step does not move and a spike of two samples does
//! not either (F. R. Hampel, The influence curve and its role in robust estimation, JASA 69, 1974). It is a spike where
//! it is off by far more than efforts are elsewhere in the log, and by more than the joint takes but for one of a
//! hundred samples: what a sensor says that fails more often than that stays.
//!
//! A low-pass spreads a spike over all that it reaches, where it looks like a push of some length. So spikes are found
//! in what was measured, before any filter.

use std::collections::{BTreeMap, VecDeque};

/// Samples whose median a sample is compared with, and those on one side of it.
const WINDOW: usize = 5;
const SIDE: usize = 2;

/// A spike differs from the median by this factor more than nine of ten samples do.
const FAR: f64 = 30.0;

/// Candidates that are kept while the log is read: of a joint, and of all.
const KEPT: usize = 10_000;
const KEPT_OF_ALL: usize = 1 << 20;

/// Spikes are rare: where more than this part of the states has one, efforts are so.
const RARE: f64 = 0.02;

/// Bins of a histogram in each octave, and the least octave: what is smaller is the same to any arm.
const BINS: f64 = 8.0;
const LEAST_OCTAVE: f64 = -128.0;

/// An effort that stands far out of those about it, for a sample or two.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Spike {
    /// The number of its message or row, from 1, header and comments not counted.
    pub message: u64,
    /// s
    pub time: f64,
    /// Its place among the joints that are read, from 0.
    pub joint: usize,
    /// N m or N
    pub effort: f64,
}

/// How often numbers of each size were there, to an eighth of an octave: memory does not grow.
#[derive(Default)]
struct Histogram {
    bins: BTreeMap<i32, u64>,
    count: u64,
}

impl Histogram {
    /// Adds a size; zero is ignored.
    #[expect(clippy::cast_possible_truncation, reason = "exponents of numbers, by eight")]
    fn push(&mut self, size: f64) {
        if size > 0.0 {
            *self.bins.entry((size.log2().max(LEAST_OCTAVE) * BINS).floor() as i32).or_default() += 1;
            self.count += 1;
        }
    }

    /// The size that this part of all sizes does not exceed; `None` without sizes.
    #[expect(clippy::cast_precision_loss, reason = "a part of states")]
    fn quantile(&self, part: f64) -> Option<f64> {
        let mut below = 0;
        let bin = self.bins.iter().find(|(_, count)| {
            below += **count;
            below as f64 >= part * self.count as f64
        });
        bin.map(|(bin, _)| (f64::from(bin + 1) / BINS).exp2())
    }
}

#[derive(Clone, Copy)]
struct Sample {
    message: u64,
    time: f64,
    effort: f64,
}

/// One joint.
#[derive(Default)]
struct Joint {
    near: VecDeque<Sample>,
    /// Whether the window has moved on since the run began.
    has_begun: bool,
    sizes: Histogram,
    distances: Histogram,
    /// The farthest samples, with their distances.
    candidates: Vec<(f64, Sample)>,
    /// How many of them are kept, and the distance of the nearest: what is nearer is no candidate any more.
    kept: usize,
    least: f64,
}

impl Joint {
    fn push(&mut self, sample: Sample) {
        self.sizes.push(sample.effort.abs());
        if self.near.len() == WINDOW {
            self.near.pop_front();
        }
        self.near.push_back(sample);
        if self.near.len() == WINDOW {
            let from = if self.has_begun { SIDE } else { 0 };
            self.look(from..=SIDE);
            self.has_begun = true;
        }
    }

    fn end_run(&mut self) {
        if self.has_begun {
            self.look(SIDE + 1..=WINDOW - 1);
        }
        self.near.clear();
        self.has_begun = false;
    }

    /// Holds samples of the window against its median.
    fn look(&mut self, places: std::ops::RangeInclusive<usize>) {
        let mut efforts: Vec<f64> = self.near.iter().map(|sample| sample.effort).collect();
        efforts.sort_by(f64::total_cmp);
        let median = efforts[SIDE];
        for place in places {
            let sample = self.near[place];
            let distance = (sample.effort - median).abs();
            self.distances.push(distance);
            if distance > self.least {
                self.candidates.push((distance, sample));
            }
        }
        if self.candidates.len() >= 2 * self.kept {
            self.candidates.sort_by(|a, b| b.0.total_cmp(&a.0));
            self.candidates.truncate(self.kept);
            self.least = self.candidates.last().map_or(0.0, |last| last.0);
        }
    }

    fn spikes(&self) -> impl Iterator<Item = Sample> {
        let usual = self.distances.quantile(0.9).zip(self.sizes.quantile(0.99));
        let least = usual.map_or(f64::INFINITY, |(distance, size)| (FAR * distance).max(size));
        self.candidates.iter().filter(move |(distance, _)| *distance > least).map(|(_, sample)| *sample)
    }
}

/// The spikes of a log that passes by, by joint.
pub(crate) struct Spikes {
    joints: Vec<Joint>,
}

impl Spikes {
    pub(crate) fn new(joints: usize) -> Self {
        let kept = KEPT.min(KEPT_OF_ALL / joints.max(1));
        Self { joints: (0..joints).map(|_| Joint { kept, ..Joint::default() }).collect() }
    }

    /// Takes the efforts of a state.
    pub(crate) fn push(&mut self, message: u64, time: f64, efforts: &[f64]) {
        for (joint, effort) in self.joints.iter_mut().zip(efforts) {
            joint.push(Sample { message, time, effort: *effort });
        }
    }

    pub(crate) fn end_run(&mut self) {
        self.joints.iter_mut().for_each(Joint::end_run);
    }

    /// The spikes, in the order of their messages; empty if they are not rare among the states.
    #[expect(clippy::cast_precision_loss, reason = "states of a log")]
    pub(crate) fn end(mut self, states: u64) -> Vec<Spike> {
        self.end_run();
        let of_joint = |(at, joint): (usize, &Joint)| -> Vec<Spike> {
            let spike = |Sample { message, time, effort }| Spike { message, time, joint: at, effort };
            let spikes: Vec<Spike> = joint.spikes().map(spike).collect();
            if spikes.len() as f64 > 1.0 + RARE * states as f64 { Vec::new() } else { spikes }
        };
        let mut spikes: Vec<Spike> = self.joints.iter().enumerate().flat_map(of_joint).collect();
        spikes.sort_by_key(|spike| (spike.message, spike.joint));
        spikes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(efforts: &[f64]) -> Vec<(u64, f64)> {
        let mut spikes = Spikes::new(1);
        for (message, effort) in (1..).zip(efforts) {
            spikes.push(message, 0.0, &[*effort]);
        }
        let spikes = spikes.end(efforts.len() as u64);
        spikes.iter().map(|spike| (spike.message, spike.effort)).collect()
    }

    fn wave() -> Vec<f64> {
        let mut random = fastrand::Rng::with_seed(4);
        // with the step that friction makes where a joint turns
        let at = |i: u32| {
            let phase = 0.1 * f64::from(i);
            5.0 * phase.sin() + phase.cos().signum() + 0.1 * (random.f64() - 0.5)
        };
        (0..400).map(at).collect()
    }

    #[test]
    fn one_or_two_samples_far_out_are_spikes() {
        assert_eq!(found(&wave()), []);
        for at in [0, 1, 7, 200, 398, 399] {
            let mut efforts = wave();
            efforts[at] = -1e4;
            assert_eq!(found(&efforts), [(at as u64 + 1, -1e4)]);
            let next = if at == 399 { 398 } else { at + 1 };
            efforts[next] = 40.0;
            assert_eq!(found(&efforts).len(), 2, "{at}");
        }
    }

    #[test]
    fn what_lasts_and_what_is_usual_is_none() {
        // a payload, a push of three samples, pulses of a gripper, an arm that stands still
        let mut efforts = wave();
        efforts[250..].iter_mut().for_each(|effort| *effort += 100.0);
        assert_eq!(found(&efforts), []);
        let mut efforts = wave();
        efforts[100..103].iter_mut().for_each(|effort| *effort += 60.0);
        assert_eq!(found(&efforts), []);
        let mut efforts = wave();
        efforts.iter_mut().step_by(9).for_each(|effort| *effort += 60.0);
        assert_eq!(found(&efforts), []);
        assert_eq!(found(&[3.0; 50]), []);
        assert_eq!(found(&[]), []);
        assert_eq!(found(&[1.0, 1e9, 1.0]), []);
    }
}
