//! Computes functions of an arm with arrays of numpy.

use std::ffi::CString;
use std::ops::Range;

use numpy::{Element, PyArrayDyn, PyArrayMethods};
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PySlice, PyTuple};
use rne::compiled::{Arguments, CompiledArm, Destination, EvaluationError, Function, Number};
use rne_codegen::{Answer, Length, Record, Shape, Sizes};

use crate::arrays::{Given, Held, are_single, memory, room, states, writable};
use crate::errors::of_evaluation;

/// Returns the shape of a part of a result for one state, as numpy users expect it.
fn shape_of(part: &Shape, sizes: Sizes) -> Vec<usize> {
    const TRIPLE: Shape = Shape::Array(Length::Fixed(3), &Shape::Number);
    match part {
        Shape::Number => Vec::new(),
        Shape::Array(length, of_each) => [vec![length.of(sizes)], shape_of(of_each, sizes)].concat(),
        // a pose becomes a homogeneous matrix
        Shape::Record(Record::Pose, _) => vec![4, 4],
        // a wrench becomes six numbers: force, then moment
        Shape::Record(_, parts) if **parts == [TRIPLE; 2] => vec![6],
        Shape::Record(_, parts) => {
            [vec![parts.len()], parts.first().map_or(Vec::new(), |part| shape_of(part, sizes))].concat()
        }
    }
}

/// Returns the parts of a record if they have different shapes. Then the result has their numbers one after the other.
fn unlike(shape: &Shape) -> Option<&'static [Shape]> {
    match *shape {
        Shape::Record(record, parts) if record != Record::Pose => {
            parts.iter().any(|part| *part != parts[0]).then_some(parts)
        }
        _ => None,
    }
}

/// Returns the shape of a result for one state, as numpy users expect it.
fn shape(function: Function, arm: &CompiledArm) -> Vec<usize> {
    if unlike(function.shape()).is_some() {
        return vec![arm.layout(function).len()];
    }
    let found = shape_of(function.shape(), rne_codegen::sizes_of(arm.robot()));
    match found[..] {
        // one column per parameter, so that Y @ parameters gives torques
        [rows, bodies, parameters] if function.is_of_every_link() => vec![rows, bodies * parameters],
        _ => found,
    }
}

/// Computes a function. If all arrays are in single precision, the result is too; otherwise it is in double precision.
pub(crate) fn evaluate<'py>(
    py: Python<'py>,
    arm: &CompiledArm,
    function: Function,
    given: &[Given<'py>],
    out: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    if are_single(given) {
        warn_of_loss(py, arm, function)?;
        evaluate_in::<f32>(py, arm, function, given, out)
    } else {
        evaluate_in::<f64>(py, arm, function, given, out)
    }
}

/// Computes a function of `count` states.
pub(crate) fn run<T: Number>(
    arm: &CompiledArm,
    function: Function,
    count: usize,
    arguments: &Arguments<'_, T>,
    numbers: &mut [T],
) -> Result<(), EvaluationError> {
    if count == 1 {
        return arm.run_one(function, arguments, numbers);
    }
    arm.run(function, count, arguments, Destination::Rows(numbers))
}

/// Warns if single precision is not enough for a function. If the function cannot be compiled, the later evaluation
/// returns the error.
pub(crate) fn warn_of_loss(py: Python<'_>, arm: &CompiledArm, function: Function) -> PyResult<()> {
    let Some(loss) = py.detach(|| arm.function(function)).ok().and_then(|compiled| compiled.program().loss) else {
        return Ok(());
    };
    let text = format!(
        "float32 is not enough for {function}: at random states, its errors are up to {loss:.1e} of the largest number \
         that it returns; pass arrays of float64"
    );
    PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(text)?, 1)
}

fn evaluate_in<'py, T: Element + Number>(
    py: Python<'py>,
    arm: &CompiledArm,
    function: Function,
    given: &[Given<'py>],
    out: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let of_state = shape(function, arm);
    let (result, many) = computed::<T>(py, given, out, [&[], &of_state], |_, count, arguments, numbers| {
        let computed = py.detach(|| match function.answer() {
            Answer::Poses => {
                let compiled = arm.function(function)?.outputs();
                let mut rows = vec![T::zero(); compiled * count];
                run(arm, function, count, arguments, &mut rows)?;
                let matrices = numbers.chunks_exact_mut(16).zip(rows.chunks_exact(12));
                matrices.for_each(|(matrix, pose)| homogeneous(pose, matrix));
                Ok(())
            }
            _ => run(arm, function, count, arguments, numbers),
        });
        computed.map_err(|error: EvaluationError| of_evaluation(&error))
    })?;
    as_python(arm, function, result, many, &of_state)
}

/// Computes results from the arguments of all states, into `out` or into new memory. Returns the results and the number
/// of states, `None` for one state without an axis. The result has the axes `before`, that of the states, then `after`.
pub(crate) fn computed<'py, T: Element + Number>(
    py: Python<'py>,
    given: &[Given<'py>],
    out: Option<&Bound<'py, PyAny>>,
    [before, after]: [&[usize]; 2],
    compute: impl FnOnce(&[Held<'py, T>], usize, &Arguments<'_, T>, &mut [T]) -> PyResult<()>,
) -> PyResult<(Bound<'py, PyArrayDyn<T>>, Option<usize>)> {
    let written = out.and_then(|out| out.cast::<PyArrayDyn<T>>().ok()).map_or(0..0, memory);
    let held: Vec<Held<'py, T>> = given.iter().map(|given| Held::of(given, &written)).collect::<PyResult<_>>()?;
    let many = states(&held)?;
    let count = many.unwrap_or(1);
    let columns: Vec<Vec<&[T]>> = held.iter().map(Held::columns).collect::<PyResult<_>>()?;
    let arguments = arguments(given, &held, &columns, count)?;
    let result = room::<T>(py, out, &[before, many.as_slice(), after].concat())?;
    {
        let mut writable = writable(&result)?;
        let numbers = writable.as_slice_mut().map_err(|_| PyValueError::new_err("`out` is not contiguous"))?;
        compute(&held, count, &arguments, numbers)?;
    }
    Ok((result, many))
}

/// Returns the elements in a range of the last axis of the results, where those of each state get this shape.
fn part<'py, T: Element>(
    result: &Bound<'py, PyArrayDyn<T>>,
    many: Option<usize>,
    elements: Range<usize>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let py = result.py();
    let slice = PySlice::new(py, isize::try_from(elements.start)?, isize::try_from(elements.end)?, 1);
    let part = match many {
        None => result.get_item(slice)?,
        Some(_) => result.get_item((PySlice::full(py), slice))?,
    };
    if shape.len() == 1 {
        return Ok(part);
    }
    let whole: Vec<usize> = many.into_iter().chain(shape.iter().copied()).collect();
    Ok(part.cast::<PyArrayDyn<T>>()?.reshape(whole)?.into_any())
}

/// Writes the homogeneous matrix of a pose, whose numbers are the three rows of the rotation and then the origin.
pub(crate) fn homogeneous<T: Number>(pose: &[T], matrix: &mut [T]) {
    for row in 0..3 {
        matrix[4 * row..][..3].copy_from_slice(&pose[3 * row..][..3]);
        matrix[4 * row + 3] = pose[9 + row];
    }
    matrix[12..].copy_from_slice(&[T::zero(), T::zero(), T::zero(), T::one()]);
}

/// Returns a new array with a block of this shape for each state, which `write` computes from the numbers of the state.
pub(crate) fn rewritten<'py, T: Element + Number>(
    result: &Bound<'py, PyArrayDyn<T>>,
    many: Option<usize>,
    shape: &[usize],
    write: impl Fn(&[T], &mut [T]),
) -> PyResult<Bound<'py, PyAny>> {
    let whole: Vec<usize> = many.into_iter().chain(shape.iter().copied()).collect();
    let (size, count) = (shape.iter().product::<usize>().max(1), many.unwrap_or(1).max(1));
    let made = PyArrayDyn::zeros(result.py(), whole, false);
    let read = result.readonly();
    let numbers = read.as_slice()?;
    let mut written = made.readwrite();
    let of_each = written.as_slice_mut()?.chunks_exact_mut(size);
    of_each.zip(numbers.chunks_exact((numbers.len() / count).max(1))).for_each(|(made, numbers)| write(numbers, made));
    drop(written);
    Ok(made.into_any())
}

/// Returns the matrices A and B of a linear model from the rows of q_dq, q_dv, q_dtau, v_dq, v_dv and v_dtau, which
/// follow each other.
fn linear_model<'py, T: Element + Number>(
    result: &Bound<'py, PyArrayDyn<T>>,
    many: Option<usize>,
    [size, inputs]: [usize; 2],
) -> PyResult<Bound<'py, PyAny>> {
    let half = 2 * size * size + size * inputs;
    let a = rewritten(result, many, &[2 * size, 2 * size], |numbers, a| {
        for (row, a) in a.chunks_exact_mut(2 * size).enumerate() {
            let numbers = &numbers[half * (row / size)..];
            for (block, a) in a.chunks_exact_mut(size).enumerate() {
                a.copy_from_slice(&numbers[size * (size * block + row % size)..][..size]);
            }
        }
    });
    let b = rewritten(result, many, &[2 * size, inputs], |numbers, b| {
        let of_half = b.chunks_exact_mut(size * inputs).zip(numbers.chunks_exact(half));
        of_half.for_each(|(b, numbers)| b.copy_from_slice(&numbers[2 * size * size..]));
    });
    Ok(PyTuple::new(result.py(), [a?, b?])?.into_any())
}

/// Returns the results in the form for Python: a record becomes a tuple of arrays.
fn as_python<'py, T: Element + Number>(
    arm: &CompiledArm,
    function: Function,
    result: Bound<'py, PyArrayDyn<T>>,
    many: Option<usize>,
    of_state: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let (py, dof) = (result.py(), arm.dof());
    let parts = |mut from: usize, shapes: &[Vec<usize>]| {
        let parts = shapes.iter().map(|shape| {
            let start = from;
            from += shape.iter().product::<usize>();
            part(&result, many, start..from, shape)
        });
        Ok(PyTuple::new(py, parts.collect::<PyResult<Vec<_>>>()?)?.into_any())
    };
    match *function.shape() {
        Shape::Record(Record::NextStateDerivatives, _) => linear_model(&result, many, [dof, dof]),
        Shape::Record(Record::FloatingStepDerivatives, _) => linear_model(&result, many, [6 + dof, dof]),
        Shape::Record(Record::FloatingNextState, _) => {
            let pose = rewritten(&result, many, &[4, 4], |numbers, matrix| homogeneous(numbers, matrix))?;
            let others = parts(12, &[vec![6], vec![dof], vec![dof]])?;
            PyTuple::new(py, [pose])?.into_any().add(others)
        }
        Shape::Record(record, all) if record != Record::Pose => {
            if let Some(all) = unlike(function.shape()) {
                // the parts of a record in the first place are elements of the tuple themselves
                let (first, rest) = all.split_at(1);
                let first = first.iter().flat_map(|part| unlike(part).unwrap_or(std::slice::from_ref(part)));
                let sizes = rne_codegen::sizes_of(arm.robot());
                let shapes: Vec<_> = first.chain(rest).map(|part| shape_of(part, sizes)).collect();
                return parts(0, &shapes);
            }
            let of = |index: usize| match many {
                None => result.get_item(index),
                Some(_) => result.get_item((PySlice::full(py), index)),
            };
            let parts = (0..all.len()).map(of).collect::<PyResult<Vec<_>>>()?;
            Ok(PyTuple::new(py, parts)?.into_any())
        }
        _ => finished(result, many.is_none() && of_state.is_empty()),
    }
}

/// Returns the arguments of a call for the compiled arm, from the arrays of Python.
fn arguments<'a, T: Element + Number>(
    given: &[Given<'_>],
    held: &'a [Held<'_, T>],
    columns: &'a [Vec<&'a [T]>],
    states: usize,
) -> PyResult<Arguments<'a, T>> {
    let mut arguments = Arguments::new();
    for ((given, held), columns) in given.iter().zip(held).zip(columns) {
        let array = held.array(states, columns)?;
        if given.parts.is_empty() {
            arguments = arguments.with(held.name(), array).ok_or_else(|| PyValueError::new_err(held.name()))?;
        }
        for (index, part) in given.parts.iter().enumerate() {
            let array = array.part(held.elements(), 3 * index..3 * index + 3);
            arguments = arguments.with(part, array).ok_or_else(|| PyValueError::new_err(*part))?;
        }
    }
    Ok(arguments)
}

/// Turns an array without axes into a number.
fn finished<T: Element>(result: Bound<'_, PyArrayDyn<T>>, is_number: bool) -> PyResult<Bound<'_, PyAny>> {
    if is_number { result.into_any().get_item(()) } else { Ok(result.into_any()) }
}
