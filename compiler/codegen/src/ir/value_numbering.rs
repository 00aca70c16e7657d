//! Value numbering: the live part of a graph written once more, with equal values as one node.

use super::{Birth, Component, Definition, Graph, Op, Place, Policy, Quantity, Ref, Step, Trace, Traced, mark_live};

/// Writes the live nodes of `from` into `to`, a numbered graph, in their order. Of nodes with equal values, the first
/// one stays.
///
/// `live` and `map` are buffers that a search uses again.
pub(crate) fn number_values(from: &Graph, to: &mut Graph, live: &mut Vec<bool>, map: &mut Vec<Ref>) {
    transcribe(from, to, &[], live, map, |_, _, _, _| {});
}

impl Traced {
    /// Numbers the values of a graph and its trace. A name stays with its value, even if another node computes it now.
    /// An argument that replaced a value is replaced by the value again.
    pub(crate) fn numbered(self) -> Self {
        let Self { graph, trace: told } = self;
        let mut numbered = Graph::new(Policy::Numbered, graph.embedding());
        let mut trace = Trace::default();
        let (mut live, mut map) = (Vec::new(), Vec::new());
        transcribe(&graph, &mut numbered, &told.held, &mut live, &mut map, |index, map, before, to| {
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
            let is_live = live[definition.at.index()];
            let value = || numbered.valued(graph.residue(definition.at));
            let at = if is_live { Some(definition.at.mapped(&map)) } else { value() }.filter(|at| at.index() > 1);
            if let Some(at) = at {
                trace.definitions.push(Definition { at, after, ..definition });
            }
        }
        Self { graph: numbered, trace }
    }
}

impl Traced {
    /// Copies names and places of the same values from the trace of another graph.
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

/// Writes the live nodes of `from` into `to`. For every node it calls `written` with the index, the map so far, and the
/// new graph with its length before. `held` has arguments, and the earlier values that replace them.
fn transcribe(
    from: &Graph,
    to: &mut Graph,
    held: &[(Ref, Ref)],
    live: &mut Vec<bool>,
    map: &mut Vec<Ref>,
    mut written: impl FnMut(usize, &[Ref], usize, &Graph),
) {
    if held.is_empty() {
        mark_live(&from.nodes, &from.outputs, live);
    } else {
        let values: Vec<Ref> = held.iter().map(|(_, value)| *value).collect();
        mark_live(&from.nodes, &[&from.outputs[..], &values].concat(), live);
    }
    to.clear(from.embedding());
    map.clear();
    map.resize(from.len(), Ref::new(0));
    for (index, node) in from.nodes.iter().enumerate().filter(|(index, _)| live[*index]) {
        let before = to.len();
        map[index] = match (held.iter().find(|(input, _)| input.index() == index), node.op) {
            (Some((_, value)), _) => value.mapped(map),
            (None, Op::Constant(place)) => to.constant_like(from, place),
            (None, op) => to.transcribed(op, node.residue, map),
        };
        written(index, map, before, to);
    }
    to.outputs.extend(from.outputs.iter().map(|at| at.mapped(map)));
}
