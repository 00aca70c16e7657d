//! numpy's arrays as the arguments and results of the machine.

use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use rne::compiled::{Array, Number};

/// An argument: its name, how many elements it has for a state, and what was given.
pub(crate) struct Given<'py> {
    pub(crate) name: &'static str,
    pub(crate) elements: usize,
    pub(crate) value: Bound<'py, PyAny>,
}

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
    pub(crate) fn of(given: &Given<'py>, dtype: &str) -> PyResult<Self> {
        let &Given { name, elements, ref value } = given;
        let py = value.py();
        let value = match seen(given)? {
            None => value.clone(),
            Some(views) => match views.cast::<PyTuple>() {
                Ok(columns) => return Self::of_columns(given, columns, dtype),
                Err(_) => views,
            },
        };
        let array = taken(py, name, &value, dtype)?;
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
        let array =
            if array.is_c_contiguous() || array.is_fortran_contiguous() { array } else { contiguous(py, array)? };
        let is_fortran = !array.is_c_contiguous();
        let array = readable(name, &array)?;
        let layout = if is_fortran { Layout::Fortran(array) } else { Layout::Rows(array) };
        Ok(Self { name, elements, layout, states })
    }

    fn of_columns(given: &Given<'py>, columns: &Bound<'py, PyTuple>, dtype: &str) -> PyResult<Self> {
        let &Given { name, elements, .. } = given;
        let py = columns.py();
        let of_column = |column: Bound<'py, PyAny>| {
            let array = taken(py, name, &column, dtype)?;
            let array = if array.is_c_contiguous() { array } else { contiguous(py, array)? };
            readable(name, &array)
        };
        let columns: Vec<_> = columns.iter().map(of_column).collect::<PyResult<_>>()?;
        let states = columns.first().map(|column| column.len());
        Ok(Self { name, elements, layout: Layout::Columns(columns), states })
    }

    /// The slices of its columns, which [`array`](Self::array) is given.
    pub(crate) fn columns(&self) -> PyResult<Vec<&[T]>> {
        let Layout::Columns(columns) = &self.layout else { return Ok(Vec::new()) };
        columns.iter().map(|column| column.as_slice().map_err(|_| not_contiguous())).collect()
    }

    /// The array for so many states: a single row is that of all.
    pub(crate) fn array<'a>(&'a self, states: usize, columns: &'a [&'a [T]]) -> PyResult<Array<'a, T>> {
        if let Some(found) = self.states.filter(|&found| found != states && found != 1) {
            return Err(PyValueError::new_err(format!(
                "`{}` has {found} states where others have {states}",
                self.name
            )));
        }
        let (array, is_fortran) = match &self.layout {
            Layout::Rows(array) => (array, false),
            Layout::Fortran(array) => (array, true),
            Layout::Columns(_) if self.states == Some(1) && states != 1 => {
                let message =
                    format!("`{}` has 1 state where others have {states}; a row of numpy is that of all", self.name);
                return Err(PyValueError::new_err(message));
            }
            Layout::Columns(_) => return Ok(Array::Columns(columns)),
        };
        let numbers = array.as_slice().map_err(|_| not_contiguous())?;
        match self.states {
            None | Some(1) if states != 1 => Ok(Array::Same(numbers)),
            Some(_) if is_fortran => Ok(Array::Strided { numbers, state: 1, element: states }),
            _ => Ok(Array::Rows(numbers)),
        }
    }

    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    pub(crate) fn elements(&self) -> usize {
        self.elements
    }
}

fn not_contiguous() -> PyErr {
    PyValueError::new_err("an array is not contiguous")
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
    let Given { name, elements, value } = given;
    if !is_arrow(value) {
        return Ok(None);
    }
    let views = value.py().import("rne.columns")?.call_method1("views", (value, *elements, *name))?;
    Ok((!views.is_none()).then_some(views))
}

fn taken<'py, T: Element>(
    py: Python<'py>,
    name: &'static str,
    value: &Bound<'py, PyAny>,
    dtype: &str,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    match value.cast::<PyArrayDyn<T>>() {
        Ok(array) => Ok(array.clone()),
        Err(_) => converted(py, name, value, dtype),
    }
}

fn contiguous<'py, T: Element>(
    py: Python<'py>,
    array: Bound<'py, PyArrayDyn<T>>,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let copy = py.import("numpy")?.call_method1("ascontiguousarray", (array,))?;
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
