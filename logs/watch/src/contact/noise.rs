//! The magnitude of the observer's external torques while nothing touches the arm.

use std::ops::Range;

use rne_logs::median;

use super::contacts;
use crate::{Settings, Signals, WatchError};

/// The factor by which deviations are raised at a time.
const RAISE: f64 = 1.1;

/// The largest error of a model in a quiet log counts as this many deviations.
const BOUND: f64 = 3.0;

/// Minimum number of samples that noise is estimated from.
const FEWEST: usize = 20;

/// An autocorrelation below this counts as zero.
const FORGOTTEN: f64 = 0.05;

/// s: in such a time the error of a model does not change.
const HALF: f64 = 0.1;

/// The median of the square of a normal number of deviation 1.
const MEDIAN: f64 = 0.4549;

/// Products of an autocorrelation are counted up to here.
const LONGEST: usize = 20_000;

/// The parts of the model's torques that no deviation is below: what rounding and its relatives leave.
const LEAST: f64 = 1e-6;

/// The noise of the observer of one joint, and the error of its model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointNoise {
    /// The median of the observer's torque, N m or N.
    pub mean: f64,
    /// Its standard deviation where the motion is as usual, N m or N.
    pub deviation: f64,
    /// The deviation of the model's error, as a part of its [terms](Signals::terms).
    pub part: f64,
    /// The median of the terms, N m or N.
    pub terms: f64,
    /// The median of the [inertia](Signals::inertia), kg m² or kg: noise of the velocities grows with it.
    pub inertia: f64,
}

impl JointNoise {
    /// The deviation of the observer at a sample. Noise and errors of the model are independent: their squares add up.
    pub(crate) fn deviation_at(&self, terms: f64, inertia: f64) -> f64 {
        let larger = if self.inertia > 0.0 { (inertia / self.inertia).max(1.0) } else { 1.0 };
        let noise = self.deviation * larger;
        let more = (terms * terms - self.terms * self.terms).max(0.0);
        (noise * noise + self.part * self.part * more).sqrt()
    }
}

/// The noise of the observer of every joint, base to tip.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactNoise {
    /// One per joint.
    pub joints: Vec<JointNoise>,
}

impl ContactNoise {
    /// The noise in a segment of signals, in samples.
    ///
    /// Medians and median deviations are taken, which a knock does not change; a deviation is raised by two of its own
    /// standard errors, so that a short segment makes cautious thresholds.
    ///
    /// # Errors
    /// When the segment is too short.
    pub fn of(signals: &Signals, quiet: Range<usize>) -> Result<Self, WatchError> {
        let quiet = quiet.start.min(signals.time.len())..quiet.end.min(signals.time.len());
        let of_joint = |joint: usize| -> Result<JointNoise, WatchError> {
            let torques = signals.measured[joint].iter().chain(&signals.residual[joint]);
            let least = LEAST * torques.fold(0.0_f64, |most, tau| most.max(tau.abs()));
            let settled: Vec<usize> = quiet.clone().filter(|&at| signals.settled[at]).collect();
            if settled.len() < FEWEST {
                return Err(WatchError::TooFew { found: settled.len(), needed: FEWEST });
            }
            let sure: Vec<usize> = settled.iter().copied().filter(|&at| signals.open[joint][at] == 0.0).collect();
            let seen = if sure.len() < FEWEST { settled } else { sure };
            let seen: Vec<f64> = seen.into_iter().map(|at| signals.external[joint][at]).collect();
            // neighbours depend on each other: fewer numbers determine the deviation
            let alone = seen.len() / remembered(&seen).max(1);
            let (mean, deviation) = spread(&seen, alone, least.max(f64::MIN_POSITIVE));
            let usual = |lists: &[Vec<f64>]| median(lists[joint][quiet.clone()].to_vec());
            Ok(JointNoise {
                mean,
                deviation,
                part: WrongParts::new(signals, joint, quiet.clone()).deviation(),
                terms: usual(&signals.terms),
                inertia: usual(&signals.inertia),
            })
        };
        Ok(Self { joints: (0..signals.dof()).map(of_joint).collect::<Result<_, _>>()? })
    }

    /// The medians of several segments, which a segment in which something happens does not change. `None` when there
    /// are no segments.
    #[must_use]
    pub fn typical(segments: &[Self]) -> Option<Self> {
        Self::by_joint(segments, |all| {
            let median_of = |each: fn(&JointNoise) -> f64| median(all.iter().map(each).collect());
            JointNoise {
                mean: median_of(|joint| joint.mean),
                deviation: median_of(|joint| joint.deviation),
                part: median_of(|joint| joint.part),
                terms: median_of(|joint| joint.terms),
                inertia: median_of(|joint| joint.inertia),
            }
        })
    }

    /// The noise that covers several segments in which nothing happens: the means of all of them are within its
    /// deviation, and no deviation is larger. `None` when there are no segments.
    #[must_use]
    pub fn covering(segments: &[Self]) -> Option<Self> {
        Self::by_joint(segments, |all| {
            let most = |of: fn(&JointNoise) -> f64| all.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
            let (low, high) = (-most(|of| -of.mean), most(|of| of.mean));
            JointNoise {
                mean: 0.5 * (low + high),
                deviation: most(|of| of.deviation) + 0.5 * (high - low),
                part: most(|of| of.part),
                terms: -most(|of| -of.terms),
                inertia: -most(|of| -of.inertia),
            }
        })
    }

    /// Multiplies the deviations of the observer, and of the model's error.
    #[must_use]
    pub fn widened(mut self, noise: f64, model: f64) -> Self {
        for joint in &mut self.joints {
            joint.deviation *= noise;
            joint.part *= model;
        }
        self
    }

    fn by_joint(segments: &[Self], one: impl Fn(&[JointNoise]) -> JointNoise) -> Option<Self> {
        let dof = segments.iter().map(|segment| segment.joints.len()).min()?;
        let joint_noise = |joint: usize| one(&segments.iter().map(|segment| segment.joints[joint]).collect::<Vec<_>>());
        Some(Self { joints: (0..dof).map(joint_noise).collect() })
    }

    /// Takes the largest error of the model in a segment in which nothing happens for three of its deviations, and
    /// raises the deviations of what would be a contact there, until nothing is: a model's errors are no normal noise.
    ///
    /// # Errors
    /// Those of [`contacts`].
    pub fn silent(mut self, signals: &Signals, settings: &Settings) -> Result<Self, WatchError> {
        for (at, joint) in self.joints.iter_mut().enumerate().take(signals.dof()) {
            let parts = WrongParts::new(signals, at, 0..signals.time.len());
            joint.part = joint.part.max(parts.largest() / BOUND);
        }
        loop {
            let found = contacts(signals, &self, settings)?;
            if found.is_empty() {
                return Ok(self);
            }
            let mut raised: Vec<usize> = found.iter().map(|contact| contact.joint).collect();
            raised.sort_unstable();
            raised.dedup();
            for joint in raised {
                self.joints[joint].deviation *= RAISE;
                self.joints[joint].part *= RAISE;
            }
        }
    }

    /// The noise of standard deviations that are known, N m or N, with a model that has no error.
    #[must_use]
    pub fn white(deviations: &[f64]) -> Self {
        let joints = deviations.iter().map(|&deviation| JointNoise { deviation, ..JointNoise::default() });
        Self { joints: joints.collect() }
    }
}

/// The residual of a joint where friction leaves nothing open, with the samples.
fn known(signals: &Signals, joint: usize, samples: Range<usize>) -> Vec<(usize, f64)> {
    let (residual, creeps) = (&signals.residual[joint], &signals.creeps[joint]);
    samples.filter(|&at| !creeps[at]).map(|at| (at, residual[at])).collect()
}

/// The relative errors of a model's terms.
struct WrongParts {
    /// Squares, growing: of means of the residual over segments that are so short that the model's error does not
    /// change. Each is the product of its two halves, whose noise is not the same: of noise alone half are negative.
    squares: Vec<f64>,
    /// Number of blocks that are independent of each other.
    alone: usize,
}

impl WrongParts {
    fn new(signals: &Signals, joint: usize, samples: Range<usize>) -> Self {
        let known = known(signals, joint, samples);
        let mean = if known.is_empty() { 0.0 } else { median(known.iter().map(|(_, residual)| *residual).collect()) };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it saturates
        let half = ((HALF / signals.period) as usize).max(2);
        let average = |samples: &[(usize, f64)], each: &dyn Fn(&(usize, f64)) -> f64| {
            #[allow(clippy::cast_precision_loss)] // a length of a list
            let count = samples.len() as f64;
            samples.iter().map(each).sum::<f64>() / count
        };
        let (mut squares, mut signed) = (Vec::new(), Vec::new());
        for segment in known.chunks_exact(2 * half) {
            let off = |(_, residual): &(usize, f64)| residual - mean;
            let (a, b) = (average(&segment[..half], &off), average(&segment[half..], &off));
            let terms = average(segment, &|(at, _)| signals.terms[joint][*at]);
            if terms > 0.0 {
                squares.push(a * b / (terms * terms));
                signed.push(0.5 * (a + b) / terms);
            }
        }
        squares.sort_unstable_by(f64::total_cmp);
        let alone = squares.len() / remembered(&signed).max(1);
        Self { squares, alone }
    }

    /// A percentile of the squares, less the part that noise adds.
    fn square(&self, percent: usize) -> f64 {
        let Some(last) = self.squares.len().checked_sub(1) else { return 0.0 };
        let at = last * percent / 100;
        (self.squares[at] + self.squares[last - at].min(0.0)).max(0.0)
    }

    /// The deviation, by the median, which what happens for less than half of the time does not change; raised by two
    /// of its own standard errors.
    fn deviation(&self) -> f64 {
        if self.squares.len() < FEWEST {
            return 0.0;
        }
        #[allow(clippy::cast_precision_loss)] // a length of a list
        let error = 1.167 / (self.alone.max(1) as f64).sqrt();
        (self.square(50) / MEDIAN).sqrt() * (1.0 + 2.0 * error)
    }

    /// The largest, but for one in a hundred.
    fn largest(&self) -> f64 {
        self.square(99).sqrt()
    }
}

/// The median, and a standard deviation by the median deviation, of which `independent` numbers tell.
fn spread(numbers: &[f64], independent: usize, least: f64) -> (f64, f64) {
    let mean = median(numbers.to_vec());
    let deviation = 1.4826 * median(numbers.iter().map(|x| (x - mean).abs()).collect());
    #[allow(clippy::cast_precision_loss)] // a length of a list
    let error = 1.167 / (independent.max(1) as f64).sqrt();
    (mean, (deviation * (1.0 + 2.0 * error)).max(least))
}

/// For how many samples noise is correlated: 1 + 2 Σ ρ, over the lags until it is forgotten.
fn remembered(numbers: &[f64]) -> usize {
    let numbers = &numbers[..numbers.len().min(LONGEST)];
    let mean = median(numbers.to_vec());
    let centred: Vec<f64> = numbers.iter().map(|x| x - mean).collect();
    let of_lag = |lag: usize| centred.iter().zip(&centred[lag..]).map(|(a, b)| a * b).sum::<f64>();
    let all = of_lag(0);
    if all <= 0.0 {
        return 1;
    }
    let mut sum = 1.0;
    for lag in 1..numbers.len() / 4 {
        let correlation = of_lag(lag) / all;
        if correlation < FORGOTTEN {
            break;
        }
        sum += 2.0 * correlation;
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // above 1, below the length
    let whole = sum.round() as usize;
    whole
}
