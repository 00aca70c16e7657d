//! Computes any function of an arm by its id, and returns its result as a flat list of numbers.

use rne_functions::Function;

use crate::values::numbers::Numbers;
use crate::{BaseMotion, BaseTwist, Constant, DynArm, Payload, Pose, Scalar, Wrench, WrongLength};

macro_rules! inputs {
    ($($(#[$doc:meta])* $name:ident: ($($type:tt)*);)*) => {
        /// The arguments of all functions, under the names in the table of functions. A function reads only its own.
        #[derive(Clone, Copy, Debug)]
        pub struct Inputs<'a, T> { $($(#[$doc])* pub $name: $($type)*),* }
    };
}
rne_functions::every_argument!(inputs);

impl<S: Constant> DynArm<S> {
    /// Returns the numbers of a function's result, in the order of its layout.
    ///
    /// # Errors
    /// When an argument of the function does not have one element per joint or tip.
    #[doc(hidden)] // the ids of functions are internal
    pub fn evaluate<T: Scalar + Numbers<T>>(
        &self,
        function: Function,
        inputs: &Inputs<'_, T>,
    ) -> Result<Vec<T>, WrongLength> {
        let mut numbers = Vec::new();
        macro_rules! calls {
            ($(
                $variant:ident $axes:tt = $name:ident($($argument:ident: $kind:ident),*)
                    -> $returned:ident $(at $of_frame:ident)?:
                    $summary:literal $(, $details:literal)?;
            )*) => {
                match function {
                    $(Function::$variant => {
                        self.$name($(inputs.$argument),*)?.each(&mut |number| numbers.push(*number));
                    })*
                }
            };
        }
        rne_functions::functions!(calls);
        Ok(numbers)
    }
}
