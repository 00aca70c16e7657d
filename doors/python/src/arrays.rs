//! Converts arrays of numpy to the arguments of compiled functions, and their results to arrays and dicts of Python.

mod given;
mod memory;
pub(crate) mod reply;

use std::ops::Range;

use numpy::{Element, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rne::Pose;
use rne::compiled::{Array, Number};

pub(crate) use self::given::{Axes, Given, Value, are_single};
use self::memory::is_arrow;
pub(crate) use self::memory::{
    array_of, in_order, is_array, memory, readable, refuse_masked, room, shape_of, taken, writable,
};
use crate::pose::pose_of;

/// How many numbers describe a payload without inertia: its mass and its centre of mass.
const POINT_MASS: usize = 4;

/// The numbers of an argument, which are borrowed or copied for the duration of a call.
pub(crate) struct Held<'py, T: Element> {
    name: &'static str,
    elements: usize,
    layout: Layout<'py, T>,
    /// The number of states; `None` if it is one row for all states.
    pub(crate) states: Option<usize>,
}

enum Layout<'py, T: Element> {
    /// An array in which the numbers of a state are next to each other.
    Rows(PyReadonlyArrayDyn<'py, T>),
    /// A copy in which the numbers of a state are next to each other.
    Own(Vec<T>),
    /// An array in Fortran order, in which the numbers of an element are next to each other.
    Fortran(PyReadonlyArrayDyn<'py, T>),
    /// One array per element, as columns of Polars and PyArrow.
    Columns(Vec<PyReadonlyArrayDyn<'py, T>>),
}

impl<'py, T: Element + Number> Held<'py, T> {
    /// Reads an argument in place if its layout allows it, otherwise from a copy; columns of Polars and PyArrow
    /// likewise. Returns an error if it shares a byte with the memory `written`.
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
            return Err(wrong_shape(given, shape));
        };
        if axes == Axes::Pose {
            let matrices = readable(name, &in_order(array)?)?;
            let matrices = matrices.as_slice().map_err(|_| no_slice(name))?.chunks_exact(16);
            let rigid = matrices.map(|matrix| of_rigid(name, matrix)).collect::<PyResult<Vec<_>>>()?;
            return Ok(held(Layout::Own(rigid.concat()), states));
        }
        // only vectors may be in Fortran order, because the rows of a matrix must be next to each other
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

    /// Returns the slices of its columns, an argument of [`array`](Self::array).
    pub(crate) fn columns(&self) -> PyResult<Vec<&[T]>> {
        let Layout::Columns(columns) = &self.layout else { return Ok(Vec::new()) };
        columns.iter().map(|column| column.as_slice().map_err(|_| no_slice(self.name))).collect()
    }

    /// Returns the array for this number of states. A single row is used for all of them.
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

    /// Returns all numbers as one slice if the layout allows it: state by state, or element by element in Fortran
    /// order.
    pub(crate) fn numbers(&self) -> PyResult<&[T]> {
        match &self.layout {
            Layout::Rows(array) | Layout::Fortran(array) => array.as_slice().map_err(|_| no_slice(self.name)),
            Layout::Own(numbers) => Ok(numbers),
            Layout::Columns(_) => Err(no_slice(self.name)),
        }
    }

    /// Returns the numbers of `states` states, state by state.
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

    /// Whether all numbers pass a test.
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

/// Writes a shape as Python does.
pub(crate) fn shape_in_words(shape: &[usize]) -> String {
    let numbers: Vec<String> = shape.iter().map(ToString::to_string).collect();
    if numbers.len() == 1 { format!("({},)", numbers[0]) } else { format!("({})", numbers.join(", ")) }
}

/// The error for an array that is not contiguous or not aligned.
fn no_slice(name: &str) -> PyErr {
    PyValueError::new_err(format!("`{name}` is not contiguous, or not aligned"))
}

/// Returns the twelve numbers of a pose from the sixteen of a homogeneous matrix, or an error if it is not a rigid
/// pose.
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

/// Returns the pose that twelve numbers describe.
pub(crate) fn pose_of_twelve<T: Copy>(numbers: &[T]) -> Pose<T> {
    let three = |at: usize| [numbers[at], numbers[at + 1], numbers[at + 2]];
    Pose { rotation: [three(0), three(3), three(6)], translation: three(9) }
}

/// Returns a column or a table as `rne.columns` reads it; `None` for any other value.
fn seen<'py>(name: &str, elements: usize, value: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
    if is_array(value) || !is_arrow(value) {
        return Ok(None);
    }
    let views = value.py().import("rne.columns")?.call_method1("views", (value, elements, name))?;
    Ok((!views.is_none()).then_some(views))
}

/// Returns how many states the arguments have; `None` if each of them is one row for all states.
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

/// Returns the error for an array of a wrong shape.
fn wrong_shape(&Given { name, elements, axes, .. }: &Given<'_>, shape: &[usize]) -> PyErr {
    let shape = shape_in_words(shape);
    PyValueError::new_err(match axes {
        Axes::Number => format!("`{name}` has the shape {shape}; it is a number for all states or (N,) for many"),
        Axes::Pose => format!("`{name}`: a pose has the shape (4, 4) or (N, 4, 4), not {shape}"),
        Axes::Vector | Axes::Rows(_) => {
            let point = if name == "payload" { "; 4 numbers in place of 10 are a point mass" } else { "" };
            format!(
                "`{name}` has the shape {shape}; it is ({elements},) for one state or (N, {elements}) for many{point}"
            )
        }
    })
}
