//! The tests.

use crate::baseline::{along_motion, known, means};
use crate::cumulative_sum::{Alarm, alarms};
use crate::{Baseline, Event, Level, Settings, Signals, Test, Thresholds, WatchError};

/// What is found in a motion.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// By their beginnings.
    pub events: Vec<Event>,
    /// Of each joint.
    pub thresholds: Vec<Thresholds>,
    /// The prediction error of each joint, see [`Signals::prediction_error`].
    pub errors: Vec<Option<f64>>,
}

/// A number, with the samples that it is of.
struct Block {
    value: f64,
    first: usize,
    last: usize,
}

/// Looks for events in the signals of a motion.
///
/// # Errors
/// When the baseline is of another number of joints, or a setting is not above 0.
pub fn watch(signals: &Signals, baseline: &Baseline, settings: &Settings) -> Result<Report, WatchError> {
    settings.check()?;
    let dof = signals.dof();
    let lengths = [baseline.residual.len(), baseline.friction.len(), baseline.external.len()];
    if let Some(&found) = lengths.iter().find(|&&length| length != dof) {
        return Err(WatchError::Joints { expected: dof, found });
    }
    let levels = [&baseline.residual, &baseline.friction, &baseline.external];
    if levels.into_iter().flatten().any(|level| !(level.deviation > 0.0 && level.mean.is_finite())) {
        return Err(WatchError::Setting("the deviation of a level"));
    }
    let held = samples_in(settings.hold, signals.period);
    #[allow(clippy::cast_precision_loss)] // samples of a hold
    let hold = held as f64 * signals.period;
    let settings = Settings { hold, ..settings.clone() };
    let (mut events, mut all) = (Vec::new(), Vec::with_capacity(dof));
    for joint in 0..dof {
        let levels = [baseline.residual[joint], baseline.friction[joint]];
        #[allow(clippy::cast_precision_loss)] // samples of a block
        let seconds = levels.map(|level| samples_in(level.block, signals.period) as f64 * signals.period);
        let thresholds = Thresholds::new(&settings, dof, seconds);
        let whole = known(signals, joint, 0..signals.time.len());
        let moving = along_motion(signals, joint, levels[0].mean, 0..signals.time.len());
        for (index, (test, numbers)) in [(Test::Offset, whole), (Test::Friction, moving)].into_iter().enumerate() {
            let blocks = blocks(&numbers, samples_in(levels[index].block, signals.period));
            events.extend(of_sums(signals, joint, test, &blocks, &levels[index], thresholds.sums[index]));
        }
        events.extend(of_observer(signals, joint, &baseline.external[joint], thresholds.external, held));
        all.push(thresholds);
    }
    events.sort_by(|a, b| a.start.total_cmp(&b.start).then((a.joint, a.test).cmp(&(b.joint, b.test))));
    let errors = (0..dof).map(|joint| signals.prediction_error(joint)).collect();
    Ok(Report { events, thresholds: all, errors })
}

/// How many samples a time lasts, one at least.
fn samples_in(time: f64, period: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it saturates
    let samples = (time / period - 1e-9).ceil() as usize;
    samples.max(1)
}

fn blocks(numbers: &[(usize, f64)], length: usize) -> Vec<Block> {
    let values: Vec<f64> = numbers.iter().map(|(_, number)| *number).collect();
    let of = |(index, value): (usize, f64)| {
        let (first, last) = (index * length, (index + 1) * length - 1);
        Block { value, first: numbers[first].0, last: numbers[last].0 }
    };
    means(&values, length).into_iter().enumerate().map(of).collect()
}

/// Events of a cumulative sum.
fn of_sums(signals: &Signals, joint: usize, test: Test, blocks: &[Block], level: &Level, h: f64) -> Vec<Event> {
    let numbers: Vec<f64> = blocks.iter().map(|block| (block.value - level.mean) / level.deviation).collect();
    let event = |Alarm { start, end }| {
        let peak = blocks[start..=end].iter().map(|block| block.value - level.mean).fold(0.0, farther);
        Event { joint, test, start: signals.time[blocks[start].first], end: signals.time[blocks[end].last], peak }
    };
    alarms(&numbers, h).into_iter().map(event).collect()
}

/// Events of the observer: beyond the threshold for so many samples, and until it is within half of it.
fn of_observer(signals: &Signals, joint: usize, level: &Level, threshold: f64, held: usize) -> Vec<Event> {
    let limit = threshold * level.deviation;
    let mut found = Vec::new();
    let mut open: Option<Event> = None;
    let mut beyond = 0;
    for (at, seen) in signals.external[joint].iter().enumerate() {
        let off = seen - level.mean;
        if !signals.settled[at] {
            (beyond, open) = (
                0,
                open.and_then(|event| {
                    found.push(event);
                    None
                }),
            );
            continue;
        }
        let sign_stays = beyond == 0 || off * (signals.external[joint][at - 1] - level.mean) > 0.0;
        let limit = limit + signals.open[joint][at];
        beyond = if off.abs() > limit { if sign_stays { beyond + 1 } else { 1 } } else { 0 };
        if let Some(event) = &mut open {
            event.peak = farther(event.peak, off);
            event.end = signals.time[at];
            if off.abs() < 0.5 * limit {
                found.extend(open.take());
            }
        } else if beyond >= held {
            let first = at + 1 - held;
            let peak = signals.external[joint][first..=at].iter().map(|seen| seen - level.mean).fold(0.0, farther);
            let (start, end) = (signals.time[first], signals.time[at]);
            open = Some(Event { joint, test: Test::External, start, end, peak });
        }
    }
    found.extend(open);
    found
}

/// The one farther from zero.
fn farther(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}
