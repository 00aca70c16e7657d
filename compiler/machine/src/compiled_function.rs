//! One compiled function of one arm.

use rne_codegen::{CompileError, Program};
use rne_runtime::VectorUnit;
use rne_runtime::machine::{Destination, Source};

use crate::{Arguments, Array, EvaluationError, Machine, Number, OutOfRange, WrongSize, arguments};

/// Up to this number of inputs an array on the stack is used: it is enough for most functions of an arm with twenty
/// joints.
const FEW: usize = 64;

/// A function of an arm, compiled when it is first used.
#[derive(Clone, Debug)]
pub struct CompiledFunction {
    program: Program,
    machine: Machine,
    arrays: Vec<(&'static str, usize)>,
    /// The place of each of these arrays among all arguments.
    places: Vec<usize>,
    /// For each input of the machine: its array, and its element there.
    inputs: Vec<(usize, usize)>,
    /// The arrays of sines and cosines, and the joints of which the machine uses at least one of both.
    turns: Option<([usize; 2], Vec<usize>)>,
    #[cfg(feature = "native")]
    natives: std::sync::Arc<crate::number::natively::Natives>,
}

impl CompiledFunction {
    /// Compiles a program.
    pub(crate) fn new(program: Program) -> Result<Self, CompileError> {
        let (function, dof) = (program.function, program.dof);
        let too_large = || CompileError::TooLarge { function, dof, most: u32::MAX as usize };
        let machine = Machine::new(&program).ok_or_else(too_large)?;
        let arrays = program.argument_arrays();
        let place = |name| {
            let places = arrays.iter().enumerate();
            let mut places = places.filter_map(|(index, array)| {
                Some((index, array.elements.iter().position(|element| *element == Some(name))?))
            });
            places.next()
        };
        let inputs: Vec<(usize, usize)> =
            machine.inputs().iter().map(|name| place(*name)).collect::<Option<_>>().ok_or_else(too_large)?;
        let arrays: Vec<_> = arrays.iter().map(|array| (array.name, array.elements.len())).collect();
        let places =
            arrays.iter().map(|(name, _)| arguments::place(name)).collect::<Option<_>>().ok_or_else(too_large)?;
        let array = |name| arrays.iter().position(|(other, _)| *other == name);
        let turns = array("sin").zip(array("cos")).map(|(sin, cos)| {
            let is_used = |joint: &usize| inputs.contains(&(sin, *joint)) || inputs.contains(&(cos, *joint));
            ([sin, cos], (0..program.dof).filter(is_used).collect())
        });
        Ok(Self {
            program,
            machine,
            arrays,
            places,
            inputs,
            turns,
            #[cfg(feature = "native")]
            natives: std::sync::Arc::default(),
        })
    }

    /// Returns the program that it runs, with its statements, counts and constants.
    #[must_use]
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Returns the program in the form that the machine executes.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Returns the arguments that the function takes, in order, each with its number of elements.
    #[must_use]
    pub fn arguments(&self) -> &[(&'static str, usize)] {
        &self.arrays
    }

    /// Returns the number of results of one state.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.program.outputs.len()
    }

    /// Prepares [`run_one`](Self::run_one) in this precision, so that its first call does not have to: with the feature
    /// `native` this compiles the function to instructions of the processor, which takes a millisecond or two for the
    /// torques of an arm.
    pub fn prepare<T: Number>(&self) {
        #[cfg(feature = "native")]
        T::prepare(&self.natives, &self.program);
    }

    /// Computes a number of states; with the feature `rayon`, on all cores.
    ///
    /// # Errors
    /// When an argument is missing, has another size or is [out of range](OutOfRange), or when `results` has another
    /// size.
    pub fn run<T: Number>(
        &self,
        unit: VectorUnit,
        states: usize,
        arguments: &Arguments<'_, T>,
        results: Destination<'_, T>,
    ) -> Result<(), EvaluationError> {
        self.check(states, arguments)?;
        let sources: Vec<Source<'_, T>> = self
            .inputs
            .iter()
            .filter_map(|&(array, element)| {
                arguments.at(self.places[array])?.source(element, self.arrays[array].1, states)
            })
            .collect();
        let outputs = self.outputs();
        let size = WrongSize::of_results(&results, outputs, states);
        let room = EvaluationError::Room { outputs, states, size };
        self.machine.code().run(unit, states, &sources, results).map_err(|_| room)
    }

    /// Computes one state, the first of the arguments; the results have the same bits as those of [`run`](Self::run).
    /// With the feature `native` it runs instructions of the processor, which are compiled at the first call. With up
    /// to 64 inputs it allocates nothing, except at the first call of a thread.
    ///
    /// # Errors
    /// When an argument is missing, has another size or is [out of range](OutOfRange), or when `results` has another
    /// size.
    pub fn run_one<T: Number>(
        &self,
        unit: VectorUnit,
        arguments: &Arguments<'_, T>,
        results: &mut [T],
    ) -> Result<(), EvaluationError> {
        self.check(1, arguments)?;
        let count = self.inputs.len();
        let (mut few, mut many);
        let inputs: &mut [T] = if count <= FEW {
            few = [T::zero(); FEW];
            &mut few[..count]
        } else {
            many = vec![T::zero(); count];
            &mut many
        };
        for (input, &(array, element)) in inputs.iter_mut().zip(&self.inputs) {
            let (argument, elements) = self.arrays[array];
            let given = self.given(array, arguments)?;
            let wrong = || refused(argument, given, elements, 1);
            *input = *given.number(element, elements, 0, 1).ok_or_else(wrong)?;
        }
        #[cfg(feature = "native")]
        if T::call(&self.natives, unit, &self.program, inputs, results) {
            return Ok(());
        }
        let size = WrongSize::Numbers { needed: self.outputs(), given: results.len() };
        let room = EvaluationError::Room { outputs: self.outputs(), states: 1, size };
        self.machine.code().run_one(unit, inputs, results).map_err(|_| room)
    }

    /// Checks the arguments of these states as [`run`](Self::run) does, also those that the program does not use. A
    /// caller that computes states in parts calls this once before the first part.
    ///
    /// # Errors
    /// When an argument is missing, has another size, or is [out of range](OutOfRange).
    pub fn check<T: Number>(&self, states: usize, arguments: &Arguments<'_, T>) -> Result<(), EvaluationError> {
        let mut arrays = self.arrays.iter().enumerate();
        arrays.try_for_each(|(index, (_, elements))| self.checked(index, *elements, states, arguments).map(|_| ()))?;
        let Some((arrays, joints)) = &self.turns else { return Ok(()) };
        for state in 0..states {
            for &joint in joints {
                let mut turn = [f64::NAN; 2];
                for (number, &index) in turn.iter_mut().zip(arrays) {
                    let given = self.given(index, arguments)?.number(joint, self.arrays[index].1, state, states);
                    *number = given.map_or(f64::NAN, |&given| given.into());
                }
                let wrong = |mistake| EvaluationError::OutOfRange { mistake, state: state + 1, states };
                OutOfRange::check_turn(joint, turn).map_err(wrong)?;
            }
        }
        Ok(())
    }

    /// Returns the array of the argument at `index`.
    fn given<'a, 'b, T>(
        &self,
        index: usize,
        arguments: &'b Arguments<'a, T>,
    ) -> Result<&'b Array<'a, T>, EvaluationError> {
        let (function, (argument, _)) = (self.program.function, self.arrays[index]);
        arguments.at(self.places[index]).ok_or(EvaluationError::Missing { function, argument })
    }

    /// Returns the array of the argument at `index`, after a check that it has this number of elements for each state
    /// and that its numbers are in range.
    pub(crate) fn checked<'a, 'b, T: Number>(
        &self,
        index: usize,
        elements: usize,
        states: usize,
        arguments: &'b Arguments<'a, T>,
    ) -> Result<&'b Array<'a, T>, EvaluationError> {
        let (argument, _) = self.arrays[index];
        let array = self.given(index, arguments)?;
        if !array.has(elements, states) {
            return Err(refused(argument, array, elements, states));
        }
        if OutOfRange::elements(argument) > 0 {
            // numbers that all states share are checked once
            let rows = if matches!(array, Array::Same(_)) { states.min(1) } else { states };
            for state in 0..rows {
                let number = |element| array.number(element, elements, state, states).map(|&number| number.into());
                let wrong = |mistake| EvaluationError::OutOfRange { mistake, state: state + 1, states };
                OutOfRange::check(argument, number).map_err(wrong)?;
            }
        }
        Ok(array)
    }

    /// Returns, for each input of the machine, its array and its element there.
    pub(crate) fn inputs(&self) -> &[(usize, usize)] {
        &self.inputs
    }
}

/// Returns the error for an argument of another size.
fn refused<T>(argument: &'static str, array: &Array<'_, T>, elements: usize, states: usize) -> EvaluationError {
    let size = WrongSize::of_argument(array, elements, states);
    EvaluationError::Argument { argument, elements, states, size }
}
