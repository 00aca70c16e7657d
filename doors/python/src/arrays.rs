//! numpy's arrays as the arguments and results of the machine.

use std::ops::Range;

use numpy::{BorrowError, Element, PyArray1, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods};
use numpy::{PyReadonlyArrayDyn, PyReadwriteArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyFloat, PyList, PyTuple, PyType};
use rne::Pose;
use rne::compiled::{Array, Number};

use crate::pose::pose_of;

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

/// The shape of an argument of real numbers; `None` for another kind of value, which is refused later.
pub(crate) fn shape_of(value: &Bound<'_, PyAny>) -> PyResult<Option<Vec<usize>>> {
    let shape =
        |array: &Bound<'_, PyUntypedArray>| b"fiub".contains(&array.dtype().kind()).then(|| array.shape().to_vec());
    if let Ok(array) = value.cast::<PyUntypedArray>() {
        return Ok(shape(array));
    }
    let array = value.py().import("numpy")?.call_method1("asarray", (value,));
    Ok(array.ok().and_then(|array| shape(array.cast::<PyUntypedArray>().ok()?)))
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

/// Numbers of a payload without inertia: its mass, and its centre of mass.
const POINT_MASS: usize = 4;

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

pub(crate) fn is_array(value: &Bound<'_, PyAny>) -> bool {
    value.cast::<PyUntypedArray>().is_ok()
}

/// Whether there is this attribute: it takes a microsecond to look for it in vain, so lists and tuples are not asked.
pub(crate) fn has(value: &Bound<'_, PyAny>, attribute: &str) -> bool {
    let is_list = value.is_exact_instance_of::<PyList>() || value.is_exact_instance_of::<PyTuple>();
    !is_list && value.hasattr(attribute).unwrap_or(false)
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
    /// State by state, in memory of its own.
    Own(Vec<T>),
    /// Element by element.
    Fortran(PyReadonlyArrayDyn<'py, T>),
    /// An array for each element.
    Columns(Vec<PyReadonlyArrayDyn<'py, T>>),
}

impl<'py, T: Element + Number> Held<'py, T> {
    /// Takes an array as it is where its layout allows, a copy where not; of columns of Polars and PyArrow likewise.
    /// It has no byte of the memory that is `written`.
    pub(crate) fn of(given: &Given<'py>, written: &Range<usize>) -> PyResult<Self> {
        let &Given { name, elements, axes, .. } = given;
        let held = |layout, states| Self { name, elements, layout, states };
        let value = match &given.value {
            Value::Of(value) => value,
            Value::Own(numbers) => {
                return Ok(held(Layout::Own(numbers.iter().map(|&number| T::from_f64(number)).collect()), None));
            }
        };
        let value = match if axes == Axes::Vector { seen(name, elements, value)? } else { None } {
            None => value.clone(),
            Some(views) => match views.cast::<PyTuple>() {
                Ok(columns) => return Self::of_columns(given, columns, written),
                Err(_) => views,
            },
        };
        let array = taken(name, &value, written)?;
        let shape = array.shape();
        let states_before = |of_state: &[usize]| match shape.strip_suffix(of_state) {
            Some([]) => Some(None),
            Some(&[states]) => Some(Some(states)),
            _ => None,
        };
        let states = match axes {
            Axes::Number => states_before(&[]),
            Axes::Vector => states_before(&[elements]),
            Axes::Rows(row) => states_before(&[elements / row, row]),
            Axes::Pose => states_before(&[4, 4]),
        };
        if let (None, "payload", Some(states)) = (states, name, states_before(&[POINT_MASS])) {
            let none = std::iter::repeat_n(T::zero(), elements - POINT_MASS);
            let points = readable(name, &in_order(array)?)?;
            let points = points.as_slice().map_err(|_| no_slice(name))?.chunks_exact(POINT_MASS);
            let bodies = points.flat_map(|point| point.iter().copied().chain(none.clone())).collect();
            return Ok(held(Layout::Own(bodies), states));
        }
        let Some(states) = states else {
            let shape = shape_in_words(shape);
            return Err(PyValueError::new_err(match axes {
                Axes::Number => {
                    format!("`{name}` has the shape {shape}; it is a number for all states or (N,) for many")
                }
                Axes::Pose => format!("`{name}`: a pose has the shape (4, 4) or (N, 4, 4), not {shape}"),
                Axes::Vector | Axes::Rows(_) => {
                    let point = if name == "payload" { "; 4 numbers in place of 10 are a point mass" } else { "" };
                    format!(
                        "`{name}` has the shape {shape}; it is ({elements},) for one state or (N, {elements}) for \
                         many{point}"
                    )
                }
            }));
        };
        if axes == Axes::Pose {
            let matrices = readable(name, &in_order(array)?)?;
            let matrices = matrices.as_slice().map_err(|_| no_slice(name))?.chunks_exact(16);
            let rigid = matrices.map(|matrix| of_rigid(name, matrix)).collect::<PyResult<Vec<_>>>()?;
            return Ok(held(Layout::Own(rigid.concat()), states));
        }
        // matrices have their rows side by side
        let is_fortran = !array.is_c_contiguous() && array.is_fortran_contiguous() && array.is_aligned();
        let is_fortran = is_fortran && axes == Axes::Vector;
        let array = readable(name, &if is_fortran { array } else { in_order(array)? })?;
        Ok(held(if is_fortran { Layout::Fortran(array) } else { Layout::Rows(array) }, states))
    }

    fn of_columns(given: &Given<'py>, columns: &Bound<'py, PyTuple>, written: &Range<usize>) -> PyResult<Self> {
        let &Given { name, elements, .. } = given;
        let of_column = |column: Bound<'py, PyAny>| {
            let array = taken(name, &column, written)?;
            readable(name, &in_order(array)?)
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
        let is_fortran = match &self.layout {
            Layout::Rows(_) | Layout::Own(_) => false,
            Layout::Fortran(_) => true,
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
        let numbers = self.numbers()?;
        match self.states {
            None | Some(1) if states != 1 => Ok(Array::Same(numbers)),
            Some(_) if is_fortran => Ok(Array::Strided { numbers, state: 1, element: states }),
            _ => Ok(Array::Rows(numbers)),
        }
    }

    /// Its numbers where they are one slice, state by state unless they are element by element.
    pub(crate) fn numbers(&self) -> PyResult<&[T]> {
        match &self.layout {
            Layout::Rows(array) | Layout::Fortran(array) => array.as_slice().map_err(|_| no_slice(self.name)),
            Layout::Own(numbers) => Ok(numbers),
            Layout::Columns(_) => Err(no_slice(self.name)),
        }
    }

    /// The numbers of so many states, state by state.
    pub(crate) fn rows(&self, states: usize) -> PyResult<Vec<T>> {
        let columns = self.columns()?;
        Ok(match self.array(states, &columns)? {
            Array::Rows(numbers) => numbers.to_vec(),
            Array::Same(numbers) => numbers.repeat(states),
            Array::Columns(columns) => {
                (0..states).flat_map(|state| columns.iter().map(move |column| column[state])).collect()
            }
            Array::Strided { numbers, state, element } => {
                let of_state = |at| (0..self.elements).map(move |index| numbers[at * state + index * element]);
                (0..states).flat_map(of_state).collect()
            }
        })
    }

    /// Whether all its numbers pass a test.
    pub(crate) fn all(&self, test: impl Fn(T) -> bool) -> bool {
        let pass = |numbers: &[T]| numbers.iter().all(|&number| test(number));
        match &self.layout {
            Layout::Columns(columns) => columns.iter().all(|column| column.as_slice().is_ok_and(pass)),
            _ => self.numbers().is_ok_and(pass),
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

/// The twelve numbers of a pose, of the sixteen of a homogeneous matrix.
fn of_rigid<T: Number>(name: &str, matrix: &[T]) -> PyResult<[T; 12]> {
    let pose = pose_of(matrix);
    if !(Pose { rotation: pose.rotation.map(|row| row.map(Into::into)), translation: [0.0; 3] }).is_rigid() {
        return Err(PyValueError::new_err(format!(
            "`{name}` is no rigid pose: the three rows of its rotation must have the length 1, be at right angles to \
             each other, and be right-handed"
        )));
    }
    let below = matrix[12..].iter().zip([0.0, 0.0, 0.0, 1.0]).map(|(&number, right)| number.into() - right);
    if below.into_iter().any(|error: f64| error.abs() > 1e-4) {
        let message = format!("`{name}` is no homogeneous matrix: its last row must be 0, 0, 0, 1");
        return Err(PyValueError::new_err(message));
    }
    let ([a, b, c], [x, y, z]) = (pose.rotation, pose.translation);
    Ok([a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2], x, y, z])
}

/// The pose that twelve numbers are.
pub(crate) fn pose_of_twelve<T: Copy>(numbers: &[T]) -> Pose<T> {
    let three = |at: usize| [numbers[at], numbers[at + 1], numbers[at + 2]];
    Pose { rotation: [three(0), three(3), three(6)], translation: three(9) }
}

/// Whether it may be a column or a table of Polars or PyArrow.
fn is_arrow(value: &Bound<'_, PyAny>) -> bool {
    ["__arrow_c_stream__", "__arrow_c_array__", "collect_schema"].iter().any(|name| has(value, name))
}

/// What `rne.columns` sees of a column or a table; `None` of all else.
fn seen<'py>(name: &str, elements: usize, value: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
    if is_array(value) || !is_arrow(value) {
        return Ok(None);
    }
    let views = value.py().import("rne.columns")?.call_method1("views", (value, elements, name))?;
    Ok((!views.is_none()).then_some(views))
}

/// What is given as an array, whatever its layout: its own memory where it has the type already.
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

/// An array in C order and aligned: itself, or a copy.
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

/// What numpy makes of lists, integers and other floats.
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

/// A new array of numbers of one state, or of many, each of this shape.
pub(crate) fn array_of<'py, T: Element>(
    py: Python<'py>,
    states: &[usize],
    shape: &[usize],
    numbers: Vec<T>,
) -> PyResult<Bound<'py, PyAny>> {
    Ok(PyArray1::from_vec(py, numbers).reshape([states, shape].concat())?.into_any())
}

/// Room for results of a shape: `out`, if it is that, or a new array.
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

/// The room as memory that nobody else reads or writes.
pub(crate) fn writable<'py, T: Element>(room: &Bound<'py, PyArrayDyn<T>>) -> PyResult<PyReadwriteArrayDyn<'py, T>> {
    room.try_readwrite().map_err(|error| {
        PyValueError::new_err(match error {
            BorrowError::NotWriteable => "`out` must be a writable array: this one is read-only",
            _ => "`out` is in use, by another call or as an argument: give it memory of its own",
        })
    })
}
