//! Rewritten graphs as a plan file keeps them.

use rne_model::Robot;

use crate::CompileError;
use crate::formulation::Formulation;
use crate::function::Function;
use crate::ir::Cost;
use crate::plan::{Plan, graph_text};
use crate::program::Proof;
use crate::reduced::algorithm::Algorithm;

/// The rewritten graph of a function.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rewritten {
    /// Operations of the function.
    pub operations: Cost,
    /// How precise it is.
    pub accuracy: Accuracy,
    /// The algorithm by which the function was written under the plan.
    pub algorithm: Algorithm,
    /// The plan that gives the graph its numbers; `None` for a function that does not depend on the choices of a plan.
    pub plan: Option<Plan>,
    /// The graph as text: constants, operations and results.
    pub graph: String,
}

/// Largest differences from the seven steps, in parts of the largest torque, rounded to two digits for people.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accuracy {
    /// The program in double precision.
    pub double: f64,
    /// The program in single precision.
    pub single: f64,
    /// The seven steps in single precision, compared with themselves in double precision.
    pub single_of_seven_steps: f64,
}

impl From<&Proof> for Accuracy {
    fn from(proof: &Proof) -> Self {
        let rounded = |value: f64| format!("{value:.1e}").parse().unwrap_or(value);
        Self {
            double: rounded(proof.rounding),
            single: rounded(proof.single),
            single_of_seven_steps: rounded(proof.single_of_seven_steps),
        }
    }
}

impl Rewritten {
    /// The graph before rewriting.
    pub(crate) fn before(&self, robot: &Robot, function: Function) -> Result<Formulation, CompileError> {
        match &self.plan {
            Some(plan) => Formulation::by_plan(robot, plan, function, self.algorithm),
            None => Ok(Formulation::numbered(robot, function)),
        }
    }

    /// Reads the rewritten graph; values keep the names that they have in the graph before rewriting.
    ///
    /// # Errors
    /// When the plan does not fit the robot, or the graph cannot be read.
    pub fn formulation(&self, robot: &Robot, function: Function) -> Result<Formulation, CompileError> {
        let before = self.before(robot, function)?;
        let read = graph_text::read(&self.graph, &before.traced.graph, function)
            .map_err(|(word, mistake)| CompileError::Graph { robot: robot.name.clone(), function, word, mistake })?;
        Ok(Formulation { traced: read.told_by(&before.traced), ..before })
    }

    /// The choices of the graph, in words.
    pub(crate) fn choices(&self) -> Vec<String> {
        let rewriting = "rewriting: the graph that the choices below give, made smaller by exact algebra";
        let algorithm = self.algorithm.words().filter(|_| self.plan.is_some());
        let choices = self.plan.iter().flat_map(Plan::choices);
        [rewriting].into_iter().chain(algorithm).map(str::to_owned).chain(choices).collect()
    }
}
