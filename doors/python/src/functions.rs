//! A function of an arm over numpy's arrays.

use std::ops::Range;

use numpy::{Element, PyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyEllipsis, PySlice, PyTuple};
use rne::compiled::{Arguments, CompiledArm, Destination, Function, Number};
use rne_codegen::{Layout, Record};

use crate::arrays::{Given, Held, are_single, memory, room, states, writable};
use crate::errors::of_evaluation;

/// The shape of a result for one state: what numpy users expect of it.
fn shape(function: Function, arm: &CompiledArm) -> Vec<usize> {
    fn of(layout: &Layout, shape: &mut Vec<usize>) {
        match layout {
            Layout::Number => {}
            Layout::Array(length, of_each) => {
                shape.push(*length);
                of(of_each, shape);
            }
            // homogeneous matrices
            Layout::Record(Record::Pose, _) => shape.extend([4, 4]),
            // force, then moment
            Layout::Record(Record::Wrench | Record::BaseAcceleration | Record::BaseTwist, _) => shape.push(6),
            Layout::Record(
                Record::TorqueDerivatives
                | Record::MomentumAndRate
                | Record::FloatingTorques
                | Record::FloatingAccelerations
                | Record::AccelerationsAndWrenches
                | Record::FloatingTorqueDerivatives
                | Record::TorqueGradient
                | Record::AccelerationDerivatives
                | Record::TorqueHessian
                | Record::NextState
                | Record::StepDerivatives
                | Record::NextStateDerivatives
                | Record::FloatingNextState
                | Record::FloatingStepDerivatives
                | Record::ClosureStep,
                parts,
            ) => {
                shape.push(parts.len());
                if let Some(part) = parts.first() {
                    of(part, shape);
                }
            }
        }
    }
    let mut found = Vec::new();
    let layout = arm.layout(function);
    if let Layout::Record(
        Record::FloatingTorques
        | Record::FloatingAccelerations
        | Record::AccelerationsAndWrenches
        | Record::FloatingTorqueDerivatives
        | Record::FloatingNextState
        | Record::FloatingStepDerivatives
        | Record::ClosureStep,
        _,
    ) = layout
    {
        // parts of different lengths stand one behind the other
        return vec![layout.len()];
    }
    of(&layout, &mut found);
    if let [rows, bodies, parameters] = found[..]
        && function.is_of_every_link()
    {
        // a column per parameter: Y @ parameters are torques
        found = vec![rows, bodies * parameters];
    }
    found
}

/// Computes a function: arrays of single precision give single precision, everything else double.
pub(crate) fn evaluate<'py>(
    py: Python<'py>,
    arm: &CompiledArm,
    function: Function,
    given: &[Given<'py>],
    out: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    if are_single(given) {
        evaluate_in::<f32>(py, arm, function, given, out, "float32")
    } else {
        evaluate_in::<f64>(py, arm, function, given, out, "float64")
    }
}

fn evaluate_in<'py, T: Element + Number>(
    py: Python<'py>,
    arm: &CompiledArm,
    function: Function,
    given: &[Given<'py>],
    out: Option<&Bound<'py, PyAny>>,
    dtype: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let written = out.and_then(|out| out.cast::<PyArrayDyn<T>>().ok()).map_or(0..0, memory);
    let held: Vec<Held<'py, T>> =
        given.iter().map(|given| Held::of(given, dtype, &written)).collect::<PyResult<_>>()?;
    let many = states(&held)?;
    let count = many.unwrap_or(1);
    let columns: Vec<Vec<&[T]>> = held.iter().map(Held::columns).collect::<PyResult<_>>()?;
    let arguments = arguments(given, &held, &columns, count)?;
    let of_state = shape(function, arm);
    let whole: Vec<usize> = many.into_iter().chain(of_state.iter().copied()).collect();
    let result = room::<T>(py, out, &whole, dtype)?;
    {
        let mut writable = writable(&result)?;
        let numbers = writable.as_slice_mut().map_err(|_| PyValueError::new_err("`out` is not contiguous"))?;
        let computed = py.detach(|| match function {
            Function::ForwardKinematics | Function::LinkPoses => {
                let compiled = arm.function(function)?.outputs();
                let mut rows = vec![T::zero(); compiled * count];
                if count == 1 {
                    arm.run_one(function, &arguments, &mut rows)?;
                } else {
                    arm.run(function, count, &arguments, Destination::Rows(&mut rows))?;
                }
                for (matrix, pose) in numbers.chunks_exact_mut(16).zip(rows.chunks_exact(12)) {
                    for row in 0..3 {
                        matrix[4 * row..][..3].copy_from_slice(&pose[3 * row..][..3]);
                        matrix[4 * row + 3] = pose[9 + row];
                    }
                    matrix[12..].copy_from_slice(&[T::zero(), T::zero(), T::zero(), T::one()]);
                }
                Ok(())
            }
            _ if count == 1 => arm.run_one(function, &arguments, numbers),
            _ => arm.run(function, count, &arguments, Destination::Rows(numbers)),
        });
        computed.map_err(|error: rne::compiled::EvaluationError| of_evaluation(&error))?;
    }
    as_python(arm, function, result, many)
}

/// Elements of the last axis of an array.
fn of_last_axis<'py>(array: &Bound<'py, PyAny>, elements: Range<usize>) -> PyResult<Bound<'py, PyAny>> {
    let py = array.py();
    let slice = PySlice::new(py, isize::try_from(elements.start)?, isize::try_from(elements.end)?, 1).into_any();
    array.get_item(PyTuple::new(py, [PyEllipsis::get(py).to_owned().into_any(), slice])?)
}

/// The homogeneous matrix of a pose whose twelve numbers stand first in each result.
fn homogeneous<'py, T: Element>(
    result: &Bound<'py, PyArrayDyn<T>>,
    many: Option<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, states) = (result.py(), Vec::from_iter(many));
    let part = |elements, columns: usize| {
        let rows = [&states[..], &[3, columns]].concat();
        of_last_axis(result.as_any(), elements)?.call_method1("reshape", (rows,))
    };
    let above = py.import("numpy")?.call_method1("concatenate", ((part(0..9, 3)?, part(9..12, 1)?), -1))?;
    let widths: Vec<[usize; 2]> = states.iter().map(|_| [0, 0]).chain([[0, 1], [0, 0]]).collect();
    let matrix = py.import("numpy")?.call_method1("pad", (above, widths))?;
    matrix.set_item((PyEllipsis::get(py), 3, 3), 1.0)?;
    Ok(matrix)
}

/// The array of all results as the user has them: records are tuples of arrays.
fn as_python<'py, T: Element>(
    arm: &CompiledArm,
    function: Function,
    result: Bound<'py, PyArrayDyn<T>>,
    many: Option<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = result.py();
    let of_state = shape(function, arm);
    match arm.layout(function) {
        Layout::Record(
            Record::TorqueDerivatives
            | Record::MomentumAndRate
            | Record::TorqueGradient
            | Record::AccelerationDerivatives
            | Record::TorqueHessian
            | Record::NextState,
            parts,
        ) => {
            let all = vec![PySlice::full(py).into_any(); of_state.len() - 1];
            let of = |index: usize| {
                let index = index.into_pyobject(py)?.into_any();
                let places = [PyEllipsis::get(py).to_owned().into_any(), index].into_iter().chain(all.clone());
                result.get_item(PyTuple::new(py, places.collect::<Vec<_>>())?)
            };
            let parts = (0..parts.len()).map(of).collect::<PyResult<Vec<_>>>()?;
            Ok(PyTuple::new(py, parts)?.into_any())
        }
        Layout::Record(record @ (Record::FloatingTorques | Record::FloatingAccelerations | Record::ClosureStep), _) => {
            let first = if record == Record::ClosureStep { arm.robot().closed.passive.len() } else { 6 };
            let parts = [0..first, first..of_state.iter().product()];
            let parts =
                parts.into_iter().map(|part| of_last_axis(result.as_any(), part)).collect::<PyResult<Vec<_>>>()?;
            Ok(PyTuple::new(py, parts)?.into_any())
        }
        Layout::Record(Record::AccelerationsAndWrenches, _) => {
            let (joints, tips) = (6 + arm.dof(), arm.robot().tip_count());
            let rows: Vec<usize> = many.into_iter().chain([tips, 6]).collect();
            let wrenches =
                of_last_axis(result.as_any(), joints..joints + 6 * tips)?.call_method1("reshape", (rows,))?;
            let [base, accelerations] = [0..6, 6..joints].map(|part| of_last_axis(result.as_any(), part));
            Ok(PyTuple::new(py, [base?, accelerations?, wrenches])?.into_any())
        }
        Layout::Record(Record::FloatingNextState, _) => {
            let dof = arm.dof();
            let parts = [12..18, 18..18 + dof, 18 + dof..18 + 2 * dof].map(|part| of_last_axis(result.as_any(), part));
            let [twist, positions, velocities] = parts;
            let pose = homogeneous(&result, many)?;
            Ok(PyTuple::new(py, [pose, twist?, positions?, velocities?])?.into_any())
        }
        // A and B, of the blocks by q, by q̇ and by τ of the positions, then of the velocities
        Layout::Record(Record::NextStateDerivatives, _) => {
            let (dof, lead) = (arm.dof(), usize::from(many.is_some()));
            let axes: Vec<usize> = (0..lead).chain([0, 2, 1, 3].map(|axis| lead + axis)).collect();
            let rows: Vec<usize> = many.into_iter().chain([2 * dof, 3 * dof]).collect();
            let matrix = result.call_method1("transpose", (axes,))?.call_method1("reshape", (rows,))?;
            let [a, b] = [0..2 * dof, 2 * dof..3 * dof].map(|part| of_last_axis(&matrix, part));
            Ok(PyTuple::new(py, [a?, b?])?.into_any())
        }
        // the same, with the rows of the base
        Layout::Record(Record::FloatingStepDerivatives, _) => {
            let (dof, lead) = (arm.dof(), usize::from(many.is_some()));
            let size = 6 + dof;
            let shaped = |array: &Bound<'py, PyAny>, shape: &[usize]| {
                array.call_method1("reshape", (many.into_iter().chain(shape.iter().copied()).collect::<Vec<_>>(),))
            };
            let halves = shaped(result.as_any(), &[2, 2 * size * size + size * dof])?;
            let a = shaped(&of_last_axis(&halves, 0..2 * size * size)?, &[2, 2, size, size])?;
            let axes: Vec<usize> = (0..lead).chain([0, 2, 1, 3].map(|axis| lead + axis)).collect();
            let a = shaped(&a.call_method1("transpose", (axes,))?, &[2 * size, 2 * size])?;
            let b = of_last_axis(&halves, 2 * size * size..2 * size * size + size * dof)?;
            Ok(PyTuple::new(py, [a, shaped(&b, &[2 * size, dof])?])?.into_any())
        }
        Layout::Record(Record::FloatingTorqueDerivatives, parts) => {
            let mut from = 0;
            let mut part = |layout: &Layout, columns: usize| {
                let to = from + layout.len();
                let numbers = of_last_axis(result.as_any(), from..to)?;
                from = to;
                let rows: Vec<usize> = many.into_iter().chain([layout.len() / columns, columns]).collect();
                numbers.call_method1("reshape", (rows,))
            };
            let columns = [arm.dof(), arm.dof(), 3];
            let parts = parts.iter().zip(columns).map(|(layout, columns)| part(layout, columns));
            Ok(PyTuple::new(py, parts.collect::<PyResult<Vec<_>>>()?)?.into_any())
        }
        _ => finished(result, many.is_none() && of_state.is_empty()),
    }
}

/// The arguments of a call: the arrays of Python as those of the machine, for a number of states.
pub(crate) fn arguments<'a, T: Element + Number>(
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

/// A number for an array without axes.
fn finished<T: Element>(result: Bound<'_, PyArrayDyn<T>>, is_number: bool) -> PyResult<Bound<'_, PyAny>> {
    if is_number { result.into_any().get_item(()) } else { Ok(result.into_any()) }
}
