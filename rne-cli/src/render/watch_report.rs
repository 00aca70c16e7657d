//! The result of `rne watch`, as text and as JSON.

use std::fmt::Write as _;

use rne_identify::JointError;
use rne_model::{Robot, one_line};
use rne_watch::{Baseline, Candidate, Cause, Changes, Event, Report, Statistic, Trend, TrendValue, unit};
use serde::Serialize;

use crate::files::motion_log::MotionLog;
use crate::palette::{GOOD, QUIET, TITLE, WARNING};
use crate::render::layout::{Align, PAGE, push_table, shortened, wrap};
use crate::values::numbers::{rounded, with_deviation};

/// Events that are shown; the others are counted.
const SHOWN: usize = 40;

/// Joints in the table of a trend.
const COLUMNS: usize = 4;

/// The name of a parameter: `elbow: Coulomb friction`.
fn parameter(robot: &Robot, candidate: Candidate) -> String {
    let name = |joint: usize| one_line(&robot.joints[joint].name);
    match candidate {
        Candidate::Coulomb(joint) => format!("{}: Coulomb friction", name(joint)),
        Candidate::Viscous(joint) => format!("{}: viscous friction", name(joint)),
        Candidate::Offset(joint) => format!("{}: offset of the effort", name(joint)),
        Candidate::Payload => "payload".to_owned(),
        Candidate::Delay => "delay of the efforts".to_owned(),
        Candidate::Gain(joint) => format!("{}: gain of the effort", name(joint)),
    }
}

/// A number with its unit; a ratio has none.
fn with_unit(number: &str, unit: &str) -> String {
    if unit == "1" { number.to_owned() } else { format!("{number} {unit}") }
}

/// Events, and how near the other parameters are to their thresholds.
pub(crate) fn events(robot: &Robot, baseline: &Baseline, report: &Report, has_runs: bool) -> String {
    let events = &report.events;
    let mut text = match events.len() {
        0 => format!("\n{GOOD}no events{GOOD:#}\n"),
        1 => format!("\n{WARNING}1 event{WARNING:#}\n"),
        count => format!("\n{WARNING}{count} events{WARNING:#}\n"),
    };
    for event in events.iter().take(SHOWN) {
        let sentence = sentence(robot, event, has_runs);
        let _ = writeln!(text, "  {}", wrap(&sentence, PAGE - 2, "    "));
    }
    if events.len() > SHOWN {
        let _ = writeln!(text, "  and {} more; --json prints all of them", events.len() - SHOWN);
    }
    if events.iter().any(|event| event.cause == Cause::Friction) {
        let _ = writeln!(text, "  {QUIET}{}{QUIET:#}", wrap(RIVALS, PAGE - 2, "  "));
    }
    if let Some(nearest) = report.changes.nearest(&baseline.scale) {
        let others = if events.is_empty() { "largest change" } else { "largest change of the others" };
        let said = format!("{others}: {}", margin(robot, nearest));
        let _ = writeln!(text, "{QUIET}{}{QUIET:#}", wrap(&said, PAGE, "  "));
    }
    let unknown: Vec<String> = unknown(robot, baseline, &report.changes);
    if !unknown.is_empty() {
        let said = format!(
            "not watched: friction of {}: a joint must move in the quiet log and in this log, as in a motion that \
             `rne excite` designs",
            unknown.join(", ")
        );
        let _ = writeln!(text, "{QUIET}{}{QUIET:#}", wrap(&said, PAGE, "  "));
    }
    text
}

/// Said below changes of friction.
const RIVALS: &str = "Temperature and speed change friction, too: compare with a quiet log of the same motion and of a \
    warm arm before you look for wear.";

/// The joints whose Coulomb friction is not known well enough for any event.
fn unknown(robot: &Robot, baseline: &Baseline, changes: &Changes) -> Vec<String> {
    let is_unknown = |statistic: &&Statistic| {
        matches!(statistic.candidate, Candidate::Coulomb(_)) && !baseline.scale.is_watched(statistic)
    };
    let joints = changes.statistics.iter().filter(is_unknown).filter_map(|statistic| statistic.candidate.joint());
    joints.map(|joint| one_line(&robot.joints[joint].name)).collect()
}

/// A change with its share of the threshold.
fn margin(robot: &Robot, statistic: &Statistic) -> String {
    format!(
        "{}, {}, {} of its threshold",
        parameter(robot, statistic.candidate),
        with_unit(&signed(statistic.change), unit(robot, statistic.candidate)),
        rounded(statistic.ratio(), 2)
    )
}

fn signed(value: f64) -> String {
    let digits = rounded(value.abs(), 3);
    if value < 0.0 { format!("-{digits}") } else { format!("+{digits}") }
}

/// An event in a sentence.
pub(crate) fn sentence(robot: &Robot, event: &Event, has_runs: bool) -> String {
    let unit = event.unit;
    let joint = event.joint.map_or(String::new(), |joint| one_line(&robot.joints[joint].name));
    let value = with_unit(&with_deviation(event.value, event.deviation), unit);
    let percent = |base: f64| {
        let part = 100.0 * event.change() / base.abs();
        if part.is_finite() && part.abs() < 1000.0 { format!(", {part:+.0} %") } else { String::new() }
    };
    let what = match event.cause {
        Cause::Friction => {
            let kind = if event.parameter == "viscous" { "viscous friction" } else { "Coulomb friction" };
            format!(
                "friction of {joint}: {kind} {value}, before {}{}",
                rounded(event.baseline_value, 3),
                percent(event.baseline_value)
            )
        }
        Cause::Payload if event.value < 0.0 => format!("payload: {value}: the tip has lost mass"),
        Cause::Payload => format!("payload: {value} at the tip"),
        Cause::Sensor if event.parameter == "delay" => format!(
            "sensors: the efforts are {value} behind the positions, before {:.3}",
            // no minus before zero
            (1e3 * event.baseline_value).round() / 1e3 + 0.0
        ),
        Cause::Sensor if event.parameter == "gain" => {
            format!("sensor of {joint}: the effort is {value} of the torque{}", gain(event))
        }
        Cause::Sensor => format!(
            "sensor of {joint}: the effort has an offset of {value}, before {}",
            rounded(event.baseline_value, 3)
        ),
        Cause::Contact => {
            let others: Vec<String> = event.others.iter().map(|of| one_line(&robot.joints[*of].name)).collect();
            let too = if others.is_empty() { String::new() } else { format!(" (also at {})", others.join(", ")) };
            format!("contact at {joint}{too}: external torque up to {} {unit}", rounded(event.value, 3))
        }
        Cause::Model => format!(
            "model of {joint}: its error is {} {unit}, before {}; no single parameter explains it",
            rounded(event.value, 3),
            rounded(event.baseline_value, 3)
        ),
    };
    format!("{what}; {}", times(event, has_runs))
}

/// The reason for which an effort can have another gain.
fn gain(event: &Event) -> &'static str {
    if event.value.abs() < event.threshold {
        ": it does not follow the motion, so the channel can be dead"
    } else if event.value < 0.0 {
        ": it has the opposite sign"
    } else {
        ": another unit, another torque constant, or a fault of the sensor"
    }
}

fn times(event: &Event, has_runs: bool) -> String {
    let run = if has_runs { format!("run {}, ", event.run + 1) } else { String::new() };
    match event.cause {
        _ if event.is_whole => "in the whole log".to_owned(),
        Cause::Contact => format!("{run}{:.2} s to {:.2} s", event.since, event.until),
        _ if event.lasts => format!("{run}since {:.1} s", event.since),
        _ => format!("{run}since {:.1} s, until {:.1} s", event.since, event.until),
    }
}

/// All parameters with their thresholds.
pub(crate) fn parameters(robot: &Robot, baseline: &Baseline, changes: &Changes) -> String {
    let heading = ["  parameter", "change", "", "deviation", "threshold", "unit", "part of it"].map(str::to_owned);
    let mut cells = vec![heading];
    for statistic in &changes.statistics {
        let part =
            if baseline.scale.is_watched(statistic) { rounded(statistic.ratio(), 2) } else { "not watched".to_owned() };
        cells.push([
            format!("  {}", shortened(&parameter(robot, statistic.candidate), 34)),
            signed(statistic.change),
            "±".to_owned(),
            rounded(statistic.deviation, 2),
            rounded(statistic.threshold, 3),
            with_unit("", unit(robot, statistic.candidate)).trim().to_owned(),
            part,
        ]);
    }
    let align = [Align::Left, Align::Right, Align::Left, Align::Right, Align::Right, Align::Left, Align::Right];
    let mut text = String::new();
    push_table(&mut text, "changes against the comparison, over the whole log", &align, &cells);
    text
}

/// A trend as a table, with the events of each log.
pub(crate) fn trend(robot: &Robot, trend: &Trend, events: &[Vec<Event>]) -> String {
    let joints = changing(trend);
    let mut cells = vec![vec!["  log".to_owned(), "events".to_owned(), "payload, kg".to_owned()]];
    cells[0].extend(joints.iter().map(|joint| shortened(&one_line(&robot.joints[*joint].name), 14)));
    let with = |of: TrendValue| with_deviation(of.value, of.deviation);
    for row in &trend.rows {
        let mut line = vec![format!("  {}", shortened(&row.name, 20)), row.events.to_string(), with(row.payload)];
        line.extend(joints.iter().map(|joint| with(row.friction[*joint])));
        cells.push(line);
    }
    let mut align = vec![Align::Left];
    align.extend(std::iter::repeat_n(Align::Right, joints.len() + 2));
    let lines = crate::render::layout::columns(&align, &cells);
    let title = "Coulomb friction, N m or N, and payload; ± is one standard deviation";
    let mut text = format!("\n{TITLE}{title}{TITLE:#}\n{QUIET}{}{QUIET:#}\n", lines[0]);
    for line in &lines[1..] {
        let _ = writeln!(text, "{line}");
    }
    let left_out = trend.friction.len() - joints.len();
    if left_out > 0 {
        let _ = writeln!(text, "{QUIET}  {left_out} joints that change less are in --csv, --json and --plot{QUIET:#}");
    }
    if events.iter().all(Vec::is_empty) {
        let _ = writeln!(text, "\n{GOOD}no events{GOOD:#}");
        return text;
    }
    let count: usize = events.iter().map(Vec::len).sum();
    let _ = writeln!(text, "\n{WARNING}{count} event{}{WARNING:#}", if count == 1 { "" } else { "s" });
    for (row, events) in trend.rows.iter().zip(events) {
        for event in events {
            let said = format!("{}: {}", row.name, sentence(robot, event, false));
            let _ = writeln!(text, "  {}", wrap(&said, PAGE - 2, "    "));
        }
    }
    text
}

/// The joints whose friction changes most from log to log, in the order of the arm.
fn changing(trend: &Trend) -> Vec<usize> {
    let range = |joint: &usize| {
        let values = trend.rows.iter().map(|row| row.friction[*joint].value);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        let least = trend.rows.iter().map(|row| row.friction[*joint].threshold).fold(f64::INFINITY, f64::min);
        (high - low) / least
    };
    let mut joints: Vec<usize> = (0..trend.friction.len()).collect();
    joints.sort_by(|a, b| range(b).total_cmp(&range(a)));
    joints.truncate(COLUMNS);
    joints.sort_unstable();
    joints
}

/// The result for a log as JSON.
#[derive(Serialize)]
pub(crate) struct Reply {
    robot: String,
    log: String,
    /// The logs or the file of the baseline.
    baseline: String,
    /// Hz
    low_pass: f64,
    read_to: f64,
    events: Vec<OfEvent>,
    parameters: Vec<OfParameter>,
    joints: Vec<OfJoint>,
}

#[derive(Serialize)]
pub(crate) struct OfEvent {
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
    /// Whether it lasts until the end of the log.
    lasts: bool,
    /// Further joints of a contact.
    also: Vec<usize>,
    /// Causes that the log cannot tell from this one.
    rivals: Vec<&'static str>,
}

#[derive(Serialize)]
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
    /// Whether the quiet log determines it.
    watched: bool,
}

#[derive(Serialize)]
struct OfJoint {
    joint: usize,
    name: String,
    error: Option<f64>,
    unfiltered: Option<f64>,
    /// N m or N, root mean square: what is left with all changes, and before.
    residual: f64,
    residual_of_baseline: f64,
    /// Deviation of the observer's torque, N m or N; contacts are beyond a multiple of it.
    observer_deviation: f64,
}

fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

fn name(robot: &Robot, joint: Option<usize>) -> Option<String> {
    joint.map(|joint| robot.joints[joint].name.clone())
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
            also: event.others.iter().map(|joint| joint + 1).collect(),
            rivals: if event.cause == Cause::Friction { vec!["temperature", "speed"] } else { Vec::new() },
        }
    }
}

impl Reply {
    pub(crate) fn of(
        robot: &Robot,
        log: &MotionLog,
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
            name: robot.joints[at].name.clone(),
            error: finite(error.error),
            unfiltered: finite(error.unfiltered),
            residual: report.changes.residual[at],
            residual_of_baseline: baseline.residual[at],
            observer_deviation: report.contact.joints[at].deviation,
        };
        Self {
            robot: robot.name.clone(),
            log: log.words(),
            baseline: words.to_owned(),
            low_pass: baseline.cutoff,
            read_to: log.read_to(),
            events: report.events.iter().map(|event| OfEvent::of(robot, event)).collect(),
            parameters: report.changes.statistics.iter().map(of_parameter).collect(),
            joints: errors.iter().enumerate().map(of_joint).collect(),
        }
    }
}

/// A trend as JSON.
#[derive(Serialize)]
pub(crate) struct TrendReply {
    robot: String,
    baseline: String,
    logs: Vec<OfRow>,
    left_out: Vec<OfLeftOut>,
}

/// A log that cannot be compared.
#[derive(Serialize)]
struct OfLeftOut {
    log: String,
    reason: String,
}

#[derive(Serialize)]
struct OfRow {
    log: String,
    events: Vec<OfEvent>,
    payload: Option<f64>,
    payload_deviation: Option<f64>,
    joints: Vec<OfFriction>,
}

#[derive(Serialize)]
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
    pub(crate) fn of(robot: &Robot, words: &str, trend: &Trend, events: &[Vec<Event>]) -> Self {
        let rows = trend.rows.iter().zip(events).map(|(row, events)| {
            let joints = row.friction.iter().zip(&row.residual).enumerate();
            let joints = joints.map(|(joint, (of, residual))| OfFriction {
                joint: joint + 1,
                name: robot.joints[joint].name.clone(),
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
