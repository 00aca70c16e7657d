//! Content of a log, as text and as JSON.

use std::fmt::Write as _;

use rne_logs::{Counts, Cutoff, Format, InvalidSample, Log, Run, Survey};
use rne_model::one_line;
use serde::Serialize;

use crate::palette::{QUIET, TITLE, WARNING};
use crate::render::layout::{Align, columns, wrap};
use crate::terminal;

/// Runs that are shown; the others are counted.
const SHOWN: usize = 20;

/// Relative difference between velocities and differences of positions from which it is reported.
const DISAGREEMENT: f64 = 0.05;

/// A log as JSON has it.
#[derive(Serialize)]
pub(crate) struct Reply {
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
    left_out: Vec<LeftOut>,
    run_count: u64,
    runs: Vec<OfRun>,
    cutoff: Option<f64>,
    cutoff_from: &'static str,
    dropped_states: usize,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct OfJoint {
    name: String,
    position: (f64, f64),
    velocity: Option<(f64, f64)>,
    effort: Option<(f64, f64)>,
    velocity_disagreement: Option<f64>,
    motion_ends: Option<f64>,
}

#[derive(Serialize)]
struct LeftOut {
    why: String,
    messages: u64,
}

#[derive(Serialize)]
struct OfRun {
    begins: String,
    start: f64,
    duration: f64,
    states: u64,
    jitter: f64,
    longest_interval: f64,
}

impl Reply {
    pub(crate) fn of(log: &Log, survey: &Survey) -> Self {
        let layout = log.layout();
        let ends = ends(survey);
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
            left_out: left_out(log, survey).map(|(messages, why)| LeftOut { why, messages }).collect(),
            run_count: survey.run_count,
            runs: survey.runs.iter().map(run).collect(),
            cutoff: survey.cutoff.hertz(),
            cutoff_from: match survey.cutoff {
                Cutoff::Given { .. } => "given",
                Cutoff::Spectrum { .. } => "spectrum",
                Cutoff::Unknown => "unknown",
            },
            dropped_states: survey.dropped,
            notes: notes(log, survey).into_iter().map(|(note, _)| note).collect(),
        }
    }
}

/// A log for people.
pub(crate) fn text(log: &Log, survey: &Survey) -> String {
    let layout = log.layout();
    let mut text = String::new();
    let files: Vec<String> = log.files().iter().map(|file| file.display().to_string()).collect();
    let topic = layout.topic.as_ref().map_or(String::new(), |topic| format!(", {topic}"));
    let _ = writeln!(text, "{TITLE}{}{TITLE:#}  {}{topic}", files.join(" "), layout.format);
    let counts = &survey.counts;
    let (what, times) = match layout.format {
        Format::Sqlite | Format::Mcap if layout.recorded => ("messages", "; times: receive times"),
        Format::Sqlite | Format::Mcap => ("messages", "; times: message stamps"),
        Format::Parquet | Format::Npy | Format::Csv => ("rows", ""),
    };
    let _ = writeln!(
        text,
        "{} of {} {what} contain states, at {} Hz{times}\n",
        counts.states,
        counts.messages,
        short(1.0 / layout.step)
    );
    text += &joints(log, survey);
    text.push('\n');
    text += &runs(survey);
    text.push('\n');
    text += &filter(log, survey);
    for (messages, why) in left_out(log, survey) {
        let _ = writeln!(text, "{WARNING}left out{WARNING:#}: {messages} messages {why}");
    }
    for (note, is_warning) in notes(log, survey) {
        let (word, style) = if is_warning { ("warning", WARNING) } else { ("note", QUIET) };
        let wrapped = wrap(&format!("{word}: {note}"), terminal::width(100), "  ");
        let _ = writeln!(text, "{style}{word}{style:#}{}", wrapped.trim_end().strip_prefix(word).unwrap_or(&wrapped));
    }
    text
}

fn joints(log: &Log, survey: &Survey) -> String {
    let range = |(least, most): &(f64, f64)| format!("{} … {}", short(*least), short(*most));
    let mut lines = vec![["", "joint", "position", "velocity", "effort", "motion up to"].map(str::to_owned).to_vec()];
    let ends = ends(survey);
    for (joint, name) in log.layout().joints.iter().enumerate() {
        lines.push(vec![
            (joint + 1).to_string(),
            name.clone(),
            range(&survey.positions[joint]),
            survey.velocities.get(joint).map_or_else(|| "none".to_owned(), range),
            survey.efforts.get(joint).map_or_else(|| "none".to_owned(), range),
            ends.and_then(|ends| ends.get(joint)).map_or(String::new(), |end| format!("{} Hz", short(*end))),
        ]);
    }
    let alignment = [Align::Right, Align::Left, Align::Right, Align::Right, Align::Right, Align::Right];
    titled(&columns(&alignment, &lines))
}

fn runs(survey: &Survey) -> String {
    let titles = ["run", "start", "duration", "states", "jitter", "longest interval", "begins"];
    let mut lines = vec![titles.map(str::to_owned).to_vec()];
    for (number, run) in survey.runs.iter().take(SHOWN).enumerate() {
        lines.push(vec![
            (number + 1).to_string(),
            format!("{:.3} s", run.start),
            format!("{:.3} s", run.duration),
            run.states.to_string(),
            format!("{} ms", short(run.jitter * 1e3)),
            format!("{} ms", short(run.longest * 1e3)),
            run.begins.to_string(),
        ]);
    }
    let alignment = [Align::Right, Align::Right, Align::Right, Align::Right, Align::Right, Align::Right, Align::Left];
    let mut text = titled(&columns(&alignment, &lines));
    let others = survey.run_count - survey.runs.len().min(SHOWN) as u64;
    if others > 0 {
        let _ = writeln!(text, "{QUIET}and {others} other runs{QUIET:#}");
    }
    text
}

/// The first line as a title.
fn titled(lines: &[String]) -> String {
    let mut text = String::new();
    for (place, line) in lines.iter().enumerate() {
        let line = line.trim_end();
        let _ = if place == 0 { writeln!(text, "{QUIET}{line}{QUIET:#}") } else { writeln!(text, "{line}") };
    }
    text
}

#[expect(clippy::cast_precision_loss, reason = "states of the ends of a run")]
fn filter(log: &Log, survey: &Survey) -> String {
    let why = match &survey.cutoff {
        Cutoff::Unknown => {
            return "no run is long enough for a spectrum (a second and 64 states): give the filter with --cutoff HZ\n"
                .into();
        }
        Cutoff::Given { .. } => "as given".to_owned(),
        Cutoff::Spectrum { bounded: false, .. } => "1.5 times the end of motion".to_owned(),
        Cutoff::Spectrum { .. } => "a bound of the automatic choice, 2 Hz or a fifth of the rate".to_owned(),
    };
    let hertz = survey.cutoff.hertz().unwrap_or_default();
    let long_enough = survey.runs.iter().filter(|run| run.duration / log.layout().step > 2.0 * survey.dropped as f64);
    let text = format!(
        "cut-off {} Hz, {why}: passes below {} Hz, stops above {} Hz, drops {:.3} s at both ends of a run; {} of {} \
         runs long enough",
        short(hertz),
        short(hertz * 2.0 / 3.0),
        short(hertz * 4.0 / 3.0),
        survey.dropped as f64 * log.layout().step,
        long_enough.count(),
        survey.runs.len()
    );
    wrap(&text, terminal::width(100), "  ").trim_end().to_owned() + "\n"
}

/// Samples that were left out, and the reason.
pub(crate) fn left_out(log: &Log, survey: &Survey) -> impl Iterator<Item = (u64, String)> {
    let counts: &Counts = &survey.counts;
    let first = survey.invalid_sample.map_or(String::new(), |first| {
        let joint = one_line(&log.layout().joints[first.joint]);
        let InvalidSample { message, time, quantity, value, .. } = first;
        format!("; the first is message {message} at {time:.3} s, {quantity} of {joint}: {}", short(value))
    });
    let all = [
        (counts.of_others, "of other joints"),
        (counts.without_joints, "without some of the joints"),
        (counts.without_positions, "without positions, or with another number of them"),
        (counts.without_velocities, "without velocities, which other messages contain"),
        (counts.without_efforts, "without efforts, which other messages contain"),
        (counts.repeats, "that repeat the message before, with its time"),
    ];
    let all = all.map(|(count, why)| (count, why.to_owned()));
    let not_finite = format!("with a value that is not a number (NaN, infinite, empty, beyond 1e12){first}");
    all.into_iter().chain([(counts.not_finite, not_finite)]).filter(|(count, _)| *count > 0)
}

/// Remarks on a log, also on what its efforts are, and whether they are warnings. Every command that reads logs prints
/// these.
pub(crate) fn notes(log: &Log, survey: &Survey) -> Vec<(String, bool)> {
    let layout = log.layout();
    let mut notes = notes_of_motion(log, survey);
    if !layout.has_efforts {
        notes.push(("the log has no efforts, so the motion has no torques".to_owned(), true));
    } else if log.unsaid_currents().is_empty() && takes_torques(log) {
        let what = "efforts are taken as torques, N m, or forces, N; if they are currents, give the N m/A with \
                    --torque-constant";
        notes.push((what.to_owned(), false));
    }
    notes
}

/// Whether efforts are torques because nobody said otherwise.
fn takes_torques(log: &Log) -> bool {
    !log.has_torque_constants() && log.layout().units.iter().any(|units| units.effort.is_none())
}

/// Remarks on everything but what efforts are, and whether they are warnings.
fn notes_of_motion(log: &Log, survey: &Survey) -> Vec<(String, bool)> {
    let layout = log.layout();
    let mut notes: Vec<(String, bool)> = layout.notes.iter().map(|note| (note.clone(), false)).collect();
    if let Some((joint, range)) = survey.may_be_degrees(log) {
        let what = format!(
            "positions of {} range over {range:.1}, more than 4π: use --degrees if they are degrees, --radians if they \
             are radians or metres",
            layout.joints[joint]
        );
        notes.push((what, true));
    }
    if !layout.ignored.is_empty() {
        notes.push((format!("joints of the log that are not read: {}", layout.ignored.join(", ")), false));
    }
    let worst = survey.disagreement.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    if let Some((joint, share)) = worst.filter(|(_, share)| **share > DISAGREEMENT) {
        let what = format!(
            "measured velocities differ from the derivative of positions by {:.0} % at {}: stamps may be wrong, or \
             velocities are filtered or in another unit; --derive-velocities ignores them",
            share * 100.0,
            layout.joints[joint]
        );
        notes.push((what, true));
    }
    if !layout.has_velocities {
        notes.push(("velocities are derived from positions".to_owned(), false));
    }
    let currents = log.unsaid_currents();
    if !currents.is_empty() {
        let what = format!(
            "efforts of {} are currents, by the names of columns: give the factor to torques in N m/A with \
             --torque-constant",
            currents.join(", ")
        );
        notes.push((what, true));
    }
    if let Some(first) = survey.spikes.first() {
        let count = survey.spikes.len();
        let what = format!(
            "{count} {} of one or two samples: the first is {} of {} at {:.3} s; an identification leaves such samples \
             out",
            if count == 1 { "effort is a spike" } else { "efforts are spikes" },
            short(first.effort),
            layout.joints[first.joint],
            first.time
        );
        notes.push((what, true));
    }
    notes
}

fn ends(survey: &Survey) -> Option<&Vec<f64>> {
    match &survey.cutoff {
        Cutoff::Spectrum { ends, .. } => Some(ends),
        _ => None,
    }
}

/// Four digits.
fn short(number: f64) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    let magnitude = number.abs().log10().floor();
    if !(-4.0..7.0).contains(&magnitude) {
        return format!("{number:.2e}");
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 7")]
    let digits = (3.0 - magnitude).max(0.0) as usize;
    let text = format!("{number:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
