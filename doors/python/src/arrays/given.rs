//! The arguments of a call from Python, before they are read.

use numpy::{PyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyFloat;

use super::memory::{has, is_array, is_arrow, refuse_masked, shape_of};
use super::shape_in_words;

/// An argument of a call: its name, its number of elements per state, its axes, and the value that was given. `parts`
/// names the vectors of three elements that it consists of, if the compiled arm takes these instead.
pub(crate) struct Given<'py> {
    pub(crate) name: &'static str,
    pub(crate) parts: &'static [&'static str],
    pub(crate) elements: usize,
    pub(crate) axes: Axes,
    pub(crate) value: Value<'py>,
}

impl<'py> Given<'py> {
    /// An argument that is a vector for each state.
    pub(crate) fn vector(name: &'static str, elements: usize, value: Bound<'py, PyAny>) -> Self {
        Self { name, parts: &[], elements, axes: Axes::Vector, value: Value::Of(value) }
    }

    /// The vector of an argument that was left out, the same for all states.
    pub(crate) fn own(name: &'static str, numbers: Vec<f64>) -> Self {
        Self { name, parts: &[], elements: numbers.len(), axes: Axes::Vector, value: Value::Own(numbers) }
    }

    /// An argument that is one number, or an array of shape (N,).
    pub(crate) fn number(name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Self> {
        let is_number = match value.cast::<PyUntypedArray>() {
            Ok(array) => array.ndim() == 0,
            Err(_) => value.is_instance_of::<PyFloat>() || value.len().is_err(),
        };
        refuse_masked(name, value)?;
        // a single number is used in the precision of the arrays
        let number = if is_number { value.extract().ok() } else { None };
        let value = match number {
            Some(number) => Value::Own(vec![number]),
            None => Value::Of(with_type(value)?),
        };
        Ok(Self { name, parts: &[], elements: 1, axes: Axes::Number, value })
    }

    /// An argument that is a matrix for each state. The error for a wrong shape ends with the text of `known`.
    pub(crate) fn matrix(
        name: &'static str,
        axes: Axes,
        elements: usize,
        value: Bound<'py, PyAny>,
        known: impl FnOnce() -> String,
    ) -> PyResult<Self> {
        let value = with_type(&value)?;
        if let Axes::Rows(row) = axes {
            let of_state = [elements / row, row];
            let wrong = shape_of(&value)?.filter(|shape| !(matches!(shape.len(), 2 | 3) && shape.ends_with(&of_state)));
            if let Some(shape) = wrong {
                let ([rows, row], shape, known) = (of_state, shape_in_words(&shape), known());
                return Err(PyValueError::new_err(format!(
                    "`{name}` has the shape {shape}, not ({rows}, {row}) or (N, {rows}, {row}){known}"
                )));
            }
        }
        Ok(Self { name, parts: &[], elements, axes, value: Value::Of(value) })
    }
}

/// Converts a value with a type of numbers, `dtype`, to an array. Other values, such as lists, are returned unchanged:
/// they are used in the precision of the arrays among the arguments.
fn with_type<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    if is_array(value) || !has(value, "dtype") {
        return Ok(value.clone());
    }
    value.py().import("numpy")?.call_method1("asarray", (value,))
}

/// The axes that an argument has for one state.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Axes {
    /// No axis.
    Number,
    Vector,
    /// A matrix with rows of this length.
    Rows(usize),
    /// A homogeneous matrix, of shape (4, 4).
    Pose,
}

/// The value of an argument.
pub(crate) enum Value<'py> {
    Of(Bound<'py, PyAny>),
    /// Numbers of one state in the precision of the arrays, such as those for an argument that was left out.
    Own(Vec<f64>),
}

/// Whether there are arrays among the arguments and all of them have single precision. Lists and numbers do not count.
pub(crate) fn are_single(given: &[Given<'_>]) -> bool {
    let mut is_found = false;
    for given in given {
        let Value::Of(value) = &given.value else { continue };
        // columns of Polars and PyArrow are read in double precision
        let is_array = is_array(value);
        if !is_array && is_arrow(value) {
            return false;
        }
        if is_array || has(value, "dtype") {
            is_found = true;
            if value.cast::<PyArrayDyn<f32>>().is_err() {
                return false;
            }
        }
    }
    is_found
}
