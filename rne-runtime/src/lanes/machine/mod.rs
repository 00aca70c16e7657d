//! The block machine: code that is known when the program runs, on the widest vector unit that the processor has.
//!
//! A robot that is known when a program is compiled becomes instructions of the processor. One that is read later
//! becomes [`Code`]: instructions of an abstract machine. Each instruction is executed for a block of states at once,
//! for eight registers of them, so that decoding it costs little compared with its execution. The machine knows no
//! robot and parses nothing: the crate `rne-machine` makes code of a compiled function.
//!
//! Sines and cosines are those of the batches, in the same registers. The results of a state depend only on the state
//! and the vector unit, not on other states, on its place in a block, or on the number of threads. Angles beyond the
//! range of the kernel (10⁵ rad), infinities and NaN are computed by `std`, lane by lane.
//!
//! ```
//! use rne_runtime::machine::{Code, Destination, Instruction, NOWHERE, Operation, Source, Turn};
//! use rne_runtime::VectorUnit;
//!
//! // 2 sin(q)
//! let run = |operation, store| Instruction { operation, store };
//! let code = Code::new(
//!     vec![run(Operation::Input(0), 0)],
//!     vec![Turn { angle: 0, sine: 1, cosine: NOWHERE }],
//!     vec![run(Operation::ProductSK(1, 2.0), NOWHERE), run(Operation::Output(0), NOWHERE)],
//!     [2, 1, 1],
//! ).expect("slots, inputs and outputs that are there");
//! let mut doubled = [0.0_f64; 3];
//! code.run(VectorUnit::widest(), 3, &[Source::Column(&[0.0, 0.5, 1.0])], Destination::Rows(&mut doubled))?;
//! assert!((doubled[2] - 2.0 * 1.0_f64.sin()).abs() < 1e-15);
//! # Ok::<(), rne_runtime::machine::WrongArrays>(())
//! ```
#![allow(clippy::inline_always)] // code for a vector unit must be compiled with its instructions
#![allow(clippy::needless_range_loop)] // loops over registers, which are unrolled

mod arrays;
mod code;
mod execution;
mod kernel;
mod many;
mod one;
mod rollout;

pub use arrays::{Destination, Source, WrongArrays};
pub use code::{Code, Instruction, NOWHERE, Operation, Slot, Turn};
pub use kernel::{Kernel, Step};
pub use rollout::{Rollout, RolloutJoint, SmoothFriction};

use arrays::States;
use many::Many;
use one::One;

use crate::VectorUnit;
use crate::lanes::batch::BatchScalar;

/// The number of states for which a task of their own is worthwhile; a multiple of the size of every block.
#[cfg(feature = "rayon")]
const TASK: usize = 4096;

impl Code {
    /// Computes a number of states, from one source per input. The destination must have space for every output.
    ///
    /// With the feature `rayon`, on all cores for more than some thousand states.
    ///
    /// # Errors
    /// When an input has too few numbers or the room is of another size. Nothing is written then.
    pub fn run<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        states: usize,
        sources: &[Source<'_, T>],
        destination: Destination<'_, T>,
    ) -> Result<(), WrongArrays> {
        if sources.len() != self.inputs {
            return Err(WrongArrays::Inputs { expected: self.inputs, found: sources.len() });
        }
        if let Some(index) = sources.iter().position(|source| !source.holds(states)) {
            return Err(WrongArrays::Input(index));
        }
        if !destination.fits(self.outputs, states) {
            return Err(WrongArrays::Outputs);
        }
        self.run_part(unit, 0..states, sources, destination);
        Ok(())
    }

    fn run_part<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        states: States,
        sources: &[Source<'_, T>],
        destination: Destination<'_, T>,
    ) {
        #[cfg(feature = "rayon")]
        if states.len() >= 2 * TASK {
            let half = states.len() / 2 / TASK * TASK;
            let middle = states.start + half;
            let (first, second) = destination.split_at(half, self.outputs);
            crate::lanes::threads::join(
                || self.run_part(unit, states.start..middle, sources, first),
                || self.run_part(unit, middle..states.end, sources, second),
            );
            return;
        }
        T::with_memory(many::memory(self), |memory| {
            unit.run(Many { code: self, memory, sources, states, destination });
        });
    }

    /// Computes one state from the numbers of the inputs, and writes the outputs.
    ///
    /// It has the bits that [`run`](Self::run) gives that state on the same unit.
    ///
    /// # Errors
    /// When there are more or fewer inputs or outputs than the code has. Nothing is written then.
    pub fn run_one<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        inputs: &[T],
        outputs: &mut [T],
    ) -> Result<(), WrongArrays> {
        if inputs.len() != self.inputs {
            return Err(WrongArrays::Inputs { expected: self.inputs, found: inputs.len() });
        }
        if outputs.len() != self.outputs {
            return Err(WrongArrays::Outputs);
        }
        T::with_memory(one::memory(self), |memory| unit.run(One { code: self, memory, inputs, outputs }));
        Ok(())
    }
}
