//! The changes of an arm's parameters between a baseline and a log.

use std::ops::Range;

use nalgebra::DVector;
use rne_identify::{FittedModel, FrictionParameter, MotionError, Stretch, Stretches, Structure};
use rne_logs::{Motion, median};

use crate::Baseline;
use crate::baseline::{Residual, products_of_joints};
use crate::candidate::{Candidate, Scale};
use crate::event::{Cause, Event, unit};
use crate::selection::{Finding, Selection, Statistic};
use crate::sensor::{Frozen, exchange};

/// The error of the model has grown where its residual is this many times that of the baseline.
const GROWN: f64 = 3.0;

/// s: so long before and after a constant effort the filters change the effort.
const EDGE: f64 = 1.0;

/// A time in a log: the number of the run, and s.
type Instant = (u64, f64);

/// A change of all unknowns and gains from one time to another one.
#[derive(Clone, Debug, PartialEq)]
struct Window {
    ends: [Instant; 2],
    change: DVector<f64>,
}

/// The changes between a baseline and a log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Changes {
    /// The changes that are events, the one that explains most first.
    pub events: Vec<Event>,
    /// All other parameters, with their thresholds.
    pub statistics: Vec<Statistic>,
    /// Root mean square of the torque of each joint that the baseline's model with all changes does not explain, N m
    /// or N.
    pub residual: Vec<f64>,
    /// The root mean square of the efforts over that of the quiet logs, in the median over the joints. Far from 1, the
    /// efforts have another unit.
    pub effort_ratio: f64,
    /// The joints whose efforts are exchanged in the log, counted from 0: all other results are of the log with these
    /// efforts exchanged back.
    pub exchanged: Option<[usize; 2]>,
    windows: Vec<Window>,
}

impl Changes {
    /// The changes of a log in which the efforts of two joints are exchanged, by the equations with these efforts
    /// exchanged back.
    pub(crate) fn of_exchanged(
        structure: &Structure,
        baseline: &Baseline,
        log: &Stretches,
        joints: [usize; 2],
    ) -> Option<Self> {
        let mut found = Self::of(structure, baseline, log)?;
        found.events.insert(0, exchange(structure, joints, log.list()));
        found.exchanged = Some(joints);
        Some(found)
    }

    /// Whether the effort of a joint repeats a value at a time of a run.
    pub(crate) fn is_frozen(&self, joint: usize, run: u64, times: Range<f64>) -> bool {
        let is_near = |event: &Event| event.since - EDGE < times.end && times.start < event.until + EDGE;
        self.events.iter().any(|event| {
            event.parameter == "frozen" && event.joint == Some(joint) && (event.run != run || is_near(event))
        })
    }

    /// The changes of a log, given by its equations; `None` where it is too short to compare.
    #[must_use]
    pub fn of(structure: &Structure, baseline: &Baseline, log: &Stretches) -> Option<Self> {
        let frozen = Frozen::all(structure, baseline, log.list());
        let list = Frozen::without(&frozen, baseline, log.list());
        let selection = Selection::of(structure, baseline, &list)?;
        let findings = selection.findings();
        let mut events: Vec<Event> = frozen.iter().map(|frozen| frozen.event(structure, log.list())).collect();
        events.extend(findings.iter().map(|found| event(structure, baseline, &selection, found)));
        let residual = residual(baseline, &selection);
        // the errors of a file are those of another motion
        let has_quiet_log = baseline.doubt == 1.0;
        for (joint, (now, before)) in residual.iter().zip(&baseline.residual).enumerate() {
            // a change that was found has a shape of its own, which the model need not have
            let is_explained =
                findings.iter().any(|found| found.statistic.candidate.joint().is_none_or(|of| of == joint));
            // friction at rest has any value between both directions
            let at_rest = if selection.is_slow(joint) { baseline.scale.friction[joint] } else { 0.0 };
            if *now > GROWN * before + at_rest && !is_explained && has_quiet_log {
                events.push(grown(structure, &selection, joint, [*now, *before]));
            }
        }
        let ends = |window: &Range<usize>| {
            let list = &selection.stretches[window.clone()];
            // a change that is there from the first row to the last is also there before and after them, in runs that
            // are too short to have rows
            let begin = list.first().filter(|_| window.start > 0);
            let end = list.last().filter(|_| window.end < selection.stretches.len());
            [
                begin.map_or((0, f64::NEG_INFINITY), |first| (first.run, first.start)),
                end.map_or((u64::MAX, f64::INFINITY), |last| (last.last_run, last.end)),
            ]
        };
        let changes = selection.changes().into_iter();
        let windows = changes.map(|(window, change)| Window { ends: ends(&window), change }).collect();
        let effort_ratio = effort_ratio(structure, baseline, log);
        Some(Self { events, statistics: selection.statistics(), residual, effort_ratio, exchanged: None, windows })
    }

    /// The torques that the changes add along a motion of a run, joint by joint, N m or N.
    ///
    /// # Errors
    /// When the motion is of another robot, or has numbers that are not finite.
    pub fn torques(
        &self,
        structure: &Structure,
        baseline: &Baseline,
        run: u64,
        motion: &Motion,
    ) -> Result<Vec<Vec<f64>>, MotionError> {
        let mut sum = vec![vec![0.0; motion.len()]; structure.dof()];
        let count = structure.count();
        for Window { ends: [first, last], change } in &self.windows {
            if run < first.0 || run > last.0 {
                continue;
            }
            let gains = change.rows_range(count..);
            let mut added = baseline.model.torques(structure, motion, &change.rows(0, count).clone_owned())?;
            let delay = if structure.options().delay { change[count - 1] } else { 0.0 };
            if delay != 0.0 || gains.iter().any(|gain| *gain != 0.0) {
                let own = baseline.model.torques(structure, motion, &baseline.model.solution)?;
                for ((added, own), gain) in added.iter_mut().zip(own).zip(gains.iter()) {
                    let late = late(&motion.time, &own, delay);
                    let torques = added.iter_mut().zip(own.iter().zip(late));
                    torques.for_each(|(added, (own, late))| *added += gain * own + late - own);
                }
            }
            let is_active = |time: f64| (run > first.0 || time >= first.1) && (run < last.0 || time <= last.1);
            for (sum, added) in sum.iter_mut().zip(added) {
                for ((sum, added), time) in sum.iter_mut().zip(added).zip(&motion.time) {
                    *sum += if is_active(*time) { added } else { 0.0 };
                }
            }
        }
        Ok(sum)
    }

    /// The statistic that is nearest to its threshold, of those that the logs determine.
    #[must_use]
    pub fn nearest(&self, scale: &Scale) -> Option<&Statistic> {
        let watched = self.statistics.iter().filter(|statistic| scale.is_watched(statistic));
        watched.max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
    }
}

/// The efforts of a log over those of the baseline, in the median over the joints that have efforts in both.
fn effort_ratio(structure: &Structure, baseline: &Baseline, log: &Stretches) -> f64 {
    let totals = products_of_joints(structure, log.list());
    let now = Scale::of(structure, &baseline.model, &totals).effort;
    let ratios = now.iter().zip(&baseline.scale.effort).map(|(now, before)| now / before);
    let ratios: Vec<f64> = ratios.filter(|ratio| *ratio > 0.0 && ratio.is_finite()).collect();
    if ratios.is_empty() { 1.0 } else { median(ratios) }
}

/// Values that come later by a delay, s.
fn late(time: &[f64], values: &[f64], delay: f64) -> Vec<f64> {
    let mut next = 0;
    let at = |instant: f64| {
        while next < time.len() && time[next] < instant {
            next += 1;
        }
        let before = next.saturating_sub(1);
        match (time.get(before).zip(time.get(next)), next) {
            (None, _) => values.last().copied().unwrap_or_default(),
            (Some(_), 0) => values[0],
            (Some((start, end)), _) => {
                let part = (instant - start) / (end - start);
                (1.0 - part) * values[before] + part * values[next]
            }
        }
    };
    time.iter().map(|time| time - delay).map(at).collect()
}

/// The values of a candidate in the robot file and in the baseline.
pub(crate) fn values(structure: &Structure, baseline: &Baseline, candidate: Candidate) -> [f64; 2] {
    let place = |joint, parameter| FittedModel::place(structure, joint, parameter);
    let at = match candidate {
        Candidate::Coulomb(joint) => place(joint, FrictionParameter::Coulomb),
        Candidate::Viscous(joint) => place(joint, FrictionParameter::Viscous),
        Candidate::Offset(joint) => place(joint, FrictionParameter::Offset),
        Candidate::Payload => None,
        Candidate::Gain(_) => return [1.0; 2],
        // a file has no delay
        Candidate::Delay => return [0.0, baseline.model.delay],
    };
    let file = FittedModel::of_file(structure, &baseline.model.transitions);
    at.map_or([0.0; 2], |at| [file.solution[at], baseline.model.solution[at]])
}

fn event(structure: &Structure, baseline: &Baseline, selection: &Selection<'_>, found: &Finding) -> Event {
    let Finding { statistic, window } = found;
    let candidate = statistic.candidate;
    let [file_value, baseline_value] = values(structure, baseline, candidate);
    let (run, since, until) = times(&selection.stretches[window.clone()]);
    Event {
        joint: candidate.joint(),
        parameter: candidate.parameter(),
        value: baseline_value + statistic.change,
        file_value,
        baseline_value,
        deviation: statistic.deviation,
        half_interval: rne_identify::student(baseline.freedom) * statistic.deviation,
        threshold: statistic.threshold,
        unit: unit(structure.robot(), candidate),
        run,
        since,
        until,
        is_whole: *window == (0..selection.stretches.len()),
        lasts: window.end == selection.stretches.len(),
        rivals: selection.rivals(found).into_iter().map(Candidate::parameter).collect(),
        ..Event::blank(Cause::of(candidate))
    }
}

fn times(list: &[&Stretch]) -> (u64, f64, f64) {
    let last = list.last().map_or(f64::NAN, |last| last.end);
    list.first().map_or((0, f64::NAN, last), |first| (first.run, first.start, last))
}

fn grown(structure: &Structure, selection: &Selection<'_>, joint: usize, [value, baseline_value]: [f64; 2]) -> Event {
    let (run, since, until) = times(&selection.stretches);
    Event {
        joint: Some(joint),
        parameter: "residual",
        value,
        file_value: baseline_value,
        baseline_value,
        threshold: (GROWN - 1.0) * baseline_value,
        unit: unit(structure.robot(), Candidate::Offset(joint)),
        run,
        since,
        until,
        is_whole: true,
        lasts: true,
        ..Event::blank(Cause::Model)
    }
}

/// The root mean square of what the model leaves of each joint, with all changes that were found, N m or N; over
/// the stretches in which nobody touches the arm.
fn residual(baseline: &Baseline, selection: &Selection<'_>) -> Vec<f64> {
    let unknowns = selection.unknowns();
    let of_joint = |joint: usize| {
        let stretches = selection.stretches.iter().zip(&unknowns);
        let residuals = stretches.map(|(stretch, unknowns)| selection.residual(joint, stretch, unknowns));
        let sum = residuals.fold(Residual::default(), Residual::plus);
        sum.root_mean_square().unwrap_or(baseline.residual[joint])
    };
    (0..baseline.residual.len()).map(of_joint).collect()
}
