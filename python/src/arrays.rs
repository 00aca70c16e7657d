//! numpy's arrays as the arguments and results of the machine.

use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rne::compiled::{Array, Number};

/// An argument: its name, how many elements it has for a state, and what was given.
pub(crate) struct Given<'py> {
    pub(crate) name: &'static str,
    pub(crate) elements: usize,
    pub(crate) value: Bound<'py, PyAny>,
}

/// Whether all arrays among the arguments are of single precision; lists and numbers follow them.
pub(crate) fn are_single(given: &[Given<'_>]) -> bool {
    let mut arrays = given.iter().filter(|given| given.value.hasattr("dtype").unwrap_or(false)).peekable();
    arrays.peek().is_some() && arrays.all(|given| given.value.cast::<PyArrayDyn<f32>>().is_ok())
}

/// An array that lives as long as it is computed with.
pub(crate) struct Held<'py, T: Element> {
    name: &'static str,
    elements: usize,
    array: PyReadonlyArrayDyn<'py, T>,
    /// How many states it has; `None`: it is one row for all.
    pub(crate) states: Option<usize>,
    /// Whether its elements come before its states in memory.
    is_fortran: bool,
}

impl<'py, T: Element + Number> Held<'py, T> {
    /// Takes an array as it is where its layout allows, a copy where not.
    pub(crate) fn of(given: &Given<'py>, dtype: &str) -> PyResult<Self> {
        let &Given { name, elements, ref value } = given;
        let py = value.py();
        let array = match value.cast::<PyArrayDyn<T>>() {
            Ok(array) => array.clone(),
            Err(_) => converted(py, name, value, dtype)?,
        };
        let shape = array.shape().to_vec();
        let states = match shape[..] {
            [found] if found == elements => None,
            [states, found] if found == elements => Some(states),
            _ => {
                let shape: Vec<String> = shape.iter().map(ToString::to_string).collect();
                let message = format!(
                    "`{name}` has the shape ({}); it is ({elements},) for one state or (N, {elements}) for many",
                    shape.join(", ")
                );
                return Err(PyValueError::new_err(message));
            }
        };
        let array = if array.is_c_contiguous() || array.is_fortran_contiguous() {
            array
        } else {
            let copy = py.import("numpy")?.call_method1("ascontiguousarray", (array,))?;
            copy.cast_into::<PyArrayDyn<T>>()?
        };
        let is_fortran = !array.is_c_contiguous();
        let array = array.try_readonly().map_err(|_| {
            PyValueError::new_err(format!("`{name}` is being written to: it is an `out` that is still in use"))
        })?;
        Ok(Self { name, elements, array, states, is_fortran })
    }

    /// The array for so many states: a single row is that of all.
    pub(crate) fn array(&self, states: usize) -> PyResult<Array<'_, T>> {
        let numbers = self.array.as_slice().map_err(|_| PyValueError::new_err("an array is not contiguous"))?;
        match self.states {
            None | Some(1) if states != 1 => Ok(Array::Same(numbers)),
            None => Ok(Array::Rows(numbers)),
            Some(found) if found != states => {
                Err(PyValueError::new_err(format!("`{}` has {found} states where others have {states}", self.name)))
            }
            Some(_) if self.is_fortran => Ok(Array::Strided { numbers, state: 1, element: states }),
            Some(_) => Ok(Array::Rows(numbers)),
        }
    }

    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    pub(crate) fn elements(&self) -> usize {
        self.elements
    }
}

/// What numpy makes of lists, integers and other floats.
fn converted<'py, T: Element>(
    py: Python<'py>,
    name: &str,
    value: &Bound<'py, PyAny>,
    dtype: &str,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let keywords = PyDict::new(py);
    keywords.set_item("dtype", dtype)?;
    let numpy = py.import("numpy")?;
    let kind = numpy.call_method1("asarray", (value,)).and_then(|array| array.getattr("dtype")?.getattr("kind"));
    let kind: String = kind.and_then(|kind| kind.extract()).unwrap_or_default();
    if !["f", "i", "u", "b"].contains(&kind.as_str()) {
        return Err(PyTypeError::new_err(format!("`{name}` is no array of real numbers")));
    }
    Ok(numpy.call_method("asarray", (value,), Some(&keywords))?.cast_into::<PyArrayDyn<T>>()?)
}

/// How many states the arguments have; `None` where all are one row.
pub(crate) fn states<T: Element + Number>(held: &[Held<'_, T>]) -> PyResult<Option<usize>> {
    let mut states = None;
    for held in held {
        states = match (states, held.states) {
            (None | Some(1), Some(found)) => Some(found),
            (Some(states), Some(found)) if found != states && found != 1 => {
                let message = format!("`{}` has {found} states where others have {states}", held.name());
                return Err(PyValueError::new_err(message));
            }
            (states, _) => states,
        };
    }
    Ok(states)
}

/// Room for results of a shape: `out`, if it is that, or a new array.
pub(crate) fn room<'py, T: Element>(
    py: Python<'py>,
    out: Option<&Bound<'py, PyAny>>,
    shape: &[usize],
    dtype: &str,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let Some(out) = out else { return Ok(PyArrayDyn::zeros(py, shape, false)) };
    let wanted = || {
        let shape: Vec<String> = shape.iter().map(ToString::to_string).collect();
        format!("`out` must be a writable array in C order of the shape ({}) and of {dtype}", shape.join(", "))
    };
    let array = out.cast::<PyArrayDyn<T>>().map_err(|_| PyValueError::new_err(wanted()))?;
    if array.shape() != shape || !array.is_c_contiguous() {
        return Err(PyValueError::new_err(wanted()));
    }
    Ok(array.clone())
}
