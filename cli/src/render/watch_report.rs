//! Writes the result of `rne watch` as text.

use std::fmt::Write as _;

use rne_model::{Robot, one_line};
use rne_watch::{Baseline, Candidate, Cause, Changes, Event, Report, Statistic, Trend, TrendValue, unit};

use crate::palette::{GOOD, QUIET, TITLE, WARNING};
use crate::render::layout::{Align, PAGE, cell, push_table, shortened, wrap};
use crate::render::watch_dates::{LogNames, times};
use crate::values::numbers::{rounded, with_deviation};

/// Largest number of events that are shown; the others are counted.
const SHOWN: usize = 40;

/// Number of joints in the table of a trend.
const COLUMNS: usize = 4;

/// Returns the name of a parameter, such as `elbow: Coulomb friction`.
fn parameter(robot: &Robot, candidate: Candidate) -> String {
    let name = |joint: usize| one_line(robot.coordinate_name(joint));
    match candidate {
        Candidate::Coulomb(joint) => format!("{}: Coulomb friction", name(joint)),
        Candidate::Viscous(joint) => format!("{}: viscous friction", name(joint)),
        Candidate::Offset(joint) => format!("{}: offset of the effort", name(joint)),
        Candidate::Payload => "payload".to_owned(),
        Candidate::Delay => "delay of the efforts".to_owned(),
        Candidate::Gain(joint) => format!("{}: gain of the effort", name(joint)),
    }
}

/// Appends a unit to a number, or nothing if the number is a ratio.
fn with_unit(number: &str, unit: &str) -> String {
    if unit == "1" { number.to_owned() } else { format!("{number} {unit}") }
}

/// Writes the events, and how near the other parameters are to their thresholds.
pub(crate) fn events(
    robot: &Robot,
    baseline: &Baseline,
    report: &Report,
    has_runs: bool,
    names: &LogNames<'_>,
) -> String {
    let events = &report.events;
    let mut text = match events.len() {
        0 => format!("\n{GOOD}no events{GOOD:#}\n"),
        1 => format!("\n{WARNING}1 event{WARNING:#}\n"),
        count => format!("\n{WARNING}{count} events{WARNING:#}\n"),
    };
    for event in events.iter().take(SHOWN) {
        let sentence = sentence(robot, event, has_runs, names);
        let _ = writeln!(text, "  {}", wrap(&sentence, PAGE - 2, "    "));
    }
    if events.len() > SHOWN {
        let _ = writeln!(text, "  and {} more; --json prints all of them", events.len() - SHOWN);
    }
    if events.iter().take(SHOWN).any(|event| event.deviation.is_finite()) {
        let _ = writeln!(text, "  {QUIET}{DEVIATION}{QUIET:#}");
    }
    if events.iter().any(|event| event.cause == Cause::Friction) {
        let _ = writeln!(text, "  {QUIET}{}{QUIET:#}", wrap(RIVALS, PAGE - 2, "  "));
    }
    // if a position channel is wrong, the other parameters are not known
    let is_known = !events.iter().any(|event| event.parameter == "frozen_position");
    if let Some(nearest) = report.changes.nearest(&baseline.scale).filter(|_| is_known) {
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

/// The line below the events that explains standard deviations, if an event has one.
const DEVIATION: &str = "± is one standard deviation.";

/// The lines below the events that name other reasons for a change of friction, if there is such a change.
const RIVALS: &str = "Temperature and speed change friction, too: compare with a quiet log of the same motion and of a \
    warm arm before you look for wear.";

/// Lists joints whose Coulomb friction is too uncertain to report events on it.
fn unknown(robot: &Robot, baseline: &Baseline, changes: &Changes) -> Vec<String> {
    let is_unknown = |statistic: &&Statistic| {
        matches!(statistic.candidate, Candidate::Coulomb(_)) && !baseline.scale.is_watched(statistic)
    };
    let joints = changes.statistics.iter().filter(is_unknown).filter_map(|statistic| statistic.candidate.joint());
    joints.map(|joint| one_line(robot.coordinate_name(joint))).collect()
}

/// Writes a change and how large a part of its threshold it is.
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

/// Describes an event in a sentence.
fn sentence(robot: &Robot, event: &Event, has_runs: bool, names: &LogNames<'_>) -> String {
    let unit = event.unit;
    let joint = event.joint.map_or(String::new(), |joint| one_line(robot.coordinate_name(joint)));
    let value = with_unit(&with_deviation(event.value, event.deviation), unit);
    let percent = |base: f64| {
        let part = 100.0 * event.change() / base.abs();
        if part.is_finite() && part.abs() < 1000.0 { format!(" ({part:+.0} %)") } else { String::new() }
    };
    let what = match event.cause {
        Cause::Friction => {
            let change = event.change();
            let sign = if change < 0.0 { "" } else { "+" };
            let impossible = if event.value < 0.0 {
                "; friction cannot be negative: suspect the sensor of this joint, or a unit"
            } else {
                ""
            };
            format!(
                "friction of {joint}: {} {sign}{}{}, from {} to {}{}{impossible}",
                friction(event.parameter),
                with_unit(&with_deviation(change, event.deviation), unit),
                percent(event.baseline_value),
                rounded(event.baseline_value, 3),
                rounded(event.value, 3),
                rivals(event)
            )
        }
        Cause::Payload if event.value < 0.0 => format!("payload: {value}: the tip has lost mass"),
        Cause::Payload => format!("payload: {value} at the tip"),
        Cause::Sensor => sensor(robot, event, &joint, &value),
        Cause::Contact => {
            let others = others(robot, event);
            let too = if others.is_empty() { others } else { format!(" (also at {others})") };
            format!("contact at {joint}{too}: external torque up to {} {unit}", rounded(event.value, 3))
        }
        Cause::Model => format!(
            "model of {joint}: its error is {} {unit}, before {}; no single parameter explains it",
            rounded(event.value, 3),
            rounded(event.baseline_value, 3)
        ),
    };
    format!("{what}; {}", times(event, has_runs, names))
}

/// Lists the other joints of an event.
fn others(robot: &Robot, event: &Event) -> String {
    event.others.iter().map(|joint| one_line(robot.coordinate_name(*joint))).collect::<Vec<_>>().join(", ")
}

/// Describes a fault of a joint's sensor.
fn sensor(robot: &Robot, event: &Event, joint: &str, value: &str) -> String {
    match event.parameter {
        "delay" => format!(
            "sensors: the efforts are {value} behind the positions, before {:.3}",
            // adding 0.0 avoids a minus before zero
            (1e3 * event.baseline_value).round() / 1e3 + 0.0
        ),
        "frozen" => {
            let value = with_unit(&rounded(event.value, 3), event.unit);
            format!("sensor of {joint}: the effort stays at {value}, although the joint moves: the channel is frozen")
        }
        "frozen_position" => {
            let value = with_unit(&rounded(event.value, 3), event.unit);
            format!(
                "sensor of {joint}: the position stays at {value}, although the velocity says that the joint moves: \
                 the channel is frozen; rne looks for no other event, because the model needs this position"
            )
        }
        "exchanged" => {
            let other = others(robot, event);
            format!(
                "sensors: the efforts of {joint} and {other} look exchanged; the other results hold for the efforts \
                 exchanged back"
            )
        }
        "gain" => {
            format!("sensor of {joint}: the effort is {value} of the torque{}", gain(event))
        }
        _ => format!(
            "sensor of {joint}: the effort has an offset of {value}, before {}",
            rounded(event.baseline_value, 3)
        ),
    }
}

fn friction(parameter: &str) -> &'static str {
    if parameter == "viscous" { "viscous friction" } else { "Coulomb friction" }
}

/// Names other causes that explain the log almost as well as the change.
fn rivals(event: &Event) -> String {
    let sentence = |rival: &&'static str| format!("; {} would explain it almost as well", friction(rival));
    event.rivals.iter().map(sentence).collect::<Vec<_>>().concat()
}

/// Names possible reasons for a changed gain of an effort.
fn gain(event: &Event) -> &'static str {
    if event.value.abs() < event.threshold {
        ": it does not follow the motion, so the channel can be dead"
    } else if event.value < 0.0 {
        ": it has the opposite sign"
    } else {
        ": another unit, another torque constant, or a fault of the sensor"
    }
}

/// Writes all parameters with their thresholds.
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

/// The beginning of the table of [`parameters_csv`].
pub(crate) const PARAMETERS: &str = "cause,joint,name,parameter,";

/// Writes all parameters with their thresholds as CSV: a header, then a line for each parameter. Columns are named like
/// the keys of `--json`; numbers have all digits. For a parameter of the whole arm the joint is empty.
pub(crate) fn parameters_csv(robot: &Robot, baseline: &Baseline, changes: &Changes) -> String {
    let mut text = format!("{PARAMETERS}change,deviation,threshold,ratio,unit,watched\n");
    for statistic in &changes.statistics {
        let candidate = statistic.candidate;
        let joint = candidate.joint().map_or_else(String::new, |joint| (joint + 1).to_string());
        let name = candidate.joint().map_or_else(String::new, |joint| cell(&one_line(robot.coordinate_name(joint))));
        let (cause, unit) = (Cause::of(candidate).name(), unit(robot, candidate));
        let Statistic { change, deviation, threshold, .. } = statistic;
        let (ratio, is_watched) = (statistic.ratio(), baseline.scale.is_watched(statistic));
        let _ = writeln!(
            text,
            "{cause},{joint},{name},{},{change:?},{deviation:?},{threshold:?},{ratio:?},{unit},{is_watched}",
            candidate.parameter()
        );
    }
    text
}

/// Writes a trend as a table, with the events of each log.
pub(crate) fn trend(robot: &Robot, trend: &Trend, events: &[Vec<Event>], names: &[LogNames<'_>]) -> String {
    let joints = changing(trend);
    let mut cells = vec![vec!["  log".to_owned(), "events".to_owned(), "payload, kg".to_owned()]];
    cells[0].extend(joints.iter().map(|joint| shortened(&one_line(robot.coordinate_name(*joint)), 14)));
    let with = |found: TrendValue| with_deviation(found.value, found.deviation);
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
    for ((row, events), names) in trend.rows.iter().zip(events).zip(names) {
        for event in events {
            let said = format!("{}: {}", row.name, sentence(robot, event, false, names));
            let _ = writeln!(text, "  {}", wrap(&said, PAGE - 2, "    "));
        }
    }
    text
}

/// Returns the joints whose friction changes most from log to log, in the order of the arm.
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
