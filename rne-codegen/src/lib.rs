//! The symbolic compiler: a robot in, straight-line code out.
//!
//! [`compile`] writes a function of the robot as a graph of sums and products (the seven steps stand once, in
//! `seven_steps.rs`), folds what is exactly zero or one, drops what is not needed, and returns a [`Program`] of named
//! statements. Everything else renders that program: [`emit::Body`] as tokens for the macro, [`emit::rust_file`] as text for people,
//! [`emit::c_code`] as C, an [`Interpreter`] for tests, [`Program::operations`] as counts.
//!
//! Data in, data out: nothing here opens a file or prints.
#![forbid(unsafe_code)]
// Symbolic matrices are values, as in the formulas.
#![allow(clippy::large_types_passed_by_value)]

mod actuation;
mod capability;
mod derivation;
mod differentiation;
mod elimination;
pub mod emit;
mod energy;
mod exact;
mod function;
pub mod fusion;
mod graph;
mod interpret;
mod kinematics;
mod latency;
mod layout;
mod ledger;
mod links;
mod mass_matrix;
mod name;
mod program;
mod proof;
mod quantity;
pub mod reduced;
mod regressor;
mod schedule;
mod seven_steps;
mod symbol;
mod worksheet;

use std::fmt;

use rne_model::Robot;

pub use capability::Capability;
pub use function::{Argument, Form, Function, UnknownName};
pub use interpret::{Arguments, Interpreter, Real};
pub use layout::{Layout, Record};
pub use ledger::{Cause, Causes, Fate, Ledger, Line, Operation, Place};
pub use name::{By, Name};
pub use program::{Constant, Expression, Finding, Found, Operations, Output, Program, Proof, Sign, Statement, Turn};
pub use quantity::{Axis, Component, Quantity, Step};

use crate::worksheet::Worksheet;

/// Compiles one function of a robot.
///
/// # Errors
/// When a constant that the code needs is not finite: numbers of the file are, but their products can overflow.
pub fn compile(robot: &Robot, function: Function, form: Form) -> Result<Program, CompileError> {
    compile_keeping(robot, function, form, &[])
}

/// Compiles one function of a robot and returns, behind its own outputs, every component of the quantities in `keep`.
///
/// Torques do not need the velocity ċ of step 3, so it disappears unless it is kept.
///
/// # Errors
/// As [`compile`].
pub fn compile_keeping(
    robot: &Robot,
    function: Function,
    form: Form,
    keep: &[Quantity],
) -> Result<Program, CompileError> {
    if form != Form::SevenSteps {
        return reduced::Choice::default_of(robot).compile(robot, function, form);
    }
    let sheet = Worksheet::default();
    let dof = robot.dof();
    let mut outputs = derivation::outputs(&sheet, robot, function);
    let written = sheet.finish();
    let of_a_link = |name: &Name| (1..=dof).contains(&name.joint);
    let kept = written
        .definitions
        .iter()
        .filter(|definition| keep.contains(&definition.name.quantity) && of_a_link(&definition.name));
    outputs.extend(kept.map(|definition| (definition.name, definition.term)));
    let heading = schedule::Heading { robot: &robot.name, dof, parameters: robot.run_time.names.len(), function, form };
    schedule::program(&heading, written, &outputs)
}

/// Why a robot cannot be compiled.
#[derive(Clone, Debug, PartialEq)]
pub enum CompileError {
    /// A constant made from finite numbers of the table overflows.
    NotFinite {
        /// The constant.
        name: Name,
    },
    /// Code that would be another function than the seven steps; it is never emitted.
    NotIdentical {
        /// The function.
        function: Function,
        /// The first number returned that differs, counted from 1: for torques, the joint.
        output: usize,
    },
    /// Code whose torques round too far away from those of the seven steps; it is never emitted.
    Imprecise {
        /// The function.
        function: Function,
        /// The largest difference, relative to the largest torque.
        rounding: f64,
    },
    /// A plan that does not fit the robot.
    Plan(String),
    /// A rewritten graph that cannot be read.
    Graph {
        /// The robot's name.
        robot: String,
        /// The line of the graph, counted from 1.
        line: usize,
        /// What is wrong there.
        message: String,
    },
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { name } => write!(
                f,
                "the constant {name} ({}) of link {} is too large for a number of double precision",
                name.quantity.meaning(),
                name.joint
            ),
            Self::NotIdentical { function, output } => write!(
                f,
                "this form of `{function}` is not the seven steps: {} {output} differs. No code is written. A \
                 graph in a plan file that has been edited does that; `rne search --fresh` writes it anew. Without a plan file, \
                 please report this robot",
                if function.returns_torques() { "the torque of joint" } else { "of its result, number" }
            ),
            Self::Imprecise { function, rounding } => write!(
                f,
                "this form of `{function}` rounds too far from the seven steps: {rounding:.1e} of the largest \
                 torque. `rne search` finds another plan, `form = \"seven_steps\"` needs none"
            ),
            Self::Plan(why) => f.write_str(why),
            Self::Graph { robot, line, message } => write!(
                f,
                "line {line} of the rewritten graph in the plan of `{robot}`: {message}; `rne search --rewrite --fresh` writes \
                 the plan anew"
            ),
        }
    }
}

impl std::error::Error for CompileError {}
