//! Options that all commands have that read logs.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use rne_logs::{Angles, LogError, Mapping, Options, Target, TimeUnit};

use crate::outcome::Failure;
use crate::remedy;
use crate::values::numbers::List;

/// How a log is read.
#[derive(Args, Clone)]
#[command(next_help_heading = "How the log is read")]
#[allow(clippy::struct_excessive_bools)] // each is an option
pub(crate) struct LogArguments {
    /// Joints to read: their names in the log, from base to tip, such as 1,3 or waist,elbow
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) joints: Option<Vec<String>>,
    /// Read this topic of a bag, or the columns of a table whose names begin with this word
    #[arg(long, value_name = "T")]
    topic: Option<String>,
    /// Efforts are currents, A; multiply them by this constant, N m/A, one number or one per joint
    #[arg(long, alias = "torque-constants", value_name = "LIST", allow_hyphen_values = true)]
    torque_constant: Option<List>,
    /// Read angles as degrees, for revolute joints only
    #[arg(long, conflicts_with = "radians")]
    degrees: bool,
    /// Read angles as radians, even if they range over more than 4π
    #[arg(long)]
    radians: bool,
    /// Cut-off of the low-pass filter, Hz [default: automatic]
    #[arg(long, value_name = "HZ", value_parser = hertz)]
    pub(crate) cutoff: Option<f64>,
    /// Split the log at gaps longer than this number of sampling intervals
    #[arg(long, value_name = "STEPS", default_value_t = 3.5)]
    gap: f64,
    /// Compute velocities from positions; ignore the velocities in the log
    #[arg(long)]
    derive_velocities: bool,
    /// Use the receive times of a bag, not the time stamps of its messages
    #[arg(long)]
    recorded: bool,
    /// Unit of the time column: s, ms, us or ns
    #[arg(long, value_name = "UNIT", value_parser = time_unit(), hide_possible_values = true)]
    time_unit: Option<TimeUnit>,
    /// Name of the column that contains the time
    #[arg(long, value_name = "NAME")]
    time_column: Option<String>,
    /// Read only the rows with this text in this column, such as robot_id=r1
    #[arg(long = "where", value_name = "COLUMN=TEXT", value_parser = selection)]
    select: Vec<(String, String)>,
    /// Sampling rate, Hz, of a table without times
    #[arg(long, value_name = "HZ", value_parser = hertz)]
    rate: Option<f64>,
    /// Meaning of the columns of an npy array, in order [default: time,q,qd,tau]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// Read a quantity from a named column, such as elbow.effort='I3 [A]'; may be repeated
    #[arg(long, value_name = "MAP", value_parser = mapping)]
    map: Vec<Mapping>,
}

fn mapping(text: &str) -> Result<Mapping, String> {
    let (target, column) = text
        .split_once('=')
        .filter(|(_, column)| !column.trim().is_empty())
        .ok_or("write a meaning, `=` and a column, such as elbow.position='Pos 2 [deg]' or time='t [ms]'")?;
    Ok(Mapping { target: target.trim().parse()?, column: column.trim().to_owned() })
}

/// Makes the mapping for a column of times.
fn of_times(column: &str) -> Mapping {
    Mapping { target: Target::Time, column: column.to_owned() }
}

fn selection(text: &str) -> Result<(String, String), String> {
    let (column, value) = text
        .split_once('=')
        .filter(|(column, _)| !column.trim().is_empty())
        .ok_or("write a column, `=` and a text in it, such as robot_id=r1")?;
    Ok((column.trim().to_owned(), value.trim().to_owned()))
}

fn time_unit() -> impl TypedValueParser<Value = TimeUnit> {
    let units = [TimeUnit::Seconds, TimeUnit::Milliseconds, TimeUnit::Microseconds, TimeUnit::Nanoseconds];
    PossibleValuesParser::new(units.map(TimeUnit::name))
        .map(move |name| units.into_iter().find(|unit| unit.name() == name).unwrap_or_default())
}

fn hertz(text: &str) -> Result<f64, String> {
    let hertz = text.parse().ok().filter(|hertz: &f64| hertz.is_finite() && *hertz > 0.0);
    hertz.ok_or_else(|| "write a number above 0, in Hz, such as 2".to_owned())
}

impl LogArguments {
    /// Returns the arguments with another cut-off frequency of the low-pass filter, Hz.
    pub(crate) fn with_cutoff(&self, cutoff: f64) -> Self {
        Self { cutoff: Some(cutoff), ..self.clone() }
    }

    /// Returns the arguments for only those rows that have a text in a column.
    pub(crate) fn with_rows(&self, column: &str, text: &str) -> Self {
        let mut rows = self.clone();
        rows.select.push((column.to_owned(), text.to_owned()));
        rows
    }

    /// Returns the options for the reader of logs.
    pub(crate) fn options(&self) -> Options {
        let angles = match (self.degrees, self.radians) {
            (true, _) => Angles::Degrees,
            (_, true) => Angles::Radians,
            _ => Angles::Unsaid,
        };
        Options {
            joints: self.joints.clone(),
            topic: self.topic.clone(),
            torque_constants: self.torque_constant.as_ref().map(|List(list)| list.clone()).unwrap_or_default(),
            angles,
            gap: self.gap,
            cutoff: self.cutoff,
            derive_velocities: self.derive_velocities,
            recorded: self.recorded,
            time_unit: self.time_unit,
            rate: self.rate,
            columns: self.columns.clone(),
            select: self.select.clone(),
            map: self.time_column.as_deref().map(of_times).into_iter().chain(self.map.iter().cloned()).collect(),
            ..Options::default()
        }
    }
}

/// Makes the error for a log that cannot be read, or that does not have what the command line asks for; `joints` are
/// those of the arm, if they are known.
pub(crate) fn failure(error: &LogError, joints: &[String]) -> Failure {
    let text = remedy::log::sentence(error, joints);
    if error.is_of_request() { Failure::usage(text) } else { Failure::input(text) }
}
