//! Options of every command that reads logs.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use rne_logs::{Angles, LogError, Mapping, Options, Target, TimeUnit};

use crate::outcome::Failure;
use crate::render::log_remedy;
use crate::values::numbers::List;

/// How a log is read.
#[derive(Args, Clone)]
#[command(next_help_heading = "How the log is read")]
#[allow(clippy::struct_excessive_bools)] // each is an option
pub(crate) struct LogArguments {
    /// Names of the joints in the log, base to tip
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) joints: Option<Vec<String>>,
    /// Topic of a bag, or prefix of column names
    #[arg(long, value_name = "T")]
    topic: Option<String>,
    /// Efforts are currents in A; factor in N m/A
    #[arg(long, alias = "torque-constants", value_name = "LIST", allow_hyphen_values = true)]
    torque_constant: Option<List>,
    /// Angles are in degrees (revolute joints only)
    #[arg(long, conflicts_with = "radians")]
    degrees: bool,
    /// Angles are in radians; do not check their range
    #[arg(long)]
    radians: bool,
    /// Cut-off of the low-pass [default: automatic]
    #[arg(long, value_name = "HZ", value_parser = hertz)]
    pub(crate) cutoff: Option<f64>,
    /// Split runs at longer gaps
    #[arg(long, value_name = "STEPS", default_value_t = 3.5)]
    gap: f64,
    /// Ignore measured velocities; derive them
    #[arg(long)]
    derive_velocities: bool,
    /// Use receive times instead of time stamps
    #[arg(long)]
    recorded: bool,
    /// Unit of the time column: s, ms, us, ns
    #[arg(long, value_name = "UNIT", value_parser = time_unit(), hide_possible_values = true)]
    time_unit: Option<TimeUnit>,
    /// Name of the time column of a table
    #[arg(long, value_name = "NAME")]
    time_column: Option<String>,
    /// Only read the rows with this text: robot_id=r1
    #[arg(long = "where", value_name = "COLUMN=TEXT", value_parser = selection)]
    select: Vec<(String, String)>,
    /// Sampling rate of a table without times
    #[arg(long, value_name = "HZ", value_parser = hertz)]
    rate: Option<f64>,
    /// Order in an array [default: time,q,qd,tau]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// Column of a quantity: elbow.effort='I3 [A]'
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

/// The mapping of a column of times.
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
    hertz.ok_or_else(|| "it is a number of Hz above 0, such as 2".to_owned())
}

impl LogArguments {
    /// The arguments with another cut-off of the low-pass, Hz.
    pub(crate) fn with_cutoff(&self, cutoff: f64) -> Self {
        Self { cutoff: Some(cutoff), ..self.clone() }
    }

    /// Options for the reader of logs.
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

/// A log that cannot be read, or a request that it cannot serve; `joints` are those of the arm, as far as it is known.
pub(crate) fn failure(error: &LogError, joints: &[String]) -> Failure {
    let text = log_remedy::sentence(error, joints);
    if error.is_of_request() { Failure::usage(text) } else { Failure::input(text) }
}
