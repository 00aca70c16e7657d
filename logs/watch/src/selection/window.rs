//! Finds the times at which a change begins and ends, and short moments that are contacts instead of changes.

use std::ops::Range;

use rne_identify::Stretch;

use super::{GAIN, Selection};
use crate::candidate::Candidate;
use crate::score::{Change, Projected, Score};

/// In seconds: the interval between the times that are tried first. A log has at most `STEPS` of them, which bounds the
/// work on a long log. The values were chosen by experiment.
const STEP: f64 = 1.0;
const STEPS: usize = 64;

/// In seconds: the shortest duration of a change. The value was chosen by experiment.
const SHORTEST: f64 = 3.0;

/// In seconds: if a moment of at most this duration explains a change, it is a contact and no change of a parameter.
/// The value was chosen by experiment.
const MOMENT: f64 = 1.0;

impl Selection<'_> {
    /// Whether a change may have this window. A delay must last for the whole log, because it is a property of the
    /// recorder.
    pub(super) fn may_begin(&self, change: &Change) -> bool {
        self.candidate(change.candidate) != Candidate::Delay || change.window == (0..self.score.len())
    }

    /// Returns the duration of the stretches of a window, s, without the time between runs.
    pub(super) fn duration(&self, window: &Range<usize>) -> f64 {
        let of_rows: u64 = self.stretches[window.clone()].iter().map(|stretch| stretch.rows).sum();
        #[allow(clippy::cast_precision_loss)]
        let rows = of_rows as f64;
        rows * self.baseline.row()
    }

    /// Returns the windows that are tried first: from the beginning, or from some later time, to the end of the log.
    pub(super) fn windows(&self) -> Vec<Range<usize>> {
        let count = self.score.len();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let steps = ((self.duration(&(0..count)) / STEP) as usize).clamp(1, STEPS);
        let starts = (1..steps).map(|step| step * count / steps..count);
        let is_long = |window: &Range<usize>| self.duration(window) >= SHORTEST;
        std::iter::once(0..count).chain(starts.filter(is_long)).collect()
    }

    /// Returns the change with the beginning and end that explain most. It tries all beginnings near the one that was
    /// found, and all ends.
    pub(super) fn refined(&self, mut change: Change) -> Change {
        let count = self.score.len();
        let reach = count.div_ceil(STEPS.min(count));
        let drop = |change: &Change| {
            let estimate = self.score.estimate(change.clone(), &self.given);
            estimate.map_or(f64::NEG_INFINITY, |estimate| estimate.drop)
        };
        let Change { window, .. } = change.clone();
        if window.start > 0 {
            let starts = window.start.saturating_sub(reach)..(window.start + reach).min(window.end - 1);
            let at = |start: usize| Change { window: start..window.end, ..change.clone() };
            let best = starts.map(|start| (start, drop(&at(start)))).max_by(|a, b| a.1.total_cmp(&b.1));
            change.window.start = best.map_or(window.start, |best| best.0);
        }
        let is_long = |change: &Change| self.duration(&change.window) >= SHORTEST;
        let to = |end: usize| Change { window: change.window.start..end, ..change.clone() };
        let ends = (change.window.start + 1..count).map(to).filter(is_long).filter(|change| self.may_begin(change));
        let best = ends.map(|change| (drop(&change), change)).max_by(|a, b| a.0.total_cmp(&b.0));
        match best {
            Some((most, earlier)) if most > drop(&change) + GAIN && self.would_be_event(&earlier) => earlier,
            _ => change,
        }
    }

    /// Returns the short moment without which a change would be less than half as large, if there is one: something
    /// touched the arm then.
    pub(super) fn moment(&self, change: &Change) -> Option<Range<usize>> {
        let mut given = self.given.clone();
        given.push(self.score.projected(change.clone()));
        let changes = self.score.changes(&given)?;
        let common = self.score.common(&changes);
        let (own, others) = changes.split_last()?;
        let own = &own.1;
        let gains: Vec<f64> = change
            .window
            .clone()
            .map(|at| {
                let active = others.iter().filter(|(window, _)| window.contains(&at));
                let shift = active.fold(common.clone(), |sum, (_, change)| sum + change);
                self.score.gain(at, &shift, own)
            })
            .collect();
        let mut best: Option<(f64, Range<usize>)> = None;
        let mut start = 0;
        let mut sum = 0.0;
        for end in 0..gains.len() {
            sum += gains[end];
            while start < end && self.duration(&(change.window.start + start..change.window.start + end + 1)) > MOMENT {
                sum -= gains[start];
                start += 1;
            }
            if best.as_ref().is_none_or(|(most, _)| sum > *most) {
                best = Some((sum, change.window.start + start..change.window.start + end + 1));
            }
        }
        let moment = best?.1;
        let rest = self.stretches.iter().enumerate().filter(|(at, _)| !moment.contains(at));
        let rest: Vec<&Stretch> = rest.map(|(_, stretch)| *stretch).collect();
        let is_dead: Vec<bool> = (0..self.structure.dof()).map(|joint| self.is_dead(joint)).collect();
        let score = Score::new(self.structure, &self.baseline.model, &rest, &is_dead)?;
        let without = |window: &Range<usize>| {
            let before = |at: usize| at - moment.clone().filter(|of| *of < at).count();
            before(window.start)..before(window.end)
        };
        let moved = |change: &Change| Change { candidate: change.candidate, window: without(&change.window) };
        let given: Vec<Projected> = self.given.iter().map(|given| score.projected(moved(&given.change))).collect();
        let all = self.score.estimate(change.clone(), &self.given)?;
        let rest = score.estimate(moved(change), &given)?;
        let is_told = rest.deviation < 0.5 * all.value().abs();
        (is_told && rest.value() / all.value() < 0.5).then_some(moment)
    }
}
