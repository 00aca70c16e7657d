//! The report on a log that `rne log --json` and Python return; docs/control/logs.md lists its keys.

use rne_logs::{Cutoff, LeftOut, Log, Run, Survey};
use serde::Serialize;

/// The report on a log, which serde can write in any format.
#[derive(Debug, Serialize)]
pub struct LogReply {
    format: String,
    topic: Option<String>,
    recorded_times: bool,
    origin_ns: i64,
    rate: f64,
    velocities: bool,
    efforts: bool,
    joints: Vec<OfJoint>,
    ignored_joints: Vec<String>,
    messages: u64,
    states: u64,
    left_out: Vec<OfLeftOut>,
    run_count: u64,
    runs: Vec<OfRun>,
    cutoff: Option<f64>,
    cutoff_from: &'static str,
    dropped_states: usize,
    notes: Vec<String>,
}

#[derive(Debug, Serialize)]
struct OfJoint {
    name: String,
    position: (f64, f64),
    velocity: Option<(f64, f64)>,
    effort: Option<(f64, f64)>,
    velocity_disagreement: Option<f64>,
    motion_ends: Option<f64>,
}

#[derive(Debug, Serialize)]
struct OfLeftOut {
    why: String,
    messages: u64,
}

impl OfLeftOut {
    fn of(left_out: &LeftOut) -> Self {
        Self { why: left_out.why(), messages: left_out.count }
    }
}

#[derive(Debug, Serialize)]
struct OfRun {
    begins: String,
    start: f64,
    duration: f64,
    states: u64,
    jitter: f64,
    longest_interval: f64,
}

impl LogReply {
    /// Makes the report on a log, with notes in sentences.
    #[must_use]
    pub fn of(log: &Log, survey: &Survey, notes: Vec<String>) -> Self {
        let layout = log.layout();
        let ends = match &survey.cutoff {
            Cutoff::Spectrum { ends, .. } => Some(ends),
            _ => None,
        };
        let joint = |(joint, name): (usize, &String)| OfJoint {
            name: name.clone(),
            position: survey.positions[joint],
            velocity: survey.velocities.get(joint).copied(),
            effort: survey.efforts.get(joint).copied(),
            velocity_disagreement: survey.disagreement.get(joint).copied(),
            motion_ends: ends.and_then(|ends| ends.get(joint)).copied(),
        };
        let run = |run: &Run| OfRun {
            begins: run.begins.to_string(),
            start: run.start,
            duration: run.duration,
            states: run.states,
            jitter: run.jitter,
            longest_interval: run.longest,
        };
        Self {
            format: layout.format.to_string(),
            topic: layout.topic.clone(),
            recorded_times: layout.recorded,
            origin_ns: layout.origin,
            rate: 1.0 / layout.step,
            velocities: layout.has_velocities,
            efforts: layout.has_efforts,
            joints: layout.joints.iter().enumerate().map(joint).collect(),
            ignored_joints: layout.ignored.clone(),
            messages: survey.counts.messages,
            states: survey.counts.states,
            left_out: log.left_out(survey).iter().map(OfLeftOut::of).collect(),
            run_count: survey.run_count,
            runs: survey.runs.iter().map(run).collect(),
            cutoff: survey.cutoff.hertz(),
            cutoff_from: match survey.cutoff {
                Cutoff::Given { .. } => "given",
                Cutoff::Spectrum { .. } => "spectrum",
                Cutoff::Unknown => "unknown",
            },
            dropped_states: survey.dropped,
            notes,
        }
    }
}
