//! Identification of logs as an aggregate: `identify('puma560@…', time, q, qd, tau)`, as `rne identify` does it.

use std::io::{BufWriter, Write};
use std::path::Path;

use datafusion::arrow::array::{Array, ArrayRef};
use datafusion::arrow::datatypes::{DataType, FieldRef};
use datafusion::common::{Result, ScalarValue, exec_err};
use datafusion::logical_expr::Accumulator;
use rne_identify::{
    ArmLog, ArmLogError, ArmLogOptions, Identification, MotionError, Options, Part, PassError, identify,
};
use rne_logs::{Angles, Npy, TimeUnit};

use crate::found::{self, Found};
use crate::identification::REGULARIZATION;
use crate::numbers;
use crate::robots::external;
use crate::rows::{OfRows, Rows};
use crate::time::{self, Instant};

/// Name, arguments and summary of the aggregate.
pub(crate) static LOG_IDENTIFICATION: OfRows = OfRows {
    name: "identify",
    is_timed: true,
    arguments: &["q", "qd", "tau"],
    over: "",
    summary: "Links and friction from a log with measured torques, as `rne identify` finds them.",
};

/// How many numbers of a row are before those of its joints: whole seconds, and the fraction of a second.
const TIME: usize = 2;

/// The rows of a group that were read so far. All of them are kept, because a log has an order.
#[derive(Debug)]
pub(crate) struct Gathered {
    rows: Rows,
    /// Whether times are time stamps. If they are plain numbers, the reader of logs finds out their unit.
    is_stamped: bool,
    /// Row by row: the time, then q, qd and tau of all joints.
    numbers: Vec<f64>,
}

impl Gathered {
    /// An empty group for a call with arguments of these types.
    pub(crate) fn new(rows: Rows, fields: &[FieldRef]) -> Self {
        let is_stamped = fields.get(1).is_some_and(|time| matches!(time.data_type(), DataType::Timestamp(..)));
        Self { rows, is_stamped, numbers: Vec::new() }
    }

    /// How many numbers a row has.
    fn width(&self) -> usize {
        TIME + LOG_IDENTIFICATION.arguments.len() * self.rows.robot.dof()
    }

    /// Writes the rows as an array of numpy, in order of time: time, q, qd and tau.
    fn write(&self, path: &Path) -> std::io::Result<()> {
        let mut rows: Vec<&[f64]> = self.numbers.chunks_exact(self.width()).collect();
        // all numbers are compared, so that the order of rows with equal times does not depend on partitions
        let order = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
        rows.sort_by(|a, b| order(a, b).unwrap_or(std::cmp::Ordering::Equal));
        let origin = rows.first().map_or(0.0, |first| first[0]);
        let mut file = BufWriter::new(std::fs::File::create(path)?);
        file.write_all(&Npy::header(rows.len() as u64, self.width() as u64 - 1))?;
        for row in rows {
            let time = row[0] - origin + row[1];
            for number in std::iter::once(&time).chain(&row[TIME..]) {
                file.write_all(&number.to_le_bytes())?;
            }
        }
        file.flush()
    }

    /// Identifies the parameters as `rne identify` does with its default options.
    fn identified(&self) -> Result<Identification, Refusal> {
        let folder = tempfile::tempdir().map_err(Refusal::of_machine)?;
        let path = folder.path().join("rows.npy");
        self.write(&path).map_err(Refusal::of_machine)?;
        let mut options = ArmLogOptions::default();
        options.log.angles = Angles::Radians;
        options.log.time_unit = self.is_stamped.then_some(TimeUnit::Seconds);
        let name = format!("{}: ", path.display());
        let log = ArmLog::open(&[path], &self.rows.robot, &options).map_err(|error| Refusal::of_log(&error, &name))?;
        let mut options = Options::default();
        options.cutoff = Some(log.cutoff());
        let pass = |take: &mut dyn FnMut(&rne_logs::Motion) -> Result<(), MotionError>| log.pass(Part::All, take);
        identify::<PassError<MotionError>>(&self.rows.robot, options, REGULARIZATION, pass).map_err(|error| match error
        {
            PassError::Log(error) => Refusal::of_log(&error, &name),
            PassError::Motion(error) => Refusal::Rows(error.to_string()),
        })
    }
}

/// The reason why the parameters cannot be identified.
enum Refusal {
    /// The rows do not suffice, or are no log of the robot. Other groups may still be identified.
    Rows(String),
    /// The temporary file cannot be written.
    Machine(std::io::Error),
}

impl Refusal {
    fn of_machine(error: std::io::Error) -> Self {
        Self::Machine(error)
    }

    /// An error of a log, without the name of the temporary file, which means nothing to a user.
    fn of_log(error: &ArmLogError, file: &str) -> Self {
        Self::Rows(error.to_string().replace(file, ""))
    }
}

impl Accumulator for Gathered {
    fn update_batch(&mut self, values: &[ArrayRef]) -> Result<()> {
        let [_, instants, arrays @ ..] = values else {
            return exec_err!("{}: `time` is missing", LOG_IDENTIFICATION.name);
        };
        let joints = self.rows.robot.dof();
        let (arguments, nulls) = self.rows.arguments(arrays)?;
        for state in 0..instants.len() {
            let Some(Instant { seconds, rest }) = time::at(LOG_IDENTIFICATION.name, instants, state)? else { continue };
            if nulls.as_ref().is_some_and(|nulls| nulls.is_null(state)) {
                continue;
            }
            self.numbers.extend([seconds, rest]);
            for argument in &arguments {
                self.numbers.extend((0..joints).map(|joint| argument.at(state, joint, joints)));
            }
        }
        Ok(())
    }

    fn state(&mut self) -> Result<Vec<ScalarValue>> {
        Ok(vec![numbers::scalar(std::mem::take(&mut self.numbers))?])
    }

    fn merge_batch(&mut self, states: &[ArrayRef]) -> Result<()> {
        let width = self.width();
        let name = LOG_IDENTIFICATION.name;
        numbers::each(name, states, |numbers| {
            if numbers.len() % width != 0 {
                return exec_err!("{name}: rows that other processes gathered have another length than {width}");
            }
            self.numbers.extend_from_slice(numbers);
            Ok(())
        })
    }

    fn evaluate(&mut self) -> Result<ScalarValue> {
        if self.numbers.is_empty() {
            return ScalarValue::try_from(&found::data_type());
        }
        match self.identified() {
            Ok(identification) => Found::of_log(&identification).scalar(),
            Err(Refusal::Rows(reason)) => found::refused((self.numbers.len() / self.width()) as u64, &reason),
            Err(Refusal::Machine(error)) => Err(external(error)),
        }
    }

    fn size(&self) -> usize {
        size_of_val(self) + self.numbers.capacity() * size_of::<f64>()
    }
}
