//! Estimates the noise of the momentum observer: its external torques while nothing touches the arm.

use std::ops::Range;

use rne_logs::median;

use super::contacts;
use crate::{Settings, Signals, WatchError};

/// The factor by which standard deviations are raised in each step.
const RAISE: f64 = 1.1;

/// Number of standard deviations as which the largest error of a model in a quiet log counts.
const BOUND: f64 = 3.0;

/// Smallest number of samples from which noise is estimated.
const FEWEST: usize = 20;

/// An autocorrelation below this counts as zero.
const FORGOTTEN: f64 = 0.05;

/// Time in which the error of a model hardly changes, s.
const HALF: f64 = 0.1;

/// The median of the square of a normal number with standard deviation 1.
const MEDIAN: f64 = 0.4549;

/// Largest number of samples from which an autocorrelation is computed.
const LONGEST: usize = 20_000;

/// Smallest standard deviation, as a part of the model's torques, because of rounding.
const LEAST: f64 = 1e-6;

/// The noise of the momentum observer for one joint, and the error of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointNoise {
    /// The median of the observer's torque, N m or N.
    pub mean: f64,
    /// The standard deviation of the observer's torque in typical motion, N m or N.
    pub deviation: f64,
    /// The standard deviation of the model's error, as a part of its [terms](Signals::terms).
    pub part: f64,
    /// The median of the terms, N m or N.
    pub terms: f64,
    /// The median of the [inertia](Signals::inertia), kg m² or kg: the effect of velocity noise grows with it.
    pub inertia: f64,
}

impl JointNoise {
    /// Returns the standard deviation of the observer's torque at a sample. Noise and errors of the model are
    /// independent, so their squares are added.
    pub(crate) fn deviation_at(&self, terms: f64, inertia: f64) -> f64 {
        let larger = if self.inertia > 0.0 { (inertia / self.inertia).max(1.0) } else { 1.0 };
        let noise = self.deviation * larger;
        let more = (terms * terms - self.terms * self.terms).max(0.0);
        (noise * noise + self.part * self.part * more).sqrt()
    }
}

/// The noise of the momentum observer for every joint, base to tip.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactNoise {
    /// The noise of each joint.
    pub joints: Vec<JointNoise>,
}

impl ContactNoise {
    /// Estimates the noise in a segment of signals, which is given by its samples.
    ///
    /// It uses medians and median deviations, which a short knock does not change. A standard deviation is raised by
    /// two of its own standard errors, so that a short segment gives cautious thresholds.
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
            // neighbouring samples are correlated, so the number of independent samples is smaller
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

    /// Returns the medians over several segments, which a few disturbed segments do not change. `None` if there are no
    /// segments.
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

    /// Returns a noise that covers several undisturbed segments: its standard deviation includes the means and
    /// deviations of all of them. `None` if there are no segments.
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

    /// Multiplies the standard deviations of the observer by `noise`, and those of the model's error by `model`.
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

    /// Raises the noise by an undisturbed segment. The largest error of the model there counts as three standard
    /// deviations. If a contact is still found there, the standard deviations of its joints are raised until none is
    /// found, because errors of a model are not normally distributed.
    ///
    /// # Errors
    /// The errors of [`contacts`].
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

    /// Makes the noise from known standard deviations, N m or N, for a model without errors.
    #[must_use]
    pub fn white(deviations: &[f64]) -> Self {
        let joints = deviations.iter().map(|&deviation| JointNoise { deviation, ..JointNoise::default() });
        Self { joints: joints.collect() }
    }
}

/// Returns the samples and residuals of a joint where friction is certain.
fn known(signals: &Signals, joint: usize, samples: Range<usize>) -> Vec<(usize, f64)> {
    let (residual, creeps) = (&signals.residual[joint], &signals.creeps[joint]);
    samples.filter(|&at| !creeps[at]).map(|at| (at, residual[at])).collect()
}

/// The errors of a model's torque, relative to its terms.
struct WrongParts {
    /// Squared relative errors in increasing order, one for each short segment, in which the model's error hardly
    /// changes. Each is the product of the mean residuals of the segment's halves, whose noise is independent: with
    /// noise only, half of the products are negative.
    squares: Vec<f64>,
    /// Number of independent segments.
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

    /// Returns a percentile of the squares, less the part that noise adds.
    fn square(&self, percent: usize) -> f64 {
        let Some(last) = self.squares.len().checked_sub(1) else { return 0.0 };
        let at = last * percent / 100;
        (self.squares[at] + self.squares[last - at].min(0.0)).max(0.0)
    }

    /// Returns the standard deviation, from the median, which disturbances in less than half of the time hardly change;
    /// it is raised by two of its own standard errors.
    fn deviation(&self) -> f64 {
        if self.squares.len() < FEWEST {
            return 0.0;
        }
        #[allow(clippy::cast_precision_loss)] // a length of a list
        let error = 1.167 / (self.alone.max(1) as f64).sqrt();
        (self.square(50) / MEDIAN).sqrt() * (1.0 + 2.0 * error)
    }

    /// Returns the largest relative error, except for the largest hundredth.
    fn largest(&self) -> f64 {
        self.square(99).sqrt()
    }
}

/// Returns the median, and a standard deviation from the median deviation, raised by two of its standard errors for
/// this number of `independent` numbers.
fn spread(numbers: &[f64], independent: usize, least: f64) -> (f64, f64) {
    let mean = median(numbers.to_vec());
    let deviation = 1.4826 * median(numbers.iter().map(|x| (x - mean).abs()).collect());
    #[allow(clippy::cast_precision_loss)] // a length of a list
    let error = 1.167 / (independent.max(1) as f64).sqrt();
    (mean, (deviation * (1.0 + 2.0 * error)).max(least))
}

/// Returns the number of samples over which noise is correlated: 1 + 2 Σ ρ, over the lags until the correlation ρ is
/// negligible.
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
