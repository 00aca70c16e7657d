//! The formulas of a function as a graph, before it is lowered.

use rne_model::Robot;

use crate::formulate;
use crate::function::Function;
use crate::ir::{Builder, Cost, Embedding, Name, Policy, Traced};
use crate::program::Scales;
use crate::reduced::near_origins;

/// A function as a graph before lowering: the names of its results, and the graph with its trace.
#[allow(missing_debug_implementations)] // a graph of thousands of nodes
pub struct Formulation {
    pub(crate) names: Vec<Name>,
    pub(crate) traced: Traced,
    /// The factors of lengths and forces, if the formulas measure them in units of the arm.
    pub(crate) scales: Vec<Scales>,
}

impl Formulation {
    /// The plain formulas of a function.
    pub(crate) fn plain(policy: Policy, robot: &Robot, function: Function) -> Self {
        Self::on(Builder::traced(policy, Embedding::default(), function), robot, function)
    }

    /// The seven steps with joint origins near the arm, even if those of the table are far away.
    pub(crate) fn near(robot: &Robot, function: Function) -> Self {
        let builder = Builder::traced(Policy::Structure, Embedding::default(), function);
        Self::on(builder.moving_origins(), robot, function)
    }

    /// The seven steps, with a record of the formulas before folding.
    pub(crate) fn explained(robot: &Robot, function: Function) -> Self {
        Self::on(Builder::explained(Policy::Structure, Embedding::default(), function), robot, function)
    }

    fn on(mut builder: Builder, robot: &Robot, function: Function) -> Self {
        if builder.moves_origins && !function.entry().is_of_table_points {
            builder.origins = near_origins(robot);
        }
        let (names, outputs) = formulate::outputs(&builder, robot).into_iter().unzip();
        Self { names, traced: builder.finish(outputs), scales: Vec::new() }
    }

    /// The plain formulas with every value computed once, even if they compute it several times in different ways. This
    /// is the reduced form of a function without a recursion of its own.
    #[must_use]
    pub fn numbered(robot: &Robot, function: Function) -> Self {
        let plain = Self::plain(Policy::Value, robot, function);
        Self { traced: plain.traced.numbered(), ..plain }
    }

    /// How its constants are mapped into the prime fields of the proof.
    pub(crate) fn embedding(&self) -> Embedding {
        self.traced.graph.embedding()
    }

    /// The number of its operations.
    #[must_use]
    pub fn cost(&self) -> Cost {
        self.traced.graph.cost(&mut Vec::new())
    }
}
