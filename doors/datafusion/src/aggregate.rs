//! The aggregates over rows of states, which identify link parameters and friction.

use datafusion::arrow::datatypes::{DataType, FieldRef};
use datafusion::common::{Result, plan_err};
use datafusion::logical_expr::function::{AccumulatorArgs, StateFieldsArgs};
use datafusion::logical_expr::{Accumulator, AggregateUDFImpl, Documentation, Signature};

use crate::call::Call;
use crate::found;
use crate::identification::{self, IDENTIFICATION};
use crate::log_identification::{self, LOG_IDENTIFICATION};
use crate::numbers;
use crate::robots::Robots;
use crate::rows::OfRows;

/// An aggregate and the robots that its calls may name.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct Aggregate {
    of: &'static OfRows,
    call: Call,
}

impl Aggregate {
    /// Returns all aggregates; their calls may name these robots.
    pub(crate) fn all(robots: &Robots) -> [Self; 2] {
        [&IDENTIFICATION, &LOG_IDENTIFICATION].map(|of| Self { of, call: of.call(robots.clone()) })
    }
}

impl AggregateUDFImpl for Aggregate {
    fn name(&self) -> &'static str {
        self.of.name
    }

    fn signature(&self) -> &Signature {
        &self.call.signature
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        self.of.coerced(given)
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        Ok(found::data_type())
    }

    fn state_fields(&self, given: StateFieldsArgs<'_>) -> Result<Vec<FieldRef>> {
        Ok(vec![numbers::field(given.name)])
    }

    fn accumulator(&self, given: AccumulatorArgs<'_>) -> Result<Box<dyn Accumulator>> {
        if given.is_distinct {
            let name = self.name();
            return plan_err!("{name}: DISTINCT is not for rows of states; select the distinct rows before");
        }
        let (held, rows) = self.of.of(&self.call, given.exprs, given.expr_fields)?;
        // only rows of a log have a time
        Ok(if self.of.is_timed {
            Box::new(log_identification::Gathered::new(rows, given.expr_fields))
        } else {
            Box::new(identification::Gathered::new(held, rows))
        })
    }

    fn documentation(&self) -> Option<&Documentation> {
        Some(self.call.documentation())
    }
}
