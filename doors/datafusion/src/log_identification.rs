//! Identification of logs as an aggregate: `identify('puma560@…', time, q, qd, tau)`, as `rne identify` does it.

use std::io::{BufWriter, Write};
use std::path::Path;

use datafusion::arrow::array::{Array, ArrayRef};
use datafusion::arrow::datatypes::{DataType, FieldRef};
use datafusion::common::{Result, ScalarValue, exec_err, plan_err};
use datafusion::logical_expr::function::{AccumulatorArgs, StateFieldsArgs};
use datafusion::logical_expr::{Accumulator, AggregateUDFImpl, Documentation, Signature};
use datafusion::physical_expr::expressions::Literal;
use rne::model::Robot;
use rne_identify::{
    ArmLog, ArmLogError, ArmLogOptions, Identification, MotionError, Options, Part, PassError, identify,
};
use rne_logs::{Angles, Npy, TimeUnit};

use crate::argument;
use crate::call::{Call, key};
use crate::found::{self, Found};
use crate::identification::REGULARIZATION;
use crate::numbers;
use crate::robots::{Robots, external};
use crate::time::{self, Instant};

const NAME: &str = "identify";

/// The arguments after the robot and the time.
const ARGUMENTS: [&str; 3] = ["q", "qd", "tau"];

/// Numbers of a row before those of its joints: whole seconds, and the part of a second.
const TIME: usize = 2;

const SUMMARY: &str = "Links and friction from a log with measured torques, as `rne identify` finds them.";

/// The aggregate, with the robots that it may be asked for.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct LogIdentification(Call);

impl LogIdentification {
    pub(crate) fn new(robots: Robots) -> Self {
        let syntax = format!("{NAME}(robot, time, {})", ARGUMENTS.join(", "));
        Self(Call::new(robots, &syntax, SUMMARY))
    }
}

impl AggregateUDFImpl for LogIdentification {
    fn name(&self) -> &'static str {
        NAME
    }

    fn signature(&self) -> &Signature {
        &self.0.signature
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        time::coerced(NAME, given)
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        Ok(found::data_type())
    }

    fn state_fields(&self, given: StateFieldsArgs<'_>) -> Result<Vec<FieldRef>> {
        Ok(vec![numbers::field(given.name)])
    }

    fn accumulator(&self, given: AccumulatorArgs<'_>) -> Result<Box<dyn Accumulator>> {
        if given.is_distinct {
            return plan_err!("{NAME}: DISTINCT is not for rows of states; select the distinct rows before");
        }
        let robot = given.exprs.first().and_then(|robot| robot.downcast_ref::<Literal>());
        let held = self.0.robots.get(key(NAME, robot.map(Literal::value))?)?;
        let columns = argument::columns(given.expr_fields.get(1..).unwrap_or_default());
        let robot = held.arm.robot();
        argument::check(NAME, &ARGUMENTS, &columns, robot)?;
        let columns = columns.iter().map(|column| column.name.to_owned()).collect();
        let is_stamped =
            given.expr_fields.get(1).is_some_and(|time| matches!(time.data_type(), DataType::Timestamp(..)));
        Ok(Box::new(Gathered { robot: robot.clone(), columns, is_stamped, numbers: Vec::new() }))
    }

    fn documentation(&self) -> Option<&Documentation> {
        Some(self.0.documentation())
    }
}

/// The rows of a group, so far: a log has an order, so all of them are kept.
#[derive(Debug)]
struct Gathered {
    robot: Robot,
    /// The names of the columns after the time.
    columns: Vec<String>,
    /// Whether times are stamps; a number may be of another unit than seconds, which the reader of logs notices.
    is_stamped: bool,
    /// Row by row the time, then q, qd and tau of all joints.
    numbers: Vec<f64>,
}

impl Gathered {
    /// Numbers of a row.
    fn width(&self) -> usize {
        TIME + ARGUMENTS.len() * self.robot.dof()
    }

    /// The numbers of rows, in order of time, as a table of numpy: time, q, qd and tau.
    fn write(&self, path: &Path) -> std::io::Result<()> {
        let mut rows: Vec<&[f64]> = self.numbers.chunks_exact(self.width()).collect();
        // all numbers are compared, so that rows of one time have an order that does not depend on partitions
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

    /// As the command does it, with its options where none is given.
    fn identified(&self) -> Result<Identification, Refusal> {
        let folder = tempfile::tempdir().map_err(Refusal::of_machine)?;
        let path = folder.path().join("rows.npy");
        self.write(&path).map_err(Refusal::of_machine)?;
        let mut options = ArmLogOptions::default();
        options.log.angles = Angles::Radians;
        options.log.time_unit = self.is_stamped.then_some(TimeUnit::Seconds);
        let name = format!("{}: ", path.display());
        let log = ArmLog::open(&[path], &self.robot, &options).map_err(|error| Refusal::of_log(&error, &name))?;
        let mut options = Options::default();
        options.cutoff = Some(log.cutoff());
        let pass = |take: &mut dyn FnMut(&rne_logs::Motion) -> Result<(), MotionError>| log.pass(Part::All, take);
        identify::<PassError<MotionError>>(&self.robot, options, REGULARIZATION, pass).map_err(|error| match error {
            PassError::Log(error) => Refusal::of_log(&error, &name),
            PassError::Motion(error) => Refusal::Rows(error.to_string()),
        })
    }
}

/// The reason why rows are not identified.
enum Refusal {
    /// These rows say too little, or are not a log of the robot: other groups are identified.
    Rows(String),
    /// The temporary file cannot be written.
    Machine(std::io::Error),
}

impl Refusal {
    fn of_machine(error: std::io::Error) -> Self {
        Self::Machine(error)
    }

    /// The error of a log without the name of its file, which nobody knows.
    fn of_log(error: &ArmLogError, file: &str) -> Self {
        Self::Rows(error.to_string().replace(file, ""))
    }
}

impl Accumulator for Gathered {
    fn update_batch(&mut self, values: &[ArrayRef]) -> Result<()> {
        let [_, instants, arrays @ ..] = values else { return exec_err!("{NAME}: `time` is missing") };
        let columns: Vec<&str> = self.columns.iter().map(String::as_str).collect();
        let joints = self.robot.dof();
        let (arguments, nulls) = argument::all(NAME, &ARGUMENTS, &columns, arrays, &self.robot)?;
        for state in 0..instants.len() {
            let Some(Instant { seconds, rest }) = time::at(NAME, instants, state)? else { continue };
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
        numbers::each(NAME, states, |numbers| {
            if numbers.len() % width != 0 {
                return exec_err!("{NAME}: rows that other processes gathered have another length than {width}");
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
