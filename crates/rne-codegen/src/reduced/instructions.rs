//! How many instructions a graph takes where a product and a sum are one: what [`fusion`](crate::fusion) makes of it, counted
//! fast enough for a search.

use super::sheet::{Dag, Op};

/// What is known of a node.
#[derive(Clone, Copy, Default)]
struct Count {
    uses: usize,
    in_sums: usize,
    /// The last sum that uses it; for a sum that is a term of one other sum alone, later, the longest sum it is part of.
    sum: usize,
}

impl Dag {
    /// Instructions of one evaluation, without those of sines, cosines and angles; `live` marks what the outputs depend on.
    pub(crate) fn instructions(&self, live: &[bool]) -> usize {
        let nodes = &self.sheet.nodes;
        let mut counts = vec![Count::default(); nodes.len()];
        for output in &self.outputs {
            counts[output.index()].uses += 1;
        }
        for (index, node) in nodes.iter().enumerate().filter(|(index, _)| live[*index]) {
            let (Op::Sum(a, b) | Op::Product(a, b)) = node.op else { continue };
            for operand in [a, b] {
                let count = &mut counts[operand.index()];
                count.uses += 1;
                if matches!(node.op, Op::Sum(..)) {
                    count.in_sums += 1;
                    count.sum = index;
                }
            }
        }
        let mut total = 0;
        let mut is_started = vec![false; nodes.len()];
        let mut waiting: Vec<(usize, usize)> = Vec::new();
        // users stand behind what they use
        for index in (0..nodes.len()).rev().filter(|&index| live[index]) {
            let node = counts[index];
            match nodes[index].op {
                Op::Sum(a, b) => {
                    total += 1;
                    let is_term = node.uses == 1 && node.in_sums == 1;
                    let longest = if is_term { counts[node.sum].sum } else { index };
                    counts[index].sum = longest;
                    for operand in [a, b] {
                        let term = counts[operand.index()];
                        match nodes[operand.index()].op {
                            Op::Product(..) if term.uses == term.in_sums => waiting.push((longest, operand.index())),
                            Op::Sum(..) if term.uses == 1 => {}
                            _ => is_started[longest] = true,
                        }
                    }
                }
                Op::Product(..) => total += usize::from(node.uses > node.in_sums),
                Op::Constant(_) | Op::Leaf(_) => {}
            }
        }
        // A sum of products alone needs one of them to start from: those first that start most sums.
        loop {
            waiting.retain(|&(sum, _)| !is_started[sum]);
            if waiting.is_empty() {
                return total;
            }
            let mut starts = vec![0_usize; nodes.len()];
            for &(_, product) in &waiting {
                starts[product] += 1;
            }
            let best = (0..nodes.len()).max_by_key(|&node| starts[node]).unwrap_or(0);
            total += 1;
            for &(sum, product) in &waiting {
                is_started[sum] |= product == best;
            }
        }
    }
}
