//! numpy's arrays as the arguments and results of the machine.

use std::ops::Range;

use numpy::{BorrowError, Element, PyArrayDyn, PyArrayMethods};
use numpy::{PyReadonlyArrayDyn, PyReadwriteArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyFloat, PyList, PyTuple, PyType};
use rne::compiled::{Array, Number};

/// An argument: its name, the arrays of three that it is made of if it is no array of its own, how many elements it has
/// for a state, and what was given.
pub(crate) struct Given<'py> {
    pub(crate) name: &'static str,
    pub(crate) parts: &'static [&'static str],
    pub(crate) elements: usize,
    pub(crate) value: Bound<'py, PyAny>,
}

/// Numbers of a payload without inertia: its mass, and its centre of mass.
const POINT_MASS: usize = 4;

/// Whether all arrays among the arguments are of single precision; lists and numbers follow them.
pub(crate) fn are_single(given: &[Given<'_>]) -> bool {
    // columns have doubles
    if given.iter().any(|given| is_arrow(&given.value)) {
        return false;
    }
    let mut arrays = given.iter().filter(|given| given.value.hasattr("dtype").unwrap_or(false)).peekable();
    arrays.peek().is_some() && arrays.all(|given| given.value.cast::<PyArrayDyn<f32>>().is_ok())
}

/// An array that lives as long as it is computed with.
pub(crate) struct Held<'py, T: Element> {
    name: &'static str,
    elements: usize,
    layout: Layout<'py, T>,
    /// How many states it has; `None`: it is one row for all.
    pub(crate) states: Option<usize>,
}

enum Layout<'py, T: Element> {
    /// State by state.
    Rows(PyReadonlyArrayDyn<'py, T>),
    /// Element by element.
    Fortran(PyReadonlyArrayDyn<'py, T>),
    /// An array for each element.
    Columns(Vec<PyReadonlyArrayDyn<'py, T>>),
}

impl<'py, T: Element + Number> Held<'py, T> {
    /// Takes an array as it is where its layout allows, a copy where not; of columns of Polars and PyArrow likewise.
    /// It has no byte of the memory that is `written`.
    pub(crate) fn of(given: &Given<'py>, dtype: &str, written: &Range<usize>) -> PyResult<Self> {
        let &Given { name, elements, ref value, .. } = given;
        let py = value.py();
        let value = match seen(given)? {
            None => value.clone(),
            Some(views) => match views.cast::<PyTuple>() {
                Ok(columns) => return Self::of_columns(given, columns, dtype, written),
                Err(_) => views,
            },
        };
        let mut array = taken(py, name, &value, dtype, written)?;
        let mut shape = array.shape().to_vec();
        if name == "payload" && shape.last() == Some(&POINT_MASS) {
            let mut widths = vec![(0, 0); shape.len()];
            if let (Some(width), Some(numbers)) = (widths.last_mut(), shape.last_mut()) {
                (width.1, *numbers) = (elements - POINT_MASS, elements);
            }
            array = py.import("numpy")?.call_method1("pad", (array, widths))?.cast_into()?;
        }
        let states = match shape[..] {
            [found] if found == elements => None,
            [states, found] if found == elements => Some(states),
            _ => {
                let point = if name == "payload" { "; 4 numbers in place of 10 are a point mass" } else { "" };
                let message = format!(
                    "`{name}` has the shape {}; it is ({elements},) for one state or (N, {elements}) for many{point}",
                    shape_in_words(&shape)
                );
                return Err(PyValueError::new_err(message));
            }
        };
        let is_in_order = array.is_c_contiguous() || array.is_fortran_contiguous();
        let array = if is_in_order && array.is_aligned() { array } else { copied(py, &array)? };
        let is_fortran = !array.is_c_contiguous();
        let array = readable(name, &array)?;
        let layout = if is_fortran { Layout::Fortran(array) } else { Layout::Rows(array) };
        Ok(Self { name, elements, layout, states })
    }

    fn of_columns(
        given: &Given<'py>,
        columns: &Bound<'py, PyTuple>,
        dtype: &str,
        written: &Range<usize>,
    ) -> PyResult<Self> {
        let &Given { name, elements, .. } = given;
        let py = columns.py();
        let of_column = |column: Bound<'py, PyAny>| {
            let array = taken(py, name, &column, dtype, written)?;
            let array = if array.is_c_contiguous() && array.is_aligned() { array } else { copied(py, &array)? };
            readable(name, &array)
        };
        let columns: Vec<_> = columns.iter().map(of_column).collect::<PyResult<_>>()?;
        let states = columns.first().map(|column| column.len());
        Ok(Self { name, elements, layout: Layout::Columns(columns), states })
    }

    /// The slices of its columns, which [`array`](Self::array) is given.
    pub(crate) fn columns(&self) -> PyResult<Vec<&[T]>> {
        let Layout::Columns(columns) = &self.layout else { return Ok(Vec::new()) };
        columns.iter().map(|column| column.as_slice().map_err(|_| no_slice(self.name))).collect()
    }

    /// The array for so many states: a single row is that of all.
    pub(crate) fn array<'a>(&'a self, states: usize, columns: &'a [&'a [T]]) -> PyResult<Array<'a, T>> {
        if let Some(found) = self.states.filter(|&found| found != states && found != 1) {
            return Err(PyValueError::new_err(format!(
                "`{}` has {found} states, but other arguments have {states}",
                self.name
            )));
        }
        let (array, is_fortran) = match &self.layout {
            Layout::Rows(array) => (array, false),
            Layout::Fortran(array) => (array, true),
            Layout::Columns(_) if self.states == Some(1) && states != 1 => {
                let message = format!(
                    "`{}` has 1 state, but other arguments have {states}; a row as an array of numpy is used for all \
                     states",
                    self.name
                );
                return Err(PyValueError::new_err(message));
            }
            Layout::Columns(_) => return Ok(Array::Columns(columns)),
        };
        let numbers = array.as_slice().map_err(|_| no_slice(self.name))?;
        match self.states {
            None | Some(1) if states != 1 => Ok(Array::Same(numbers)),
            Some(_) if is_fortran => Ok(Array::Strided { numbers, state: 1, element: states }),
            _ => Ok(Array::Rows(numbers)),
        }
    }

    /// Whether all its numbers pass a test.
    pub(crate) fn all(&self, test: impl Fn(T) -> bool) -> bool {
        let pass =
            |array: &PyReadonlyArrayDyn<'py, T>| array.as_slice().is_ok_and(|slice| slice.iter().all(|&x| test(x)));
        match &self.layout {
            Layout::Rows(array) | Layout::Fortran(array) => pass(array),
            Layout::Columns(columns) => columns.iter().all(pass),
        }
    }

    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    pub(crate) fn elements(&self) -> usize {
        self.elements
    }
}

/// A shape as Python writes it.
pub(crate) fn shape_in_words(shape: &[usize]) -> String {
    let numbers: Vec<String> = shape.iter().map(ToString::to_string).collect();
    if numbers.len() == 1 { format!("({},)", numbers[0]) } else { format!("({})", numbers.join(", ")) }
}

/// An array that cannot be a slice: it is copied before, or refused.
fn no_slice(name: &str) -> PyErr {
    PyValueError::new_err(format!("`{name}` is not contiguous, or not aligned"))
}

/// Whether it may be a column or a table of Polars or PyArrow.
fn is_arrow(value: &Bound<'_, PyAny>) -> bool {
    // an attribute that an array lacks is looked for in vain at 0.4 us
    let is_array = value.cast::<PyUntypedArray>().is_ok();
    !is_array
        && ["__arrow_c_stream__", "__arrow_c_array__", "collect_schema"]
            .iter()
            .any(|name| value.hasattr(name).unwrap_or(false))
}

/// What `rne.columns` sees of a column or a table; `None` of all else.
fn seen<'py>(given: &Given<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let Given { name, elements, value, .. } = given;
    if !is_arrow(value) {
        return Ok(None);
    }
    let views = value.py().import("rne.columns")?.call_method1("views", (value, *elements, *name))?;
    Ok((!views.is_none()).then_some(views))
}

/// What is given as an array, whatever its layout: its own memory where it has the type already.
fn taken<'py, T: Element>(
    py: Python<'py>,
    name: &'static str,
    value: &Bound<'py, PyAny>,
    dtype: &str,
    written: &Range<usize>,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    refuse_masked(name, value)?;
    let array = match value.cast::<PyArrayDyn<T>>() {
        Ok(array) => array.clone(),
        Err(_) => converted(py, name, value, dtype)?,
    };
    // numpy compares the owners of arrays, and one memory may have several: memoryviews, files, shared memory
    let read = if written.is_empty() { 0..0 } else { memory(&array) };
    if read.start < written.end && written.start < read.end {
        let message = format!("`out` and `{name}` share memory: give `out` memory of its own");
        return Err(PyValueError::new_err(message));
    }
    Ok(array)
}

/// The addresses from the first byte of an array to its last one, gaps between its numbers included; none of an empty
/// array.
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

/// Refuses what `numpy.ma` hides: a masked number is no number, as null of Polars and PyArrow is none.
pub(crate) fn refuse_masked(name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
    // most arguments are plain arrays: nothing more is asked of them
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

/// The numbers of an array in memory of their own, in C order and aligned.
fn copied<'py, T: Element>(py: Python<'py>, array: &Bound<'py, PyArrayDyn<T>>) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let keywords = PyDict::new(py);
    keywords.set_item("order", "C")?;
    let copy = py.import("numpy")?.call_method("array", (array,), Some(&keywords))?;
    Ok(copy.cast_into::<PyArrayDyn<T>>()?)
}

fn readable<'py, T: Element>(name: &str, array: &Bound<'py, PyArrayDyn<T>>) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    array.try_readonly().map_err(|_| {
        PyValueError::new_err(format!("`{name}` is being written to: it is an `out` that is still in use"))
    })
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
        let order = match name {
            "parameters" => ": write them in the order of `arm.parameters`, or as a dict by their names",
            "payload" => ": it has 10 numbers, which `rne.payload` makes, or the 4 numbers of a point mass",
            _ => "",
        };
        return Err(PyTypeError::new_err(format!("`{name}` is not an array of real numbers{order}")));
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
                let message = format!("`{}` has {found} states, but other arguments have {states}", held.name());
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
    let wanted =
        || format!("`out` must be a writable array in C order of the shape {} and of {dtype}", shape_in_words(shape));
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

/// The room as memory that nobody else reads or writes.
pub(crate) fn writable<'py, T: Element>(room: &Bound<'py, PyArrayDyn<T>>) -> PyResult<PyReadwriteArrayDyn<'py, T>> {
    room.try_readwrite().map_err(|error| {
        PyValueError::new_err(match error {
            BorrowError::NotWriteable => "`out` must be a writable array: this one is read-only",
            _ => "`out` is in use, by another call or as an argument: give it memory of its own",
        })
    })
}
