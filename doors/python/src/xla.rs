//! Functions of an arm for XLA, the compiler of JAX. The Python module `rne/xla.py` builds `Arm.jax` from them.
//!
//! XLA's foreign-function interface calls a C function with the addresses of its arrays. [`border`] makes slices of
//! them, and [`compute`] gives these to the machine, which reads and writes them where they are. The attributes of a
//! call name the arm and the function. An arm is kept under its name as long as the process lives, because a compiled
//! program of XLA can call it at any time.

mod border;

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{LazyLock, PoisonError, RwLock};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyCapsule;
use rne::compiled::{Arguments, Array, CompiledArm, Destination, Function, Number};
use rne_codegen::{Layout, Record};

use crate::arm::Arm;

/// The arms that XLA may call, by the names that calls use for them.
static ARMS: LazyLock<RwLock<HashMap<String, CompiledArm>>> = LazyLock::new(RwLock::default);

/// What XLA calls, with one function for all arms, where XLA has this version of its interface.
#[pyfunction]
pub(crate) fn xla_handler(py: Python<'_>, major: i32, minor: i32) -> PyResult<Bound<'_, PyCapsule>> {
    border::capsule(py, (major, minor))
}

/// An operand of a function in XLA: its name, its shape for one state, and the arguments of the compiled arm that it
/// consists of.
struct Operand {
    name: &'static str,
    shape: Vec<usize>,
    parts: Vec<(&'static str, usize)>,
}

/// Returns the operands of a function: one array per argument, and one per part of the motion of a base.
fn operands(arm: &CompiledArm, function: Function) -> Vec<Operand> {
    let sizes = rne_codegen::sizes_of(arm.robot());
    let mut all = Vec::new();
    for argument in function.arguments() {
        let parts: Vec<_> = argument.parts().map(|part| (part.name, part.length.of(sizes))).collect();
        let elements = argument.elements(sizes);
        match (&parts[..], argument.row()) {
            (&[(name, _)], row) => {
                let shape = match name {
                    // the Python side converts between twelve numbers and homogeneous matrices
                    "pose" => vec![12],
                    _ if argument.is_number() => Vec::new(),
                    _ => row.map_or_else(|| vec![elements], |row| vec![elements / row, row]),
                };
                all.push(Operand { name, shape, parts: vec![(name, elements)] });
            }
            (&[("force", _), ..], _) => all.push(Operand { name: "wrench", shape: vec![elements], parts }),
            _ => all.extend(parts.iter().map(|&(name, length)| Operand {
                name,
                shape: vec![length],
                parts: vec![(name, length)],
            })),
        }
    }
    let run_time = arm.robot().run_time.names.len();
    if run_time > 0 {
        all.push(Operand { name: "parameters", shape: vec![run_time], parts: vec![("parameters", run_time)] });
    }
    all
}

/// Returns the shapes of the arrays that a function returns, in order, each with a flag for poses.
pub(crate) fn results(arm: &CompiledArm, function: Function) -> Vec<(Vec<usize>, bool)> {
    fn of(layout: &Layout) -> Vec<(Vec<usize>, bool)> {
        match layout {
            Layout::Number => vec![(vec![], false)],
            Layout::Array(length, each) => {
                let of_each = of(each);
                let [(shape, is_pose)] = &of_each[..] else { return of_each };
                vec![([&[*length], &shape[..]].concat(), *is_pose)]
            }
            Layout::Record(Record::Pose, _) => vec![(vec![], true)],
            Layout::Record(Record::Wrench | Record::BaseAcceleration | Record::BaseTwist, _) => {
                vec![(vec![layout.len()], false)]
            }
            Layout::Record(_, parts) => parts.iter().flat_map(of).collect(),
        }
    }
    let mut found = of(&arm.layout(function));
    if let [(shape, _)] = &mut found[..]
        && function.is_of_every_link()
        && let [rows, bodies, parameters] = shape[..]
    {
        *shape = vec![rows, bodies * parameters];
    }
    found
}

/// The description of a function that Python gets: the name of the method, the name of the function, the operands with
/// their shapes, and the shape of each result with a flag for poses.
type Told = (&'static str, &'static str, Vec<(&'static str, Vec<usize>)>, Vec<(Vec<usize>, bool)>);

impl Arm {
    /// Returns the arm, or the arm with this frame in the place of the tip.
    pub(crate) fn at(&self, frame: Option<&Bound<'_, PyAny>>) -> PyResult<CompiledArm> {
        let Some(frame) = frame else { return Ok(self.arm.clone()) };
        let frame = self.frame_name(frame)?;
        self.arm.at_frame(&frame).map_err(|unknown| PyValueError::new_err(unknown.to_string()))
    }
}

#[pymethods]
impl Arm {
    /// Tells of the functions of this arm, or of this arm at a frame.
    #[pyo3(signature = (frame=None))]
    fn _functions(&self, frame: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Told>> {
        let arm = self.at(frame)?;
        let told = rne_codegen::functions_of(arm.robot()).map(|function| {
            let operands = operands(&arm, function).into_iter().map(|operand| (operand.name, operand.shape));
            let method = function.of_frame().unwrap_or(function.name());
            (method, function.name(), operands.collect(), results(&arm, function))
        });
        Ok(told.collect())
    }

    /// Keeps this arm, or this arm at a frame, for XLA under a name.
    #[pyo3(signature = (name, frame=None))]
    fn _for_xla(&self, name: String, frame: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let arm = self.at(frame)?;
        ARMS.write().unwrap_or_else(PoisonError::into_inner).insert(name, arm);
        Ok(())
    }

    /// The run-time parameters as they stand in the robot file.
    fn _parameter_values(&self) -> Vec<f64> {
        self.robot().run_time.values(self.robot())
    }

    /// Functions of this arm for JAX: `jit`, `vmap`, `grad`, `jacfwd` and `jacrev` of them work, on the CPU.
    ///
    /// Each function of the arm is an attribute of what is returned: `arm.jax().inverse_dynamics(q, qd, qdd)`.
    /// Arguments have any leading axes, which follow numpy's rules of broadcasting, then those of one state: shape
    /// (..., n). Several results are a tuple.
    ///
    /// The program that XLA compiles calls the machine with the addresses of its arrays;
    /// axes of `vmap` become leading axes of one call. More than some thousand states are computed on all cores, or as
    /// the variable RAYON_NUM_THREADS says. Arrays of float32 are computed in single precision, and everything is where
    /// JAX's option `jax_enable_x64` is off; a warning says so of numpy's arrays of float64.
    ///
    /// Torques, accelerations, the mass matrix and its inverse, the two energies, `pose`, `jacobian` and
    /// `centre_of_mass` have derivatives by positions, velocities, accelerations, torques and wrenches. Many have
    /// second derivatives, which `jax.hessian` takes. JAX raises NotImplementedError for a derivative that a function
    /// does not have. With `frame`, the functions of the tip, such as `pose`, compute values of this frame. Needs the
    /// package jax, 0.5 or later.
    #[pyo3(signature = (*, frame=None))]
    fn jax<'py>(slf: &Bound<'py, Self>, frame: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("rne.xla")?.call_method1("functions", (slf, frame))
    }

    /// Functions of this arm for PyTorch, with derivatives in reverse mode, on the CPU.
    ///
    /// Each function of the arm is an attribute of what is returned: `arm.torch().inverse_dynamics(q, qd, qdd)`.
    /// Arguments are tensors with any leading axes, which follow the rules of broadcasting, then those of one state:
    /// shape (..., n). Several results are a tuple. Each call is one operator, `rne::compute`, also in `torch.compile`
    /// and in `torch.vmap` (torch 2.5). The backward pass of torques is one call of `torque_gradient`.
    ///
    /// The functions that have derivatives and second derivatives for `jax` have them here; others raise
    /// NotImplementedError. With `frame`, the functions of the tip, such as `pose`, compute values of this frame. Needs
    /// the package torch, 2.4 or later.
    #[pyo3(signature = (*, frame=None))]
    fn torch<'py>(slf: &Bound<'py, Self>, frame: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("rne.pytorch")?.call_method1("functions", (slf, frame))
    }
}

/// The numbers of an array of XLA, in either precision.
enum Numbers<'a> {
    Single(&'a [f32]),
    Double(&'a [f64]),
}

/// The memory for the numbers of a result of XLA, in either precision.
enum Room<'a> {
    Single(&'a mut [f32]),
    Double(&'a mut [f64]),
}

/// An array of XLA in row-major order: the lengths of its axes, and its numbers.
struct Argument<'a> {
    shape: Vec<usize>,
    numbers: Numbers<'a>,
}

/// A call by XLA: its attributes, the arrays, the shape of the result and the memory for it.
struct Call<'a> {
    arm: &'a str,
    function: &'a str,
    arguments: Vec<Argument<'a>>,
    shape: Vec<usize>,
    room: Room<'a>,
}

/// A number type whose arrays XLA may pass: `f32` or `f64`.
trait Passed: Number {
    /// Returns the numbers if they have this type.
    fn of<'a>(numbers: &Numbers<'a>) -> Option<&'a [Self]>;
}

impl Passed for f32 {
    fn of<'a>(numbers: &Numbers<'a>) -> Option<&'a [Self]> {
        if let Numbers::Single(numbers) = numbers { Some(numbers) } else { None }
    }
}

impl Passed for f64 {
    fn of<'a>(numbers: &Numbers<'a>) -> Option<&'a [Self]> {
        if let Numbers::Double(numbers) = numbers { Some(numbers) } else { None }
    }
}

/// Computes a call. XLA reports an error with the text that is returned.
fn compute(call: Call<'_>) -> Result<(), String> {
    let Call { arm, function: name, arguments, shape, room } = call;
    let found = ARMS.read().unwrap_or_else(PoisonError::into_inner).get(arm).cloned();
    let arm = found.ok_or_else(|| format!("this process has no arm `{arm}`: call `Arm.jax` before"))?;
    let function = rne_codegen::function_named(name).map_err(|error| error.to_string())?;
    if !rne_codegen::functions_of(arm.robot()).any(|other| other == function) {
        return Err(format!("`{}` has no function `{name}`", arm.robot().name));
    }
    match room {
        Room::Single(room) => compute_in(&arm, function, &arguments, &shape, room),
        Room::Double(room) => compute_in(&arm, function, &arguments, &shape, room),
    }
}

fn compute_in<T: Passed>(
    arm: &CompiledArm,
    function: Function,
    given: &[Argument<'_>],
    shape: &[usize],
    room: &mut [T],
) -> Result<(), String> {
    let name = function.name();
    let compiled = arm.function(function).map_err(|error| error.to_string())?;
    let Some((&outputs, leading)) = shape.split_last().filter(|(outputs, _)| **outputs == compiled.outputs()) else {
        return Err(format!("the result of `{name}` has the shape {shape:?}; its last axis is {}", compiled.outputs()));
    };
    if outputs == 0 || room.is_empty() {
        return Ok(());
    }
    let states = room.len() / outputs;
    let operands = operands(arm, function);
    if operands.len() != given.len() {
        return Err(format!("`{name}` takes {} arrays, but {} are given", operands.len(), given.len()));
    }
    let rows_of = |(operand, argument)| rows(operand, argument, leading, states);
    let arrays = operands.iter().zip(given).map(rows_of).collect::<Result<Vec<_>, _>>()?;
    let mut arguments = Arguments::new();
    for (Operand { name, parts, .. }, (numbers, is_one)) in operands.iter().zip(&arrays) {
        let array = if *is_one { Array::Same(numbers) } else { Array::Rows(numbers) };
        let elements: usize = parts.iter().map(|(_, length)| length).sum();
        let mut from = 0;
        for &(part, length) in parts {
            let array = if length == elements { array } else { array.part(elements, from..from + length) };
            arguments = arguments.with(part, array).ok_or_else(|| format!("`{name}` is no argument"))?;
            from += length;
        }
    }
    if states == 1 {
        arm.run_one(function, &arguments, room)
    } else {
        arm.run(function, states, &arguments, Destination::Rows(room))
    }
    .map_err(|error| error.to_string())
}

/// Returns the numbers of an argument, and whether they are one row that holds for all states. Otherwise there is one
/// row per state.
fn rows<'a, T: Passed>(
    Operand { name, parts, .. }: &Operand,
    argument: &'a Argument<'_>,
    leading: &[usize],
    states: usize,
) -> Result<(Cow<'a, [T]>, bool), String> {
    let elements: usize = parts.iter().map(|(_, length)| length).sum();
    let of_state = argument.shape.split_last().filter(|&(&last, _)| last == elements);
    let fits = |axes: &[usize]| {
        axes.len() == leading.len() && axes.iter().zip(leading).all(|(&axis, &whole)| axis == whole || axis == 1)
    };
    let Some((_, axes)) = of_state.filter(|(_, axes)| fits(axes)) else {
        return Err(format!(
            "`{name}` has the shape {:?}; it is {leading:?}, or 1 in place of some of them, then {elements}",
            argument.shape
        ));
    };
    let numbers = T::of(&argument.numbers).ok_or_else(|| format!("`{name}` has another precision than the result"))?;
    let rows: usize = axes.iter().product();
    Ok(if rows == states || rows == 1 {
        (Cow::Borrowed(numbers), rows != states)
    } else {
        (Cow::Owned(spread_over(numbers, elements, axes, leading, states)), false)
    })
}

/// Returns a copy with one row per state of an array that has the length 1 in place of some leading axes.
fn spread_over<T: Copy>(numbers: &[T], elements: usize, axes: &[usize], leading: &[usize], states: usize) -> Vec<T> {
    let mut spread = Vec::with_capacity(states * elements);
    for state in 0..states {
        let (mut rest, mut row, mut stride) = (state, 0, 1);
        for (&axis, &whole) in axes.iter().zip(leading).rev() {
            row += if axis == 1 { 0 } else { rest % whole * stride };
            (rest, stride) = (rest / whole, stride * axis);
        }
        spread.extend_from_slice(numbers.get(row * elements..(row + 1) * elements).unwrap_or_default());
    }
    spread
}
