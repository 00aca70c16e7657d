//! Checks the inputs of a call, which are arrays of the caller, and computes a function with them.

use std::panic::resume_unwind;
use std::sync::{Mutex, PoisonError};
use std::thread;

use rne_machine::{ARGUMENTS, Arguments, Array, CompiledFunction, Destination, EvaluationError, Number, WrongSize};
use rne_runtime::VectorUnit;

use crate::handle::Arm;
use crate::status::{Failure, Status};

/// How many states a thread computes at a time: their torques take some tens of microseconds.
const TASK: usize = 4096;

/// An argument: its numbers, with the strides of states and elements.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Given<'a, T> {
    pub(crate) name: &'a str,
    pub(crate) numbers: &'a [T],
    /// The distance between states, in numbers; 0 if all states have the same numbers.
    pub(crate) state: usize,
    /// The distance between elements, in numbers; 0 means 1.
    pub(crate) element: usize,
}

/// Checks the inputs and returns them as the arguments of the function. If the function does not take an input, only
/// the name of this input is checked.
fn arguments<'a, T: Number>(
    function: &CompiledFunction,
    inputs: impl Iterator<Item = Result<Given<'a, T>, Failure>>,
    states: usize,
) -> Result<Arguments<'a, T>, Failure> {
    let mut arguments = Arguments::new();
    let mut taken = 0_u64;
    for given in inputs {
        let Given { name, numbers, state, element } = given?;
        let Some(place) = ARGUMENTS.iter().position(|argument| *argument == name) else {
            let message = format!("there is no argument `{name}`; the arguments are {}", ARGUMENTS.join(", "));
            return Err(Failure::new(Status::UnknownName, message));
        };
        if taken & 1 << place != 0 {
            return Err(Failure::new(Status::WrongSize, format!("the argument `{name}` is given twice")));
        }
        taken |= 1 << place;
        let Some(&(name, elements)) = function.arguments().iter().find(|(argument, _)| *argument == name) else {
            continue;
        };
        let apart = element.max(1);
        let last = |count: usize, apart: usize| count.saturating_sub(1).checked_mul(apart);
        let needed = || last(states, state)?.checked_add(last(elements, apart)?)?.checked_add(1);
        if states > 0 && elements > 0 && needed().is_none_or(|needed| numbers.len() < needed) {
            let needed = needed().map_or("more than memory can hold".to_owned(), |needed| needed.to_string());
            let message = format!(
                "`{name}` has {elements} elements for each of {states} states: with a state_stride of {state} and an \
                 element_stride of {apart} that is {needed} numbers; `count` says {}",
                numbers.len()
            );
            return Err(Failure::new(Status::WrongSize, message));
        }
        let array = Array::Strided { numbers, state, element: apart };
        arguments = arguments.with(name, array).unwrap_or(arguments);
    }
    Ok(arguments)
}

/// Computes one state. Allocates nothing after the first call of a thread.
pub(crate) fn one<'a, T: Number>(
    arm: &Arm,
    id: u32,
    inputs: impl Iterator<Item = Result<Given<'a, T>, Failure>>,
    outputs: &mut [T],
) -> Result<(), Failure> {
    let function = arm.function(id)?;
    let arguments = arguments(function, inputs, 1)?;
    Ok(function.run_one(VectorUnit::widest(), &arguments, outputs)?)
}

/// Computes many states in the calling thread.
pub(crate) fn many<'a, T: Number>(
    arm: &Arm,
    id: u32,
    states: usize,
    inputs: impl Iterator<Item = Result<Given<'a, T>, Failure>>,
    outputs: &mut [T],
) -> Result<(), Failure> {
    let function = arm.function(id)?;
    let arguments = arguments(function, inputs, states)?;
    Ok(function.run(VectorUnit::widest(), states, &arguments, Destination::Rows(outputs))?)
}

/// Computes many states on `threads` threads, including the calling one; 0 means one per core. The results do not
/// depend on the number of threads.
pub(crate) fn on_threads<'a, T: Number + Send + Sync>(
    arm: &Arm,
    id: u32,
    (states, threads): (usize, usize),
    inputs: impl Iterator<Item = Result<Given<'a, T>, Failure>>,
    outputs: &mut [T],
) -> Result<(), Failure> {
    let function = arm.function(id)?;
    let given: Vec<Given<'a, T>> = inputs.collect::<Result<_, _>>()?;
    // all errors are found before a result is written
    let all = arguments(function, given.iter().copied().map(Ok), states)?;
    let threads = match threads {
        0 => thread::available_parallelism().map_or(1, usize::from),
        threads => threads,
    };
    let (width, helpers) = (function.outputs(), threads.min(states.div_ceil(TASK)).saturating_sub(1));
    if helpers == 0 {
        return Ok(function.run(VectorUnit::widest(), states, &all, Destination::Rows(outputs))?);
    }
    if states.checked_mul(width) != Some(outputs.len()) {
        let size = WrongSize::Numbers { needed: states.saturating_mul(width), given: outputs.len() };
        return Err(EvaluationError::Room { outputs: width, states, size }.into());
    }
    function.check(states, &all)?;
    let tasks = Mutex::new(outputs.chunks_mut((TASK * width).max(1)).enumerate());
    let work = || -> Result<(), Failure> {
        loop {
            let task = tasks.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((index, room)) = task else { return Ok(()) };
            let (first, count) = (index * TASK, room.len() / width.max(1));
            let part = given.iter().map(|given| {
                // an input that the function does not take was not checked, so its stride may be too large
                let start = first.saturating_mul(given.state);
                Ok(Given { numbers: given.numbers.get(start..).unwrap_or_default(), ..*given })
            });
            let arguments = arguments(function, part, count)?;
            function.run(VectorUnit::widest(), count, &arguments, Destination::Rows(room))?;
        }
    };
    thread::scope(|scope| {
        // if the system cannot start a thread, the others do its work
        let start = |_| thread::Builder::new().spawn_scoped(scope, work).ok();
        let running: Vec<_> = (0..helpers).filter_map(start).collect();
        let mine = work();
        running
            .into_iter()
            .fold(mine, |result, thread| result.and(thread.join().unwrap_or_else(|payload| resume_unwind(payload))))
    })
}
