//! Magnitudes of signals while nothing happens.

use std::ops::Range;

use rne_logs::median;

use crate::{Settings, Signals, Test, WatchError, watch};

/// The factor by which deviations are raised at a time.
const RAISE: f64 = 1.1;

/// Deviations of the model's error that are no change of a mean.
pub(crate) const BOUND: f64 = 3.0;

/// Minimum number of blocks in a segment that noise is estimated from.
const BLOCKS: usize = 20;

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

/// A signal while nothing happens, N m or N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseFloor {
    /// Its median.
    pub mean: f64,
    /// The standard deviation of its means over blocks.
    pub deviation: f64,
    /// Length of a block, s; 0 for single samples. Means of blocks that follow each other know nothing of each other.
    pub block: f64,
}

/// How wrong the model of a joint is, and what was usual along the motion of the noise floors: where a motion is not
/// as usual, the floors are others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModelError {
    /// The deviation of its error, as a part of its [terms](Signals::terms): where they are larger the torque is wrong
    /// by more.
    pub part: f64,
    /// The median of the terms, N m or N.
    pub terms: f64,
    /// The median of the [inertia](Signals::inertia), kg m² or kg: where it is larger noise of the velocities is.
    pub inertia: f64,
}

impl ModelError {
    /// The deviation of the observer at a sample, by its deviation where the motion is as usual. Noise and errors of
    /// the model know nothing of each other: their squares add up.
    pub(crate) fn deviation(&self, usual: f64, terms: f64, inertia: f64) -> f64 {
        let noise = if self.inertia > 0.0 { usual * (inertia / self.inertia).max(1.0) } else { usual };
        let more = (terms * terms - self.terms * self.terms).max(0.0);
        (noise * noise + self.part * self.part * more).sqrt()
    }
}

/// The noise floors of the signals of every joint, base to tip.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Baseline {
    /// The noise floor of the residual.
    pub residual: Vec<NoiseFloor>,
    /// The noise floor of the residual in the direction of motion.
    pub friction: Vec<NoiseFloor>,
    /// The noise floor of the observer, sample by sample.
    pub external: Vec<NoiseFloor>,
    /// The error of the model.
    pub model: Vec<ModelError>,
}

impl Baseline {
    /// From a quiet segment of signals, in samples. It ought to be like what will be watched: an arm that stands still
    /// tells nothing of what its model gets wrong in motion.
    ///
    /// Medians and median deviations are taken, which a knock does not change; a deviation is raised by two of its own
    /// standard errors, so that a short segment makes cautious thresholds.
    ///
    /// # Errors
    /// When the segment is too short.
    pub fn of(signals: &Signals, quiet: Range<usize>) -> Result<Self, WatchError> {
        let quiet = quiet.start.min(signals.time.len())..quiet.end.min(signals.time.len());
        if quiet.len() < BLOCKS {
            return Err(WatchError::TooFew { found: quiet.len(), needed: BLOCKS });
        }
        let (mut residual, mut friction, mut external) = (Vec::new(), Vec::new(), Vec::new());
        let mut model = Vec::new();
        for joint in 0..signals.dof() {
            let torques = signals.measured[joint].iter().chain(&signals.residual[joint]);
            let least = LEAST * torques.fold(0.0_f64, |most, tau| most.max(tau.abs()));
            let least = least.max(f64::MIN_POSITIVE);
            let known = known(signals, joint, quiet.clone());
            let known: Vec<f64> = known.into_iter().map(|(_, number)| number).collect();
            // of an arm that never leaves its place all is known that there is
            let of_residual = if known.len() < BLOCKS { &signals.residual[joint][quiet.clone()] } else { &known };
            let floor = noise_floor(of_residual, signals.period, least);
            let moving = along_motion(signals, joint, floor.mean, quiet.clone());
            let moving: Vec<f64> = moving.into_iter().map(|(_, number)| number).collect();
            // of an arm that stands still: the same noise
            friction.push(if moving.len() < BLOCKS {
                NoiseFloor { mean: 0.0, ..floor }
            } else {
                let found = noise_floor(&moving, signals.period, least);
                NoiseFloor { deviation: found.deviation.max(scaled(&floor, &found)), ..found }
            });
            let usual = |lists: &[Vec<f64>]| median(lists[joint][quiet.clone()].to_vec());
            model.push(ModelError {
                part: WrongParts::new(signals, joint, floor.mean, quiet.clone()).deviation(),
                terms: usual(&signals.terms),
                inertia: usual(&signals.inertia),
            });
            residual.push(floor);
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
            external.push(NoiseFloor { mean, deviation, block: 0.0 });
        }
        Ok(Self { residual, friction, external, model })
    }

    /// The medians of several baselines, which a segment in which something happens does not change. `None` when there
    /// are no baselines.
    #[must_use]
    pub fn typical(baselines: &[Self]) -> Option<Self> {
        let of_model = |all: &[ModelError]| {
            let of = |each: fn(&ModelError) -> f64| median(all.iter().map(each).collect());
            ModelError { part: of(|of| of.part), terms: of(|of| of.terms), inertia: of(|of| of.inertia) }
        };
        Self::of_floors(baselines, of_model, |floors| {
            let of = |each: fn(&NoiseFloor) -> f64| median(floors.iter().map(each).collect());
            NoiseFloor {
                mean: of(|floor| floor.mean),
                deviation: of(|floor| floor.deviation),
                block: of(|floor| floor.block),
            }
        })
    }

    /// The baseline that covers several segments in which nothing happens: the means of all of them are within its
    /// deviation, and no deviation or block is larger. `None` when there are no baselines.
    #[must_use]
    pub fn covering(baselines: &[Self]) -> Option<Self> {
        let of_model = |all: &[ModelError]| {
            let least = |of: fn(&ModelError) -> f64| all.iter().map(of).fold(f64::INFINITY, f64::min);
            let part = -least(|of| -of.part);
            ModelError { part, terms: least(|of| of.terms), inertia: least(|of| of.inertia) }
        };
        Self::of_floors(baselines, of_model, |floors| {
            let most = |of: fn(&NoiseFloor) -> f64| floors.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
            let (low, high) = (-most(|floor| -floor.mean), most(|floor| floor.mean));
            let deviation = most(|floor| floor.deviation) + 0.5 * (high - low);
            NoiseFloor { mean: 0.5 * (low + high), deviation, block: most(|floor| floor.block) }
        })
    }

    /// Multiplies the deviations of the noise floors, and of the model's error.
    #[must_use]
    pub fn widened(mut self, floors: f64, model: f64) -> Self {
        for floor in [&mut self.residual, &mut self.friction, &mut self.external].into_iter().flatten() {
            floor.deviation *= floors;
        }
        self.model.iter_mut().for_each(|of| of.part *= model);
        self
    }

    fn of_floors(
        baselines: &[Self],
        error: impl Fn(&[ModelError]) -> ModelError,
        one: impl Fn(&[NoiseFloor]) -> NoiseFloor,
    ) -> Option<Self> {
        let dof = baselines.iter().map(|baseline| baseline.residual.len()).min()?;
        let of = |floors: fn(&Self) -> &[NoiseFloor]| -> Vec<NoiseFloor> {
            (0..dof).map(|joint| one(&baselines.iter().map(|of| floors(of)[joint]).collect::<Vec<_>>())).collect()
        };
        let errors = |joint: usize| baselines.iter().map(|of| of.model[joint]).collect::<Vec<_>>();
        let model = (0..dof).map(|joint| error(&errors(joint))).collect();
        let [residual, friction, external] = [of(|of| &of.residual), of(|of| &of.friction), of(|of| &of.external)];
        Some(Self { residual, friction, external, model })
    }

    /// Takes the largest error of the model in a segment in which nothing happens for three of its deviations, and
    /// raises the deviations of what would be an event there, until nothing is: a model's errors are no noise that is
    /// normal.
    ///
    /// # Errors
    /// Those of [`watch`].
    pub fn silent(mut self, signals: &Signals, settings: &Settings) -> Result<Self, WatchError> {
        for joint in 0..signals.dof().min(self.model.len()) {
            let parts = WrongParts::new(signals, joint, self.residual[joint].mean, 0..signals.time.len());
            let part = &mut self.model[joint].part;
            *part = part.max(parts.largest() / BOUND);
        }
        loop {
            let report = watch(signals, &self, settings)?;
            if report.events.is_empty() {
                return Ok(self);
            }
            let mut raised: Vec<(usize, Test)> = report.events.iter().map(|event| (event.joint, event.test)).collect();
            raised.sort_unstable();
            raised.dedup();
            for (joint, test) in raised {
                let floors = match test {
                    Test::External => &mut self.external,
                    Test::Offset => &mut self.residual,
                    Test::Friction => &mut self.friction,
                };
                floors[joint].deviation *= RAISE;
                self.model[joint].part *= RAISE;
            }
        }
    }

    /// From standard deviations that are known: of white noise of the measured efforts, and of what the observer makes
    /// of all noise. Lists run from base to tip.
    #[must_use]
    pub fn white(efforts: &[f64], external: &[f64]) -> Self {
        let of = |deviations: &[f64]| -> Vec<NoiseFloor> {
            let floor = |&deviation: &f64| NoiseFloor { mean: 0.0, deviation, block: 0.0 };
            deviations.iter().map(floor).collect()
        };
        let model = vec![ModelError::default(); efforts.len()];
        Self { residual: of(efforts), friction: of(efforts), external: of(external), model }
    }
}

/// The residual of a joint where friction leaves nothing open, with the samples.
pub(crate) fn known(signals: &Signals, joint: usize, samples: Range<usize>) -> Vec<(usize, f64)> {
    let (residual, creeps) = (&signals.residual[joint], &signals.creeps[joint]);
    samples.filter(|&at| !creeps[at]).map(|at| (at, residual[at])).collect()
}

/// The residual of a joint, less its floor, in the direction of motion: where it moves, with the samples.
pub(crate) fn along_motion(signals: &Signals, joint: usize, mean: f64, samples: Range<usize>) -> Vec<(usize, f64)> {
    let (residual, direction) = (&signals.residual[joint], &signals.direction[joint]);
    let moving = samples.filter(|&at| direction[at] != 0.0 && !signals.creeps[joint][at]);
    moving.map(|at| (at, (residual[at] - mean) * direction[at])).collect()
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
    fn new(signals: &Signals, joint: usize, mean: f64, samples: Range<usize>) -> Self {
        let known = known(signals, joint, samples);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it saturates
        let half = ((HALF / signals.period) as usize).max(2);
        let of = |samples: &[(usize, f64)], each: &dyn Fn(&(usize, f64)) -> f64| {
            #[allow(clippy::cast_precision_loss)] // a length of a list
            let count = samples.len() as f64;
            samples.iter().map(each).sum::<f64>() / count
        };
        let (mut squares, mut signed) = (Vec::new(), Vec::new());
        for segment in known.chunks_exact(2 * half) {
            let off = |(_, residual): &(usize, f64)| residual - mean;
            let (a, b) = (of(&segment[..half], &off), of(&segment[half..], &off));
            let terms = of(segment, &|(at, _)| signals.terms[joint][*at]);
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
        if self.squares.len() < BLOCKS {
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

/// The deviation of a floor for blocks of another one: of white noise, it falls with the root of their length.
fn scaled(floor: &NoiseFloor, other: &NoiseFloor) -> f64 {
    if floor.block == 0.0 || other.block == 0.0 {
        return 0.0;
    }
    floor.deviation * (floor.block / other.block).sqrt()
}

fn noise_floor(numbers: &[f64], period: f64, least: f64) -> NoiseFloor {
    let length = block_length(numbers);
    let means = means(numbers, length);
    let (mean, deviation) = spread(&means, means.len(), least);
    #[allow(clippy::cast_precision_loss)] // a length of a list
    NoiseFloor { mean, deviation, block: length as f64 * period }
}

/// Samples of a block: several times what the noise remembers, but so few that there are blocks enough.
fn block_length(numbers: &[f64]) -> usize {
    let memory = remembered(numbers);
    let length = if memory <= 1 { 1 } else { 4 * memory };
    length.min(numbers.len() / BLOCKS).max(1)
}

/// Means of blocks of `length` numbers; numbers left over at the end are not used.
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
