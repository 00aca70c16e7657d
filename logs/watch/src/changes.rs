//! Finds the changes of an arm's parameters between a baseline and a log.

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

/// Ratio of a residual to that of the baseline above which the error of the model counts as grown.
const GROWN: f64 = 3.0;

/// Time before and after a constant effort in which the filters change the effort, s.
const EDGE: f64 = 1.0;

/// A time in a log: the number of the run, and the time, s.
type Instant = (u64, f64);

/// A change of all unknowns and gains between two times of a log.
#[derive(Clone, Debug, PartialEq)]
struct Window {
    ends: [Instant; 2],
    change: DVector<f64>,
}

/// The changes between a baseline and a log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Changes {
    /// The changes that are events; the one that explains most comes first.
    pub events: Vec<Event>,
    /// The changes of all other parameters, with their thresholds.
    pub statistics: Vec<Statistic>,
    /// Root mean square of the torque of each joint that the baseline's model with all changes does not explain, N m
    /// or N.
    pub residual: Vec<f64>,
    /// The root mean square of the efforts over that of the quiet logs; the median over the joints. If it is far from
    /// 1, the efforts have another unit.
    pub effort_ratio: f64,
    /// The two joints whose efforts are exchanged in the log, counted from 0. All other results are for the log with
    /// these efforts exchanged back.
    pub exchanged: Option<[usize; 2]>,
    windows: Vec<Window>,
}

impl Changes {
    /// Finds the changes of a log in which the efforts of two joints are exchanged, from the equations with these
    /// efforts exchanged back.
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

    /// Whether the effort of a joint repeats one value during some times of a run.
    pub(crate) fn is_frozen(&self, joint: usize, run: u64, times: Range<f64>) -> bool {
        let is_near = |event: &Event| event.since - EDGE < times.end && times.start < event.until + EDGE;
        self.events.iter().any(|event| {
            event.parameter == "frozen" && event.joint == Some(joint) && (event.run != run || is_near(event))
        })
    }

    /// Finds the changes of a log, which is given by its equations; `None` if it is too short to compare.
    #[must_use]
    pub fn of(structure: &Structure, baseline: &Baseline, log: &Stretches) -> Option<Self> {
        let frozen = Frozen::all(structure, baseline, log.list());
        let list = Frozen::without(&frozen, baseline, log.list());
        let selection = Selection::of(structure, baseline, &list)?;
        let findings = selection.findings();
        let mut events: Vec<Event> = frozen.iter().map(|frozen| frozen.event(structure, log.list())).collect();
        events.extend(findings.iter().map(|found| event(structure, baseline, &selection, found)));
        let residual = residual(baseline, &selection);
        // residuals cannot be compared with a robot file, whose errors are those of another motion
        let has_quiet_log = baseline.doubt == 1.0;
        for (joint, (now, before)) in residual.iter().zip(&baseline.residual).enumerate() {
            // the model may not have the exact shape of a detected change, so a residual may remain
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
            // a change from the first row to the last one also exists before and after them, in runs that are too short
            // to have rows
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

    /// Returns for each joint the torques that the changes add along a motion of a run, N m or N.
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

    /// Returns the statistic that is nearest to its threshold, among those that the logs determine.
    #[must_use]
    pub fn nearest(&self, scale: &Scale) -> Option<&Statistic> {
        let watched = self.statistics.iter().filter(|statistic| scale.is_watched(statistic));
        watched.max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
    }
}

/// Returns the ratio of the efforts of a log to those of the baseline; the median over the joints that have efforts in
/// both.
fn effort_ratio(structure: &Structure, baseline: &Baseline, log: &Stretches) -> f64 {
    let totals = products_of_joints(structure, log.list());
    let now = Scale::of(structure, &baseline.model, &totals).effort;
    let ratios = now.iter().zip(&baseline.scale.effort).map(|(now, before)| now / before);
    let ratios: Vec<f64> = ratios.filter(|ratio| *ratio > 0.0 && ratio.is_finite()).collect();
    if ratios.is_empty() { 1.0 } else { median(ratios) }
}

/// Returns values delayed by `delay`, s.
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

/// Returns the values of a candidate in the robot file and in the baseline.
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

/// Returns the root mean square of each joint's residual torque, N m or N, with all changes that were found, over the
/// stretches without contacts.
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
