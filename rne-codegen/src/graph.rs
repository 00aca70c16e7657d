//! The expression graph: hash-consed sums and products with free signs, and constructors that fold.
//!
//! A constructor folds only what is exact for finite values, up to the sign of zero: 0·x, 1·x, x + 0, x - x, a sign
//! pulled out of a product or a sum, the order of two operands, and an operation of two constants. So the graph
//! computes the same bits as the unfolded formula.

use std::collections::HashMap;
use std::ops::Neg;

use crate::exact::{Image, Number, Reading};
use crate::name::Name;
use crate::reduced::Point;
use rne_model::Angle;

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
    /// A quotient of two nodes.
    Quotient(NodeId, NodeId),
    /// One of two values, by the sign of the first; 0 where that is 0.
    BySign(Term, Term, Term),
}

impl Node {
    /// The nodes that it uses.
    pub(crate) fn operands(self) -> impl Iterator<Item = NodeId> {
        let operands = match self {
            Self::Constant(_) | Self::Argument(_) => [None; 3],
            Self::Sine(angle) | Self::Cosine(angle) => [Some(angle.node), None, None],
            Self::Sum(a, b) => [Some(a.node), Some(b.node), None],
            Self::Product(a, b) | Self::Quotient(a, b) => [Some(a), Some(b), None],
            Self::BySign(x, a, b) => [x, a, b].map(|term| Some(term.node)),
        };
        operands.into_iter().flatten()
    }
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
    Quotient(NodeId, NodeId),
    BySign(Term, Term, Term),
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
    merged: Option<Merged>,
}

/// What nodes are worth at a random point: two that are equal there are one.
struct Merged {
    point: Point,
    /// By node.
    images: Vec<Image>,
    /// The first node of each value, which may be its negative.
    known: HashMap<Image, Term>,
}

impl Merged {
    fn image(&self, term: Term) -> Image {
        let image = self.images[term.node.index()];
        if term.negative { -image } else { image }
    }

    fn term(&self, image: Image) -> Option<Term> {
        let known = |image: Image| self.known.get(&image).copied();
        known(image).or_else(|| known(-image).map(|term| -term))
    }
}

impl Graph {
    /// A graph whose constants are exact: it folds what is zero and one, not what rounds to it.
    pub(crate) fn exact(reading: Reading) -> Self {
        Self { exact: Some(Exact { reading, numbers: HashMap::new(), merged: None }), ..Self::default() }
    }

    /// An exact graph in which equal values are one node, however they are computed.
    pub(crate) fn merged(reading: Reading) -> Self {
        let merged = Merged { point: Point::new(reading, 0), images: Vec::new(), known: HashMap::new() };
        Self { exact: Some(Exact { reading, numbers: HashMap::new(), merged: Some(merged) }), ..Self::default() }
    }

    fn merge(&self) -> Option<&Merged> {
        self.exact.as_ref()?.merged.as_ref()
    }

    /// What a node is worth at a point, when those before it are worth `images`.
    pub(crate) fn image(&self, node: Node, number: Option<Number>, images: &[Image], point: &Point) -> Image {
        let of = |term: Term| {
            let image = images[term.node.index()];
            if term.negative { -image } else { image }
        };
        match node {
            Node::Constant(_) => number.map_or(Image::ZERO, |number| number.image),
            Node::Argument(name) => point.argument(name),
            Node::Sine(angle) => self.turn_image(angle, point).0,
            Node::Cosine(angle) => self.turn_image(angle, point).1,
            Node::Sum(a, b) => of(a) + of(b),
            Node::Product(a, b) => images[a.index()] * images[b.index()],
            Node::Quotient(a, b) => images[a.index()] * images[b.index()].inverse().unwrap_or(Image::ZERO),
            // no rational function: nothing is said of it
            Node::BySign(..) => Image::ZERO,
        }
    }

    /// Sine and cosine of an angle: q, or a constant and q.
    fn turn_image(&self, angle: Term, point: &Point) -> (Image, Image) {
        let (sine, cosine) = match self.node(angle.node) {
            Node::Argument(name) => point.turn(name.joint - 1),
            Node::Constant(magnitude) => {
                let turn = self.reading().unwrap_or_default().turn(&Angle::new(magnitude));
                (turn.sin.image, turn.cos.image)
            }
            Node::Sum(a, b) => {
                let ((s, c), (sine, cosine)) = (self.turn_image(a, point), self.turn_image(b, point));
                (s * cosine + c * sine, c * cosine - s * sine)
            }
            _ => (Image::ZERO, Image::ZERO),
        };
        (if angle.negative { -sine } else { sine }, cosine)
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
            if let Some(merged) = &mut exact.merged {
                merged.images[node.index()] = magnitude.image;
                merged.known.entry(magnitude.image).or_insert(Term { node, negative: false });
            }
        }
        Term { node, negative: number.is_negative() }
    }

    pub(crate) fn node(&self, id: NodeId) -> Node {
        self.nodes[id.index()]
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Sums, products and quotients.
    pub(crate) fn operations(&self) -> usize {
        let is_operation = |node: &&Node| matches!(node, Node::Sum(..) | Node::Product(..) | Node::Quotient(..));
        self.nodes.iter().filter(is_operation).count()
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

    /// Whether a term is the constant 0: in an exact graph the number, not what rounds to it.
    fn is_zero(&self, term: Term) -> bool {
        self.value(term) == Some(0.0) && self.number(term).is_none_or(Number::is_zero)
    }

    /// Whether a term is the constant 1 or -1.
    fn is_unit(&self, term: Term) -> bool {
        self.value(term).is_some_and(|value| value.abs() == 1.0) && self.number(term).is_none_or(Number::is_unit)
    }

    /// a + b
    pub(crate) fn sum(&mut self, a: Term, b: Term) -> (Term, Outcome) {
        if self.is_zero(b) {
            return (a, Outcome::Zero(Side::Right));
        }
        if self.is_zero(a) {
            return (b, Outcome::Zero(Side::Left));
        }
        if let (Some(left), Some(right)) = (self.value(a), self.value(b)) {
            let sum = match (self.number(a), self.number(b)) {
                (Some(a), Some(b)) => self.constant_number(a + b),
                _ => self.constant(left + right),
            };
            return (sum, Outcome::Constants);
        }
        if a == -b {
            return (self.constant(0.0), Outcome::Cancelled);
        }
        if let Some(merged) = self.merge() {
            let image = merged.image(a) + merged.image(b);
            if image.is_zero() {
                return (self.constant(0.0), Outcome::Cancelled);
            }
            if let Some(known) = merged.term(image) {
                return (known, Outcome::Shared);
            }
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
        if self.is_zero(b) {
            return (b, Outcome::Zero(Side::Right));
        }
        if self.is_zero(a) {
            return (a, Outcome::Zero(Side::Left));
        }
        if self.is_unit(b) {
            return (a.signed(b.negative), Outcome::One(Side::Right));
        }
        if self.is_unit(a) {
            return (b.signed(a.negative), Outcome::One(Side::Left));
        }
        if let (Some(left), Some(right)) = (self.value(a), self.value(b)) {
            let product = match (self.number(a), self.number(b)) {
                (Some(a), Some(b)) => self.constant_number(a * b),
                _ => self.constant(left * right),
            };
            return (product, Outcome::Constants);
        }
        if let Some(merged) = self.merge()
            && let Some(known) = merged.term(merged.image(a) * merged.image(b))
        {
            return (known, Outcome::Shared);
        }
        let key = Key::Product(a.node.min(b.node), a.node.max(b.node));
        let (node, outcome) = self.intern(key, Node::Product(a.node, b.node));
        (Term { node, negative: a.negative != b.negative }, outcome)
    }

    /// a / b. Only what is exact whatever b is folds; what is divided by zero is left to the code, whose result is not finite.
    pub(crate) fn quotient(&mut self, a: Term, b: Term) -> (Term, Outcome) {
        if self.is_unit(b) {
            return (a.signed(b.negative), Outcome::One(Side::Right));
        }
        if let (Some(left), Some(right)) = (self.value(a), self.value(b))
            && right != 0.0
        {
            let inverse = self.number(b).and_then(Number::inverse);
            let quotient = match (self.number(a), inverse) {
                (Some(a), Some(inverse)) => self.constant_number(a * inverse),
                _ => self.constant(left / right),
            };
            return (quotient, Outcome::Constants);
        }
        let (node, outcome) = self.intern(Key::Quotient(a.node, b.node), Node::Quotient(a.node, b.node));
        (Term { node, negative: a.negative != b.negative }, outcome)
    }

    /// `positive` where x > 0, `negative` where x < 0, else 0.
    pub(crate) fn by_sign(&mut self, x: Term, positive: Term, negative: Term) -> Term {
        if self.is_zero(positive) && self.is_zero(negative) {
            return self.constant(0.0);
        }
        self.leaf(Key::BySign(x, positive, negative), Node::BySign(x, positive, negative))
    }

    fn leaf(&mut self, key: Key, node: Node) -> Term {
        Term { node: self.intern(key, node).0, negative: false }
    }

    fn intern(&mut self, key: Key, node: Node) -> (NodeId, Outcome) {
        let next = Self::id(self.nodes.len());
        let id = *self.known.entry(key).or_insert(next);
        if id == next {
            self.nodes.push(node);
            self.remember(id, node);
            return (id, Outcome::Computed);
        }
        (id, Outcome::Shared)
    }

    fn remember(&mut self, id: NodeId, node: Node) {
        let Some(merged) = self.merge() else { return };
        let image = self.image(node, None, &merged.images, &merged.point);
        // a constant is remembered when its number is
        let is_known_later = matches!(node, Node::BySign(..) | Node::Constant(_));
        if let Some(merged) = self.exact.as_mut().and_then(|exact| exact.merged.as_mut()) {
            merged.images.push(image);
            if !is_known_later && merged.term(image).is_none() {
                merged.known.insert(image, Term { node: id, negative: false });
            }
        }
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
        let [zero, one] = [0.0, 1.0].map(|value| graph.constant(value));
        assert_eq!(graph.quotient(one, zero).1, Outcome::Computed, "infinity is no number of the table");
    }
}
