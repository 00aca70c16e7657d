//! The arguments of a function as they are given.

use numpy::{PyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyFloat;

use super::memory::{has, is_array, is_arrow, refuse_masked, shape_of};
use super::shape_in_words;

/// An argument: its name, the arrays of three that it is made of if it is no array of its own, how many elements it has
/// for a state, how they stand in an array, and what was given.
pub(crate) struct Given<'py> {
    pub(crate) name: &'static str,
    pub(crate) parts: &'static [&'static str],
    pub(crate) elements: usize,
    pub(crate) axes: Axes,
    pub(crate) value: Value<'py>,
}

impl<'py> Given<'py> {
    /// Numbers side by side.
    pub(crate) fn vector(name: &'static str, elements: usize, value: Bound<'py, PyAny>) -> Self {
        Self { name, parts: &[], elements, axes: Axes::Vector, value: Value::Of(value) }
    }

    /// What stands for numbers side by side that were left out.
    pub(crate) fn own(name: &'static str, numbers: Vec<f64>) -> Self {
        Self { name, parts: &[], elements: numbers.len(), axes: Axes::Vector, value: Value::Own(numbers) }
    }

    /// A number, or an array of shape (N,).
    pub(crate) fn number(name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Self> {
        let is_number = match value.cast::<PyUntypedArray>() {
            Ok(array) => array.ndim() == 0,
            Err(_) => value.is_instance_of::<PyFloat>() || value.len().is_err(),
        };
        refuse_masked(name, value)?;
        // a number follows the precision of the arrays
        let number = if is_number { value.extract().ok() } else { None };
        let value = match number {
            Some(number) => Value::Own(vec![number]),
            None => Value::Of(with_type(value)?),
        };
        Ok(Self { name, parts: &[], elements: 1, axes: Axes::Number, value })
    }

    /// Rows of numbers; the refusal of another shape ends with what is `known`.
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

/// What has a type of numbers as an array; lists, which follow the arrays among the arguments, as they are.
fn with_type<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    if is_array(value) || !has(value, "dtype") {
        return Ok(value.clone());
    }
    value.py().import("numpy")?.call_method1("asarray", (value,))
}

/// How the elements of a state stand in an array.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Axes {
    /// Without an axis.
    Number,
    Vector,
    /// In rows of this length.
    Rows(usize),
    /// As a homogeneous matrix.
    Pose,
}

/// What was given for an argument.
pub(crate) enum Value<'py> {
    Of(Bound<'py, PyAny>),
    /// Numbers of one state, which follow the precision of the arrays: what stands for an argument that was left out.
    Own(Vec<f64>),
}

/// Whether all arrays among the arguments are of single precision; lists and numbers follow them.
pub(crate) fn are_single(given: &[Given<'_>]) -> bool {
    let mut is_found = false;
    for given in given {
        let Value::Of(value) = &given.value else { continue };
        // columns have doubles
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
