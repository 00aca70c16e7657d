//! Chooses among the candidates: first the change that explains most, then the next one in addition to it.

mod window;

use std::ops::Range;

use nalgebra::DVector;
use rne_identify::{FittedModel, Stretch, Structure};

use rne_logs::median;

use crate::Baseline;
use crate::baseline::{Residual, products_of_joints};
use crate::candidate::{Candidate, speeds};
use crate::score::{Change, Estimate, Projected, Score};
use crate::sensor::is_dead;
use rne_identify::SLOWEST;

/// In standard deviations of the change: a change is an event if it is larger than this. Normal noise alone is larger
/// in 0.3 % of all cases.
const DEVIATIONS: f64 = 3.0;

/// In standard deviations: a change that does not last from the beginning to the end of the log is an event if it is
/// larger than this. The number is larger, because many times are tried and noise may exceed the threshold at each. The
/// value was chosen by experiment.
const DEVIATIONS_OF_PART: f64 = 3.3;

/// A factor: the smallest size of a change that does not last for the whole log, relative to one that does. The value
/// was chosen by experiment.
const SIZE_OF_PART: f64 = 1.5;

/// In squared standard deviations: a change begins or ends within the log only if this explains at least so much more
/// of the residuals. The value was chosen by experiment.
const GAIN: f64 = 10.0;

/// In squared standard deviations: how much more a payload must explain than friction does. It has three more
/// parameters, which explain 3 on average even without a payload. Twice that was chosen by experiment.
const PAID_BY_PAYLOAD: f64 = 6.0;

/// A part of what the gain of an effort explains: the gain must explain more than another change by this part, because
/// it changes the whole torque. The value was chosen by experiment.
const PAID_BY_GAIN: f64 = 0.2;

/// The standard deviation of a gain by errors of the model, as a part of the ratio between the residual of the joint
/// and its effort. The value was chosen by experiment.
const UNEXPLAINED: f64 = 0.5;

/// A ratio of speeds: the friction of a joint becomes less certain if the joint is slower or faster than in the quiet
/// logs by more than this factor, because the model of friction has only three numbers. The value was chosen by
/// experiment.
const LIKE: f64 = 3.0;

/// The largest number of changes in a log. The value was chosen by experiment.
const MOST: usize = 4;

/// A part of what the first change explains: a further change that explains less counts as an error in the model of the
/// first, unless it is larger than `LARGE` thresholds. The values were chosen by experiment.
const REST: f64 = 0.15;
const LARGE: f64 = 3.0;

/// In seconds: errors of the model are correlated over this time, so a change over a shorter time is less certain. The
/// value was chosen by experiment.
const ALIKE: f64 = 8.0;

/// The smallest mean square of a stretch that is an outlier, over the median of all stretches: 7² / 0.455. The median
/// of the square of normal noise with standard deviation 1 is 0.455, and an outlier has seven standard deviations.
const OUTLIER: f64 = 108.0;

/// The largest number of iterations that leave out outliers. The value was chosen by experiment.
const ROUNDS: usize = 3;

/// The estimate of a change, with the threshold that makes it an event.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Statistic {
    /// The parameter.
    pub candidate: Candidate,
    /// The change against the baseline.
    pub change: f64,
    /// Standard deviation of the change.
    pub deviation: f64,
    /// The smallest change that would be an event.
    pub threshold: f64,
}

impl Statistic {
    /// Returns the size of the change as a part of its threshold.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.change.abs() / self.threshold
    }
}

/// A parameter that has changed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Finding {
    pub(crate) statistic: Statistic,
    pub(crate) window: Range<usize>,
}

/// The change that explains most, with the decrease of the sum of squares, and its size in thresholds.
struct Largest {
    change: Change,
    drop: f64,
    ratio: f64,
}

/// The changes between a baseline and a log.
pub(crate) struct Selection<'a> {
    structure: &'a Structure,
    baseline: &'a Baseline,
    /// The stretches that are used.
    pub(crate) stretches: Vec<&'a Stretch>,
    pub(crate) score: Score,
    /// The changes that were found.
    pub(crate) given: Vec<Projected>,
    /// The ratio of each joint's speed to that in the quiet logs.
    speed_ratios: Vec<f64>,
}

impl<'a> Selection<'a> {
    /// Finds the changes of a log; `None` if the log and the baseline together give no information.
    pub(crate) fn of(structure: &'a Structure, baseline: &'a Baseline, stretches: &'a [Stretch]) -> Option<Self> {
        let mut selection = Self::selected(structure, baseline, stretches.iter().collect())?;
        for _ in 0..ROUNDS {
            let contacts = selection.outliers();
            if contacts.is_empty() || 4 * (selection.stretches.len() - contacts.len()) < 3 * stretches.len() {
                break;
            }
            let kept = selection.stretches.iter().enumerate().filter(|(at, _)| !contacts.contains(at));
            selection = Self::selected(structure, baseline, kept.map(|(_, stretch)| *stretch).collect())?;
        }
        Some(selection)
    }

    /// Selects changes, and leaves out short moments that alone explain a change. A log has few of them, so at least
    /// half of it must remain.
    fn selected(structure: &'a Structure, baseline: &'a Baseline, stretches: Vec<&'a Stretch>) -> Option<Self> {
        let count = stretches.len();
        let mut selection = Self::empty(structure, baseline, stretches)?;
        while 2 * selection.stretches.len() > count {
            let Some(moment) = selection.select() else { break };
            let rest = selection.stretches.iter().enumerate().filter(|(at, _)| !moment.contains(at));
            selection = Self::empty(structure, baseline, rest.map(|(_, stretch)| *stretch).collect())?;
        }
        Some(selection)
    }

    /// Returns the stretches whose residuals are outliers even with all changes that were found: something touches the
    /// arm there.
    fn outliers(&self) -> Vec<usize> {
        let unknowns = self.unknowns();
        let mut found = Vec::new();
        for joint in 0..self.structure.dof() {
            let stretches = self.stretches.iter().zip(&unknowns);
            let each: Vec<f64> =
                stretches.map(|(stretch, unknowns)| self.residual(joint, stretch, unknowns).mean_square()).collect();
            let usual = median(each.clone());
            found.extend(each.iter().enumerate().filter(|(_, square)| **square > OUTLIER * usual).map(|(at, _)| at));
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    fn empty(structure: &'a Structure, baseline: &'a Baseline, stretches: Vec<&'a Stretch>) -> Option<Self> {
        let is_dead: Vec<bool> = (0..structure.dof()).map(|joint| is_dead(baseline, &stretches, joint)).collect();
        let score = Score::new(structure, &baseline.model, &stretches, &is_dead)?;
        let ratios = speed_ratios(structure, baseline, &stretches);
        let mut selection = Self { structure, baseline, stretches, score, given: Vec::new(), speed_ratios: ratios };
        selection.given = selection.dead_channels();
        Some(selection)
    }

    /// Returns a gain of zero for each effort that is always zero in the log, but not in the quiet log. No other change
    /// can explain this effort. Without this gain, the missing torques would be explained by changes of other joints.
    fn dead_channels(&self) -> Vec<Projected> {
        let window = 0..self.score.len();
        let candidates = self.score.candidates().iter().enumerate();
        let dead = candidates.filter(|(_, (of, _))| matches!(of, Candidate::Gain(joint) if self.is_dead(*joint)));
        dead.map(|(candidate, _)| self.score.projected(Change { candidate, window: window.clone() })).collect()
    }

    fn is_dead(&self, joint: usize) -> bool {
        is_dead(self.baseline, &self.stretches, joint)
    }

    /// Selects changes until no further one is an event. If a short moment alone explains a change, stops and returns
    /// the moment.
    fn select(&mut self) -> Option<Range<usize>> {
        let mut first = None;
        while self.given.len() < MOST {
            let Some(Largest { change, drop, ratio }) = self.largest() else { break };
            if first.is_some_and(|first| drop < REST * first) && ratio < LARGE {
                break;
            }
            if let Some(payload) = self.small_payload(drop) {
                self.given.push(self.score.projected(payload));
                continue;
            }
            let refined = self.refined(change.clone());
            let change = if self.would_be_event(&refined) { refined } else { change };
            if let Some(moment) = self.moment(&change) {
                return Some(moment);
            }
            first.get_or_insert(drop);
            self.given.push(self.score.projected(change));
        }
        None
    }

    /// Returns the change that explains most, among those that would be events.
    fn largest(&self) -> Option<Largest> {
        let mut best: Option<Largest> = None;
        for window in self.windows() {
            let cost = if window.start > 0 { GAIN } else { 0.0 };
            for (candidate, estimate) in self.score.estimates(&window, &self.given).into_iter().enumerate() {
                let Some(estimate) = estimate else { continue };
                let change = Change { candidate, window: window.clone() };
                if !self.may_begin(&change) {
                    continue;
                }
                let drop = estimate.drop - cost - self.paid(candidate, estimate.drop);
                if best.as_ref().is_none_or(|best| drop > best.drop) && self.is_event(&change, &estimate) {
                    let ratio = self.statistic(&change, &estimate).ratio();
                    best = Some(Largest { change, drop, ratio });
                }
            }
        }
        best.map(|best| self.gain_in_place_of_offset(best))
    }

    /// Returns the gain of an effort instead of its offset if the gain explains more. The offset may have won because
    /// most of a missing torque can be its mean.
    fn gain_in_place_of_offset(&self, best: Largest) -> Largest {
        let Candidate::Offset(joint) = self.candidate(best.change.candidate) else { return best };
        let candidates = self.score.candidates();
        let Some(candidate) = candidates.iter().position(|(of, _)| *of == Candidate::Gain(joint)) else { return best };
        let change = Change { candidate, ..best.change.clone() };
        match self.score.estimate(change.clone(), &self.given) {
            Some(estimate) if estimate.drop > best.drop && self.is_event(&change, &estimate) => {
                let ratio = self.statistic(&change, &estimate).ratio();
                Largest { change, drop: estimate.drop, ratio }
            }
            _ => best,
        }
    }

    /// Returns a payload that is too small for an event but explains more than `drop`. Without it, its effect would be
    /// reported as another event.
    fn small_payload(&self, drop: f64) -> Option<Change> {
        let candidate = self.score.candidates().iter().position(|(of, _)| *of == Candidate::Payload)?;
        let change = Change { candidate, window: 0..self.score.len() };
        let estimate = self.score.estimate(change.clone(), &self.given)?;
        let is_given = self.given.iter().any(|given| given.change.candidate == candidate);
        let is_sure = estimate.value().abs() > DEVIATIONS * self.baseline.inflation[candidate] * estimate.deviation;
        (!is_given && is_sure && estimate.drop - PAID_BY_PAYLOAD > drop).then_some(change)
    }

    fn paid(&self, candidate: usize, drop: f64) -> f64 {
        match self.candidate(candidate) {
            Candidate::Payload => PAID_BY_PAYLOAD,
            Candidate::Gain(_) => PAID_BY_GAIN * drop,
            _ => 0.0,
        }
    }

    fn candidate(&self, at: usize) -> Candidate {
        self.score.candidates()[at].0
    }

    fn would_be_event(&self, change: &Change) -> bool {
        let estimate = self.score.estimate(change.clone(), &self.given);
        estimate.is_some_and(|estimate| self.is_event(change, &estimate))
    }

    fn is_event(&self, change: &Change, estimate: &Estimate) -> bool {
        let columns = |change: &Change| self.candidate(change.candidate);
        let is_gain = |candidate: Candidate| matches!(candidate, Candidate::Gain(_));
        // if the gain of a joint's effort has changed, the effort does not show other changes of the joint
        let excludes = |given: &Projected| {
            let (one, other) = (columns(&given.change), columns(change));
            one == other || (one.joint().is_some() && one.joint() == other.joint() && (is_gain(one) || is_gain(other)))
        };
        let is_given = self.given.iter().any(excludes);
        let statistic = self.statistic(change, estimate);
        let scale = &self.baseline.scale;
        // an uncertain change is no event, however large it seems
        let is_known = statistic.deviation < 2.0 * scale.least(statistic.candidate);
        !is_given && is_known && statistic.ratio() > 1.0
    }

    /// Returns a change with its standard deviation, which is larger if only a part of the log determines the change.
    fn statistic(&self, change: &Change, estimate: &Estimate) -> Statistic {
        let candidate = self.candidate(change.candidate);
        let Baseline { scale, inflation, doubt, residual, .. } = self.baseline;
        let is_part = change.window.start > 0 || change.window.end < self.score.len();
        let [deviations, size, alike] = if is_part {
            [DEVIATIONS_OF_PART, SIZE_OF_PART, (ALIKE / self.duration(&change.window)).max(1.0)]
        } else {
            [DEVIATIONS, 1.0, 1.0]
        };
        let unlike = match candidate {
            Candidate::Coulomb(joint) | Candidate::Viscous(joint) => {
                let ratio = self.speed_ratios[joint];
                (ratio.max(1.0 / ratio) / LIKE).max(1.0)
            }
            // friction that changes its sign over a displacement seems delayed, and more so for slow joints
            Candidate::Delay => median(self.speed_ratios.iter().map(|ratio| 1.0 / ratio).collect()).max(1.0),
            _ => 1.0,
        };
        // errors of the model also cause errors of a gain, except if the effort is zero
        let unexplained = match candidate {
            Candidate::Gain(joint) if scale.effort[joint] > 0.0 && !self.is_dead(joint) => {
                UNEXPLAINED * residual[joint] / scale.effort[joint]
            }
            _ => 0.0,
        };
        let model = unlike * alike * doubt * scale.model_error(candidate).max(unexplained);
        // errors of the model average out over the joints, less so if some efforts are dead
        let dof = self.structure.dof();
        let alive = (0..dof).filter(|joint| !self.is_dead(*joint)).count().max(1);
        #[allow(clippy::cast_precision_loss)] // some joints
        let fewer = if candidate.joint().is_none() { (dof as f64 / alive as f64).sqrt() } else { 1.0 };
        let deviation = fewer * (inflation[change.candidate] * estimate.deviation).hypot(model);
        let threshold = (deviations * deviation).max(size * scale.least(candidate));
        Statistic { candidate, change: estimate.value(), deviation, threshold }
    }

    /// Estimates each change that was found together with all others; returns those that still are events.
    pub(crate) fn findings(&self) -> Vec<Finding> {
        self.estimated().filter(|found| found.statistic.ratio() > 1.0).collect()
    }

    fn estimated(&self) -> impl Iterator<Item = Finding> {
        (0..self.given.len()).filter_map(|at| {
            let mut others = self.given.clone();
            let change = others.remove(at).change;
            let estimate = self.score.estimate(change.clone(), &others)?;
            Some(Finding { statistic: self.statistic(&change, &estimate), window: change.window })
        })
    }

    /// Returns the statistics of all candidates that are no events, estimated together with the changes that were
    /// found. They are over the whole log, except for changes that were found over a part of it.
    pub(crate) fn statistics(&self) -> Vec<Statistic> {
        let whole = 0..self.score.len();
        let estimates = self.score.estimates(&whole, &self.given).into_iter().enumerate();
        let is_given = |candidate: &usize| self.given.iter().any(|given| given.change.candidate == *candidate);
        let statistics = estimates.filter(|(candidate, _)| !is_given(candidate)).filter_map(|(candidate, estimate)| {
            let change = Change { candidate, window: whole.clone() };
            Some(self.statistic(&change, &estimate?))
        });
        let small = self.estimated().map(|found| found.statistic).filter(|statistic| statistic.ratio() <= 1.0);
        statistics.chain(small).collect()
    }

    /// Whether a joint moves far more slowly than in the quiet logs, or hardly at all.
    pub(crate) fn is_slow(&self, joint: usize) -> bool {
        self.speed_ratios[joint] * LIKE < 1.0
    }

    /// Returns the residual of the torques of a joint in a stretch, with these unknowns and gains.
    pub(crate) fn residual(&self, joint: usize, stretch: &Stretch, unknowns: &DVector<f64>) -> Residual {
        let of_joint = of_joint(self.structure, &self.baseline.model, joint, unknowns);
        Residual::of(self.structure, joint, stretch, &of_joint)
    }

    /// Returns the unknowns of the model and the gains at each stretch, with all changes that were found.
    pub(crate) fn unknowns(&self) -> Vec<DVector<f64>> {
        let changes = self.score.changes(&self.given).unwrap_or_default();
        let mut common = self.score.common(&changes);
        common.rows_mut(0, self.structure.count()).zip_apply(&self.baseline.model.solution, |sum, own| *sum += own);
        let at = |at: usize| {
            let active = changes.iter().filter(|(window, _)| window.contains(&at));
            active.fold(common.clone(), |sum, (_, change)| sum + change)
        };
        (0..self.score.len()).map(at).collect()
    }

    /// Returns each change that was found as a change of all unknowns, with its window.
    pub(crate) fn changes(&self) -> Vec<(Range<usize>, DVector<f64>)> {
        self.score.changes(&self.given).unwrap_or_default()
    }
}

/// Returns the unknowns for one joint's torque from all unknowns and gains: a gain changes the whole torque of the
/// baseline.
pub(crate) fn of_joint(
    structure: &Structure,
    baseline: &FittedModel,
    joint: usize,
    unknowns: &DVector<f64>,
) -> DVector<f64> {
    unknowns.rows(0, structure.count()) + &baseline.solution * unknowns[structure.count() + joint]
}

/// Returns the ratio of each joint's speed to that in the quiet logs.
fn speed_ratios(structure: &Structure, baseline: &Baseline, stretches: &[&Stretch]) -> Vec<f64> {
    let totals = products_of_joints(structure, stretches.iter().copied());
    let speeds = speeds(structure, &totals).into_iter().zip(&baseline.scale.speed);
    speeds.map(|(now, before)| now.max(SLOWEST) / before.max(SLOWEST)).collect()
}
