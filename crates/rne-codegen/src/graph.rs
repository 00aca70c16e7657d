//! The expression graph: hash-consed sums and products with free signs, and constructors that fold.
//!
//! A constructor folds only what is exact for finite values, up to the sign of zero: 0·x, 1·x, x + 0, x - x, a sign
//! pulled out of a product or a sum, the order of two operands, and an operation of two constants. So the graph
//! computes the same bits as the unfolded formula.

use std::collections::HashMap;
use std::ops::Neg;

use crate::exact::{Image, Number, Reading};
use crate::quantity::Name;

/// The index of a node in its graph.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct NodeId(u32);

impl NodeId {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// A node or its negative: negation costs no operation, so it lives in the reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Term {
    pub(crate) node: NodeId,
    pub(crate) negative: bool,
}

impl Neg for Term {
    type Output = Self;

    fn neg(self) -> Self {
        Self { negative: !self.negative, ..self }
    }
}

impl Term {
    /// The term, negated if `negative`.
    fn signed(self, negative: bool) -> Self {
        if negative { -self } else { self }
    }
}

/// A node of the graph. Operands always have smaller indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Node {
    /// A constant, never negative: its sign is in the reference.
    Constant(f64),
    /// An argument of the function.
    Argument(Name),
    /// Sine of an angle.
    Sine(Term),
    /// Cosine of an angle.
    Cosine(Term),
    /// A sum; a difference has a negative operand.
    Sum(Term, Term),
    /// A product of two nodes.
    Product(NodeId, NodeId),
}

/// What became of an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// A new node: it will be computed, unless it turns out dead.
    Computed,
    /// The same node was there before.
    Shared,
    /// One operand is zero; which one.
    Zero(Side),
    /// One factor is 1 or -1; which one.
    One(Side),
    /// Both operands are constants.
    Constants,
    /// x - x.
    Cancelled,
}

/// One of the two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

/// A key under which an equal node is found again. Operands of a commutative operation are sorted.
#[derive(PartialEq, Eq, Hash)]
enum Key {
    /// The bits of its value; in an exact graph also its image.
    Constant(u64, Option<Image>),
    Argument(Name),
    Sine(Term),
    Cosine(Term),
    Sum(NodeId, NodeId, bool),
    Product(NodeId, NodeId),
}

/// Nodes in order of creation, which is an order of evaluation too.
#[derive(Default)]
pub(crate) struct Graph {
    nodes: Vec<Node>,
    // Looked up, never iterated: the order of its entries is not deterministic.
    known: HashMap<Key, NodeId>,
    /// What constants are exactly, for a graph that is compared in fields instead of being computed.
    exact: Option<Exact>,
}

/// The constants of an exact graph.
struct Exact {
    reading: Reading,
    numbers: HashMap<NodeId, Number>,
}

impl Graph {
    /// A graph whose constants are exact: it folds what is zero and one, not what rounds to it.
    pub(crate) fn exact(reading: Reading) -> Self {
        Self { exact: Some(Exact { reading, numbers: HashMap::new() }), ..Self::default() }
    }

    /// How an exact graph reads the numbers of a robot.
    pub(crate) fn reading(&self) -> Option<Reading> {
        self.exact.as_ref().map(|exact| exact.reading)
    }

    /// What a constant of an exact graph is.
    pub(crate) fn number(&self, term: Term) -> Option<Number> {
        let number = *self.exact.as_ref()?.numbers.get(&term.node)?;
        Some(if term.negative { -number } else { number })
    }

    /// A constant of an exact graph.
    pub(crate) fn constant_number(&mut self, number: Number) -> Term {
        let magnitude = number.abs();
        let value = magnitude.to_f64();
        let key = Key::Constant(value.to_bits(), Some(magnitude.image));
        let (node, outcome) = self.intern(key, Node::Constant(value));
        if let (Outcome::Computed, Some(exact)) = (outcome, &mut self.exact) {
            exact.numbers.insert(node, magnitude);
        }
        Term { node, negative: number.is_negative() }
    }

    pub(crate) fn node(&self, id: NodeId) -> Node {
        self.nodes[id.index()]
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// All nodes with their ids, in order of creation.
    pub(crate) fn nodes(&self) -> impl DoubleEndedIterator<Item = (NodeId, Node)> + ExactSizeIterator {
        self.nodes.iter().enumerate().map(|(index, &node)| (Self::id(index), node))
    }

    pub(crate) fn constant(&mut self, value: f64) -> Term {
        if let Some(reading) = self.reading() {
            return self.constant_number(reading.decimal(value));
        }
        // -0 is 0: the graph is exact up to the sign of zero
        let magnitude = if value == 0.0 { 0.0 } else { value.abs() };
        let (node, _) = self.intern(Key::Constant(magnitude.to_bits(), None), Node::Constant(magnitude));
        Term { node, negative: value < 0.0 }
    }

    pub(crate) fn argument(&mut self, name: Name) -> Term {
        self.leaf(Key::Argument(name), Node::Argument(name))
    }

    pub(crate) fn sine(&mut self, angle: Term) -> Term {
        self.leaf(Key::Sine(angle), Node::Sine(angle))
    }

    pub(crate) fn cosine(&mut self, angle: Term) -> Term {
        self.leaf(Key::Cosine(angle), Node::Cosine(angle))
    }

    /// The value of a term that is a constant.
    pub(crate) fn value(&self, term: Term) -> Option<f64> {
        match self.node(term.node) {
            Node::Constant(magnitude) => Some(if term.negative { -magnitude } else { magnitude }),
            _ => None,
        }
    }

    /// a + b
    pub(crate) fn sum(&mut self, a: Term, b: Term) -> (Term, Outcome) {
        let (left, right) = (self.value(a), self.value(b));
        if right == Some(0.0) {
            return (a, Outcome::Zero(Side::Right));
        }
        if left == Some(0.0) {
            return (b, Outcome::Zero(Side::Left));
        }
        if let (Some(left), Some(right)) = (left, right) {
            let sum = match (self.number(a), self.number(b)) {
                (Some(a), Some(b)) => self.constant_number(a + b),
                _ => self.constant(left + right),
            };
            return (sum, Outcome::Constants);
        }
        if a == -b {
            return (self.constant(0.0), Outcome::Cancelled);
        }
        // Pull out the sign of the first operand: (-a) + b = -(a - b).
        let mut negative = a.negative;
        let (mut a, mut b) = (a.signed(negative), b.signed(negative));
        // a - b and b - a are one node: the one whose first operand is older.
        if b.negative && a.node > b.node {
            (a, b) = (-b, -a);
            negative = !negative;
        }
        let key = Key::Sum(a.node.min(b.node), a.node.max(b.node), b.negative);
        let (node, outcome) = self.intern(key, Node::Sum(a, b));
        (Term { node, negative }, outcome)
    }

    /// a · b
    pub(crate) fn product(&mut self, a: Term, b: Term) -> (Term, Outcome) {
        let (left, right) = (self.value(a), self.value(b));
        if right == Some(0.0) {
            return (b, Outcome::Zero(Side::Right));
        }
        if left == Some(0.0) {
            return (a, Outcome::Zero(Side::Left));
        }
        if let Some(right) = right
            && right.abs() == 1.0
        {
            return (a.signed(right < 0.0), Outcome::One(Side::Right));
        }
        if let Some(left) = left
            && left.abs() == 1.0
        {
            return (b.signed(left < 0.0), Outcome::One(Side::Left));
        }
        if let (Some(left), Some(right)) = (left, right) {
            let product = match (self.number(a), self.number(b)) {
                (Some(a), Some(b)) => self.constant_number(a * b),
                _ => self.constant(left * right),
            };
            return (product, Outcome::Constants);
        }
        let key = Key::Product(a.node.min(b.node), a.node.max(b.node));
        let (node, outcome) = self.intern(key, Node::Product(a.node, b.node));
        (Term { node, negative: a.negative != b.negative }, outcome)
    }

    fn leaf(&mut self, key: Key, node: Node) -> Term {
        Term { node: self.intern(key, node).0, negative: false }
    }

    fn intern(&mut self, key: Key, node: Node) -> (NodeId, Outcome) {
        let next = Self::id(self.nodes.len());
        let id = *self.known.entry(key).or_insert(next);
        if id == next {
            self.nodes.push(node);
            return (id, Outcome::Computed);
        }
        (id, Outcome::Shared)
    }

    fn id(index: usize) -> NodeId {
        NodeId(u32::try_from(index).expect("a robot has at most 64 joints, its graph far fewer than 2^32 nodes"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Quantity;

    fn arguments() -> (Graph, Term, Term) {
        let mut graph = Graph::default();
        let a = graph.argument(Name::scalar(Quantity::Position, 1));
        let b = graph.argument(Name::scalar(Quantity::Position, 2));
        (graph, a, b)
    }

    #[test]
    fn exact_identities_fold() {
        let (mut graph, a, _) = arguments();
        let [zero, one, two] = [0.0, 1.0, 2.0].map(|value| graph.constant(value));
        assert_eq!(graph.product(zero, a), (zero, Outcome::Zero(Side::Left)));
        assert_eq!(graph.product(a, zero), (zero, Outcome::Zero(Side::Right)));
        assert_eq!(graph.product(one, a), (a, Outcome::One(Side::Left)));
        assert_eq!(graph.product(a, -one), (-a, Outcome::One(Side::Right)));
        assert_eq!(graph.sum(a, zero), (a, Outcome::Zero(Side::Right)));
        assert_eq!(graph.sum(zero, -a), (-a, Outcome::Zero(Side::Left)));
        assert_eq!(graph.sum(a, -a), (zero, Outcome::Cancelled));
        assert_eq!(graph.sum(one, one), (two, Outcome::Constants));
    }

    #[test]
    fn signs_and_order_do_not_make_new_nodes() {
        let (mut graph, a, b) = arguments();
        let (difference, _) = graph.sum(a, -b);
        assert_eq!(graph.sum(b, -a), (-difference, Outcome::Shared));
        assert_eq!(graph.sum(-b, a), (difference, Outcome::Shared));
        assert_eq!(graph.sum(-a, b), (-difference, Outcome::Shared));
        let (sum, _) = graph.sum(b, a);
        assert_eq!(graph.sum(-a, -b), (-sum, Outcome::Shared));
        let (product, _) = graph.product(a, -b);
        assert_eq!(graph.product(b, a), (-product, Outcome::Shared));
        assert_eq!(graph.product(-b, -a), (-product, Outcome::Shared));
    }

    #[test]
    fn what_is_not_exact_is_left_alone() {
        let (mut graph, a, b) = arguments();
        let (two, three) = (graph.constant(2.0), graph.constant(3.0));
        let (inner, _) = graph.product(three, a);
        assert_eq!(graph.product(two, inner).1, Outcome::Computed, "2·(3·a) is not 6·a in floating point");
        let (sum, _) = graph.sum(a, b);
        let (other, _) = graph.sum(sum, -b);
        assert_ne!(other, a, "(a + b) - b is not a");
    }
}
