//! The tests for disturbances: thresholds and cumulative sums over the signals of a log.

use crate::baseline::{BOUND, along_motion, known, means};
use crate::change_point::change_point;
use crate::cumulative_sum::{Alarm, alarms};
use crate::{Baseline, Event, ModelError, NoiseFloor, Settings, Signals, Test, Thresholds, WatchError};

/// The events of a motion.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// The events, sorted by their start.
    pub events: Vec<Event>,
    /// The thresholds of each joint.
    pub thresholds: Vec<Thresholds>,
    /// The prediction error of each joint, see [`Signals::prediction_error`].
    pub errors: Vec<Option<f64>>,
}

/// The mean of numbers, by their indices.
struct Block {
    value: f64,
    /// The range that the model leaves open.
    open: f64,
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
    let floors = [&baseline.residual, &baseline.friction, &baseline.external];
    if floors.into_iter().flatten().any(|floor| !(floor.deviation > 0.0 && floor.mean.is_finite())) {
        return Err(WatchError::Setting("the deviation of a noise floor"));
    }
    let held = samples_in(settings.hold, signals.period);
    #[allow(clippy::cast_precision_loss)] // samples of a hold
    let hold = held as f64 * signals.period;
    let settings = Settings { hold, ..settings.clone() };
    let (mut events, mut all) = (Vec::new(), Vec::with_capacity(dof));
    for joint in 0..dof {
        let floors = [baseline.residual[joint], baseline.friction[joint]];
        #[allow(clippy::cast_precision_loss)] // samples of a block
        let seconds = floors.map(|floor| samples_in(floor.block, signals.period) as f64 * signals.period);
        let thresholds = Thresholds::new(&settings, dof, seconds);
        let whole = known(signals, joint, 0..signals.time.len());
        let moving = along_motion(signals, joint, floors[0].mean, 0..signals.time.len());
        for (index, (test, numbers)) in [(Test::Offset, whole), (Test::Friction, moving)].into_iter().enumerate() {
            let open = UnmodelledRange { terms: &signals.terms[joint], wrong: baseline.model[joint] };
            let blocks = blocks(&numbers, &open, samples_in(floors[index].block, signals.period));
            events.extend(of_sums(signals, (joint, test), &numbers, &blocks, &floors[index], thresholds.sums[index]));
        }
        let (floor, wrong) = (&baseline.external[joint], &baseline.model[joint]);
        events.extend(of_observer(signals, joint, floor, wrong, thresholds.external, held));
        all.push(thresholds);
    }
    events.sort_by(|a, b| a.start.total_cmp(&b.start).then((a.joint, a.test).cmp(&(b.joint, b.test))));
    let errors = (0..dof).map(|joint| signals.prediction_error(joint)).collect();
    Ok(Report { events, thresholds: all, errors })
}

/// Number of samples in a time, one at least.
fn samples_in(time: f64, period: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it saturates
    let samples = (time / period - 1e-9).ceil() as usize;
    samples.max(1)
}

/// The range that the model of a joint leaves open, because it may be wrong.
#[derive(Clone, Copy)]
struct UnmodelledRange<'a> {
    terms: &'a [f64],
    wrong: ModelError,
}

impl UnmodelledRange<'_> {
    fn at(&self, sample: usize) -> f64 {
        BOUND * self.wrong.part * self.terms[sample]
    }
}

fn blocks(numbers: &[(usize, f64)], open: &UnmodelledRange<'_>, length: usize) -> Vec<Block> {
    let means = |of: &dyn Fn(&(usize, f64)) -> f64| means(&numbers.iter().map(of).collect::<Vec<_>>(), length);
    let (values, open) = (means(&|(_, number)| *number), means(&|(at, _)| open.at(*at)));
    let of = |(index, (value, open)): (usize, (f64, f64))| {
        let (first, last) = (index * length, (index + 1) * length - 1);
        Block { value, open, first, last }
    };
    values.into_iter().zip(open).enumerate().map(of).collect()
}

/// Events of a cumulative sum over blocks of numbers, which have their samples with them.
fn of_sums(
    signals: &Signals,
    (joint, test): (usize, Test),
    numbers: &[(usize, f64)],
    blocks: &[Block],
    floor: &NoiseFloor,
    h: f64,
) -> Vec<Event> {
    // what the model leaves open is no change
    let beyond = |block: &Block| {
        let off = block.value - floor.mean;
        off.signum() * (off.abs() - block.open).max(0.0) / floor.deviation
    };
    let event = |alarm: Alarm| {
        let (first, last) = bounds(numbers, blocks, alarm, floor.mean);
        let peak = largest_mean(&numbers[first..=last], floor.mean, signals.period);
        let [start, end] = [first, last].map(|index| signals.time[numbers[index].0]);
        Event { joint, test, start, end, peak }
    };
    let beyond: Vec<f64> = blocks.iter().map(beyond).collect();
    alarms(&beyond, h).into_iter().map(event).collect()
}

/// The first and the last number of a change. A sum wanders before it grows for good, and knows of blocks alone: so the
/// mean is looked for that begins between the block before and the one behind where the sum passed its threshold, and
/// the one that ends about its end.
fn bounds(numbers: &[(usize, f64)], blocks: &[Block], alarm: Alarm, mean: f64) -> (usize, usize) {
    let off = |range: &mut dyn Iterator<Item = usize>| -> Vec<f64> { range.map(|at| numbers[at].1 - mean).collect() };
    let block = |index: usize| &blocks[index.min(blocks.len() - 1)];
    let length = block(0).last + 1;
    let (from, to) = (block(alarm.start.saturating_sub(1)).first, block((alarm.raised + 1).min(alarm.end)).last);
    let first = from + change_point(&off(&mut (from..=to)), length.div_ceil(4));
    let (from, to) = (first.max(block(alarm.end.saturating_sub(2)).first), block(alarm.end + 1).last);
    let last = to - change_point(&off(&mut (from..=to).rev()), length.div_ceil(4));
    (first, last.max(first))
}

/// The mean, less another, that is the largest of segments of half a second, or of all where they are shorter.
fn largest_mean(numbers: &[(usize, f64)], mean: f64, period: f64) -> f64 {
    let values: Vec<f64> = numbers.iter().map(|(_, number)| number - mean).collect();
    let length = samples_in(SEGMENT, period).min(values.len());
    means(&values, length).into_iter().fold(0.0, farther)
}

/// Shortest change of a mean, s.
const SEGMENT: f64 = 0.5;

/// Events of the observer: from the first of `hold` samples beyond the threshold until it is within half of it.
fn of_observer(
    signals: &Signals,
    joint: usize,
    floor: &NoiseFloor,
    wrong: &ModelError,
    threshold: f64,
    held: usize,
) -> Vec<Event> {
    let mut found = Vec::new();
    let mut open: Option<Event> = None;
    let mut beyond = 0;
    // what friction may be is no torque of the environment
    let sure = |at: usize| {
        let off = signals.external[joint][at] - floor.mean;
        off.signum() * (off.abs() - signals.open[joint][at]).max(0.0)
    };
    for (at, seen) in signals.external[joint].iter().enumerate() {
        let off = seen - floor.mean;
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
        let sign_stays = beyond == 0 || off * (signals.external[joint][at - 1] - floor.mean) > 0.0;
        let (terms, inertia) = (signals.terms[joint][at], signals.inertia[joint][at]);
        let limit = threshold * wrong.deviation(floor.deviation, terms, inertia) + signals.open[joint][at];
        beyond = if off.abs() > limit { if sign_stays { beyond + 1 } else { 1 } } else { 0 };
        if let Some(event) = &mut open {
            event.peak = farther(event.peak, sure(at));
            event.end = signals.time[at];
            if off.abs() < 0.5 * limit {
                found.extend(open.take());
            }
        } else if beyond >= held {
            let first = at + 1 - held;
            let peak = (first..=at).map(sure).fold(0.0, farther);
            let (start, end) = (signals.time[first], signals.time[at]);
            open = Some(Event { joint, test: Test::External, start, end, peak });
        }
    }
    found.extend(open);
    found
}

/// The number that is farther from zero.
fn farther(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}
