//! The memory of numpy's arrays: arguments that are read, and arrays for results.

use std::ops::Range;

use numpy::{BorrowError, Element, PyArray1, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods};
use numpy::{PyReadonlyArrayDyn, PyReadwriteArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyFloat, PyList, PyTuple, PyType};

use super::shape_in_words;

pub(crate) fn is_array(value: &Bound<'_, PyAny>) -> bool {
    value.cast::<PyUntypedArray>().is_ok()
}

/// Whether a value has an attribute. Lists and tuples are not searched, because a search in vain takes a microsecond.
pub(crate) fn has(value: &Bound<'_, PyAny>, attribute: &str) -> bool {
    let is_list = value.is_exact_instance_of::<PyList>() || value.is_exact_instance_of::<PyTuple>();
    !is_list && value.hasattr(attribute).unwrap_or(false)
}

/// Returns the shape of an argument; `None` if it does not consist of real numbers, for which an error follows later.
pub(crate) fn shape_of(value: &Bound<'_, PyAny>) -> PyResult<Option<Vec<usize>>> {
    let shape =
        |array: &Bound<'_, PyUntypedArray>| b"fiub".contains(&array.dtype().kind()).then(|| array.shape().to_vec());
    if let Ok(array) = value.cast::<PyUntypedArray>() {
        return Ok(shape(array));
    }
    let array = value.py().import("numpy")?.call_method1("asarray", (value,));
    Ok(array.ok().and_then(|array| shape(array.cast::<PyUntypedArray>().ok()?)))
}

/// Whether a value may be a column or a table of Polars or PyArrow.
pub(super) fn is_arrow(value: &Bound<'_, PyAny>) -> bool {
    ["__arrow_c_stream__", "__arrow_c_array__", "collect_schema"].iter().any(|name| has(value, name))
}

/// Returns the array that a caller gave, of any layout. If its numbers have the right type, its memory is used without
/// a copy.
pub(crate) fn taken<'py, T: Element>(
    name: &'static str,
    value: &Bound<'py, PyAny>,
    written: &Range<usize>,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    refuse_masked(name, value)?;
    let array = match value.cast::<PyArrayDyn<T>>() {
        Ok(array) => array.clone(),
        Err(_) => converted(name, value)?,
    };
    // numpy's own check compares the owners of arrays, but the same memory can have several owners: memoryviews, mapped
    // files, shared memory
    let read = if written.is_empty() { 0..0 } else { memory(&array) };
    if read.start < written.end && written.start < read.end {
        let message = format!("`out` and `{name}` share memory: give `out` memory of its own");
        return Err(PyValueError::new_err(message));
    }
    Ok(array)
}

/// Returns the addresses from the first byte of an array to its last one, including gaps between its numbers. An empty
/// array has none.
pub(crate) fn memory<T: Element>(array: &Bound<'_, PyArrayDyn<T>>) -> Range<usize> {
    if array.is_empty() {
        return 0..0;
    }
    let first = array.data().addr();
    let (mut start, mut end) = (first, first.saturating_add(size_of::<T>()));
    for (&length, &stride) in array.shape().iter().zip(array.strides()) {
        let reach = stride.unsigned_abs().saturating_mul(length - 1);
        if stride < 0 {
            start = start.saturating_sub(reach);
        } else {
            end = end.saturating_add(reach);
        }
    }
    start..end
}

/// Returns an error for an array of `numpy.ma` with masked elements, because a masked element has no value.
pub(crate) fn refuse_masked(name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
    // most arguments are plain arrays, which have no masked elements
    if value.is_exact_instance_of::<PyUntypedArray>() {
        return Ok(());
    }
    let has_masked = match (value.cast::<PyList>(), value.cast::<PyTuple>()) {
        (Ok(list), _) => any(list.iter(), is_masked)?,
        (_, Ok(tuple)) => any(tuple.iter(), is_masked)?,
        _ => is_masked(value)?,
    };
    if has_masked {
        let message = format!("`{name}`: there are masked elements, which are not numbers: drop or fill them before");
        return Err(PyValueError::new_err(message));
    }
    Ok(())
}

fn any<'py>(
    mut values: impl Iterator<Item = Bound<'py, PyAny>>,
    is: impl Fn(&Bound<'py, PyAny>) -> PyResult<bool>,
) -> PyResult<bool> {
    values.try_fold(false, |found, value| Ok(found || is(&value)?))
}

fn is_masked(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    static MASKED_ARRAY: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    if value.is_exact_instance_of::<PyFloat>() {
        return Ok(false);
    }
    let py = value.py();
    if !value.is_instance(MASKED_ARRAY.import(py, "numpy.ma", "MaskedArray")?)? {
        return Ok(false);
    }
    py.import("numpy.ma")?.call_method1("is_masked", (value,))?.extract()
}

/// Returns the array itself if it is aligned and in C order, otherwise a copy that is.
pub(crate) fn in_order<T: Element>(array: Bound<'_, PyArrayDyn<T>>) -> PyResult<Bound<'_, PyArrayDyn<T>>> {
    if array.is_c_contiguous() && array.is_aligned() {
        return Ok(array);
    }
    let keywords = PyDict::new(array.py());
    keywords.set_item("order", "C")?;
    let copy = array.py().import("numpy")?.call_method("array", (array,), Some(&keywords))?;
    Ok(copy.cast_into::<PyArrayDyn<T>>()?)
}

pub(crate) fn readable<'py, T: Element>(
    name: &str,
    array: &Bound<'py, PyArrayDyn<T>>,
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    array.try_readonly().map_err(|_| {
        PyValueError::new_err(format!("`{name}` is being written to: it is an `out` that is still in use"))
    })
}

/// Converts lists, integers and other floats to an array, as numpy does.
fn converted<'py, T: Element>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let py = value.py();
    let keywords = PyDict::new(py);
    keywords.set_item("dtype", T::get_dtype(py))?;
    let numpy = py.import("numpy")?;
    let kind = numpy.call_method1("asarray", (value,)).and_then(|array| array.getattr("dtype")?.getattr("kind"));
    let kind: String = kind.and_then(|kind| kind.extract()).unwrap_or_default();
    if !["f", "i", "u", "b"].contains(&kind.as_str()) {
        let order = match name {
            "parameters" => ": write them in the order of `arm.parameters`, or as a dict by their names",
            "payload" => ": it has 10 numbers, which `rne.payload` makes, or the 4 numbers of a point mass",
            _ => "",
        };
        let what = if name == "step" { "a real number" } else { "an array of real numbers" };
        return Err(PyTypeError::new_err(format!("`{name}` is not {what}{order}")));
    }
    Ok(numpy.call_method("asarray", (value,), Some(&keywords))?.cast_into::<PyArrayDyn<T>>()?)
}

/// Returns a new array with the numbers of one state, or of many, which have this shape each.
pub(crate) fn array_of<'py, T: Element>(
    py: Python<'py>,
    states: &[usize],
    shape: &[usize],
    numbers: Vec<T>,
) -> PyResult<Bound<'py, PyAny>> {
    Ok(PyArray1::from_vec(py, numbers).reshape([states, shape].concat())?.into_any())
}

/// Returns an array for results of a shape: `out` if it is given and suitable, otherwise a new array.
pub(crate) fn room<'py, T: Element>(
    py: Python<'py>,
    out: Option<&Bound<'py, PyAny>>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let Some(out) = out else { return Ok(PyArrayDyn::zeros(py, shape, false)) };
    let wanted = || {
        let (shape, dtype) = (shape_in_words(shape), T::get_dtype(py));
        format!("`out` must be a writable array in C order of the shape {shape} and of {dtype}")
    };
    let array = out.cast::<PyArrayDyn<T>>().map_err(|_| PyValueError::new_err(wanted()))?;
    if array.shape() != shape || !array.is_c_contiguous() {
        return Err(PyValueError::new_err(wanted()));
    }
    if !array.is_aligned() {
        let message = format!("`out` is not aligned: its address must be a multiple of {}", align_of::<T>());
        return Err(PyValueError::new_err(message));
    }
    refuse_masked("out", out)?;
    Ok(array.clone())
}

/// Borrows the array for results exclusively, so that nobody else reads or writes it.
pub(crate) fn writable<'py, T: Element>(room: &Bound<'py, PyArrayDyn<T>>) -> PyResult<PyReadwriteArrayDyn<'py, T>> {
    room.try_readwrite().map_err(|error| {
        PyValueError::new_err(match error {
            BorrowError::NotWriteable => "`out` must be a writable array: this one is read-only",
            _ => "`out` is in use, by another call or as an argument: give it memory of its own",
        })
    })
}
