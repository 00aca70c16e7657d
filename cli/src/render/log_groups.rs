//! Writes the description of a log separately for each text in one of its columns, as text and as JSON.

use std::path::PathBuf;

use rne_identify::LogReply;
use rne_logs::number::short;
use rne_model::one_line;
use serde::Serialize;

use crate::outcome::Failure;
use crate::palette::{QUIET, TITLE, WARNING};
use crate::render::layout::{Align, columns};
use crate::render::log_report::{Described, push_remark, titled};

/// The rows of a log that have one text in the column.
pub(crate) struct Group {
    pub(crate) value: String,
    pub(crate) rows: u64,
    pub(crate) described: Result<Described, Failure>,
}

impl Group {
    pub(crate) fn is_at_fault(&self) -> bool {
        self.described.as_ref().map_or(true, Described::is_at_fault)
    }

    /// Returns the text of the group as it is shown.
    fn shown(&self) -> String {
        if self.value.is_empty() { "(empty)".to_owned() } else { one_line(&self.value) }
    }

    /// Makes the failure of this group, whose message contains its text.
    pub(crate) fn failure(&self, column: &str, error: &Failure) -> Failure {
        let what = format!("{} {}: {}", one_line(column), self.shown(), error.sentence());
        Failure { status: error.status, ..Failure::input(what) }
    }
}

/// The groups of a column, for JSON.
#[derive(Serialize)]
pub(crate) struct Reply {
    by: String,
    values: Vec<OfGroup>,
}

#[derive(Serialize)]
struct OfGroup {
    value: String,
    rows: u64,
    log: Option<LogReply>,
    error: Option<String>,
}

impl Reply {
    pub(crate) fn of(column: &str, groups: &[Group]) -> Self {
        let group = |group: &Group| OfGroup {
            value: group.value.clone(),
            rows: group.rows,
            log: group.described.as_ref().ok().map(Described::reply),
            error: group.described.as_ref().err().map(Failure::sentence),
        };
        Self { by: column.to_owned(), values: groups.iter().map(group).collect() }
    }
}

/// Writes the groups of a column as text: a line for each, followed by their remarks, each once.
pub(crate) fn text(files: &[PathBuf], column: &str, groups: &[Group]) -> String {
    let files: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    let mut text = format!("{TITLE}{}{TITLE:#}  by {}\n\n", files.join(" "), one_line(column));
    let titles = ["rows", "states", "runs", "duration", "rate", "cut-off"].map(str::to_owned);
    let mut lines = vec![[&[one_line(column)], &titles[..]].concat()];
    let mut remarks: Vec<(&str, String, Vec<String>)> = Vec::new();
    let mut remark = |word: &'static str, remark: String, group: &Group| {
        let found = remarks.iter_mut().find(|(other, said, _)| (*other, said.as_str()) == (word, remark.as_str()));
        match found {
            Some((.., values)) => values.push(group.shown()),
            None => remarks.push((word, remark, vec![group.shown()])),
        }
    };
    for group in groups {
        let mut line = vec![group.shown(), group.rows.to_string()];
        match &group.described {
            Ok(described) => {
                let survey = &described.survey;
                let duration: f64 = survey.runs.iter().map(|run| run.duration).sum();
                let cutoff = survey.cutoff.hertz().map_or_else(|| "none".to_owned(), |f| format!("{} Hz", short(f)));
                line.extend([survey.counts.states.to_string(), survey.run_count.to_string()]);
                line.extend([format!("{duration:.3} s"), format!("{} Hz", short(1.0 / described.log.layout().step))]);
                line.push(cutoff);
                for left_out in described.log.left_out(survey) {
                    remark("warning", format!("left out: {left_out}"), group);
                }
                for note in described.notes() {
                    remark(if note.is_warning { "warning" } else { "note" }, note.text, group);
                }
            }
            Err(error) => {
                line.extend(["0", "0", "", "", ""].map(str::to_owned));
                remark("error", error.sentence(), group);
            }
        }
        lines.push(line);
    }
    text += &titled(&columns(&[&[Align::Left], &[Align::Right; 6][..]].concat(), &lines));
    if !remarks.is_empty() {
        text.push('\n');
    }
    // errors come first, then warnings, then notes
    remarks.sort_by_key(|(word, ..)| ["error", "warning", "note"].iter().position(|other| other == word));
    for (word, remark, values) in &remarks {
        let style = if *word == "note" { QUIET } else { WARNING };
        let groups_with_it = if values.len() == groups.len() { "all".to_owned() } else { values.join(", ") };
        push_remark(&mut text, word, style, &format!("{groups_with_it}: {remark}"));
    }
    text
}
