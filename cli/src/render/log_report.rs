//! Describes the content of a log, as text and as JSON.

use std::fmt::Write as _;

use rne_identify::{ArmLogRemark, LogReply};
use rne_logs::number::short;
use rne_logs::{Cutoff, Format, Interruption, Log, Remark, Run, Survey};
use rne_model::one_line;

use crate::palette::{QUIET, Style, TITLE, WARNING};
use crate::render::layout::{Align, columns, wrap};
use crate::render::log_remark::{log_remark, remark_sentence};
use crate::terminal;

/// Largest number of lines on runs that are shown; other runs are counted.
const SHOWN: usize = 20;

/// Largest number of runs with the same reason that are shown one by one; more of them become one line.
const FEW: usize = 3;

/// A log and its survey.
pub(crate) struct Described {
    pub(crate) log: Log,
    pub(crate) survey: Survey,
    /// A remark on how the joints of the log were matched with those of a robot, if there is one.
    pub(crate) matched: Option<ArmLogRemark>,
}

impl Described {
    /// Returns whether the log cannot be filtered without a further option.
    pub(crate) fn is_at_fault(&self) -> bool {
        let Self { log, survey, .. } = self;
        survey.may_be_degrees(log).is_some() || !log.unsaid_currents().is_empty() || survey.cutoff == Cutoff::Unknown
    }

    /// Returns the log as data for JSON.
    pub(crate) fn reply(&self) -> LogReply {
        LogReply::of(&self.log, &self.survey, self.notes().into_iter().map(|note| note.text).collect())
    }

    /// Returns the remarks on the log.
    pub(crate) fn notes(&self) -> Vec<Note> {
        let matched = self.matched.iter().map(|remark| Note {
            text: remark_sentence(remark),
            is_warning: remark.is_warning(),
            is_reason: false,
        });
        let remarks = self.log.remarks(&self.survey);
        let remarks = remarks.iter().map(|remark| Note {
            text: log_remark(remark),
            is_warning: remark.is_warning(),
            is_reason: matches!(remark, Remark::MayBeDegrees { .. } | Remark::TimeGoesBack { .. }),
        });
        matched.chain(remarks).collect()
    }
}

/// A remark in words.
pub(crate) struct Note {
    pub(crate) text: String,
    pub(crate) is_warning: bool,
    /// Whether the remark may be the reason why runs begin.
    is_reason: bool,
}

impl Note {
    fn push(&self, text: &mut String) {
        let (word, style) = if self.is_warning { ("warning", WARNING) } else { ("note", QUIET) };
        push_remark(text, word, style, &self.text);
    }
}

/// Describes a log as text; with its filter, if the motion is filtered.
pub(crate) fn text(described: &Described, is_filtered: bool) -> String {
    let Described { log, survey, .. } = described;
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
    // remarks that explain missing states and new runs come first
    let mut reasons = String::new();
    for left_out in log.left_out(survey) {
        let _ = writeln!(reasons, "{WARNING}left out{WARNING:#}: {}", one_line(&left_out.to_string()));
    }
    let (first, others): (Vec<_>, Vec<_>) = described.notes().into_iter().partition(|note| note.is_reason);
    for note in &first {
        note.push(&mut reasons);
    }
    if !reasons.is_empty() {
        text += &reasons;
        text.push('\n');
    }
    text += &joints(log, survey);
    text.push('\n');
    text += &runs(survey);
    text.push('\n');
    if is_filtered {
        text += &filter(log, survey);
    }
    for note in &others {
        note.push(&mut text);
    }
    text
}

/// Appends a remark after a word such as `note`.
pub(crate) fn push_remark(text: &mut String, word: &str, style: Style, remark: &str) {
    let wrapped = wrap(&format!("{word}: {remark}"), terminal::width(100), "  ");
    let _ = writeln!(text, "{style}{word}{style:#}{}", wrapped.trim_end().strip_prefix(word).unwrap_or(&wrapped));
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

/// Lists the runs. Many runs with the same reason become one line.
fn runs(survey: &Survey) -> String {
    let titles = ["run", "start", "duration", "states", "jitter", "longest interval", "begins"];
    let mut lines = vec![titles.map(str::to_owned).to_vec()];
    let groups = by_reason(&survey.runs);
    let mut shown = 0;
    for group in groups.iter().take(SHOWN) {
        shown += group.len();
        let runs = || group.iter().map(|(_, run)| *run);
        let most = |quantity: fn(&Run) -> f64| runs().map(quantity).fold(0.0, f64::max);
        let number = group[0].0 + 1;
        lines.push(vec![
            if group.len() == 1 { number.to_string() } else { format!("{number} and {} more", group.len() - 1) },
            format!("{:.3} s", group[0].1.start),
            range(runs().map(|run| run.duration), |duration| format!("{duration:.3}")) + " s",
            runs().map(|run| run.states).sum::<u64>().to_string(),
            format!("{} ms", short(most(|run| run.jitter) * 1e3)),
            format!("{} ms", short(most(|run| run.longest) * 1e3)),
            reason(&runs().map(|run| run.begins).collect::<Vec<_>>()),
        ]);
    }
    let alignment = [Align::Right, Align::Right, Align::Right, Align::Right, Align::Right, Align::Right, Align::Left];
    let mut text = titled(&columns(&alignment, &lines));
    let others = survey.run_count - shown as u64;
    if others > 0 {
        let _ = writeln!(text, "{QUIET}and {others} other runs{QUIET:#}");
    }
    text
}

/// Returns the runs with their numbers, from 0. More than a few runs that begin for the same reason are one group.
fn by_reason(runs: &[Run]) -> Vec<Vec<(usize, &Run)>> {
    let mut groups: Vec<Vec<(usize, &Run)>> = Vec::new();
    for (number, run) in runs.iter().enumerate() {
        let is_same = |group: &&mut Vec<(usize, &Run)>| is_one_reason(group[0].1.begins, run.begins);
        match groups.iter_mut().find(is_same) {
            Some(group) => group.push((number, run)),
            None => groups.push(vec![(number, run)]),
        }
    }
    let is_folded = |group: &Vec<(usize, &Run)>| group.len() > FEW;
    let (folded, few): (Vec<_>, Vec<_>) = groups.into_iter().partition(is_folded);
    let mut groups: Vec<_> = few.into_iter().flatten().map(|run| vec![run]).chain(folded).collect();
    groups.sort_by_key(|group| group[0].0);
    groups
}

fn is_one_reason(a: Interruption, b: Interruption) -> bool {
    match (a, b) {
        (Interruption::Jump { joint: a, .. }, Interruption::Jump { joint: b, .. }) => a == b,
        _ => std::mem::discriminant(&a) == std::mem::discriminant(&b),
    }
}

/// Describes the reason why the runs of a group begin.
fn reason(begins: &[Interruption]) -> String {
    let by = begins.iter().map(|begins| match begins {
        Interruption::Gap { seconds } | Interruption::Reset { seconds } => *seconds,
        Interruption::Jump { by, .. } => *by,
        Interruption::Beginning | Interruption::Duplicate => 0.0,
    });
    let by = range(by, |by| format!("{by:.3}"));
    match begins {
        [one] => one.to_string(),
        [Interruption::Gap { .. }, ..] => format!("after gaps of {by} s"),
        [Interruption::Reset { .. }, ..] => format!("time went back by {by} s"),
        [Interruption::Jump { joint, .. }, ..] => format!("joint {} jumped by {by}", joint + 1),
        [one, ..] => one.to_string(),
        [] => String::new(),
    }
}

/// Writes the smallest and the largest of some numbers; only one if both look the same.
fn range(numbers: impl Iterator<Item = f64>, shown: impl Fn(f64) -> String) -> String {
    let (least, most) = numbers.fold((f64::INFINITY, 0.0_f64), |(least, most), x| (least.min(x), most.max(x)));
    let (least, most) = (shown(least), shown(most));
    if least == most { most } else { format!("{least} … {most}") }
}

/// Joins lines, of which the first is a title.
pub(crate) fn titled(lines: &[String]) -> String {
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

fn ends(survey: &Survey) -> Option<&Vec<f64>> {
    match &survey.cutoff {
        Cutoff::Spectrum { ends, .. } => Some(ends),
        _ => None,
    }
}
