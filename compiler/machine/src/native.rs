//! Computes one state at a time, as instructions of the processor.
//!
//! The machine decodes every instruction once for a block of states; a single state has to pay for the decoding alone.
//! [`Native`] is the same program without decoding: Cranelift compiles it to a function that computes one state and
//! returns, with the same bits as [`Code::run_one`] on the same vector unit.
//!
//! # Why Cranelift
//!
//! Nanoseconds of a call to the torques in double precision, in a sequence of calls on one core of an AMD EPYC with
//! AVX-512, and milliseconds to compile the code:
//!
//! ```text
//! cargo run --release --manifest-path benches/Cargo.toml --no-default-features --features run_time --bin run_time
//! ```
//!
//! | | derived, by rustc | machine, one state | this module | to build |
//! |---|---|---|---|---|
//! | PUMA 560 | 40 | 259 | 42 | 0.8 |
//! | Panda | 80 | 450 | 78 | 2.1 |
//! | iiwa 14 | 62 | 332 | 58 | 1.4 |
//! | UR5 | 38 | 225 | 39 | 0.7 |
//! | Cobra 600 | 9.4 | 59 | 9.7 | 0.1 |
//! | Stanford arm | 36 | 196 | 36 | 0.7 |
//!
//! The derived code was compiled for every x86-64, so it has no fused operations; this module uses all that the
//! processor has. Machine code that this crate wrote itself would hardly be faster, would support one family of
//! processors, and would have to be trusted as a whole; Cranelift is tested by all programs that use it. Its optimiser
//! finds nothing to improve, because the compiler of programs has done so before: with it, calls took the same time or
//! up to a tenth more, and compilation a quarter to a half more. With its fast register allocator, compilation took a
//! third of the time and calls 1.5 to 2 times as long.
//!
//! # Sines and cosines
//!
//! The function contains the sine and cosine of rne-runtime, operation by operation ([`Kernel`]). A state with an angle
//! beyond the range of this kernel is computed by the machine.
//!
//! # Safety
//!
//! This is the only module of the crate with `unsafe`: it calls the compiled function and frees its memory.
//!
//! - **Signature.** `translation` declares three pointers and a return value of their size, in the calling convention
//!   that Cranelift has for C on the host: that of [`Function`].
//! - **Memory.** The function reads inputs, writes outputs and reads constants at fixed places: an input by its index
//!   among the inputs, an output by its index among the outputs, constants by the places they were given. Both lengths
//!   are compared before every call, and the constants belong to the function. It calls nothing. Inputs do not change
//!   while outputs are written: one is borrowed shared, the other mutably.
//! - **Stack.** A long program needs kilobytes of stack. It touches every page in order (`enable_probestack`), as code
//!   of rustc does, so that a stack that is too small ends at its guard page.
//! - **Lifetime.** [`Pages`] has the memory of the function and is freed with the [`Native`], the only owner of the
//!   pointer, which gives it to nobody. A call borrows the `Native`. (On Windows Cranelift frees nothing.)
//! - **Threads.** The function changes nothing but the outputs. The owner of its memory is in a mutex that nobody
//!   locks, so that the compiler itself derives that a `Native` is `Send` and `Sync`.
//! - **Instructions.** Cranelift detects the instructions of the processor. If the processor lacks the fused
//!   multiply-add of the vector unit, no function is compiled.
#![allow(unsafe_code)]

use core::fmt;
use std::sync::Mutex;

use cranelift_codegen::isa::{self, OwnedTargetIsa};
use cranelift_codegen::settings::{self, Configurable};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{Module, default_libcall_names};
use rne_codegen::{Name, Program};
use rne_runtime::VectorUnit;
use rne_runtime::machine::{Code, Kernel, WrongArrays};

use crate::dataflow::Dataflow;
use crate::schedule;
use crate::{Number, translation};

/// Programs with more values or outputs than this are left to the machine. The longest one of an arm of this
/// repository, 9,243 operations (the derivatives of the Panda's torques in seven steps), takes a tenth of a second to
/// compile.
const MOST: usize = 1 << 14;

/// The compiled function; it takes the inputs, the outputs and the constants. It returns 0 if an angle is beyond the
/// range of the kernel; then nothing is written.
type Function<T> = unsafe extern "C" fn(*const T, *mut T, *const T) -> usize;

/// A program that is compiled to instructions of the processor, for one state at a time.
///
/// For many states the machine is faster. A call allocates nothing and may run on any thread.
///
/// ```
/// use rne_codegen::{Compiler, Form, Function};
/// use rne_machine::Native;
///
/// # let yaml = "{format: 1, name: rod, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
/// #     {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}]}";
/// let robot = rne_model::Robot::from_yaml(yaml).unwrap();
/// // for one call the programs for the shortest wait are the fastest
/// let program = Compiler::new(&robot).compile(Function::GravityTorques, Form::Reduced)?;
/// if let Ok(native) = Native::<f64>::new(&program) {
///     let mut tau = [0.0];
///     native.call(&[0.1], &mut tau).unwrap();
///     assert!((tau[0] - 2.5 * 9.81 * 0.4 * 0.1_f64.cos()).abs() < 1e-12);
/// }
/// # Ok::<(), rne_codegen::CompileError>(())
/// ```
pub struct Native<T: Number = f64> {
    function: Function<T>,
    constants: Vec<T>,
    /// The memory of the function. The mutex, which nobody locks, makes it `Sync`.
    _pages: Mutex<Pages>,
    /// Interpreted code for states with angles beyond the range of the kernel.
    code: Code,
    unit: VectorUnit,
    inputs: Vec<Name>,
    outputs: usize,
}

impl<T: Number> Native<T> {
    /// Compiles a program for the widest vector unit; programs for [`Target::Latency`](rne_codegen::Target) are the
    /// fastest. This takes a millisecond or two for the torques of an arm, and longer for longer functions.
    ///
    /// # Errors
    /// When Cranelift does not support the processor, when the program is too long, or when Cranelift does not compile
    /// it. The machine can execute it in all these cases.
    pub fn new(program: &Program) -> Result<Self, NativeError> {
        Self::on(VectorUnit::widest(), program)
    }

    /// Compiles the program for a given vector unit; the results have the bits of that unit.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn on(unit: VectorUnit, program: &Program) -> Result<Self, NativeError> {
        Self::with(unit, program, &cranelift_native::builder().map_err(NativeError::processor)?)
    }

    fn with(unit: VectorUnit, program: &Program, processor: &isa::Builder) -> Result<Self, NativeError> {
        let dataflow = Dataflow::of(program);
        let values = dataflow.values.len().max(dataflow.outputs.len());
        let too_long = NativeError::TooLong { values, most: MOST };
        if values > MOST {
            return Err(too_long);
        }
        let code = schedule::code(&dataflow).ok_or(too_long)?;
        let kernel = Kernel::of::<T>(unit);
        let isa = set_up(processor, kernel.is_fused)?;
        let mut pages = Pages(Some(JITModule::new(JITBuilder::with_isa(isa, default_libcall_names()))));
        let (function, constants) = pages.compiled(&dataflow, &kernel)?;
        let outputs = dataflow.outputs.len();
        Ok(Self { function, constants, _pages: Mutex::new(pages), code, unit, inputs: dataflow.inputs, outputs })
    }

    /// Returns the names of the inputs that the program uses, in order.
    #[must_use]
    pub fn inputs(&self) -> &[Name] {
        &self.inputs
    }

    /// Computes one state. `inputs` and `outputs` have the inputs and outputs of the program, in its order.
    ///
    /// # Errors
    /// When there are more or fewer inputs or outputs than the program has. Nothing is written then.
    #[inline]
    pub fn call(&self, inputs: &[T], outputs: &mut [T]) -> Result<(), WrongArrays> {
        if inputs.len() != self.inputs.len() {
            return Err(WrongArrays::Inputs { expected: self.inputs.len(), found: inputs.len() });
        }
        if outputs.len() != self.outputs {
            return Err(WrongArrays::Outputs);
        }
        // SAFETY: both arrays have the lengths that the function reads and writes, and its memory exists; see the head
        // of this file.
        let is_done = unsafe { (self.function)(inputs.as_ptr(), outputs.as_mut_ptr(), self.constants.as_ptr()) };
        if is_done == 0 { self.code.run_one(self.unit, inputs, outputs) } else { Ok(()) }
    }
}

impl<T: Number> fmt::Debug for Native<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { unit, inputs, outputs, .. } = self;
        let mut parts = f.debug_struct("Native");
        parts.field("unit", unit).field("inputs", inputs).field("outputs", outputs).finish_non_exhaustive()
    }
}

/// The memory of compiled functions, which Cranelift does not free by itself. The `Option` lets `drop` take the module
/// out to free it.
struct Pages(Option<JITModule>);

impl Pages {
    /// Compiles a program; returns the function and the constants that it reads.
    fn compiled<T: Number>(
        &mut self,
        dataflow: &Dataflow,
        kernel: &Kernel,
    ) -> Result<(Function<T>, Vec<T>), NativeError> {
        let module = self.0.as_mut().expect("it is not freed yet");
        let mut context = module.make_context();
        let constants = translation::write(&mut context.func, module.target_config(), dataflow, kernel);
        let signature = &context.func.signature;
        let function = module.declare_anonymous_function(signature).map_err(NativeError::compilation)?;
        module.define_function(function, &mut context).map_err(NativeError::compilation)?;
        module.finalize_definitions().map_err(NativeError::compilation)?;
        let function = module.get_finalized_function(function);
        // SAFETY: the function was compiled with this signature; see the head of this file.
        let function = unsafe { core::mem::transmute::<*const u8, Function<T>>(function) };
        Ok((function, constants))
    }
}

impl Drop for Pages {
    fn drop(&mut self) {
        if let Some(module) = self.0.take() {
            // SAFETY: a caller of the function borrows the owner of this memory, and nobody else has a pointer to it.
            unsafe { module.free_memory() };
        }
    }
}

/// Sets up Cranelift for a processor.
fn set_up(processor: &isa::Builder, is_fused: bool) -> Result<OwnedTargetIsa, NativeError> {
    let mut flags = settings::builder();
    let settings = [
        ("opt_level", "none"),
        ("regalloc_algorithm", "backtracking"),
        ("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" }),
        ("is_pic", "false"),
        ("enable_probestack", "true"),
        ("probestack_strategy", "inline"),
    ];
    for (name, value) in settings {
        flags.set(name, value).map_err(NativeError::processor)?;
    }
    let isa = processor.finish(settings::Flags::new(flags)).map_err(NativeError::processor)?;
    let lacks_fused = isa.isa_flags().iter().any(|flag| flag.name == "has_fma" && flag.as_bool() == Some(false));
    if is_fused && lacks_fused {
        return Err(NativeError::Processor("it has no fused multiply-add".to_owned()));
    }
    Ok(isa)
}

/// Why there is no native code for a program. The machine can execute it all the same.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NativeError {
    /// Cranelift does not support the processor, or not all instructions of the vector unit.
    Processor(String),
    /// The program has more values than are allowed.
    TooLong {
        /// The number of values of the program.
        values: usize,
        /// The largest number that is allowed.
        most: usize,
    },
    /// Cranelift does not compile the program, or the system does not execute code that is created at run time.
    Compilation(String),
}

impl NativeError {
    #[allow(clippy::needless_pass_by_value)] // by value, as `map_err` passes an error
    fn processor(why: impl fmt::Display) -> Self {
        Self::Processor(why.to_string())
    }

    #[allow(clippy::needless_pass_by_value)]
    fn compilation(why: impl fmt::Display) -> Self {
        Self::Compilation(why.to_string())
    }
}

impl fmt::Display for NativeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Processor(why) => write!(f, "no native code for this processor: {why}"),
            Self::TooLong { values, most } => write!(f, "{values} values; native code is made of {most} at most"),
            Self::Compilation(why) => write!(f, "no native code of this program: {why}"),
        }
    }
}

impl core::error::Error for NativeError {}

#[cfg(test)]
mod tests {
    use rne_codegen::{Compiler, Form, Function};

    use super::*;

    fn program() -> Program {
        let file = rne_robots::find("puma560").expect("it is shipped");
        let robot = rne_model::Robot::from_yaml(file.yaml).expect("a shipped robot");
        Compiler::new(&robot).compile(Function::InverseDynamics, Form::Reduced).expect("it compiles")
    }

    /// Tests code that uses only the instructions that every x86-64 has: vectors in memory are then loaded by separate
    /// instructions, because they may be unaligned.
    #[test]
    fn the_oldest_processor_of_the_family_has_the_same_bits() {
        let program = program();
        let unit = VectorUnit::all().next().expect("that of the target");
        let oldest = cranelift_native::builder_with_options(false).expect("a processor that Cranelift knows");
        if Kernel::of::<f64>(unit).is_fused && cfg!(target_arch = "x86_64") {
            return; // these tests were compiled for a newer processor
        }
        let native = Native::<f64>::with(unit, &program, &oldest).expect("native code");
        let mut random = fastrand::Rng::with_seed(9);
        for _ in 0..100 {
            let state: Vec<f64> = native.inputs().iter().map(|_| 10.0 * (random.f64() - 0.5)).collect();
            let [mut expected, mut found] = [(); 2].map(|()| vec![0.0; program.outputs.len()]);
            native.code.run_one(unit, &state, &mut expected).expect("these lengths");
            native.call(&state, &mut found).expect("these lengths");
            assert_eq!(expected, found);
        }
    }

    #[test]
    fn a_unit_that_fuses_wants_a_processor_that_does() {
        let unit = VectorUnit::widest();
        let oldest = cranelift_native::builder_with_options(false).expect("a processor that Cranelift knows");
        if Kernel::of::<f64>(unit).is_fused && cfg!(target_arch = "x86_64") {
            let error = Native::<f64>::with(unit, &program(), &oldest).expect_err("it would call a library");
            assert_eq!(error.to_string(), "no native code for this processor: it has no fused multiply-add");
        }
    }

    #[test]
    fn a_program_that_is_too_long_is_left_to_the_machine() {
        let mut program = program();
        program.outputs.truncate(1);
        let output = program.outputs[0].clone();
        program.outputs.resize(MOST + 1, output);
        let error = Native::<f64>::new(&program).expect_err("too long");
        assert_eq!(error.to_string(), "16385 values; native code is made of 16384 at most");
        program.outputs.pop();
        let native = Native::<f64>::new(&program).expect("native code");
        let mut outputs = vec![0.0; MOST];
        native.call(&vec![0.5; native.inputs().len()], &mut outputs).expect("these lengths");
        assert!(outputs[0] != 0.0 && outputs.iter().all(|output| *output == outputs[0]));
    }
}
