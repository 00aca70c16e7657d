//! The passes in their order, for one function: formulas, graph, lowering, the target's arrangement, proof.

use rne_model::Robot;

use crate::error::CompileError;
use crate::fma;
use crate::formulate;
use crate::function::{Argument, Form, Function};
use crate::ir::{Builder, Cost, Embedding, Name, Policy, Quantity, Traced};
use crate::lower::{Heading, lower};
use crate::plan::{self, Plan};
use crate::program::{Exactly, Program, Proof, Scales};
use crate::prove::{self, Reference};
use crate::reduced::Algorithm;

/// Sums and products of a function that are compiled: `inverse_dynamics_derivatives` of an arm of 40 joints in which
/// nothing folds. Its text is some 15 MB.
pub(crate) const LARGEST: usize = 500_000;

/// The purpose that a program is arranged for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Target {
    /// The shortest wait for the result of one call ([`fma::ordered_for_latency`]); the fewest instructions where a
    /// program is so long that they matter more.
    #[default]
    Latency,
    /// The fewest instructions of a machine with fused multiply-add ([`fma::contracted`]), as batches want.
    Throughput,
}

impl Target {
    fn arranged(self, program: &Program) -> Program {
        match self {
            Self::Latency if !program.is_long() => fma::ordered_for_latency(program),
            Self::Latency | Self::Throughput => fma::contracted(program),
        }
    }
}

/// A function as a graph that has not been lowered: what it returns, by name, and the graph of that with its trace.
#[allow(missing_debug_implementations)] // a graph of thousands of nodes
pub struct Formulation {
    pub(crate) names: Vec<Name>,
    pub(crate) traced: Traced,
    /// The factors of lengths and forces, if it measures them in units of the arm.
    pub(crate) scales: Option<Scales>,
}

impl Formulation {
    /// The plain formulas of a function.
    pub(crate) fn plain(policy: Policy, robot: &Robot, function: Function) -> Self {
        Self::on(Builder::traced(policy, Embedding::default(), function), robot, function)
    }

    /// The seven steps with the formulas as they are before anything folds.
    fn explained(robot: &Robot, function: Function) -> Self {
        Self::on(Builder::explained(Policy::Structure, Embedding::default(), function), robot, function)
    }

    fn on(builder: Builder, robot: &Robot, function: Function) -> Self {
        let (names, outputs) = formulate::outputs(&builder, robot, function).into_iter().unzip();
        Self { names, traced: builder.finish(outputs), scales: None }
    }

    /// The plain formulas with every value computed once, however often and in whatever way they compute it: the
    /// reduced form of what has no recursion of its own.
    #[must_use]
    pub fn numbered(robot: &Robot, function: Function) -> Self {
        let plain = Self::plain(Policy::Value, robot, function);
        Self { traced: plain.traced.numbered(), ..plain }
    }

    /// A function written by one algorithm under a plan, every value once.
    ///
    /// # Errors
    /// When the plan does not fit the robot.
    pub fn by_plan(robot: &Robot, plan: &Plan, function: Function, algorithm: Algorithm) -> Result<Self, CompileError> {
        if !robot.is_serial() {
            return Err(CompileError::PlanDoesNotFit { robot: robot.name.clone() });
        }
        let sphere = plan.gyrostat && !function.takes(Argument::Payload);
        let plan = &Plan { gyrostat: sphere, ..plan.clone() };
        let written = plan::frame(robot, plan).and_then(|frame| frame.written(plan, function, algorithm));
        written.ok_or_else(|| CompileError::PlanDoesNotFit { robot: robot.name.clone() })
    }

    /// How its constants are read in the fields of the proof.
    pub(crate) fn embedding(&self) -> Embedding {
        self.traced.graph.embedding()
    }

    /// Its operations.
    #[must_use]
    pub fn cost(&self) -> Cost {
        self.traced.graph.cost(&mut Vec::new())
    }

    /// The reduced form that it is, with its constants, not proved.
    pub(crate) fn lowered(self, robot: &Robot, function: Function) -> Result<(Program, Exactly), CompileError> {
        lower(&Heading { robot, function, form: Form::Reduced }, self.traced, &self.names)
    }

    /// The reduced form that it is: lowered, arranged for a target, and proved to be that of the seven steps.
    pub(crate) fn proved(
        self,
        function: Function,
        target: Target,
        reference: &Reference<'_>,
    ) -> Result<Program, CompileError> {
        let (embedding, scales) = (self.embedding(), self.scales);
        let (program, exactly) = self.lowered(reference.robot(), function)?;
        let mut program = target.arranged(&program);
        program.scales = scales;
        program.proof = Some(prove::prove(reference, &program, &exactly, embedding)?);
        Ok(program)
    }
}

impl<'r> Reference<'r> {
    /// The seven steps of a function of a robot.
    ///
    /// # Errors
    /// When they cannot be compiled.
    pub fn of(robot: &'r Robot, function: Function) -> Result<Self, CompileError> {
        Self::new(robot, function, |function| seven_steps_within(LARGEST, robot, function, &[], false))
    }

    /// The evidence that a formulation, arranged as a build arranges it, is that of the seven steps.
    ///
    /// # Errors
    /// When it is another function, or rounds too badly.
    pub fn proof(&self, function: Function, formulation: Formulation) -> Result<Proof, CompileError> {
        // a program that was proved has its proof
        Ok(formulation.proved(function, Target::Latency, self)?.proof.unwrap_or_default())
    }

    /// Whether a formulation can be proved, and how many times less precise than the seven steps it is in single
    /// precision, on the average of random states; `None` when it is another function.
    ///
    /// # Errors
    /// When it cannot be lowered.
    pub fn loss_of_precision(
        &self,
        function: Function,
        formulation: Formulation,
        states: usize,
    ) -> Result<Option<f64>, CompileError> {
        let embedding = formulation.embedding();
        let (program, exactly) = formulation.lowered(self.robot(), function)?;
        let is_identical = prove::identical(self.robot(), &program, &exactly, embedding).is_ok();
        Ok(is_identical.then(|| prove::loss_of_precision(self, &program, states)))
    }
}

/// A function by the seven steps, if they are not more than `most` operations; behind its own outputs stands every
/// component of the quantities in `keep`. With `explains` it tells its formulas before folding, too.
pub(crate) fn seven_steps_within(
    most: usize,
    robot: &Robot,
    function: Function,
    keep: &[Quantity],
    explains: bool,
) -> Result<Program, CompileError> {
    let Formulation { mut names, mut traced, .. } = if explains {
        Formulation::explained(robot, function)
    } else {
        Formulation::plain(Policy::Structure, robot, function)
    };
    if traced.graph.operations() > most {
        return Err(CompileError::TooLarge { function, dof: robot.dof(), most });
    }
    for definition in &traced.trace.definitions {
        if keep.contains(&definition.name.quantity) && (1..=robot.dof()).contains(&definition.name.joint) {
            names.push(definition.name);
            traced.graph.outputs.push(definition.at);
        }
    }
    Ok(lower(&Heading { robot, function, form: Form::SevenSteps }, traced, &names)?.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_is_refused_with_what_to_do() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/ur5.yaml");
        let robot = rne_model::Reader::new("ur5").read(&std::fs::read(path).unwrap()).unwrap().robot;
        let function = Function::InverseDynamicsDerivatives;
        let error = seven_steps_within(1_000, &robot, function, &[], false).unwrap_err();
        assert_eq!(error, CompileError::TooLarge { function, dof: 6, most: 1_000 });
        let message = error.to_string();
        assert!(message.contains("more than 1000 operations") && message.contains("rne::DynArm"), "{message}");
        assert!(seven_steps_within(1_000, &robot, Function::InverseDynamics, &[], false).is_ok());
    }
}
