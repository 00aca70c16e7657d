//! The functions as methods with their own names, for one state; arguments and results are those of `DynArm`.

use rne_codegen::{Argument, Function, Length, argument_type};
use rne_runtime::{BaseMotion, BaseTwist, Numbers, Payload, Pose, Shaped, VectorUnit, Wrench};

use crate::results;
use crate::{Arguments, Array, CompiledArm, EvaluationError, Number};

/// Methods for one state. Arrays have one element per joint: rad, rad/s, rad/s², N m for revolute joints; m, m/s, m/s²,
/// N for prismatic ones.
impl CompiledArm {
    /// Computes any function for one state and writes its numbers to `results`, in the order of the function's
    /// [layout](Function::layout). It allocates memory for nothing but the arguments.
    ///
    /// # Errors
    /// When an argument is missing or has another size, when `results` has another size, when an argument is [out of
    /// range](crate::OutOfRange), or when the function cannot be compiled.
    pub fn run_one<T: Number>(
        &self,
        function: Function,
        arguments: &Arguments<'_, T>,
        results: &mut [T],
    ) -> Result<(), EvaluationError> {
        self.function(function)?.run_one(VectorUnit::widest(), arguments, results)
    }

    /// Computes a function and returns its numbers in their shape.
    fn result<T: Number, R: Shaped<T>>(
        &self,
        function: Function,
        arguments: &Arguments<'_, T>,
    ) -> Result<R, EvaluationError> {
        let compiled = self.function(function)?;
        let mut numbers = vec![T::zero(); compiled.outputs()];
        compiled.run_one(VectorUnit::widest(), arguments, &mut numbers)?;
        Ok(R::take(&self.layout(function), &mut numbers.into_iter()))
    }
}

/// The numbers of all arguments of a call, one argument after the other.
struct Given<T> {
    numbers: Vec<T>,
    /// For each array of the arguments, the index in `numbers` at which it ends.
    ends: Vec<usize>,
}

impl<T: Number> Given<T> {
    /// Adds an argument. An array of fixed length gets that many of its numbers, the last array all that are left.
    fn add(&mut self, argument: Argument, given: &impl Numbers<T>) {
        let start = self.numbers.len();
        given.each(&mut |number| self.numbers.push(*number));
        let mut end = start;
        let lengths = argument.parts().map(|part| part.length);
        self.ends.extend(lengths.map(|length| {
            match length {
                // an argument can consist of several arrays of fixed length
                Length::Fixed(count) if !argument.is_of_each_tip() => end += count,
                _ => end = self.numbers.len(),
            }
            end
        }));
    }

    /// Returns the arguments of a function, by name.
    fn arguments(&self, function: Function) -> Arguments<'_, T> {
        let parts = function.arguments().iter().flat_map(|argument| argument.parts());
        let (mut arguments, mut start) = (Arguments::new(), 0);
        for (part, &end) in parts.zip(&self.ends) {
            arguments = arguments.of_part(part, Array::Same(&self.numbers[start..end]));
            start = end;
        }
        arguments
    }
}

macro_rules! methods {
    ($(
        $variant:ident $axes:tt =
            $name:ident($($argument:ident: $kind:ident),*) -> $returned:ident $(at $of_frame:ident)?:
            $summary:literal $(, $details:literal)?;
    )*) => {
        impl CompiledArm {$(
            #[doc = $summary]
            ///
            /// # Errors
            /// When an argument does not have one element per joint or tip, when it is
            /// [out of range](crate::OutOfRange), or when the function cannot be compiled for this robot.
            #[allow(clippy::too_many_arguments)] // the arguments are those of the table of functions
            pub fn $name<'a, T: Number>(
                &self,
                $($argument: argument_type!($kind),)*
            ) -> Result<results::$returned<T>, EvaluationError> {
                let mut given = Given { numbers: Vec::with_capacity(64), ends: Vec::with_capacity(8) };
                $(given.add(Argument::$kind, &$argument);)*
                self.result(Function::$variant, &given.arguments(Function::$variant))
            }
        )*}
    };
}

rne_codegen::functions!(methods);
