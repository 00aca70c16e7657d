//! The time of a row: a time stamp or a number of seconds.

use datafusion::arrow::array::{Array, ArrayRef, AsArray};
use datafusion::arrow::datatypes::{DataType, Float64Type, TimeUnit, TimestampNanosecondType};
use datafusion::common::{Result, exec_err, plan_err};

use crate::argument;
use crate::function;

/// Nanoseconds per second.
const SECOND: i64 = 1_000_000_000;

/// A time without rounding: whole seconds, and the rest in seconds.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) struct Instant {
    pub(crate) seconds: f64,
    pub(crate) rest: f64,
}

impl Instant {
    /// Returns the time since an earlier one, s.
    pub(crate) fn since(self, other: Self) -> f64 {
        self.seconds - other.seconds + (self.rest - other.rest)
    }
}

/// Returns the types to which the arguments are converted: the name of a robot, a time, then numbers.
pub(crate) fn coerced(function: &str, given: &[DataType]) -> Result<Vec<DataType>> {
    let [robot, time, columns @ ..] = given else {
        return plan_err!("{function}: the robot and the time are missing, the first two arguments");
    };
    let time = match time {
        DataType::Timestamp(_, zone) => DataType::Timestamp(TimeUnit::Nanosecond, zone.clone()),
        of if of.is_numeric() || *of == DataType::Null => DataType::Float64,
        of => return plan_err!("{function}: the time, the second argument, is a time stamp or seconds, not {of}"),
    };
    let mut all = function::coerced(function, std::slice::from_ref(robot))?;
    all.push(time);
    all.extend(columns.iter().map(argument::coerced));
    Ok(all)
}

/// The time of a row; `None` where it is null.
pub(crate) fn at(function: &str, array: &ArrayRef, row: usize) -> Result<Option<Instant>> {
    if array.is_null(row) {
        return Ok(None);
    }
    if let Some(stamps) = array.as_primitive_opt::<TimestampNanosecondType>() {
        let stamp = stamps.value(row);
        #[allow(clippy::cast_precision_loss)] // exact: seconds of some centuries, and nanoseconds below 1e9
        let [seconds, rest] = [stamp.div_euclid(SECOND) as f64, stamp.rem_euclid(SECOND) as f64 * 1e-9];
        return Ok(Some(Instant { seconds, rest }));
    }
    match array.as_primitive_opt::<Float64Type>().map(|seconds| seconds.value(row)) {
        Some(seconds) if seconds.is_finite() => Ok(Some(Instant { seconds, rest: 0.0 })),
        Some(seconds) => exec_err!("{function}: `time`, row {} of a batch: {seconds} is no finite number", row + 1),
        None => exec_err!("{function}: `time` is {}, neither a time stamp nor a number", array.data_type()),
    }
}
