//! The nodes that results depend on.

use super::{Node, Op, Ref};

/// Marks the nodes that the outputs depend on.
pub(crate) fn mark_live(nodes: &[Node], outputs: &[Ref], live: &mut Vec<bool>) {
    mark(nodes, outputs, live, |_| true);
}

/// Marks the nodes that the outputs depend on, without nodes that serve only to compute angles of sines and cosines.
pub(crate) fn mark_live_outside_angles(nodes: &[Node], outputs: &[Ref], live: &mut Vec<bool>) {
    mark(nodes, outputs, live, |op| !matches!(op, Op::Sine(_) | Op::Cosine(_)));
}

fn mark(nodes: &[Node], outputs: &[Ref], live: &mut Vec<bool>, follows: impl Fn(Op) -> bool) {
    live.clear();
    live.resize(nodes.len(), false);
    for at in outputs {
        live[at.index()] = true;
    }
    for (index, node) in nodes.iter().enumerate().rev() {
        if live[index] && follows(node.op) {
            node.op.operands().for_each(|operand| live[operand.index()] = true);
        }
    }
}
