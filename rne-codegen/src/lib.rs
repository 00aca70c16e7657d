//! The symbolic compiler: a robot in, straight-line code out.
//!
//! [`compile`] writes a function of the robot as a graph of sums and products (the seven steps stand once, in
//! `seven_steps.rs`), folds what is exactly zero or one, drops what is not needed, and returns a [`Program`] of named
//! statements. Everything else renders that program: [`emit::Body`] as tokens for the macro, [`emit::rust_file`] as
//! text for people, [`emit::c_code`] as C, an [`Interpreter`] for tests, [`Program::operations`] as counts.
//!
//! Data in, data out: nothing here opens a file or prints.
#![forbid(unsafe_code)]
// Symbolic matrices are values, as in the formulas.
#![allow(clippy::large_types_passed_by_value)]

pub mod emit;
pub mod fma;
mod formulate;
mod function;
mod interpret;
mod ir;
mod latency;
mod lower;
mod named;
pub mod plan;
mod program;
mod prove;
mod reduced;

use std::fmt;

use rne_model::Robot;

pub use function::{
    Answer, AnswerTable, Argument, Capability, Form, Function, Labels, Layout, Length, MatrixUnit, Record, Shape,
};
pub use interpret::{Arguments, Interpreter, Real};
pub use ir::ledger::{Cause, Causes, Fate, Ledger, Line, Operation, Place};
pub use ir::name::{By, Name};
pub use ir::quantity::{Axis, Component, Quantity, Step};
pub use named::UnknownName;
pub use program::{
    Constant, Expression, Finding, Found, Operations, Operator, Output, Program, Proof, Sign, Statement, Turn,
};
pub use reduced::algorithm::Way;
pub use reduced::crba::Gathering;

use crate::ir::{Builder, Policy, Reading};

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
        return plan::Choice::default_of(robot).compile(robot, function, form);
    }
    seven_steps_within(LARGEST, robot, function, keep)
}

/// The seven steps, if they are not more than `most` operations.
fn seven_steps_within(
    most: usize,
    robot: &Robot,
    function: Function,
    keep: &[Quantity],
) -> Result<Program, CompileError> {
    let builder = Builder::traced(Policy::Structure, Reading::default(), function);
    let (mut names, outputs): (Vec<Name>, Vec<_>) = formulate::outputs(&builder, robot, function).into_iter().unzip();
    let mut written = builder.finish(outputs);
    if written.graph.operations() > most {
        return Err(CompileError::TooLarge { function, dof: robot.dof(), most });
    }
    for definition in &written.trace.definitions {
        if keep.contains(&definition.name.quantity) && (1..=robot.dof()).contains(&definition.name.joint) {
            names.push(definition.name);
            written.graph.outputs.push(definition.at);
        }
    }
    Ok(lower::lower(&lower::Heading { robot, function, form: Form::SevenSteps }, written, &names)?.0)
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
        /// What may be the cause.
        suspect: Suspect,
    },
    /// Code that rounds too far away from the seven steps; it is never emitted.
    Imprecise {
        /// The function.
        function: Function,
        /// The largest difference, relative to the largest number returned.
        rounding: f64,
        /// What may be the cause.
        suspect: Suspect,
    },
    /// Two variables of one name, of which the second would shadow the first; it is never emitted.
    TwoOfOneName {
        /// The function.
        function: Function,
        /// The name.
        name: String,
    },
    /// A function of so many joints that no compiler would take its code.
    TooLarge {
        /// The function.
        function: Function,
        /// Joints of the robot.
        dof: usize,
        /// The most operations that are compiled.
        most: usize,
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

/// Sums and products of a function that are compiled: `inverse_dynamics_derivatives` of an arm of 40 joints in which
/// nothing folds. Its text is some 15 MB.
const LARGEST: usize = 500_000;

/// What may be the cause when a form is refused.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Suspect {
    /// It was written by the plan of a plan file.
    pub planned: bool,
    /// A number of the robot whose products leave the range of double precision.
    pub number: Option<Extreme>,
}

/// A number of a robot that is very large or very small.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// What it is, and its link.
    what: &'static str,
    link: usize,
    value: f64,
}

impl Extreme {
    /// The number of a robot that is farthest from one, if its powers leave the range of double precision or the
    /// precision of twice that, in which constants are computed.
    #[must_use]
    pub fn of(robot: &Robot) -> Option<Self> {
        const LARGEST: f64 = 1e75;
        let far = |value: f64| value.abs().log2().abs();
        let mut numbers = Vec::new();
        for (index, joint) in robot.joints.iter().enumerate() {
            let mut put = |what, values: &[f64]| {
                numbers.extend(values.iter().map(|&value| Self { what, link: index + 1, value }));
            };
            put("the length d", &[joint.row.dh.d]);
            put("the length a", &[joint.row.dh.a]);
            put("the angle theta", &[joint.row.dh.theta.radians]);
            put("the angle alpha", &[joint.row.dh.alpha.radians]);
            put("the mass", &[joint.row.link.mass]);
            put("a coordinate of the centre of mass,", &joint.row.link.com);
            put("an inertia,", joint.written_inertia.0.rows().as_flattened());
        }
        numbers.retain(|number| number.value != 0.0 && far(number.value) > LARGEST.log2());
        numbers.into_iter().max_by(|a, b| far(a.value).total_cmp(&far(b.value)))
    }
}

impl fmt::Display for Extreme {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, link, value } = self;
        let (size, beyond) = if value.abs() > 1.0 { ("large", "overflow") } else { ("small", "vanish") };
        write!(
            f,
            "{what} {value:e} of link {link} is too {size} for it: products of such numbers {beyond} in double \
            precision. \
             Other units help, `form = \"seven_steps\"` multiplies less"
        )
    }
}

impl CompileError {
    /// Whether a form was written and refused, for it is another function than the seven steps or a worse one.
    #[must_use]
    pub fn is_refusal(&self) -> bool {
        matches!(self, Self::NotIdentical { .. } | Self::Imprecise { .. })
    }

    /// The error with what may be the cause.
    fn suspecting(mut self, robot: &Robot, is_planned: bool) -> Self {
        if let Self::NotIdentical { suspect, .. } | Self::Imprecise { suspect, .. } = &mut self {
            *suspect = Suspect { planned: is_planned, number: Extreme::of(robot) };
        }
        self
    }
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
            Self::NotIdentical { function, output, suspect } => {
                let what = if function.returns_torques() { "the torque of joint" } else { "of its result, number" };
                write!(
                    f,
                    "this form of `{function}` is not the seven steps: {what} {output} differs. No code is written. "
                )?;
                match suspect {
                    Suspect { number: Some(number), .. } => number.fmt(f),
                    Suspect { planned: true, .. } => f.write_str(
                        "A graph in a plan file that has been edited does that; `rne search --fresh` writes it anew",
                    ),
                    Suspect { planned: false, .. } => f.write_str("Please report this robot"),
                }
            }
            Self::Imprecise { function, rounding, suspect } => {
                let what = match function {
                    _ if function.returns_torques() => "torque",
                    _ if function.returns_accelerations() => "acceleration",
                    _ => "number that it returns",
                };
                write!(
                    f,
                    "this form of `{function}` rounds too far from the seven steps: {rounding:.1e} of the largest \
                    {what}. "
                )?;
                match suspect {
                    Suspect { number: Some(number), .. } => number.fmt(f),
                    Suspect { planned: true, .. } => {
                        f.write_str("`rne search --fresh` finds another plan, `form = \"seven_steps\"` needs none")
                    }
                    Suspect { planned: false, .. } => f.write_str("`form = \"seven_steps\"` does not"),
                }
            }
            Self::TwoOfOneName { function, name } => write!(
                f,
                "the code of `{function}` has two variables called `{name}`: the second would stand where the first is \
                 meant. No code is written. Please report this robot"
            ),
            Self::TooLarge { function, dof, most } => write!(
                f,
                "`{function}` of {dof} joints is straight-line code of more than {most} operations, which no \
                compiler takes in \
                 reasonable time. Leave this function out; `rne::DynArm` computes it in a loop"
            ),
            Self::Plan(why) => f.write_str(why),
            Self::Graph { robot, line, message } => write!(
                f,
                "line {line} of the rewritten graph in the plan of `{robot}`: {message}; `rne search --rewrite \
                --fresh` writes \
                 the plan anew"
            ),
        }
    }
}

impl std::error::Error for CompileError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_is_refused_with_what_to_do() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/ur5.yaml");
        let robot = rne_model::check_bytes("ur5", &std::fs::read(path).unwrap()).unwrap().robot;
        let function = Function::InverseDynamicsDerivatives;
        let error = seven_steps_within(1_000, &robot, function, &[]).unwrap_err();
        assert_eq!(error, CompileError::TooLarge { function, dof: 6, most: 1_000 });
        let message = error.to_string();
        assert!(message.contains("more than 1000 operations") && message.contains("rne::DynArm"), "{message}");
        assert!(seven_steps_within(1_000, &robot, Function::InverseDynamics, &[]).is_ok());
    }
}
