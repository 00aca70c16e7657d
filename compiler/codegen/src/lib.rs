//! The symbolic compiler: it turns a robot into straight-line code.
//!
//! [`Compiler`] is the only entry point. It writes a function of the robot as a graph of sums and products (the
//! formulas of the seven steps are in `formulate/seven_steps.rs`), folds terms that are exactly zero or one, drops
//! unused ones, and returns a [`Program`] of named statements. All other code renders that program: `rne-emit` as
//! tokens for the macro and as text for people, an [`Interpreter`] for tests, [`Program::operations`] as counts.
//!
//! ```text
//! Robot → formulate → ir::Graph → value numbering, rewriting → lower → Program → fma, latency → prove
//! ```
//!
//! This crate neither opens files nor prints.
#![warn(missing_debug_implementations)]
#![forbid(unsafe_code)]
// Symbolic matrices are passed by value, so that code reads like formulas.
#![allow(clippy::large_types_passed_by_value)]

mod argument_array;
mod coordinates;
mod equation;
mod error;
mod exact;
mod expression;
mod factorization;
pub mod fma;
mod formulate;
mod formulation;
mod function;
mod interpret;
mod ir;
mod latency;
mod lower;
mod named;
mod pipeline;
pub mod plan;
mod program;
mod proof;
mod quantity;
mod reduced;
mod refusal;
mod registers;
mod rounding;
mod values;

use std::sync::OnceLock;

use rne_model::Robot;

pub use argument_array::ArgumentArray;
pub use equation::{Equation, Operation as TermOperation, Term};
pub use error::{CheckFor, CompileError, Extreme, GraphMistake, Remedy, Suspect};
pub use exact::ExactFunction;
pub use expression::{Expression, ExpressionKind};
pub use factorization::Factorization;
pub use function::{
    Answer, AnswerTable, Argument, ArgumentPart, Axes, Base, Capability, Entry, Form, Function, Labels, Layout, Length,
    Load, MatrixUnit, OfRobot, Own, Owner, Record, Shape, Sizes, What, function_named, function_of_plan, functions_of,
    own, sizes_of,
};
pub use interpret::{Arguments, Interpreter, Real};
pub use ir::{
    Axis, Cause, Causes, Component, Derivation, ExactConstant, ExactStep, Fold, FoldReport, Line, Name, Operation,
    Operator, Place, Quantity, Residue, Sign, Step, WithRespectTo,
};
pub use named::UnknownName;
pub use pipeline::Target;
pub use program::{
    Constant, Operations, Order, Output, Program, Proof, Resolution, ResolvedAs, Scales, SineCosine, Statement,
};
pub use reduced::algorithm::Algorithm;
pub use reduced::inward::ExpressedIn;
pub use refusal::{Attempt, LeftOut, Reason, Refusal};
pub use registers::{order_for_registers, ordered_for_registers, statements_of_outputs};
pub use rne_functions::{argument_parts, argument_type, capabilities, example, functions};
pub use values::{Contraction, Negated, Value, ValueId, Values};

use crate::formulation::Formulation;
use crate::pipeline::{LARGEST, seven_steps_within};
use crate::plan::PlanSet;
use crate::reduced::near_origins;
use crate::rounding::Reference;

/// Whether frames of the table are so far from the arm that code of the seven steps loses digits.
fn has_far_frames(robot: &Robot) -> bool {
    near_origins(robot).is_some()
}

/// Whether code without a proof loses more digits in single precision than users expect, and they must be told: frames
/// of the table are far from the arm, or a length is very long.
#[must_use]
pub fn loses_digits(robot: &Robot) -> bool {
    /// A length above this, in m, occurs only if the frames are far from the arm.
    const LONGEST: f64 = 20.0;
    let of_rows = robot.joints.iter().flat_map(|joint| [joint.row.dh.a, joint.row.dh.d]);
    let links = robot.joints.iter().map(|joint| &joint.row.link);
    let links = links.chain(robot.floating_base.iter().map(|base| &base.link));
    let of_links = links.flat_map(|link| link.com);
    let branches = robot.joints.iter().filter_map(|joint| joint.branch).map(|branch| branch.placement);
    let frames = robot.frames.iter().map(|frame| frame.fixed.placement);
    let placements = [robot.base, robot.tool].into_iter().chain(branches).chain(frames);
    let is_long = |x: f64| x.abs() > LONGEST;
    of_rows.chain(of_links).chain(placements.flat_map(|placement| placement.xyz)).any(is_long) || has_far_frames(robot)
}

/// Returns the program with its loss in single precision. A program with a proof has this loss already.
#[must_use]
pub fn measured(robot: &Robot, program: Program) -> Program {
    if program.proof.is_some() {
        return program;
    }
    // the loss stays unknown if nothing can be compiled for comparison
    let loss = pipeline::loss_of_seven_steps(robot, &program).unwrap_or_default();
    Program { loss, ..program }
}

/// Compiles the functions of one robot.
///
/// ```
/// use rne_codegen::{Compiler, Form, Function};
/// # let yaml = "{format: 1, name: one, source: doc, convention: standard, gravity: [0, -9.81, 0], joints: [
/// #     {type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: 1, com: [-0.5, 0, 0]}}]}";
/// # let robot = rne_model::Robot::from_yaml(yaml).unwrap();
/// let compiler = Compiler::new(&robot);
/// let program = compiler.compile(Function::InverseDynamics, Form::Reduced)?;
/// assert!(program.operations().total() < 10);
/// # Ok::<(), rne_codegen::CompileError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Compiler<'r> {
    robot: &'r Robot,
    /// The plans of a plan file, or those that the build makes by itself when they are first needed.
    plans: OnceLock<PlanSet>,
    target: Target,
    intermediates: Vec<Quantity>,
    explains: bool,
}

impl<'r> Compiler<'r> {
    /// Makes a compiler with the choices that a build makes by itself.
    #[must_use]
    pub const fn new(robot: &'r Robot) -> Self {
        Self { robot, plans: OnceLock::new(), target: Target::Latency, intermediates: Vec::new(), explains: false }
    }

    /// Uses these choices, such as those of a plan file.
    #[must_use]
    pub fn with_plans(self, plans: impl Into<PlanSet>) -> Self {
        Self { plans: OnceLock::from(plans.into()), ..self }
    }

    /// Arranges the programs for another target.
    #[must_use]
    pub fn for_target(self, target: Target) -> Self {
        Self { target, ..self }
    }

    /// Makes programs of the seven steps return, after their own outputs, every component of these quantities. Torques
    /// do not need the velocity ċ of step 3, so it disappears unless it is kept. The reduced form has no such
    /// quantities.
    #[must_use]
    pub fn with_intermediates(self, quantities: &[Quantity]) -> Self {
        Self { intermediates: quantities.to_vec(), ..self }
    }

    /// Makes programs of the seven steps keep the formula of every component as it is before folding
    /// ([`Program::equations`]).
    #[must_use]
    pub fn with_equations(self) -> Self {
        Self { explains: true, ..self }
    }

    /// The choices of the reduced form.
    pub fn plans(&self) -> &PlanSet {
        self.plans.get_or_init(|| PlanSet::default_of(self.robot))
    }

    /// Compiles a function. A program in the reduced form has been proved to be that of the seven steps.
    ///
    /// # Errors
    /// When a constant that the code needs is not finite (numbers of the file are, but their products can overflow),
    /// when the code would be too large for any compiler, or when a plan of a plan file does not fit the robot or
    /// cannot be proved.
    pub fn compile(&self, function: Function, form: Form) -> Result<Program, CompileError> {
        let program = self.compile_unmeasured(function, form)?;
        Ok(if loses_digits(self.robot) { measured(self.robot, program) } else { program })
    }

    fn compile_unmeasured(&self, function: Function, form: Form) -> Result<Program, CompileError> {
        let robot = self.robot;
        function.check_kind(robot)?;
        if form == Form::SevenSteps {
            return seven_steps_within(LARGEST, robot, function, &self.intermediates, self.explains);
        }
        if function.entry().is_irreducible {
            return seven_steps_within(LARGEST, robot, function, &[], false);
        }
        // formulas that always divide by zero cannot be compared with other code
        if proof::divides_by_zero(robot, function) {
            let refusals = vec![Refusal::new(Attempt::Any, Reason::DividesByZero)];
            return Ok(Program { refusals, ..seven_steps_within(LARGEST, robot, function, &[], false)? });
        }
        let reference = Reference::of(robot, function)?;
        // run-time parameters have no numbers yet, so they cannot be regrouped
        if !robot.run_time.is_empty() {
            return Ok(self.numbered(function, reference, Vec::new()));
        }
        // rewritten graphs have no rotors, and no frame but the tip
        let of_links = self
            .plans
            .get()
            .filter(|_| !(robot.has_rotors() && function.feels_rotors()) && function.frame(robot).is_none());
        if let Some(rewritten) = of_links.and_then(|plans| plans.rewritten.get(&function)) {
            let program = rewritten
                .formulation(robot, function)
                .and_then(|formulation| formulation.proved(function, self.target, &reference))
                .map_err(|error| error.suspecting(robot, true))?;
            let (algorithm, choices) = (rewritten.algorithm, rewritten.choices());
            return Ok(Program { algorithm, choices, is_rewritten: true, ..program });
        }
        if !Algorithm::is_planned(function) {
            return Ok(self.numbered(function, reference, Vec::new()));
        }
        let plans = self.plans().of_function(robot, function);
        match self.planned(&plans, function, &reference) {
            Ok(program) => Ok(program),
            // fewer choices make no program shorter
            Err(error @ CompileError::TooLarge { .. }) => Err(error),
            // a plan file must work for the function that it was made for; for other functions it is a suggestion
            Err(error) if plans.is_of_build() || function != crate::function_of_plan(robot) && error.is_refusal() => {
                let mut refusals = vec![Refusal::of_error(Attempt::Planned(LeftOut::Nothing), error)];
                for (left_out, plans) in plans.with_ever_fewer_choices() {
                    match self.planned(&plans, function, &reference) {
                        Ok(program) => return Ok(Program { refusals, ..program }),
                        Err(error) => refusals.push(Refusal::of_error(Attempt::Planned(left_out), error)),
                    }
                }
                Ok(self.numbered(function, reference, refusals))
            }
            Err(error) => Err(error.suspecting(robot, true)),
        }
    }

    /// How the constants of a program are computed exactly from the numbers of the robot file, for checkers that share
    /// no code with the compiler. `program` is what [`Compiler::compile`] returned. `None` for a program whose
    /// constants are rounded one operation after another, as those of the seven steps are.
    ///
    /// # Errors
    /// The errors of [`Compiler::compile`].
    pub fn derivation(&self, program: &Program) -> Result<Option<Derivation>, CompileError> {
        // makes the plan before recording: its search computes numbers that no program has
        self.plans();
        let (compiled, ways) = ir::derivation::recorded(|| self.compile(program.function, program.form));
        let constants: Vec<_> = compiled?.constants().map(|constant| (constant.name, constant.value)).collect();
        Ok(ways.derivation(&constants))
    }

    /// Compiles a function by the plan, with the algorithm that takes the fewest operations.
    fn planned(&self, plans: &PlanSet, function: Function, reference: &Reference<'_>) -> Result<Program, CompileError> {
        let (plan, algorithm) = plans.cheapest(self.robot, function);
        let formulation = Formulation::by_plan(self.robot, &plan, function, algorithm)?;
        let program = formulation.proved(function, self.target, reference)?;
        let choices = algorithm.words().map(str::to_owned).into_iter().chain(plan.choices()).collect();
        Ok(Program { algorithm, choices, ..program })
    }

    /// Compiles the plain formulas with every value computed once; returns the seven steps if these are cheaper, or if
    /// the proof fails. `refusals` are those of earlier attempts.
    fn numbered(&self, function: Function, reference: Reference<'_>, mut refusals: Vec<Refusal>) -> Program {
        let attempt = Attempt::EveryValueOnce;
        let of_seven_steps = reference.operations();
        match Formulation::numbered(self.robot, function).proved(function, self.target, &reference) {
            Ok(numbered) => {
                let operations = numbered.operations().total();
                // if the table has frames far from the arm, digits are worth more than operations
                if operations <= of_seven_steps || reference.is_near() {
                    return Program { refusals, ..numbered };
                }
                // longer: value numbering may take a value from a formula that nothing else uses, with all operations
                // of that formula
                refusals.push(Refusal::new(attempt, Reason::Longer { operations, of_seven_steps }));
            }
            Err(error) => refusals.push(Refusal::of_error(attempt, error)),
        }
        Program { refusals, ..reference.into_program() }
    }
}
