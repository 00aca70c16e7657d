//! Functions without rounding: the plain formulas at random points of two prime fields.

use rne_model::Robot;

use crate::formulate;
use crate::function::Function;
use crate::ir::{Builder, Embedding, Graph, Input, Name, Op, Policy, Residue, SamplePoint};

/// The plain formulas of a function, evaluated at random points of two prime fields. Sines and cosines are random
/// points of the circle there. Nothing is rounded, so a rank or an identity that is found at a few points needs no
/// tolerance.
#[derive(Clone, Debug)]
pub struct ExactFunction {
    graph: Graph,
}

impl ExactFunction {
    /// Writes a function of a robot by the seven steps.
    #[must_use]
    pub fn new(robot: &Robot, function: Function) -> Self {
        Self::with(robot, function, Embedding::default())
    }

    /// Writes a function whose constants are mapped into the fields by `embedding`.
    pub(crate) fn with(robot: &Robot, function: Function, embedding: Embedding) -> Self {
        let builder = Builder::untraced(Policy::Structure, embedding, function);
        let outputs = formulate::outputs(&builder, robot).into_iter().map(|(_, at)| at).collect();
        Self { graph: builder.finish(outputs).graph }
    }

    /// The numbers that the function returns at a point, in the order of its layout. Points are counted from 1.
    #[must_use]
    pub fn at(&self, point: u64) -> Vec<Residue> {
        self.at_point(&SamplePoint::new(self.graph.embedding(), point))
    }

    /// The value of the argument with this name at a point.
    #[must_use]
    pub fn argument(&self, point: u64, name: Name) -> Residue {
        SamplePoint::new(self.graph.embedding(), point).argument(Input::new(name))
    }

    pub(crate) fn at_point(&self, point: &SamplePoint) -> Vec<Residue> {
        let residues = self.residues(point);
        self.graph.outputs.iter().map(|at| at.residue(&residues)).collect()
    }

    /// Whether the formulas divide by zero at a point.
    pub(crate) fn divides_by_zero(&self, point: &SamplePoint) -> bool {
        let residues = self.residues(point);
        self.graph.nodes().any(|(_, op)| matches!(op, Op::Quotient(_, b) if residues[b.index()].is_zero()))
    }

    /// The residues of all nodes.
    fn residues(&self, point: &SamplePoint) -> Vec<Residue> {
        let mut residues: Vec<Residue> = Vec::with_capacity(self.graph.len());
        for (_, op) in self.graph.nodes() {
            residues.push(self.graph.image_at(op, &residues, point));
        }
        residues
    }
}
