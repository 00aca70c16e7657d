//! The cost of a graph: the operations of its results.

use std::ops::Add;

use super::{Graph, Op, Ref, mark_live};

/// Products, sums and angles of a graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, PartialOrd, Ord)]
pub struct Cost {
    /// Products.
    pub mul: usize,
    /// Sums, including sums of angles.
    pub add: usize,
    /// Angles whose sine or cosine is needed.
    pub sincos: usize,
}

impl Cost {
    /// An angle weighs as much as this many operations.
    const ANGLE: usize = 15;

    /// Products and sums.
    #[must_use]
    pub const fn total(&self) -> usize {
        self.mul + self.add
    }

    /// The number that a search minimises.
    #[must_use]
    pub const fn weight(&self) -> usize {
        self.total() + Self::ANGLE * self.sincos
    }
}

impl Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { mul: self.mul + other.mul, add: self.add + other.add, sincos: self.sincos + other.sincos }
    }
}

impl Graph {
    /// Operations that the results need.
    pub(crate) fn cost(&self, live: &mut Vec<bool>) -> Cost {
        mark_live(&self.nodes, &self.outputs, live);
        let mut cost = Cost::default();
        let mut angles: Vec<Ref> = Vec::new();
        for (node, _) in self.nodes.iter().zip(live.iter()).filter(|(_, live)| **live) {
            match node.op {
                Op::Sum(..) => cost.add += 1,
                Op::Product(..) => cost.mul += 1,
                Op::Sine(angle) | Op::Cosine(angle) if !angles.contains(&angle) => angles.push(angle),
                _ => {}
            }
        }
        cost.sincos = angles.len();
        cost
    }
}
