//! The reports on events and trends that `rne watch --json` and Python return; docs/control/watch.md lists their keys.

use rne_identify::JointError;
use rne_logs::UtcTime;
use rne_model::Robot;
use serde::Serialize;

use crate::baseline::Baseline;
use crate::candidate::Candidate;
use crate::event::{Cause, Event, unit};
use crate::report::Report;
use crate::selection::Statistic;
use crate::trend::Trend;

/// The report on a log, which serde can write in any format. Numbers that are not finite are null.
#[derive(Debug, Serialize)]
pub struct WatchReply {
    robot: String,
    log: String,
    /// Names of the logs, or of the file, of the baseline.
    baseline: String,
    /// Cut-off of the low-pass filter, Hz.
    low_pass: f64,
    read_to: f64,
    events: Vec<OfEvent>,
    parameters: Vec<OfParameter>,
    joints: Vec<OfJoint>,
}

#[derive(Debug, Serialize)]
struct OfEvent {
    cause: &'static str,
    joint: Option<usize>,
    name: Option<String>,
    parameter: &'static str,
    value: f64,
    file_value: f64,
    baseline_value: f64,
    deviation: Option<f64>,
    half_interval: Option<f64>,
    threshold: Option<f64>,
    unit: &'static str,
    run: u64,
    since: f64,
    until: f64,
    whole: bool,
    /// Whether the event lasts until the end of the log.
    lasts: bool,
    /// Dates of `since` and `until` by RFC 3339, UTC; those of the beginning and end of the log if the change already
    /// exists there, or still exists.
    since_time: Option<String>,
    until_time: Option<String>,
    /// Dates that limit a change over the whole log: it began after `not_before_time`, the end of earlier quiet logs,
    /// and ended before `not_after_time`, the beginning of later quiet logs.
    not_before_time: Option<String>,
    not_after_time: Option<String>,
    /// Further joints of a contact.
    also: Vec<usize>,
    /// Causes that the log cannot distinguish from this one: `temperature`, `speed`, `coulomb`, `viscous`.
    rivals: Vec<&'static str>,
}

#[derive(Debug, Serialize)]
struct OfParameter {
    cause: &'static str,
    joint: Option<usize>,
    name: Option<String>,
    parameter: &'static str,
    change: f64,
    deviation: f64,
    threshold: f64,
    ratio: f64,
    unit: &'static str,
    /// Whether the quiet log determines the parameter.
    watched: bool,
}

#[derive(Debug, Serialize)]
struct OfJoint {
    joint: usize,
    name: String,
    error: Option<f64>,
    unfiltered: Option<f64>,
    /// Root mean square of the residual torque with all changes, and of the baseline, N m or N.
    residual: f64,
    residual_of_baseline: f64,
    /// The standard deviation of the torque that the momentum observer finds without any contact, N m or N. A contact
    /// is a torque that is larger than a multiple of it.
    observer_deviation: f64,
}

fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

fn name(robot: &Robot, joint: Option<usize>) -> Option<String> {
    joint.map(|joint| robot.coordinate_name(joint).to_owned())
}

fn rivals(event: &Event) -> Vec<&'static str> {
    let of_friction: &[&str] = if event.cause == Cause::Friction { &["temperature", "speed"] } else { &[] };
    of_friction.iter().chain(&event.rivals).copied().collect()
}

impl OfEvent {
    fn of(robot: &Robot, event: &Event) -> Self {
        Self {
            cause: event.cause.name(),
            joint: event.joint.map(|joint| joint + 1),
            name: name(robot, event.joint),
            parameter: event.parameter,
            value: event.value,
            file_value: event.file_value,
            baseline_value: event.baseline_value,
            deviation: finite(event.deviation),
            half_interval: finite(event.half_interval),
            threshold: finite(event.threshold),
            unit: event.unit,
            run: event.run + 1,
            since: event.since,
            until: event.until,
            whole: event.is_whole,
            lasts: event.lasts,
            since_time: event.since_time.map(UtcTime::rfc3339),
            until_time: event.until_time.map(UtcTime::rfc3339),
            not_before_time: event.not_before.map(UtcTime::rfc3339),
            not_after_time: event.not_after.map(UtcTime::rfc3339),
            also: event.others.iter().map(|joint| joint + 1).collect(),
            rivals: rivals(event),
        }
    }
}

impl WatchReply {
    /// Makes the report on a log with the name `log`; `words` describes its baseline.
    #[must_use]
    pub fn of(
        robot: &Robot,
        log: String,
        read_to: f64,
        words: &str,
        baseline: &Baseline,
        report: &Report,
        errors: &[JointError],
    ) -> Self {
        let of_parameter = |statistic: &Statistic| OfParameter {
            cause: Cause::of(statistic.candidate).name(),
            joint: statistic.candidate.joint().map(|joint| joint + 1),
            name: name(robot, statistic.candidate.joint()),
            parameter: statistic.candidate.parameter(),
            change: statistic.change,
            deviation: statistic.deviation,
            threshold: statistic.threshold,
            ratio: statistic.ratio(),
            unit: unit(robot, statistic.candidate),
            watched: baseline.scale.is_watched(statistic),
        };
        let of_joint = |(at, error): (usize, &JointError)| OfJoint {
            joint: at + 1,
            name: robot.coordinate_name(at).to_owned(),
            error: finite(error.error),
            unfiltered: finite(error.unfiltered),
            residual: report.changes.residual[at],
            residual_of_baseline: baseline.residual[at],
            observer_deviation: report.contact.joints[at].deviation,
        };
        Self {
            robot: robot.name.clone(),
            log,
            baseline: words.to_owned(),
            low_pass: baseline.cutoff,
            read_to,
            events: report.events.iter().map(|event| OfEvent::of(robot, event)).collect(),
            parameters: report.changes.statistics.iter().map(of_parameter).collect(),
            joints: errors.iter().enumerate().map(of_joint).collect(),
        }
    }
}

/// The report on a trend, which serde can write in any format. Numbers that are not finite are null.
#[derive(Debug, Serialize)]
pub struct TrendReply {
    robot: String,
    baseline: String,
    logs: Vec<OfRow>,
    left_out: Vec<OfLeftOut>,
}

/// A log that cannot be compared.
#[derive(Debug, Serialize)]
struct OfLeftOut {
    log: String,
    reason: String,
}

#[derive(Debug, Serialize)]
struct OfRow {
    log: String,
    events: Vec<OfEvent>,
    payload: Option<f64>,
    payload_deviation: Option<f64>,
    joints: Vec<OfFriction>,
}

#[derive(Debug, Serialize)]
struct OfFriction {
    joint: usize,
    name: String,
    coulomb: Option<f64>,
    coulomb_deviation: Option<f64>,
    threshold: Option<f64>,
    file_value: f64,
    residual: f64,
    unit: &'static str,
}

impl TrendReply {
    /// Makes the report on a trend with the events of each log; `words` describes the baseline.
    #[must_use]
    pub fn of(robot: &Robot, words: &str, trend: &Trend, events: &[Vec<Event>]) -> Self {
        let rows = trend.rows.iter().zip(events).map(|(row, events)| {
            let joints = row.friction.iter().zip(&row.residual).enumerate();
            let joints = joints.map(|(joint, (of, residual))| OfFriction {
                joint: joint + 1,
                name: robot.coordinate_name(joint).to_owned(),
                coulomb: finite(of.value),
                coulomb_deviation: finite(of.deviation),
                threshold: finite(of.threshold),
                file_value: trend.friction[joint][0],
                residual: *residual,
                unit: unit(robot, Candidate::Coulomb(joint)),
            });
            OfRow {
                log: row.name.clone(),
                events: events.iter().map(|event| OfEvent::of(robot, event)).collect(),
                payload: finite(row.payload.value),
                payload_deviation: finite(row.payload.deviation),
                joints: joints.collect(),
            }
        });
        let left_out = trend.left_out.iter();
        Self {
            robot: robot.name.clone(),
            baseline: words.to_owned(),
            logs: rows.collect(),
            left_out: left_out.map(|(log, reason)| OfLeftOut { log: log.clone(), reason: reason.clone() }).collect(),
        }
    }
}
