//! How large signals are while nothing happens.

use std::ops::Range;

use rne_logs::median;

use crate::{Settings, Signals, Test, WatchError, watch};

/// By so much deviations are raised at a time.
const RAISE: f64 = 1.1;

/// Of a stretch that tells what noise is: so many blocks at least.
const BLOCKS: usize = 20;

/// An autocorrelation below this is none.
const FORGOTTEN: f64 = 0.05;

/// Products of an autocorrelation are counted up to here.
const LONGEST: usize = 20_000;

/// The parts of the model's torques that no deviation is below: what rounding and its relatives leave.
const LEAST: f64 = 1e-6;

/// A signal while nothing happens, N m or N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Its median.
    pub mean: f64,
    /// The standard deviation of its means over blocks.
    pub deviation: f64,
    /// How long a block is, s; 0 for single samples. Means of blocks that follow each other know nothing of each other.
    pub block: f64,
}

/// The levels of the signals of every joint, base to tip.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Baseline {
    /// Of the residual.
    pub residual: Vec<Level>,
    /// Of the residual in the direction of motion.
    pub friction: Vec<Level>,
    /// Of the observer, sample by sample.
    pub external: Vec<Level>,
}

impl Baseline {
    /// From a quiet stretch of signals, in samples. It ought to be like what will be watched: an arm that stands still
    /// tells nothing of what its model gets wrong in motion.
    ///
    /// Medians and median deviations are taken, which a knock does not change; a deviation is raised by two of its own
    /// standard errors, so that a short stretch makes cautious thresholds.
    ///
    /// # Errors
    /// When the stretch is too short.
    pub fn of(signals: &Signals, quiet: Range<usize>) -> Result<Self, WatchError> {
        let quiet = quiet.start.min(signals.time.len())..quiet.end.min(signals.time.len());
        if quiet.len() < BLOCKS {
            return Err(WatchError::TooFew { found: quiet.len(), needed: BLOCKS });
        }
        let (mut residual, mut friction, mut external) = (Vec::new(), Vec::new(), Vec::new());
        for joint in 0..signals.dof() {
            let torques = signals.measured[joint].iter().chain(&signals.residual[joint]);
            let least = LEAST * torques.fold(0.0_f64, |most, tau| most.max(tau.abs()));
            let least = least.max(f64::MIN_POSITIVE);
            let known = known(signals, joint, quiet.clone());
            let known: Vec<f64> = known.into_iter().map(|(_, number)| number).collect();
            // of an arm that never leaves its place all is known that there is
            let of_residual = if known.len() < BLOCKS { &signals.residual[joint][quiet.clone()] } else { &known };
            let level = level(of_residual, signals.period, least);
            let moving = along_motion(signals, joint, level.mean, quiet.clone());
            let moving: Vec<f64> = moving.into_iter().map(|(_, number)| number).collect();
            // of an arm that stands still: the same noise
            friction.push(if moving.len() < BLOCKS {
                Level { mean: 0.0, ..level }
            } else {
                let found = self::level(&moving, signals.period, least);
                Level { deviation: found.deviation.max(scaled(&level, &found)), ..found }
            });
            residual.push(level);
            let settled: Vec<usize> = quiet.clone().filter(|&at| signals.settled[at]).collect();
            if settled.len() < BLOCKS {
                return Err(WatchError::TooFew { found: settled.len(), needed: BLOCKS });
            }
            let sure: Vec<usize> = settled.iter().copied().filter(|&at| signals.open[joint][at] == 0.0).collect();
            let seen = if sure.len() < BLOCKS { settled } else { sure };
            let seen: Vec<f64> = seen.into_iter().map(|at| signals.external[joint][at]).collect();
            // neighbours know of each other: fewer tell of the deviation
            let alone = seen.len() / remembered(&seen).max(1);
            let (mean, deviation) = spread(&seen, alone, least);
            external.push(Level { mean, deviation, block: 0.0 });
        }
        Ok(Self { residual, friction, external })
    }

    /// What several stretches have in common: the medians of their levels, which a stretch in which something happens
    /// does not change. `None` of none.
    #[must_use]
    pub fn typical(baselines: &[Self]) -> Option<Self> {
        Self::of_levels(baselines, |levels| {
            let of = |each: fn(&Level) -> f64| median(levels.iter().map(each).collect());
            Level {
                mean: of(|level| level.mean),
                deviation: of(|level| level.deviation),
                block: of(|level| level.block),
            }
        })
    }

    /// What covers several stretches in which nothing happens: means of all of them are within its deviation, and no
    /// deviation or block is larger. `None` of none.
    #[must_use]
    pub fn covering(baselines: &[Self]) -> Option<Self> {
        Self::of_levels(baselines, |levels| {
            let most = |of: fn(&Level) -> f64| levels.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
            let (low, high) = (-most(|level| -level.mean), most(|level| level.mean));
            let deviation = most(|level| level.deviation) + 0.5 * (high - low);
            Level { mean: 0.5 * (low + high), deviation, block: most(|level| level.block) }
        })
    }

    /// Deviations that are so many times as large.
    #[must_use]
    pub fn widened(mut self, times: f64) -> Self {
        for level in [&mut self.residual, &mut self.friction, &mut self.external].into_iter().flatten() {
            level.deviation *= times;
        }
        self
    }

    fn of_levels(baselines: &[Self], one: impl Fn(&[Level]) -> Level) -> Option<Self> {
        let dof = baselines.iter().map(|baseline| baseline.residual.len()).min()?;
        let of = |levels: fn(&Self) -> &[Level]| -> Vec<Level> {
            (0..dof).map(|joint| one(&baselines.iter().map(|of| levels(of)[joint]).collect::<Vec<_>>())).collect()
        };
        Some(Self { residual: of(|of| &of.residual), friction: of(|of| &of.friction), external: of(|of| &of.external) })
    }

    /// Raises the deviations of what would be an event in a stretch in which nothing happens, until nothing is: a
    /// model's errors in motion are no noise that is normal.
    ///
    /// # Errors
    /// Those of [`watch`].
    pub fn silent(mut self, signals: &Signals, settings: &Settings) -> Result<Self, WatchError> {
        loop {
            let report = watch(signals, &self, settings)?;
            if report.events.is_empty() {
                return Ok(self);
            }
            let mut raised: Vec<(usize, Test)> = report.events.iter().map(|event| (event.joint, event.test)).collect();
            raised.sort_unstable();
            raised.dedup();
            for (joint, test) in raised {
                let levels = match test {
                    Test::External => &mut self.external,
                    Test::Offset => &mut self.residual,
                    Test::Friction => &mut self.friction,
                };
                levels[joint].deviation *= RAISE;
            }
        }
    }

    /// From standard deviations that are known: of white noise of the measured efforts, and of what the observer makes
    /// of all noise. Lists run from base to tip.
    #[must_use]
    pub fn white(efforts: &[f64], external: &[f64]) -> Self {
        let of = |deviations: &[f64]| -> Vec<Level> {
            let level = |&deviation: &f64| Level { mean: 0.0, deviation, block: 0.0 };
            deviations.iter().map(level).collect()
        };
        Self { residual: of(efforts), friction: of(efforts), external: of(external) }
    }
}

/// The residual of a joint where friction leaves nothing open, with the samples.
pub(crate) fn known(signals: &Signals, joint: usize, samples: Range<usize>) -> Vec<(usize, f64)> {
    let (residual, creeps) = (&signals.residual[joint], &signals.creeps[joint]);
    samples.filter(|&at| !creeps[at]).map(|at| (at, residual[at])).collect()
}

/// The residual of a joint, less its level, in the direction of motion: where it moves, with the samples.
pub(crate) fn along_motion(signals: &Signals, joint: usize, mean: f64, samples: Range<usize>) -> Vec<(usize, f64)> {
    let (residual, direction) = (&signals.residual[joint], &signals.direction[joint]);
    let moving = samples.filter(|&at| direction[at] != 0.0 && !signals.creeps[joint][at]);
    moving.map(|at| (at, (residual[at] - mean) * direction[at])).collect()
}

/// The deviation of a level for blocks of another one: of white noise, it falls with the root of their length.
fn scaled(level: &Level, other: &Level) -> f64 {
    if level.block == 0.0 || other.block == 0.0 {
        return 0.0;
    }
    level.deviation * (level.block / other.block).sqrt()
}

fn level(numbers: &[f64], period: f64, least: f64) -> Level {
    let length = block_length(numbers);
    let means = means(numbers, length);
    let (mean, deviation) = spread(&means, means.len(), least);
    #[allow(clippy::cast_precision_loss)] // a length of a list
    Level { mean, deviation, block: length as f64 * period }
}

/// Samples of a block: several times what the noise remembers, but so few that there are blocks enough.
fn block_length(numbers: &[f64]) -> usize {
    let memory = remembered(numbers);
    let length = if memory <= 1 { 1 } else { 4 * memory };
    length.min(numbers.len() / BLOCKS).max(1)
}

/// Means of blocks of so many; what is left at the end is no block.
pub(crate) fn means(numbers: &[f64], length: usize) -> Vec<f64> {
    #[allow(clippy::cast_precision_loss)] // a length of a list
    numbers.chunks_exact(length.max(1)).map(|block| block.iter().sum::<f64>() / block.len() as f64).collect()
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
