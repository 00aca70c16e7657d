//! Functions over rows of states, that is, aggregates and window functions: the data of their calls.

use std::sync::Arc;

use datafusion::arrow::array::ArrayRef;
use datafusion::arrow::buffer::NullBuffer;
use datafusion::arrow::datatypes::{DataType, FieldRef};
use datafusion::common::Result;
use datafusion::physical_expr::PhysicalExpr;
use datafusion::physical_expr::expressions::Literal;
use rne::model::Robot;

use crate::argument::{self, Argument};
use crate::call::{Call, key};
use crate::function;
use crate::robots::{Held, Robots};
use crate::time;

/// An aggregate or a window function over rows of states.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct OfRows {
    pub(crate) name: &'static str,
    /// Whether the time is the argument after the robot.
    pub(crate) is_timed: bool,
    /// The names of the other arguments.
    pub(crate) arguments: &'static [&'static str],
    /// The text after the arguments in the example of a call, such as an `OVER` clause.
    pub(crate) over: &'static str,
    pub(crate) summary: &'static str,
}

impl OfRows {
    pub(crate) fn call(&self, robots: Robots) -> Call {
        let Self { name, arguments, over, summary, .. } = self;
        let time = if self.is_timed { "time, " } else { "" };
        Call::new(robots, &format!("{name}(robot, {time}{}){over}", arguments.join(", ")), summary)
    }

    /// Returns the types to which the arguments of a call are converted.
    pub(crate) fn coerced(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        if self.is_timed { time::coerced(self.name, given) } else { function::coerced(self.name, given) }
    }

    /// Returns the robot that a call names, and its columns. Returns an error if they are not the arguments of the
    /// function.
    pub(crate) fn of<'a>(
        &'static self,
        call: &'a Call,
        arguments: &[Arc<dyn PhysicalExpr>],
        fields: &[FieldRef],
    ) -> Result<(&'a Held, Rows)> {
        let robot = arguments.first().and_then(|robot| robot.downcast_ref::<Literal>());
        let held = call.robots.get(key(self.name, robot.map(Literal::value))?)?;
        let columns = argument::columns(fields.get(usize::from(self.is_timed)..).unwrap_or_default());
        let robot = held.arm.robot();
        argument::check(self.name, self.arguments, &columns, robot)?;
        let columns = columns.iter().map(|column| column.name.to_owned()).collect();
        Ok((held, Rows { of: self, robot: robot.clone(), columns }))
    }
}

/// The columns of a call after the robot and the time.
#[derive(Debug)]
pub(crate) struct Rows {
    of: &'static OfRows,
    pub(crate) robot: Robot,
    /// The names of the columns of the call, for messages.
    pub(crate) columns: Vec<String>,
}

impl Rows {
    /// Returns the arguments in the columns of a batch, and which rows are null.
    pub(crate) fn arguments<'a>(&self, arrays: &'a [ArrayRef]) -> Result<(Vec<Argument<'a>>, Option<NullBuffer>)> {
        let columns: Vec<&str> = self.columns.iter().map(String::as_str).collect();
        argument::all(self.of.name, self.of.arguments, &columns, arrays, &self.robot)
    }
}
