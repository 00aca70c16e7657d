//! Writes the marks of a class as a table, as CSV and as JSON.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use rne_diagnose::worksheet::{Comparison, Quantity, Reach, Verdict, Worksheet};
use rne_model::six_digits;
use serde::Serialize;

use crate::outcome::Failure;
use crate::palette::{ERROR, GOOD, QUIET};
use crate::render::layout::{left, right, shortened, width, wrap};
use crate::terminal;

/// The file of a student with its mark, or the reason why it has none.
pub(crate) struct Marked {
    pub(crate) student: String,
    pub(crate) file: String,
    pub(crate) mark: Result<Mark, Failure>,
}

/// The cause of a first error in q, q̇ or q̈: the worksheet is for another state than the one of the command line.
const OTHER_STATE: &str = "the worksheet is for another state";

/// The mark of a worksheet.
#[derive(Serialize)]
pub(crate) struct Mark {
    points: usize,
    of: usize,
    /// Points for values that are right only with the student's own earlier values.
    carried: usize,
    /// Values that are asked for and were not filled in.
    missing: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    first_error: Option<FirstError>,
}

/// The first wrong value, in the order of computation.
#[derive(Clone, Serialize)]
struct FirstError {
    step: u8,
    joint: usize,
    quantity: &'static str,
    component: &'static str,
    #[serde(skip)]
    symbol: String,
    yours: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    right: Option<f64>,
    unit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    cause: Option<String>,
    /// Whether the cause explains every value of the worksheet.
    explains_everything: bool,
}

impl Mark {
    /// Marks a worksheet. There is a point for each right value in the cells that are asked for, by joint and step,
    /// except values that are `always_zero`; with `carry`, also for values that are right with the student's own
    /// earlier values.
    pub(crate) fn new(
        sheet: &Worksheet,
        comparison: Comparison,
        is_asked: impl Fn(usize, u8) -> bool,
        always_zero: &BTreeSet<(usize, usize)>,
        carry: bool,
    ) -> Self {
        let counts = |place: &(usize, usize)| {
            let line = sheet.lines.get(place.0);
            line.is_some_and(|line| is_asked(line.joint, line.quantity.step())) && !always_zero.contains(place)
        };
        let all = sheet.lines.iter().enumerate();
        let all = all.flat_map(|(index, line)| (0..line.values.len()).map(move |component| (index, component)));
        let most = all.filter(counts).count();
        let of_verdict = |verdict| {
            let counted = comparison.verdicts.iter().filter(|(place, own)| counts(place) && **own == verdict);
            counted.count()
        };
        let [right, followed, wrong] = [Verdict::Right, Verdict::Followed, Verdict::Wrong].map(of_verdict);
        let (carried, given) = (if carry { followed } else { 0 }, right + followed + wrong);
        let points = right + carried;
        let first_error = comparison.first.map(|first| {
            let line = &sheet.lines[first.line];
            let is_state = matches!(line.quantity, Quantity::Q | Quantity::Qd | Quantity::Qdd);
            let other = is_state.then(|| OTHER_STATE.to_owned());
            let reason = first.reasons.first();
            FirstError {
                step: line.quantity.step(),
                joint: line.joint,
                quantity: line.quantity.name(),
                component: line.quantity.components()[first.component],
                symbol: line.symbol(),
                yours: first.theirs,
                right: Some(first.ours),
                unit: line.unit(),
                cause: other.or_else(|| reason.map(|reason| reason.says.clone())),
                explains_everything: reason.is_some_and(|reason| reason.reach == Reach::Everything),
            }
        });
        Self { points, of: most, carried, missing: most.saturating_sub(given), first_error }
    }
}

impl Marked {
    /// Returns whether the worksheet was made for another state.
    pub(crate) fn is_for_another_state(&self) -> bool {
        let first = self.mark.as_ref().ok().and_then(|mark| mark.first_error.as_ref());
        first.and_then(|first| first.cause.as_deref()).is_some_and(|cause| cause.starts_with(OTHER_STATE))
    }

    /// Adds to the cause whose state the worksheet for another state has.
    pub(crate) fn name_owner(&mut self, owner: &str) {
        let first = self.mark.as_mut().ok().and_then(|mark| mark.first_error.as_mut());
        if let Some(cause) = first.and_then(|first| first.cause.as_mut()) {
            let _ = write!(cause, ": that of {}", shown(owner));
        }
    }
}

/// Makes a text from a file harmless for one line of the terminal: shortened, without control characters.
pub(crate) fn shown(text: &str) -> String {
    let visible: String = text
        .chars()
        .flat_map(|c| if c.is_control() { c.escape_debug().collect::<Vec<_>>() } else { vec![c] })
        .collect();
    shortened(&visible, 60)
}

/// Returns in one sentence why a file is not marked: the line of the first mistake, if it has one, and the mistake.
fn refusal(failure: &Failure) -> String {
    let sentence = failure.sentence();
    let mut lines = sentence.lines();
    let what = lines.next().unwrap_or_default();
    let line =
        lines.next().and_then(|place| place.trim().strip_prefix("--> ")?.rsplit(':').nth(1)?.parse::<u64>().ok());
    line.map_or_else(|| what.to_owned(), |line| format!("line {line}: {what}"))
}

/// Returns the cells of a row of the table: name, points, first error, cause.
fn cells(one: &Marked, hint: bool) -> [String; 4] {
    let student = shown(&one.student);
    let mark = match &one.mark {
        Ok(mark) => mark,
        Err(failure) => {
            let points = "-".to_owned();
            return [student, points, "not marked".to_owned(), shortened(&refusal(failure), 200)];
        }
    };
    let points = format!("{}/{}", mark.points, mark.of);
    let Some(first) = &mark.first_error else {
        let missing = match mark.missing {
            0 => String::new(),
            1 => "1 value is missing".to_owned(),
            missing => format!("{missing} values are missing"),
        };
        return [student, points, "none".to_owned(), missing];
    };
    let place = match first.step {
        0 => "input".to_owned(),
        step => format!("step {step}"),
    };
    let mut error = format!("{place}, {}", first.symbol);
    if !first.component.is_empty() {
        let _ = write!(error, " {}", first.component);
    }
    let _ = write!(error, ": {}", six_digits(first.yours));
    if let Some(right) = first.right.filter(|_| !hint) {
        let _ = write!(error, ", right {}", six_digits(right));
    }
    let cause = match (&first.cause, first.explains_everything) {
        (None, _) => "no usual mistake".to_owned(),
        (Some(cause), false) => cause.clone(),
        (Some(cause), true) => format!("{cause}; this explains every value"),
    };
    [student, points, error, cause]
}

/// Smallest width of the column of causes.
const NARROWEST: usize = 24;

/// Writes the marks as a table, and the causes that several students share.
pub(crate) fn table(all: &[Marked], hint: bool) -> String {
    let mut rows = vec![["student", "points", "first error", "likely cause"].map(str::to_owned)];
    rows.extend(all.iter().map(|one| cells(one, hint)));
    let widths = [0, 1, 2].map(|column: usize| rows.iter().map(|row| width(&row[column])).max().unwrap_or(0));
    let indent = widths.iter().sum::<usize>() + 6;
    let page = terminal::width(100);
    let room = page.saturating_sub(indent).max(NARROWEST);
    let mut text = String::new();
    for (index, [student, points, error, cause]) in rows.iter().enumerate() {
        let cause = wrap(cause, room, "").replace('\n', &format!("\n{}", " ".repeat(indent)));
        let line =
            format!("{}  {}  {}  {cause}", left(student, widths[0]), right(points, widths[1]), left(error, widths[2]));
        let line = line.trim_end();
        let _ = match index.checked_sub(1).map(|at| &all[at].mark) {
            None => writeln!(text, "{QUIET}{line}{QUIET:#}"),
            Some(Err(_)) => writeln!(text, "{ERROR}{line}{ERROR:#}"),
            Some(Ok(mark)) if mark.points == mark.of => writeln!(text, "{GOOD}{line}{GOOD:#}"),
            Some(Ok(_)) => writeln!(text, "{line}"),
        };
    }
    let mut causes: BTreeMap<&str, usize> = BTreeMap::new();
    for cause in all.iter().filter_map(|one| one.mark.as_ref().ok()?.first_error.as_ref()?.cause.as_deref()) {
        *causes.entry(cause).or_default() += 1;
    }
    let mut shared: Vec<(&str, usize)> = causes.into_iter().filter(|(_, count)| *count > 1).collect();
    shared.sort_by_key(|(cause, count)| (std::cmp::Reverse(*count), *cause));
    if !shared.is_empty() {
        let _ = writeln!(text, "\n{QUIET}first errors that several students share{QUIET:#}");
    }
    for (cause, count) in shared {
        let _ = writeln!(text, "{}", wrap(&format!("{count:>3} × {cause}"), page, "      "));
    }
    text
}

/// Writes the marks as CSV, with a row for each file.
pub(crate) fn csv(all: &[Marked], hint: bool) -> Result<String, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header = vec![
        "student",
        "file",
        "points",
        "of",
        "carried",
        "missing",
        "step",
        "joint",
        "quantity",
        "component",
        "yours",
        "right",
        "cause",
        "explains_everything",
        "refused",
    ];
    header.retain(|column| !(hint && *column == "right"));
    writer.write_record(&header).map_err(Failure::input)?;
    for one in all {
        let mut cells = vec![harmless(&one.student), harmless(&one.file)];
        let (mark, refused) = match &one.mark {
            Ok(mark) => (Some(mark), String::new()),
            Err(failure) => (None, harmless(&refusal(failure))),
        };
        let first = mark.and_then(|mark| mark.first_error.as_ref());
        let counts = mark.map_or([None; 4], |mark| [mark.points, mark.of, mark.carried, mark.missing].map(Some));
        cells.extend(counts.map(text_of));
        cells.extend([text_of(first.map(|first| first.step)), text_of(first.map(|first| first.joint))]);
        cells.extend([text_of(first.map(|first| first.quantity)), text_of(first.map(|first| first.component))]);
        cells.push(text_of(first.map(|first| first.yours)));
        if !hint {
            cells.push(text_of(first.and_then(|first| first.right)));
        }
        cells.push(text_of(first.and_then(|first| first.cause.as_ref())));
        cells.push(text_of(first.map(|first| first.explains_everything)));
        cells.push(refused);
        writer.write_record(&cells).map_err(Failure::input)?;
    }
    let bytes = writer.into_inner().map_err(Failure::input)?;
    String::from_utf8(bytes).map_err(Failure::input)
}

fn text_of(value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// Makes a text from a file harmless for a spreadsheet, which must not take it for a formula.
fn harmless(text: &str) -> String {
    if text.starts_with(['=', '+', '-', '@', '\t', '\r']) { format!("'{text}") } else { text.to_owned() }
}

/// The marks, for JSON.
#[derive(Serialize)]
pub(crate) struct Reply {
    of: usize,
    marks: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    student: String,
    file: String,
    #[serde(flatten)]
    mark: Option<Mark>,
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<String>,
}

pub(crate) fn json(all: &[Marked], hint: bool) -> Reply {
    let row = |marked: &Marked| {
        let first_error = |mark: &Mark| {
            let first = mark.first_error.clone()?;
            Some(FirstError { right: first.right.filter(|_| !hint), ..first })
        };
        let mark = marked.mark.as_ref().ok().map(|mark| Mark { first_error: first_error(mark), ..*mark });
        let refused = marked.mark.as_ref().err().map(Failure::sentence);
        Row { student: marked.student.clone(), file: marked.file.clone(), mark, refused }
    };
    let most = all.iter().filter_map(|one| one.mark.as_ref().ok()).map(|mark| mark.of).max().unwrap_or(0);
    Reply { of: most, marks: all.iter().map(row).collect() }
}
