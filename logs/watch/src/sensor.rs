//! Finds channels of effort that do not measure their joint: a channel that repeats one value, and two channels that
//! are exchanged. The torques that the baseline predicts distinguish both from an arm at rest.

use std::ops::Range;

use nalgebra::DVector;
use rne_identify::{FittedModel, FrictionParameter, Stretch, Stretches, Structure};

use crate::baseline::{Residual, products};
use crate::event::{Cause, Event, unit};
use crate::{Baseline, Candidate};

/// Shortest time for which a frozen channel repeats its value, s.
const SHORTEST: f64 = 1.5;

/// Largest standard deviation of a value that is repeated, in residuals of the quiet log; it allows for rounding.
const REPEATED: f64 = 1e-3;

/// Smallest standard deviation of the predicted torque in that time, in residuals of the quiet log.
const MOVES: f64 = 1.5;

/// Time over which the low-pass filter spreads a step, in periods of the cut-off.
const SPREAD: f64 = 2.0;

/// Smallest factor by which the squared residuals of two joints decrease if their efforts are exchanged back; those of
/// each single joint decrease at least by its square root.
const FALLS: f64 = 16.0;

/// Ratio of a residual to that of the quiet log above which a joint may have the effort of another joint.
const SUSPECT: f64 = 1.5;

/// Largest number of joints that are tried for exchanged efforts.
const MOST: usize = 4;

/// A channel of effort that repeats one value for some time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Frozen {
    pub(crate) joint: usize,
    /// The stretches in which the value is constant.
    window: Range<usize>,
    /// The repeated value, N m or N.
    value: f64,
}

/// The sums over rows of one joint from which means and variances follow: weights, efforts, predicted torques.
#[derive(Clone, Copy, Default)]
struct Sums {
    rows: u64,
    weight: f64,
    effort: [f64; 2],
    model: [f64; 2],
}

impl Sums {
    fn of(structure: &Structure, model: &FittedModel, joint: usize, stretch: &Stretch) -> Self {
        let count = structure.count();
        let products = products(structure, joint, [stretch]);
        let Some(one) = FittedModel::place(structure, joint, FrictionParameter::Offset) else { return Self::default() };
        let predicted: DVector<f64> = products.view((0, 0), (count, count)) * &model.solution;
        Self {
            rows: stretch.rows,
            weight: products[(one, one)],
            effort: [products[(one, count)], products[(count, count)]],
            model: [predicted[one], model.solution.dot(&predicted)],
        }
    }

    fn plus(self, other: Self) -> Self {
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        Self {
            rows: self.rows + other.rows,
            weight: self.weight + other.weight,
            effort: sum(self.effort, other.effort),
            model: sum(self.model, other.model),
        }
    }

    fn deviation(self, [sum, squares]: [f64; 2]) -> f64 {
        let mean = sum / self.weight;
        (squares / self.weight - mean * mean).max(0.0).sqrt()
    }
}

impl Frozen {
    /// Returns the channels that repeat a value other than zero while the predicted torque changes.
    pub(crate) fn all(structure: &Structure, baseline: &Baseline, list: &[Stretch]) -> Vec<Self> {
        (0..structure.dof()).filter_map(|joint| Self::of(structure, baseline, list, joint)).collect()
    }

    /// Returns the longest time in which a channel repeats a value.
    fn of(structure: &Structure, baseline: &Baseline, list: &[Stretch], joint: usize) -> Option<Self> {
        let residual = baseline.residual[joint];
        let mut longest: Option<(Range<usize>, Sums)> = None;
        let (mut start, mut sums) = (0, Sums::default());
        for (at, stretch) in list.iter().enumerate() {
            let own = Sums::of(structure, &baseline.model, joint, stretch);
            let joined = sums.plus(own);
            (start, sums) =
                if joined.deviation(joined.effort) <= REPEATED * residual { (start, joined) } else { (at, own) };
            if longest.as_ref().is_none_or(|(_, longest)| sums.rows > longest.rows) {
                longest = Some((start..at + 1, sums));
            }
        }
        let (window, sums) = longest?;
        #[allow(clippy::cast_precision_loss)] // no log has 2⁵² rows
        let duration = sums.rows as f64 * baseline.row();
        let is_constant = sums.weight > 0.0 && sums.deviation(sums.effort) <= REPEATED * residual;
        let value = sums.effort[0] / sums.weight;
        let moves = sums.deviation(sums.model) > MOVES * residual;
        (is_constant && duration >= SHORTEST && value != 0.0 && moves).then_some(Self { joint, window, value })
    }

    /// Returns the stretches without the rows that frozen channels affect. These include rows next to the window, over
    /// which the low-pass filter spreads the step to the constant value.
    pub(crate) fn without(all: &[Self], baseline: &Baseline, list: &[Stretch]) -> Vec<Stretch> {
        let mut rest = list.to_vec();
        let spread = SPREAD / baseline.cutoff;
        for frozen in all {
            let [first, last] = [&list[frozen.window.start], &list[frozen.window.end - 1]];
            let is_near = |of: &Stretch| {
                (of.last_run, of.end) >= (first.run, first.start - spread)
                    && (of.run, of.start) <= (last.last_run, last.end + spread)
            };
            rest.iter_mut().filter(|of| is_near(of)).for_each(|of| of.leave_out(frozen.joint));
        }
        rest
    }

    pub(crate) fn event(&self, structure: &Structure, list: &[Stretch]) -> Event {
        let stretches = &list[self.window.clone()];
        let last = self.window.end - 1;
        Event {
            joint: Some(self.joint),
            parameter: "frozen",
            value: self.value,
            unit: unit(structure.robot(), Candidate::Offset(self.joint)),
            run: stretches.first().map_or(0, |first| first.run),
            since: stretches.first().map_or(f64::NAN, |first| first.start),
            until: list[last].end,
            is_whole: self.window == (0..list.len()),
            lasts: self.window.end == list.len(),
            ..Event::blank(Cause::Sensor)
        }
    }
}

/// Whether the effort of a joint is always zero, but not in the quiet log.
pub(crate) fn is_dead(baseline: &Baseline, stretches: &[&Stretch], joint: usize) -> bool {
    baseline.scale.effort[joint] > 0.0 && stretches.iter().all(|stretch| stretch.is_silent(joint))
}

/// Returns the two joints whose efforts are exchanged in a log, counted from 0, the smaller first, with the equations
/// of the log with these efforts exchanged back. Only then does the model explain nearly all of the log. `exchanged`
/// returns the equations of the log with the efforts of two joints exchanged.
///
/// # Errors
/// The errors of `exchanged`.
pub fn exchanged_efforts<E>(
    structure: &Structure,
    baseline: &Baseline,
    log: &Stretches,
    mut exchanged: impl FnMut([usize; 2]) -> Result<Stretches, E>,
) -> Result<Option<([usize; 2], Stretches)>, E> {
    let squares = |log: &Stretches, joint: usize| {
        let residuals = log.list().iter().map(|of| Residual::of(structure, joint, of, &baseline.model.solution));
        residuals.fold(Residual::default(), Residual::plus).mean_square()
    };
    let own: Vec<f64> = (0..structure.dof()).map(|joint| squares(log, joint)).collect();
    let parts: Vec<f64> = own.iter().zip(&baseline.residual).map(|(own, before)| own.sqrt() / before).collect();
    let mut suspects: Vec<usize> = (0..own.len()).filter(|joint| parts[*joint] > SUSPECT).collect();
    suspects.sort_by(|a, b| parts[*b].total_cmp(&parts[*a]));
    suspects.truncate(MOST);
    suspects.sort_unstable();
    let mut best: Option<(f64, [usize; 2], Stretches)> = None;
    for (at, &first) in suspects.iter().enumerate() {
        for &second in &suspects[at + 1..] {
            let pair = [first, second];
            let log = exchanged(pair)?;
            // relative to the squared residuals of the quiet log, so that both joints have the same weight
            let part = |of: f64, joint: usize| of / baseline.residual[joint].powi(2);
            let [now, then]: [[f64; 2]; 2] =
                [pair.map(|joint| part(own[joint], joint)), pair.map(|joint| part(squares(&log, joint), joint))];
            let fall = (now[0] + now[1]) / (then[0] + then[1]);
            let each = (0..2).all(|of| now[of] > FALLS.sqrt() * then[of]);
            if fall > FALLS && each && best.as_ref().is_none_or(|(most, ..)| fall > *most) {
                best = Some((fall, pair, log));
            }
        }
    }
    Ok(best.map(|(_, pair, log)| (pair, log)))
}

/// Makes the event of two channels that are exchanged in a whole log.
pub(crate) fn exchange(structure: &Structure, [first, second]: [usize; 2], list: &[Stretch]) -> Event {
    Event {
        joint: Some(first),
        parameter: "exchanged",
        others: vec![second],
        unit: unit(structure.robot(), Candidate::Offset(first)),
        run: list.first().map_or(0, |first| first.run),
        since: list.first().map_or(f64::NAN, |first| first.start),
        until: list.last().map_or(f64::NAN, |last| last.end),
        is_whole: true,
        lasts: true,
        ..Event::blank(Cause::Sensor)
    }
}
