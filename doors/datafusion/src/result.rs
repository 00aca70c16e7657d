//! Results as columns: nested lists and structs in the shape of the function's result.

use std::sync::Arc;

use datafusion::arrow::array::{ArrayRef, FixedSizeListArray, Float64Array, StructArray};
use datafusion::arrow::buffer::NullBuffer;
use datafusion::arrow::datatypes::{DataType, Field, FieldRef};
use datafusion::common::{Result, exec_err};
use rne::compiled::Layout;

/// Returns the type of a column of results. Where the argument of a state is null, each field of its result is null,
/// too, because a query may read a field without a test of the record.
pub(crate) fn data_type(layout: &Layout) -> DataType {
    match layout {
        Layout::Number => DataType::Float64,
        Layout::Array(length, of) => DataType::FixedSizeList(item(data_type(of)), size(*length)),
        Layout::Record(record, parts) => {
            let parts = record.fields().iter().copied().zip(parts);
            DataType::Struct(parts.map(|(name, part)| Field::new(name, data_type(part), true)).collect())
        }
    }
}

/// Returns the numbers of all states, one state after the other, as a column of this shape.
pub(crate) fn column(layout: &Layout, numbers: Vec<f64>, states: usize, nulls: Option<NullBuffer>) -> Result<ArrayRef> {
    let outputs = layout.len();
    if numbers.len() != states * outputs {
        return exec_err!("{} numbers are no {states} results of {outputs}", numbers.len());
    }
    Numbers { values: numbers, outputs, states }.elements(layout, &[0], nulls.as_ref())
}

struct Numbers {
    values: Vec<f64>,
    outputs: usize,
    states: usize,
}

impl Numbers {
    /// Returns, state by state, the elements whose numbers begin at the offsets `starts` in the numbers of each state.
    /// `nulls` has one entry per element.
    fn elements(&self, layout: &Layout, starts: &[usize], nulls: Option<&NullBuffer>) -> Result<ArrayRef> {
        let Self { values: numbers, outputs, states } = self;
        let length = states * starts.len();
        match layout {
            Layout::Number if starts.iter().copied().eq(0..*outputs) => {
                Ok(Arc::new(Float64Array::new(numbers.clone().into(), nulls.cloned())))
            }
            Layout::Number => {
                let of_state = |state: usize| starts.iter().map(move |start| numbers[state * outputs + start]);
                let values = (0..*states).flat_map(of_state).collect::<Vec<f64>>();
                Ok(Arc::new(Float64Array::new(values.into(), nulls.cloned())))
            }
            Layout::Array(count, of) => {
                let inner = self.elements(of, &each(starts, *count, of), None)?;
                Ok(Arc::new(FixedSizeListArray::try_new(item(data_type(of)), size(*count), inner, nulls.cloned())?))
            }
            Layout::Record(record, parts) => {
                let (mut before, mut fields, mut arrays) = (0, Vec::new(), Vec::new());
                for (name, part) in record.fields().iter().copied().zip(parts) {
                    fields.push(Field::new(name, data_type(part), true));
                    let starts: Vec<usize> = starts.iter().map(|start| start + before).collect();
                    arrays.push(self.elements(part, &starts, nulls)?);
                    before += part.len();
                }
                Ok(Arc::new(StructArray::try_new_with_length(fields.into(), arrays, nulls.cloned(), length)?))
            }
        }
    }
}

/// Returns the offsets of the elements of arrays which begin at the offsets `starts` and have `length` elements each.
fn each(starts: &[usize], length: usize, of: &Layout) -> Vec<usize> {
    starts.iter().flat_map(|start| (0..length).map(move |index| start + index * of.len())).collect()
}

fn item(of: DataType) -> FieldRef {
    Arc::new(Field::new("item", of, false))
}

fn size(length: usize) -> i32 {
    i32::try_from(length).unwrap_or(i32::MAX)
}
