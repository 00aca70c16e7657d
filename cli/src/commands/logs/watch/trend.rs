//! `rne watch --by`: compares several groups of logs with one baseline.

use std::path::PathBuf;

use rne_identify::{Purpose, Structure};
use rne_logs::{LabelValue, Log};
use rne_model::one_line;
use rne_watch::{Baseline, Changes, Trend, TrendReply, changes};

use crate::commands::logs::watch::{Known, Task};
use crate::files::motion_log::{MotionLog, watch_failure};
use crate::files::output_file;
use crate::files::reading;
use crate::outcome::{Failure, Outcome};
use crate::palette::{TITLE, TYPED};
use crate::render::layout::{PAGE, warning, wrap};
use crate::render::watch_dates::{LogName, LogNames};
use crate::render::watch_report;
use crate::values::log_arguments;

/// Logs, or some rows of them, that are compared as one.
struct Group {
    name: String,
    paths: Vec<PathBuf>,
    /// The column and the text that the rows must have; `None` for all rows.
    rows: Option<(String, String)>,
}

impl Group {
    /// Returns the name of the group, such as `friday.mcap`, `the logs of 2026-11-27` or `the rows of pick`.
    fn log_name(&self) -> LogName {
        match &self.rows {
            Some(_) => LogName::several(format!("the rows of {}", one_line(&self.name))),
            None => LogName::of(&self.paths, &format!("the logs of {}", self.name)),
        }
    }
}

impl Task<'_> {
    /// Compares each group with the baseline, and prints the changes as text, JSON or CSV.
    pub(super) fn trend(mut self, known: Option<Known>, by: &str) -> Result<Outcome, Failure> {
        let Self { arguments, robot, .. } = self;
        let groups = self.groups(known.as_ref(), by)?;
        let mut known = if let Some(known) = known {
            known
        } else {
            self.of_first(groups.first().ok_or_else(|| Failure::input("the logs have no rows"))?)?
        };
        let structure = Baseline::structure(robot, known.baseline.cutoff);
        let mut trend = Trend::new(&structure, &known.baseline);
        let (mut events, mut logs) = (Vec::new(), Vec::new());
        let mut first_failure = None;
        for group in groups {
            match self.compare(&group, &structure, &mut known) {
                Ok(found) => {
                    logs.push(group.log_name());
                    trend.push(group.name, &found);
                    events.push(found.events);
                }
                // one unusable log of many, such as that of a morning without motion, is skipped
                Err(failure) if failure.is_of_input() => {
                    trend.left_out.push((group.name, failure.sentence()));
                    first_failure.get_or_insert(failure);
                }
                Err(failure) => return Err(failure),
            }
        }
        if let Some(failure) = first_failure.filter(|_| trend.rows.is_empty()) {
            return Err(failure);
        }
        for (name, reason) in &trend.left_out {
            self.remark += &warning(&format!("{name} is not compared: {reason}"));
        }
        let at_fault = events.iter().any(|events| !events.is_empty()) || !trend.left_out.is_empty();
        let what = if ["log", "day"].contains(&by) { by } else { "group" };
        let plural = if trend.rows.len() == 1 { "" } else { "s" };
        let about = format!("{} {what}{plural} compared with {}", trend.rows.len(), known.words);
        if let Some(path) = &arguments.plot {
            self.write(path, &trend.svg(robot, &about))?;
        }
        if let Some(path) = &arguments.csv {
            if output_file::is_standard_output(path) {
                return Ok(Outcome { text: trend.csv(robot), remark: self.remark, at_fault, ..Outcome::default() });
            }
            self.write(path, &trend.csv(robot))?;
        }
        if arguments.json {
            let reply = TrendReply::of(robot, &known.words, &trend, &events);
            return Ok(Outcome { remark: self.remark, at_fault, ..Outcome::json(&reply)? });
        }
        let head = format!("{}: {about}", one_line(&robot.name));
        let names: Vec<LogNames<'_>> = logs.into_iter().map(|log| LogNames { log, quiet: &known.name }).collect();
        let text = format!("{TITLE}{}{TITLE:#}\n", wrap(&head, PAGE, "  "))
            + &watch_report::trend(robot, &trend, &events, &names);
        Ok(Outcome { text, remark: self.remark, at_fault, remark_last: true })
    }

    /// Computes the changes of a group relative to the baseline.
    fn compare(&mut self, group: &Group, structure: &Structure, known: &mut Known) -> Result<Changes, Failure> {
        let log = self.open(group, Some(known))?;
        self.remark += &log.remark_beside(&known.remarks);
        known.remarks.extend(log.log().remarks().iter().cloned());
        changes(structure, &known.baseline, log.log(), &mut reading::progress(false))
            .map_err(|error| watch_failure(&error, &log.words()))
    }

    /// Opens the logs of a group, with the low-pass filter of a baseline.
    fn open(&self, group: &Group, known: Option<&Known>) -> Result<MotionLog, Failure> {
        let mut reading = self.arguments.reading.clone();
        if let Some((column, text)) = &group.rows {
            reading = reading.with_rows(column, text);
        }
        match known {
            Some(known) => MotionLog::open_beside(&group.paths, self.robot, &reading, known.baseline.cutoff),
            None => MotionLog::open(&group.paths, self.robot, &reading, Purpose::Watch),
        }
    }

    /// Returns the groups, in the order of the logs.
    fn groups(&self, known: Option<&Known>, by: &str) -> Result<Vec<Group>, Failure> {
        let arguments = self.arguments;
        if !["log", "day"].contains(&by) {
            let values = Log::values(&arguments.logs, by, &arguments.reading.options(), reading::progress(false))
                .map_err(|error| log_arguments::failure(&error, &[]))?;
            let group = |found: LabelValue| Group {
                paths: arguments.logs.clone(),
                rows: Some((by.to_owned(), found.value.clone())),
                name: found.value,
            };
            return Ok(values.into_iter().map(group).collect());
        }
        let mut groups: Vec<Group> = Vec::new();
        for path in &arguments.logs {
            let name = one_line(&path.file_name().unwrap_or(path.as_os_str()).to_string_lossy());
            let mut group = Group { name, paths: vec![path.clone()], rows: None };
            if by == "day" {
                let day = self.open(&group, known)?.day();
                group.name = day.ok_or_else(|| {
                    usage_error!(
                        "the times of {} are not dates, so it belongs to no day; {TYPED}--by log{TYPED:#} compares the \
                         logs one by one",
                        group.name
                    )
                })?;
            }
            match groups.iter_mut().find(|known| by == "day" && known.name == group.name) {
                Some(of) => of.paths.push(path.clone()),
                None => groups.push(group),
            }
        }
        Ok(groups)
    }

    /// Makes the baseline from the first group, if no other baseline is given.
    fn of_first(&self, group: &Group) -> Result<Known, Failure> {
        let log = self.open(group, None)?;
        let structure = Baseline::structure(self.robot, log.cutoff());
        let baseline = Baseline::of_parameters(&structure, log.log(), &mut reading::progress(false))
            .map_err(|error| watch_failure(&error, &log.words()))?;
        let (words, name) = (format!("the first, {}", group.name), group.log_name());
        Ok(Known { baseline, words, name, remarks: Vec::new() })
    }
}
