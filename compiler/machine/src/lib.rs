//! Compiles functions of a robot inside the running program, for arms that are known only at run time.
//!
//! A [`Machine`] is created from a [`Program`] in some ten microseconds. It is safe code that interprets the program
//! for blocks of states, on the widest vector unit of the processor. With the feature `native`, `Native` computes
//! single states at the speed of code that is generated when the program is built.
//!
//! ```
//! use rne_codegen::{Compiler, Form, Function, Target};
//! use rne_machine::{Machine, Source, Destination};
//! use rne_runtime::VectorUnit;
//!
//! # let yaml = "{format: 1, name: rod, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
//! #     {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}]}";
//! let robot = rne_model::Robot::from_yaml(yaml).unwrap();
//! let compiler = Compiler::new(&robot).for_target(Target::Throughput);
//! let machine = Machine::new(&compiler.compile(Function::GravityTorques, Form::Reduced)?).expect("a small program");
//! let q = [0.0_f64, 0.1, 0.2];
//! let mut tau = [0.0; 3];
//! machine.code().run(VectorUnit::widest(), 3, &[Source::Column(&q)], Destination::Rows(&mut tau)).unwrap();
//! assert!((tau[0] - 2.5 * 9.81 * 0.4).abs() < 1e-12);
//! # Ok::<(), rne_codegen::CompileError>(())
//! ```
#![warn(missing_debug_implementations)]
#![cfg_attr(not(feature = "native"), forbid(unsafe_code))]

mod arguments;
mod array_size;
mod compiled_arm;
mod compiled_function;
mod dataflow;
mod error;
mod integrator;
#[cfg(feature = "native")]
mod native;
mod number;
mod one_state;
mod out_of_range;
pub mod results;
mod rollout;
mod schedule;
mod search;
mod selection;
#[cfg(feature = "native")]
mod translation;

pub use arguments::{ARGUMENTS, Arguments, Array};
pub use array_size::WrongSize;
pub use compiled_arm::{CompiledArm, RobotFiles};
pub use compiled_function::CompiledFunction;
pub use error::{ArmError, EvaluationError};
pub use out_of_range::OutOfRange;
pub use rne_codegen::{Argument, Form, Function, Layout, Record, Sizes, sizes_of};
pub use rne_search::{PlanFile, SearchError, SearchOptions};
pub use rollout::{FrictionWidth, Rollout, RolloutError, RolloutLimits};
pub use search::SearchProgress;

use rne_codegen::{Name, Program};
use rne_runtime::machine::Code;
pub use rne_runtime::machine::{Destination, Source, WrongArrays};

use dataflow::Dataflow;
#[cfg(feature = "native")]
pub use native::{Native, NativeError};
pub use number::Number;

/// A program in a form that is executed for many states.
#[derive(Clone, Debug)]
pub struct Machine {
    code: Code,
    inputs: Vec<Name>,
}

impl Machine {
    /// Creates a machine for a program; programs for [`Target::Throughput`](rne_codegen::Target) are the fastest.
    /// `None` if it would need more than 2³² values at once.
    #[must_use]
    pub fn new(program: &Program) -> Option<Self> {
        let dataflow = Dataflow::of(program);
        let code = schedule::code(&dataflow)?;
        Some(Self { code, inputs: dataflow.inputs })
    }

    /// Returns the code that the machine executes.
    #[must_use]
    pub fn code(&self) -> &Code {
        &self.code
    }

    /// Returns the names of the inputs that the program uses, in order.
    #[must_use]
    pub fn inputs(&self) -> &[Name] {
        &self.inputs
    }
}
