//! The trace of a graph, for people who read the code: names, places, causes, and how every operation was folded. A
//! search, which counts thousands of plans, keeps no trace.

use rustc_hash::FxHashMap;

use super::{
    Axis, Cause, Causes, CausesId, Component, Fold, FoldReport, Graph, Name, Operation, Outcome, Place, Ref, Side,
    Symbol, TermId, WrittenTerms, causes::KnownCauses,
};

/// A name that was given to a value. Definitions are in the order in which the names were given.
#[derive(Clone, Debug)]
pub(crate) struct Definition {
    pub(crate) name: Name,
    pub(crate) at: Ref,
    /// The causes of its value, if it is a constant.
    pub(crate) causes: Causes,
    /// The number of nodes that the graph had when the name was given.
    pub(crate) after: usize,
    /// The formula that got the name.
    pub(crate) term: TermId,
    /// The place at which its operations are counted.
    pub(crate) place: Option<Place>,
}

/// The place at which a node was created.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Birth {
    pub(crate) place: Place,
    pub(crate) component: Component,
}

/// The trace of a graph.
#[derive(Default)]
pub(crate) struct Trace {
    pub(crate) fold_report: FoldReport,
    pub(crate) definitions: Vec<Definition>,
    /// The place of each node; `None` for a node that belongs to no step.
    pub(crate) births: Vec<Option<Birth>>,
    /// The name under which a node uses a constant: (node, constant) → name.
    pub(crate) roles: FxHashMap<(Ref, Ref), Name>,
    pub(crate) causes: KnownCauses,
    /// Arguments that replace values which derivatives keep constant, each with its value.
    pub(super) held: Vec<(Ref, Ref)>,
    /// The formulas as they were written, if they are kept.
    pub(crate) terms: Option<WrittenTerms>,
    place: Option<Place>,
    axis: Option<Axis>,
}

/// A graph and its trace.
pub(crate) struct Traced {
    pub(crate) graph: Graph,
    pub(crate) trace: Trace,
}

impl Trace {
    /// Sets the place and component of the next operations; returns those of the operations before.
    pub(super) fn enter(
        &mut self,
        nodes: usize,
        place: Option<Place>,
        axis: Option<Axis>,
    ) -> (Option<Place>, Option<Axis>) {
        // leaves and table constants that were made before belong to no step
        self.births.resize_with(nodes, || None);
        (std::mem::replace(&mut self.place, place), std::mem::replace(&mut self.axis, axis))
    }

    /// The place of the next operations.
    pub(super) fn place(&self) -> Option<Place> {
        self.place
    }

    /// Sets the component that the next operations belong to.
    pub(super) fn along(&mut self, axis: Axis) {
        self.axis = Some(axis);
    }

    /// Records the current place and component for all new nodes.
    pub(super) fn record_birth(&mut self, nodes: usize) {
        let component = self.axis.map_or(Component::Scalar, Component::Vector);
        let birth = self.place.map(|place| Birth { place, component });
        self.births.resize_with(nodes, || birth);
    }

    /// Removes the places of constants and arguments, which then belong to no step.
    pub(crate) fn forget_births_of_leaves(&mut self, graph: &Graph) {
        let leaves = self.births.iter_mut().zip(&graph.nodes).filter(|(_, node)| !node.op.is_operation());
        leaves.for_each(|(birth, _)| *birth = None);
    }

    /// Records the name under which a new node uses a constant: the same number may be a length in one node and a mass
    /// in another.
    pub(super) fn record_roles(&mut self, graph: &Graph, at: Ref, outcome: Outcome, operands: [Symbol<'_>; 2]) {
        if outcome != Outcome::Computed {
            return;
        }
        for operand in operands {
            if graph.is_constant(operand.at)
                && let Some(name) = self.causes.get(operand.causes).entry()
            {
                self.roles.insert((at.magnitude(), operand.at.magnitude()), name);
            }
        }
    }

    /// Returns the causes of the value of a sum or product, and the causes for which the operation was folded.
    pub(super) fn causes_of(
        &mut self,
        graph: &Graph,
        operation: Operation,
        at: Ref,
        outcome: Outcome,
        operands: [Symbol<'_>; 2],
    ) -> (CausesId, CausesId) {
        let [a, b] = operands.map(|operand| operand.causes);
        let none = CausesId::ARITHMETIC;
        let both_zero = outcome == Outcome::Zero(Side::Right) && graph.is_zero(operands[0].at);
        match (operation, outcome) {
            // a sum is zero if both summands are
            (Operation::Sum, Outcome::Zero(_)) if both_zero => (self.causes.both(a, b), b),
            // the result is the other operand
            (Operation::Sum, Outcome::Zero(Side::Right)) | (_, Outcome::One(Side::Right)) => (a, b),
            (Operation::Sum, Outcome::Zero(Side::Left)) | (_, Outcome::One(Side::Left)) => (b, a),
            (Operation::Sum, _) if graph.is_zero(at) => (self.causes.single(Cause::Cancellation), none),
            // a product is zero if either factor is
            (Operation::Product, Outcome::Zero(side)) => {
                let either = match side {
                    _ if both_zero => self.causes.either(a, b),
                    Side::Left => a,
                    Side::Right => b,
                };
                (either, either)
            }
            _ => (none, none),
        }
    }

    pub(super) fn record(&mut self, nodes: usize, operation: Operation, outcome: Outcome, causes: CausesId) {
        // Operations outside any step compute constants of the table. A runtime computes these once, too, so they are
        // not counted.
        let Some(place) = self.place else { return };
        let cause = self.causes.get(causes).main();
        let fold = match outcome {
            Outcome::Computed => Fold::Kept,
            Outcome::Shared => Fold::Shared,
            Outcome::Zero(_) => Fold::Zero(cause),
            Outcome::One(_) => Fold::One(cause),
            Outcome::Constants => Fold::Constant,
            Outcome::Cancelled => Fold::Cancelled,
        };
        self.fold_report.enter(place, operation, fold);
        self.record_birth(nodes);
    }
}
