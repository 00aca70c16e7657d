//! The passes in their order, for one function: formulas, graph, lowering, the target's arrangement, proof.

use rne_model::Robot;

use crate::error::CompileError;
use crate::fma;
use crate::formulation::Formulation;
use crate::function::{Form, Function};
use crate::ir::{Exactly, Policy, Quantity};
use crate::lower::{Heading, lower};
use crate::program::{Program, Proof};
use crate::proof;
use crate::reduced::near_origins;
use crate::rounding::{self, Reference, STATES};

/// Largest number of sums and products of a function that is compiled: that of `inverse_dynamics_derivatives` for an
/// arm of 40 joints in which nothing folds. Its text has about 15 MB.
pub(crate) const LARGEST: usize = 500_000;

/// The purpose that a program is arranged for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Target {
    /// The shortest wait for the result of one call ([`fma::ordered_for_latency`]); the fewest instructions if a
    /// program is so long that they count more.
    #[default]
    Latency,
    /// The fewest instructions on a processor with fused multiply-add ([`fma::contracted`]), for batches of many
    /// states.
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

impl Formulation {
    /// Lowers the formulas to a program in the reduced form, which is not proved. Also returns its exact constants.
    pub(crate) fn lowered(self, robot: &Robot, function: Function) -> Result<(Program, Exactly), CompileError> {
        lower(&Heading { robot, function, form: Form::Reduced }, self.traced, &self.names)
    }

    /// Lowers the formulas to a program in the reduced form, arranges it for a target, and proves that it is the
    /// function of the seven steps.
    pub(crate) fn proved(
        self,
        function: Function,
        target: Target,
        reference: &Reference<'_>,
    ) -> Result<Program, CompileError> {
        let (embedding, scales) = (self.embedding(), self.scales.clone());
        let (program, exactly) = self.lowered(reference.robot(), function)?;
        let mut program = target.arranged(&program);
        program.scales = scales;
        let (proof, loss) = proof::prove(reference, &program, &exactly, embedding)?;
        (program.proof, program.loss) = (Some(proof), loss);
        Ok(program)
    }
}

/// Returns the error of a program of the seven steps in single precision, if that is too large.
///
/// # Errors
/// When a program for the comparison cannot be compiled.
pub(crate) fn loss_of_seven_steps(robot: &Robot, program: &Program) -> Result<Option<f64>, CompileError> {
    let reference = Reference::to(robot, program.clone())?;
    Ok(rounding::loss(&reference, program, &rounding::errors(&reference, program, STATES)))
}

impl<'r> Reference<'r> {
    /// The seven steps of a function of a robot.
    ///
    /// # Errors
    /// When they cannot be compiled.
    pub fn of(robot: &'r Robot, function: Function) -> Result<Self, CompileError> {
        Self::to(robot, seven_steps_within(LARGEST, robot, function, &[], false)?)
    }

    /// As [`Reference::of`], with the program of the seven steps as an argument.
    ///
    /// # Errors
    /// When a further program for the comparison cannot be compiled.
    pub(crate) fn to(robot: &'r Robot, seven_steps: Program) -> Result<Self, CompileError> {
        let compiled = |function| {
            let heading = Heading { robot, function, form: Form::SevenSteps };
            let Formulation { names, traced, .. } = Formulation::near(robot, function);
            Ok(lower(&heading, traced, &names)?.0)
        };
        let function = seven_steps.function;
        let is_far = !function.entry().is_of_table_points && near_origins(robot).is_some();
        Self::new(robot, seven_steps, is_far, compiled)
    }

    /// Returns the evidence that a formulation, arranged as in a build, is the function of the seven steps.
    ///
    /// # Errors
    /// When it is another function, or rounds too badly.
    pub fn proof(&self, function: Function, formulation: Formulation) -> Result<Proof, CompileError> {
        // a program that was proved has its proof
        Ok(formulation.proved(function, Target::Latency, self)?.proof.unwrap_or_default())
    }

    /// Returns how many times less precise a formulation is in single precision than the seven steps, on the average of
    /// random states; `None` if it is another function.
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
        let is_identical = proof::identical(self.robot(), &program, &exactly, embedding).is_ok();
        Ok(is_identical.then(|| rounding::loss_of_precision(self, &program, states)))
    }
}

/// Compiles a function by the seven steps, if they have at most `most` operations. After its own outputs it returns
/// every component of the quantities in `keep`. With `explains` it also keeps its formulas before folding.
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
        if keep.contains(&definition.name.quantity) && (1..=robot.joints.len()).contains(&definition.name.joint) {
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
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/ur5.yaml");
        let robot = rne_model::Reader::new("ur5").read(&std::fs::read(path).unwrap()).unwrap().robot;
        let function = Function::InverseDynamicsDerivatives;
        let error = seven_steps_within(1_000, &robot, function, &[], false).unwrap_err();
        assert_eq!(error, CompileError::TooLarge { function, dof: 6, most: 1_000 });
        let message = error.to_string();
        assert!(message.contains("more than 1000 operations") && message.contains("rne::DynArm"), "{message}");
        assert!(seven_steps_within(1_000, &robot, Function::InverseDynamics, &[], false).is_ok());
    }
}
