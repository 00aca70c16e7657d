//! Finds spikes of efforts: one or two samples that differ so strongly from their neighbours that no arm can have had
//! these efforts.
//!
//! An effort is compared with the median of the five samples around it, which a step does not change, nor a spike of
//! two samples (F. R. Hampel, The influence curve and its role in robust estimation, JASA 69, 1974). It is a spike if
//! it differs by far more than other efforts of the log do, and by more than the joint's effort in 99 of 100 samples.
//! So a sensor that fails more often than that has no spikes.
//!
//! A low-pass filter spreads a spike over the length of its kernel, so that it looks like a push. So spikes are
//! searched in the measured efforts, before any filter.

use std::collections::{BTreeMap, VecDeque};

/// Number of samples of the median, and number of samples on each side of the middle one.
const WINDOW: usize = 5;
const SIDE: usize = 2;

/// Smallest ratio of the distance of a spike from the median to the distance that nine of ten samples do not exceed.
const FAR: f64 = 30.0;

/// Largest number of candidates that are kept while the log is read: for each joint, and for all joints.
const KEPT: usize = 10_000;
const KEPT_OF_ALL: usize = 1 << 20;

/// Largest part of the states that may have a spike. If more have one, it is normal for these efforts, and there are no
/// spikes.
const RARE: f64 = 0.02;

/// Number of bins of a histogram in each octave, and the lowest octave, which also counts all smaller numbers.
const BINS: f64 = 8.0;
const LEAST_OCTAVE: f64 = -128.0;

/// An effort of one or two samples that differs strongly from the samples before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Spike {
    /// The number of the message or row, from 1, header and comments not counted.
    pub message: u64,
    /// Time, s.
    pub time: f64,
    /// Index of the joint among those that are read, from 0.
    pub joint: usize,
    /// The effort, N m or N.
    pub effort: f64,
}

/// Counts numbers by their size, with a resolution of an eighth of an octave, so that memory is bounded.
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

    /// Returns the size that this part of all numbers does not exceed; `None` without numbers.
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

/// The search for spikes of one joint.
#[derive(Default)]
struct Joint {
    near: VecDeque<Sample>,
    /// Whether the window has been full since the run began.
    has_begun: bool,
    sizes: Histogram,
    distances: Histogram,
    /// The samples with the largest distances from the median, with these distances.
    candidates: Vec<(f64, Sample)>,
    /// Number of candidates that are kept, and the smallest distance among them. Samples with smaller distances are no
    /// longer added.
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

    /// Compares samples of the window with its median.
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

/// Finds the spikes of each joint while a log is read.
pub(crate) struct Spikes {
    joints: Vec<Joint>,
}

impl Spikes {
    pub(crate) fn new(joints: usize) -> Self {
        let kept = KEPT.min(KEPT_OF_ALL / joints.max(1));
        Self { joints: (0..joints).map(|_| Joint { kept, ..Joint::default() }).collect() }
    }

    /// Adds the efforts of a state.
    pub(crate) fn push(&mut self, message: u64, time: f64, efforts: &[f64]) {
        for (joint, effort) in self.joints.iter_mut().zip(efforts) {
            joint.push(Sample { message, time, effort: *effort });
        }
    }

    pub(crate) fn end_run(&mut self) {
        self.joints.iter_mut().for_each(Joint::end_run);
    }

    /// Returns the spikes in the order of their messages; empty if they are not rare among the states.
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
        // with the step of friction where a joint reverses
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
        // no spikes: a payload, a push of three samples, pulses of a gripper, an arm at rest
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
