//! Numbers that an aggregate gathered, as a list that travels from one process to another.

use std::sync::Arc;

use datafusion::arrow::array::{ArrayRef, AsArray, Float64Array, ListArray};
use datafusion::arrow::buffer::OffsetBuffer;
use datafusion::arrow::datatypes::{DataType, Field, FieldRef, Float64Type};
use datafusion::common::{Result, ScalarValue, exec_err};

/// The field of the state of an aggregate with this name: a list of numbers.
pub(crate) fn field(aggregate: &str) -> FieldRef {
    Arc::new(Field::new(format!("{aggregate}[rows]"), DataType::List(item(DataType::Float64)), true))
}

/// The field of the elements of a list.
pub(crate) fn item(of: DataType) -> FieldRef {
    Arc::new(Field::new_list_field(of, true))
}

/// A list of numbers as one value.
pub(crate) fn scalar(numbers: Vec<f64>) -> Result<ScalarValue> {
    let offsets = OffsetBuffer::from_lengths([numbers.len()]);
    let list = ListArray::try_new(item(DataType::Float64), offsets, Arc::new(Float64Array::from(numbers)), None)?;
    Ok(ScalarValue::List(Arc::new(list)))
}

/// Calls `take` with each list of numbers that other processes gathered.
pub(crate) fn each(aggregate: &str, states: &[ArrayRef], mut take: impl FnMut(&[f64]) -> Result<()>) -> Result<()> {
    let Some(lists) = states.first().and_then(|states| states.as_list_opt::<i32>()) else {
        return exec_err!(
            "{aggregate}: the data from other processes is not a list: these processes run another version of rne"
        );
    };
    for list in lists.iter().flatten() {
        let Some(numbers) = list.as_primitive_opt::<Float64Type>() else {
            return exec_err!(
                "{aggregate}: the data from other processes are not numbers: these processes run another version of rne"
            );
        };
        take(numbers.values())?;
    }
    Ok(())
}
