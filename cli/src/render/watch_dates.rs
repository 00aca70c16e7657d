//! Describes the times of an event: seconds in its log, and dates.

use std::path::PathBuf;

use rne_logs::UtcTime;
use rne_model::one_line;
use rne_watch::{Cause, Event};

/// The name of some logs in words, such as `friday` or `the quiet logs`.
#[derive(Clone, Debug)]
pub(crate) struct LogName {
    words: String,
    is_one: bool,
}

impl LogName {
    /// Returns the name of the only file or folder; for several, the words `several`.
    pub(crate) fn of(paths: &[PathBuf], several: &str) -> Self {
        match paths {
            [path] if path.file_name().is_some() => {
                let name = path.file_name().unwrap_or_default();
                Self { words: one_line(&name.to_string_lossy()), is_one: true }
            }
            _ => Self::several(several.to_owned()),
        }
    }

    pub(crate) fn several(words: String) -> Self {
        Self { words, is_one: false }
    }

    fn begin(&self) -> String {
        format!("{} begin{}", self.words, if self.is_one { "s" } else { "" })
    }

    fn end(&self) -> String {
        format!("{} end{}", self.words, if self.is_one { "s" } else { "" })
    }
}

/// The names of the logs of an event: the watched ones, and those with which they are compared.
#[derive(Debug)]
pub(crate) struct LogNames<'a> {
    pub(crate) log: LogName,
    pub(crate) quiet: &'a LogName,
}

/// Says when an event was observed.
pub(crate) fn times(event: &Event, has_runs: bool, names: &LogNames<'_>) -> String {
    let run = if has_runs { format!("run {}, ", event.run + 1) } else { String::new() };
    let date = event.since_time.map_or(String::new(), |time| format!(" ({time})"));
    match event.cause {
        _ if event.is_whole => in_the_whole_log(event, names),
        Cause::Contact => format!("{run}{:.2} s to {:.2} s{date}", event.since, event.until),
        _ if event.lasts => format!("{run}since {:.1} s{date}", event.since),
        _ => format!("{run}since {:.1} s{date}, until {:.1} s", event.since, event.until),
    }
}

fn in_the_whole_log(event: &Event, LogNames { log, quiet }: &LogNames<'_>) -> String {
    let when = |what: &str, logs: &str, time: UtcTime| format!("{what} when {logs} ({time})");
    let there = match (event.since_time, event.until_time) {
        // the error of the model is a mean over the whole log, so it has no date
        _ if event.cause == Cause::Model => None,
        (_, Some(end)) if event.not_after.is_some() => Some(when("still there", &log.end(), end)),
        (Some(start), _) => Some(when("already there", &log.begin(), start)),
        (None, _) => None,
    };
    let not_there = match (event.not_before, event.not_after) {
        (Some(time), _) => Some(when("not there", &quiet.end(), time)),
        (None, Some(time)) => Some(when("not there", &quiet.begin(), time)),
        (None, None) => None,
    };
    let known: Vec<String> = there.into_iter().chain(not_there).collect();
    if known.is_empty() { "in the whole log".to_owned() } else { known.join("; ") }
}
