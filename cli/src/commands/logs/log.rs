//! `rne log`: describes a log of an arm, and writes its filtered motion.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::ProgressBar;
use rne_identify::{check_units, joint_options};
use rne_logs::{Heading, Log, Options, Quantity};
use rne_model::one_line;

use crate::files::file_name::Format;
use crate::files::input_file::is_standard_input;
use crate::files::motion_file::{self, Manner, Stopped, Written};
use crate::files::motion_log;
use crate::files::output_file::{Replacement, check_new, is_standard_output, unwritable};
use crate::files::reading;
use crate::files::robot_file::{self, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{GOOD, TYPED};
use crate::render::layout;
use crate::render::log_groups::{self, Group};
use crate::render::log_report::{self, Described};
use crate::values::log_arguments::{LogArguments, failure};

/// Describe a log of an arm; filter it and add accelerations
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne log docs/desk_arm_log.csv --cutoff 4 -o motion.csv
  rne log docs/desk_arm_log.csv --raw -o samples.csv
  rne log docs/desk_arm_log.csv --robot docs/desk_arm.yaml --json
  rne log docs/two_arms_log.csv --by robot_id
  rne log docs/two_arms_log.csv --where robot_id=r2

rne reads CSV and npy logs. It also reads ROS 2 bags (*.db3, *.mcap) and Parquet
logs if it was built with the features `bags` and `parquet`. docs/control/logs.md lists
the names of columns that rne knows.")]
#[allow(clippy::struct_excessive_bools)] // each is an option
pub(crate) struct Arguments {
    /// Log files in order of time, or folders of ROS 2 bags
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Read only the joints that this robot file names
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,
    /// Describe the log separately for each text in this column of a table, such as robot_id
    #[arg(long, value_name = "COLUMN")]
    by: Option<String>,
    /// Write the filtered motion to this file, *.csv or *.parquet; - is standard output
    #[arg(short, long = "output", alias = "out", value_name = "FILE")]
    out: Option<PathBuf>,
    /// Do not filter the samples that --output writes; the file can also be *.npy
    #[arg(long, requires = "out")]
    raw: bool,
    /// Overwrite the output file if it exists
    #[arg(long, requires = "out")]
    force: bool,
    /// Print the description of the log as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    reading: LogArguments,
}

impl Arguments {
    /// Opens and surveys the log, with the joints of the robot file if there is one.
    fn describe(&self, mut options: Options, is_result_shown: bool) -> Result<Described, Failure> {
        let mut matched = None;
        let robot = self.robot.as_deref().map(|path| robot_file::robot(path, Shape::Coupled)).transpose()?;
        if let Some(robot) = &robot {
            (options, matched) =
                joint_options(&self.files, robot, options).map_err(|error| motion_log::failure(&error))?;
        }
        let log = Log::open(&self.files, options).map_err(|error| failure(&error, &[]))?;
        if let Some(robot) = &robot {
            check_units(robot, log.layout()).map_err(|error| motion_log::failure(&error))?;
        }
        let survey = reading::survey(&log, is_result_shown).map_err(|error| failure(&error, &[]))?;
        Ok(Described { log, survey, matched })
    }

    /// Describes separately the rows with each text in a column.
    fn describe_each(&self, column: &str, is_result_shown: bool) -> Result<Vec<Group>, Failure> {
        let options = self.reading.options();
        let values = Log::values(&self.files, column, &options, reading::progress(is_result_shown));
        let described = |value: &str| {
            let mut options = options.clone();
            options.select.push((column.to_owned(), value.to_owned()));
            self.describe(options, is_result_shown)
        };
        let values = values.map_err(|error| failure(&error, &[]))?;
        Ok(values
            .into_iter()
            .map(|found| Group { described: described(&found.value), value: found.value, rows: found.rows })
            .collect())
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if let Some(stream) = arguments.files.iter().find(|file| is_standard_input(file)) {
        let what = format!("{} is standard input; a log is read twice, so name a file", stream.display());
        return Err(Failure::usage(what));
    }
    if arguments.raw && arguments.reading.cutoff.is_some() {
        return Err(usage_error!(
            "{TYPED}--raw{TYPED:#} writes the samples without a filter, and {TYPED}--cutoff{TYPED:#} is the cut-off of \
             the filter; leave one of these options out"
        ));
    }
    let out = arguments.out.as_deref();
    let mut format = Format::Csv;
    let is_result_shown = out.is_some_and(is_standard_output);
    if let Some(path) = out.filter(|path| !is_standard_output(path)) {
        let sources: Vec<&Path> = arguments.files.iter().chain(&arguments.robot).map(PathBuf::as_path).collect();
        check_new(path, None, &sources, arguments.force)?;
        format = motion_file::format(path, arguments.raw)?;
        if format == Format::Npy && arguments.by.is_some() {
            return Err(usage_error!(
                "{TYPED}--by{TYPED:#} writes a column of texts, and an array has only numbers; name a file that ends \
                 with {TYPED}.csv{TYPED:#} or {TYPED}.parquet{TYPED:#}"
            ));
        }
    }
    let manner = Manner { format, is_raw: arguments.raw, is_by_order: arguments.robot.is_some(), label: None };
    if let Some(column) = &arguments.by {
        let groups = arguments.describe_each(column, is_result_shown)?;
        if groups.iter().all(|group| group.described.is_err())
            && let Some(group) = groups.first()
            && let Err(error) = &group.described
        {
            return Err(group.failure(column, error));
        }
        let at_fault = groups.iter().any(Group::is_at_fault);
        let text = match (is_result_shown, arguments.json) {
            (true, _) => String::new(),
            (false, true) => Outcome::json(&log_groups::Reply::of(column, &groups))?.text,
            (false, false) => log_groups::text(&arguments.files, column, &groups),
        };
        let Some(path) = out else { return Ok(Outcome { text, at_fault, ..Outcome::default() }) };
        let mut logs = Vec::new();
        for group in &groups {
            let described = group.described.as_ref().map_err(|error| group.failure(column, error))?;
            logs.push(Written { log: &described.log, survey: &described.survey, label: &group.value });
        }
        return written(arguments, &logs, Manner { label: Some(column), ..manner }, path, text);
    }
    let described = arguments.describe(arguments.reading.options(), is_result_shown)?;
    let text = match (is_result_shown, arguments.json) {
        (true, _) => String::new(),
        (false, true) => Outcome::json(&described.reply())?.text,
        (false, false) => log_report::text(&described, !arguments.raw),
    };
    let Some(path) = out else {
        return Ok(Outcome { text, at_fault: described.is_at_fault(), ..Outcome::default() });
    };
    let logs = [Written { log: &described.log, survey: &described.survey, label: "" }];
    written(arguments, &logs, manner, path, text)
}

/// Writes the motions of logs.
fn written(
    arguments: &Arguments,
    logs: &[Written<'_>],
    manner: Manner<'_>,
    path: &Path,
    text: String,
) -> Result<Outcome, Failure> {
    let is_result_shown = is_standard_output(path);
    let states = if is_result_shown {
        let mut out = BufWriter::new(io::stdout());
        let written = motion_file::write(logs, manner, &ProgressBar::hidden(), &mut out);
        match written.and_then(|states| out.flush().map(|()| states).map_err(Stopped::Unwritable)) {
            // not an error: the reader, as in `rne log … -o - | head`, has read enough
            Err(Stopped::Unwritable(error)) if error.kind() == io::ErrorKind::BrokenPipe => 1,
            Err(Stopped::Unwritable(error)) => {
                return Err(input_error!("the output cannot be written: {error}"));
            }
            Err(Stopped::Unreadable(error)) => return Err(failure(&error, &[])),
            Ok(states) => states,
        }
    } else {
        write_file(logs, manner, path)?
    };
    if states == 0 {
        let left = if manner.is_raw { "there is no sample" } else { "no sample is left after the filter" };
        let what = format!("{}: {left}", arguments.files[0].display());
        return Err(Failure::input(what));
    }
    let remark = if is_result_shown {
        String::new()
    } else {
        format!("{GOOD}wrote{GOOD:#} {}, {states} states\n", path.display()) + &about(logs, manner)
    };
    Ok(Outcome { text, remark, ..Outcome::default() })
}

/// Returns notes on the columns of a written file that the file itself does not contain.
fn about(logs: &[Written<'_>], manner: Manner<'_>) -> String {
    let mut notes = Vec::new();
    let Some(layout) = logs.first().map(|written| written.log.layout()) else { return String::new() };
    let joints = layout.joints.iter().map(|joint| one_line(joint));
    if manner.format == Format::Npy {
        let letters = |quantity: &Quantity| Heading::letters(*quantity);
        let quantities: Vec<&str> = manner.quantities(layout).iter().map(letters).collect();
        let quantities = quantities.join(",");
        let all = joints.collect::<Vec<_>>().join(", ");
        notes.push(format!(
            "the columns of the array are time,{quantities}, all but the time once for each joint: {all}; rne reads \
             the array with --columns time,{quantities}"
        ));
    } else if manner.format == Format::Csv && manner.heading(layout).is_numbered() {
        let is_name = |joint: &String| !joint.bytes().all(|byte| byte.is_ascii_digit());
        if layout.joints.iter().any(is_name) {
            let pairs: Vec<String> = joints.enumerate().map(|(at, joint)| format!("q{} is {joint}", at + 1)).collect();
            notes.push(format!("the columns have the numbers of the joints: {}", pairs.join(", ")));
        }
    }
    if manner.format != Format::Parquet
        && let [one] = logs
        && let Some(origin) = one.log.layout().utc(0.0)
    {
        notes.push(format!("the time 0 s of the file is {}", origin.rfc3339()));
    }
    notes.iter().map(|what| layout::note(what)).collect()
}

fn write_file(logs: &[Written<'_>], manner: Manner<'_>, path: &Path) -> Result<u64, Failure> {
    let unwritable = |error: io::Error| unwritable(path, &error);
    let replacement = Replacement::begin(path).map_err(unwritable)?;
    let mut out = BufWriter::new(replacement.file().map_err(unwritable)?);
    let bar = reading::bar(if manner.is_raw { "written" } else { "filtered" }, false);
    let written = motion_file::write(logs, manner, &bar, &mut out);
    bar.finish_and_clear();
    let states = written.map_err(|stopped| match stopped {
        Stopped::Unreadable(error) => failure(&error, &[]),
        Stopped::Unwritable(error) => unwritable(error),
    })?;
    out.flush().map_err(unwritable)?;
    drop(out);
    if states > 0 {
        replacement.keep().map_err(unwritable)?;
    }
    Ok(states)
}
