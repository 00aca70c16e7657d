//! The symbolic compiler: a robot in, straight-line code out.
//!
//! [`compile`] writes a function of the robot as a graph of sums and products (the seven steps stand once, in
//! `seven_steps.rs`), folds what is exactly zero or one, drops what is not needed, and returns a [`Program`] of named
//! statements. Everything else renders that program: [`emit::body`] as tokens for the macro, [`emit::rust_file`] as text for people, an
//! [`Interpreter`] for tests, [`Program::operations`] as counts.
//!
//! Data in, data out: nothing here opens a file or prints.
// Symbolic matrices are values, as in the formulas.
#![allow(clippy::large_types_passed_by_value)]

pub mod emit;
mod exact;
mod function;
mod graph;
mod interpret;
mod ledger;
mod links;
mod program;
mod quantity;
pub mod reduced;
mod schedule;
mod seven_steps;
mod symbol;
mod worksheet;

use std::fmt;

use rne_model::Robot;

pub use function::{Form, Function, UnknownName};
pub use interpret::{Arguments, Interpreter};
pub use ledger::{Cause, Causes, Fate, Ledger, Line, Operation, Place};
pub use program::{Binding, Constant, Expression, Finding, Found, Operations, Output, Program, Sign, Statement};
pub use quantity::{Axis, Component, Name, Quantity, Step};

use crate::links::Arm;
use crate::seven_steps::{JointState, Wrench};
use crate::symbol::Vector;
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
    let Form::SevenSteps = form;
    let sheet = Worksheet::default();
    let arm = Arm::new(&sheet, robot);
    let dof = robot.dof();
    let states: Vec<JointState<'_>> = (1..=dof)
        .map(|joint| {
            let argument = |quantity| sheet.argument(Name::scalar(quantity, joint));
            JointState {
                q: argument(Quantity::Position),
                qd: if function.has_rates() { argument(Quantity::Rate) } else { sheet.constant(0.0, Cause::AtRest) },
                qdd: if function.has_accelerations() {
                    argument(Quantity::RateDot)
                } else {
                    sheet.constant(0.0, Cause::NoAcceleration)
                },
            }
        })
        .collect();
    let tip = if function.has_wrench() {
        let argument = |quantity| Vector(Axis::ALL.map(|axis| sheet.argument(Name::vector(quantity, dof + 1, axis))));
        Wrench { force: argument(Quantity::JointForce), moment: argument(Quantity::JointMoment) }
    } else {
        Wrench { force: sheet.zeros(Cause::FreeTip), moment: sheet.zeros(Cause::FreeTip) }
    };

    let torques = seven_steps::inverse_dynamics(&sheet, &arm, &states, tip);
    let mut outputs: Vec<_> = torques
        .into_iter()
        .enumerate()
        .map(|(index, torque)| schedule::output(Name::scalar(Quantity::Torque, index + 1), torque))
        .collect();
    drop((arm, states));
    let written = sheet.finish();
    let of_a_link = |name: &Name| (1..=dof).contains(&name.joint);
    let kept = written
        .definitions
        .iter()
        .filter(|definition| keep.contains(&definition.name.quantity) && of_a_link(&definition.name));
    outputs.extend(kept.map(|definition| (definition.name, definition.term)));
    let heading = schedule::Heading { robot: &robot.name, dof, function, form };
    schedule::program(&heading, written, &outputs)
}

/// Why a robot cannot be compiled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CompileError {
    /// A constant made from finite numbers of the table overflows.
    NotFinite {
        /// The constant.
        name: Name,
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
        }
    }
}

impl std::error::Error for CompileError {}
