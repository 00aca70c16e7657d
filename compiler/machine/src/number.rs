//! The number types of states.

use rne_runtime::{BatchScalar, Numbers, Shaped};

/// A number type of states: `f64` or `f32`, and no other type.
#[cfg(feature = "native")]
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a number of a state",
    label = "`f64` or `f32` is needed",
    note = "`Array::Rows` and `Destination::Rows` take flat slices of numbers: of states such as \
            `states: Vec<[f64; 7]>`, write `.q(&states)` and `Destination::Rows(states.as_flattened_mut())`"
)]
pub trait Number:
    BatchScalar + Into<f64> + Numbers<Self> + Shaped<Self> + crate::translation::sealed::Number + natively::Natively
{
}

/// A number type of states: `f64` or `f32`, and no other type.
#[cfg(not(feature = "native"))]
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a number of a state",
    label = "`f64` or `f32` is needed",
    note = "`Array::Rows` and `Destination::Rows` take flat slices of numbers: of states such as \
            `states: Vec<[f64; 7]>`, write `.q(&states)` and `Destination::Rows(states.as_flattened_mut())`"
)]
pub trait Number: BatchScalar + Into<f64> + Numbers<Self> + Shaped<Self> {}

impl Number for f32 {}
impl Number for f64 {}

/// Computes one state at a time, as instructions of the processor.
#[cfg(feature = "native")]
pub(crate) mod natively {
    use std::sync::OnceLock;

    use rne_codegen::Program;
    use rne_runtime::VectorUnit;

    use crate::native::Native;

    /// A function in both precisions, each compiled when a single state is first computed in it; `None` if Cranelift
    /// cannot compile it. Then the machine also computes single states.
    #[derive(Debug, Default)]
    pub struct Natives {
        double: OnceLock<Option<Native<f64>>>,
        single: OnceLock<Option<Native<f32>>>,
    }

    /// A number type that selects its precision of [`Natives`].
    pub trait Natively: Sized {
        /// Compiles a function, unless it was compiled before.
        fn prepare(natives: &Natives, program: &Program);

        /// Computes a state on the widest unit, with the same bits as the machine. Returns false if nothing was
        /// computed.
        fn call(natives: &Natives, unit: VectorUnit, program: &Program, inputs: &[Self], outputs: &mut [Self]) -> bool;
    }

    macro_rules! natively {
        ($type:ident, $precision:ident) => {
            impl Natively for $type {
                fn prepare(natives: &Natives, program: &Program) {
                    natives.$precision.get_or_init(|| Native::new(program).ok());
                }

                fn call(
                    natives: &Natives,
                    unit: VectorUnit,
                    program: &Program,
                    inputs: &[Self],
                    outputs: &mut [Self],
                ) -> bool {
                    if unit.name() != VectorUnit::widest().name() {
                        return false;
                    }
                    let native = natives.$precision.get_or_init(|| Native::on(unit, program).ok());
                    native.as_ref().is_some_and(|native| native.call(inputs, outputs).is_ok())
                }
            }
        };
    }
    natively!(f64, double);
    natively!(f32, single);
}
