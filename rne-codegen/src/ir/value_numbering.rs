//! Value numbering: the live part of a graph written once more, with equal values as one node.

use rustc_hash::FxHashMap;

use super::{Birth, Component, Definition, Graph, Op, Place, Policy, Quantity, Ref, Step, Trace, Traced, mark_live};

/// Writes what is live of `from` into `to`, a numbered graph, in its order: of equal values the first one stays.
///
/// `live` and `map` are memory that a search uses again.
pub(crate) fn number_values(from: &Graph, to: &mut Graph, live: &mut Vec<bool>, map: &mut Vec<Ref>) {
    transcribe(from, to, live, map, |_, _, _, _| {});
}

impl Traced {
    /// Puts what was solved for in place of the arguments that stood for it: a value, and what is to be put there. What
    /// was folded among others is folded once more.
    pub(crate) fn with_values(self, of: &FxHashMap<Ref, Ref>) -> Self {
        let Self { graph: from, mut trace } = self;
        let mut graph = Graph::new(from.policy, from.embedding());
        let mut map: Vec<Ref> = Vec::with_capacity(from.len());
        let (mut births, mut roles, mut lengths) = (Vec::new(), FxHashMap::default(), Vec::new());
        for (index, node) in from.nodes.iter().enumerate() {
            let (old, before) = (Ref::new(index), graph.len());
            lengths.push(before);
            let new = match (of.get(&old), node.op) {
                (Some(value), _) => value.mapped(&map),
                (None, Op::Constant(place)) => graph.constant_like(&from, place),
                (None, op) => graph.transcribed(op, node.residue, &map),
            };
            births.resize(before, None);
            births.resize(graph.len(), trace.births.get(index).copied().flatten());
            for operand in node.op.operands().filter(|at| from.is_constant(*at)) {
                if let Some(name) = trace.roles.get(&(old, operand.magnitude())) {
                    roles.entry((new.magnitude(), operand.mapped(&map).magnitude())).or_insert(*name);
                }
            }
            map.push(new);
        }
        graph.outputs = from.outputs.iter().map(|at| at.mapped(&map)).collect();
        for definition in &mut trace.definitions {
            definition.at = definition.at.mapped(&map);
            definition.after = lengths.get(definition.after).copied().unwrap_or(graph.len());
        }
        (trace.births, trace.roles) = (births, roles);
        Self { graph, trace }
    }

    /// Numbers the values of a graph and its trace: a name stays with its value, wherever that is computed now.
    pub(crate) fn numbered(self) -> Self {
        let Self { graph, trace: told } = self;
        let mut numbered = Graph::new(Policy::Numbered, graph.embedding());
        let mut trace = Trace::default();
        let (mut live, mut map) = (Vec::new(), Vec::new());
        transcribe(&graph, &mut numbered, &mut live, &mut map, |index, map, before, to| {
            trace.births.resize(before, None);
            trace.births.resize(to.len(), told.births.get(index).copied().flatten());
            let (old, new) = (Ref::new(index), map[index].magnitude());
            for operand in graph.op(old).operands().filter(|at| graph.is_constant(*at)) {
                if let Some(name) = told.roles.get(&(old, operand.magnitude())) {
                    trace.roles.entry((new, operand.mapped(map).magnitude())).or_insert(*name);
                }
            }
        });
        let after = numbered.len();
        for definition in told.definitions {
            // values that are zero or one keep no name
            let at = numbered.valued(graph.residue(definition.at)).filter(|at| at.index() > 1);
            if let Some(at) = at {
                trace.definitions.push(Definition { at, after, ..definition });
            }
        }
        Self { graph: numbered, trace }
    }
}

impl Traced {
    /// A graph of the same values that knows less: names and places of those values go over to it.
    pub(crate) fn told_by(mut self, other: &Self) -> Self {
        // a new node belongs to none of the seven steps
        let place = Place { joint: 0, step: Step::Torque, quantity: Quantity::Term, by: None };
        self.trace.births.resize(self.graph.len(), None);
        for (birth, node) in self.trace.births.iter_mut().zip(&self.graph.nodes) {
            *birth = node.op.is_operation().then_some(Birth { place, component: Component::Scalar });
        }
        let births = other.graph.nodes.iter().zip(&other.trace.births);
        for (node, birth) in births.filter(|(_, birth)| birth.is_some()) {
            if let Some(at) = self.graph.valued(node.residue) {
                self.trace.births[at.index()] = *birth;
            }
        }
        let after = self.graph.len();
        for definition in &other.trace.definitions {
            if let Some(at) = self.graph.valued(other.graph.residue(definition.at)).filter(|at| at.index() > 1) {
                self.trace.definitions.push(Definition { at, after, ..definition.clone() });
            }
        }
        self
    }
}

/// Tells `written` of every node: its index, the map so far, and the length of the new graph before.
fn transcribe(
    from: &Graph,
    to: &mut Graph,
    live: &mut Vec<bool>,
    map: &mut Vec<Ref>,
    mut written: impl FnMut(usize, &[Ref], usize, &Graph),
) {
    mark_live(&from.nodes, &from.outputs, live);
    to.clear(from.embedding());
    map.clear();
    map.resize(from.len(), Ref::new(0));
    for (index, node) in from.nodes.iter().enumerate().filter(|(index, _)| live[*index]) {
        let before = to.len();
        map[index] = match node.op {
            Op::Constant(place) => to.constant_like(from, place),
            op => to.transcribed(op, node.residue, map),
        };
        written(index, map, before, to);
    }
    to.outputs.extend(from.outputs.iter().map(|at| at.mapped(map)));
}
