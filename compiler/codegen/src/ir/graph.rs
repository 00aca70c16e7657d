//! The expression graph. Its nodes are sums, products and other operations; signs cost nothing. Every constant is an
//! exact number, and every node has its residue at one sample point of two prime fields.
//!
//! The policy of a graph says what its constructors may fold:
//!
//! - [`Policy::Structure`] folds only what is exact for finite values, up to the sign of zero: 0·x, 1·x, x + 0, x - x,
//!   a sign pulled out of a product or a sum, the order of two operands, and an operation of two constants, rounded as
//!   the runtime rounds it. So the graph computes the same bits as the unfolded formula.
//! - [`Policy::Value`] folds terms that are equal as exact numbers: a sum whose terms cancel is zero, constant factors
//!   are gathered, c₁ x + c₂ x = (c₁ + c₂) x. With [`Policy::Numbered`], also two nodes with the same value, up to
//!   sign, become one node, however they were computed: the one that was written first.

use rustc_hash::FxHashMap;

use hashbrown::HashTable;

use super::{
    Embedding, ExactAngle, Input, Node, Number, Op, Ref, Residue, SamplePoint, composed, numbers::Numbers,
    numbers::canonical, numbers::key,
};

/// The rule by which the constructors of a graph fold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Policy {
    /// Only identities that are exact in floating point fold.
    Structure,
    /// Equal numbers fold.
    Value,
    /// Equal numbers fold, and equal values are one node.
    Numbered,
}

/// The result of writing an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// A new node. The code computes it unless no result depends on it.
    Computed,
    /// The node existed before.
    Shared,
    /// This operand is zero.
    Zero(Side),
    /// This factor is 1 or -1.
    One(Side),
    /// Both operands are constants.
    Constants,
    /// The operands cancel, as in x - x.
    Cancelled,
}

/// One of the two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

/// The nodes in the order of their creation, which is also an order of evaluation, and the results among them.
#[derive(Clone, Debug)]
pub(crate) struct Graph {
    pub(crate) nodes: Vec<Node>,
    pub(crate) numbers: Numbers,
    pub(crate) outputs: Vec<Ref>,
    pub(super) policy: Policy,
    /// The sample point of the residues, and how constants are mapped into the fields there.
    pub(crate) point: SamplePoint,
    /// Sine and cosine of each constant that is an angle, by the place of the constant.
    pub(super) turns: FxHashMap<u32, ExactAngle>,
    /// Hash tables of node indices, by operation and by value. They are used for look-ups only, so their order has no
    /// effect.
    structures: HashTable<u32>,
    values: HashTable<u32>,
}

impl Graph {
    pub(crate) fn new(policy: Policy, embedding: Embedding) -> Self {
        let mut graph = Self {
            nodes: Vec::new(),
            numbers: Numbers::default(),
            outputs: Vec::new(),
            policy,
            point: SamplePoint::new(embedding, 0),
            turns: FxHashMap::default(),
            structures: HashTable::new(),
            values: HashTable::new(),
        };
        graph.clear(embedding);
        graph
    }

    /// Empties the graph and keeps its memory.
    pub(crate) fn clear(&mut self, embedding: Embedding) {
        self.point = SamplePoint::new(embedding, 0);
        self.numbers.clear();
        self.turns.clear();
        self.clear_nodes();
    }

    /// Removes all nodes. The list of constants stays, with the same places. With policies that look up values, zero
    /// and one are added again as the first two nodes.
    pub(crate) fn clear_nodes(&mut self) {
        self.nodes.clear();
        self.outputs.clear();
        self.structures.clear();
        self.values.clear();
        if self.policy != Policy::Structure {
            let _ = (self.constant(Number::ZERO), self.constant(Number::ONE));
        }
    }

    pub(crate) fn policy(&self) -> Policy {
        self.policy
    }

    pub(crate) fn embedding(&self) -> Embedding {
        self.point.embedding()
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The number of operations: sums, products, quotients and choices by a sign.
    pub(crate) fn operations(&self) -> usize {
        self.nodes.iter().filter(|node| node.op.is_operation()).count()
    }

    pub(crate) fn op(&self, at: Ref) -> Op {
        self.nodes[at.index()].op
    }

    /// All nodes, in order of creation.
    pub(crate) fn nodes(&self) -> impl DoubleEndedIterator<Item = (Ref, Op)> + ExactSizeIterator {
        self.nodes.iter().enumerate().map(|(index, node)| (Ref::new(index), node.op))
    }

    /// The residue of a node, negated if the reference is negative.
    pub(crate) fn residue(&self, at: Ref) -> Residue {
        self.nodes[at.index()].residue.signed(at.is_negative())
    }

    /// Whether a node is the constant 0: exactly zero, not a number that rounds to zero.
    pub(crate) fn is_zero(&self, at: Ref) -> bool {
        match self.policy {
            Policy::Structure => self.number(at).is_some_and(|number| number.is_zero() && number.to_f64() == 0.0),
            _ => at.index() == 0,
        }
    }

    /// Whether a node is the constant 1 or -1.
    pub(super) fn is_unit(&self, at: Ref) -> bool {
        match self.policy {
            Policy::Structure => self.number(at).is_some_and(|number| number.is_unit() && number.to_f64().abs() == 1.0),
            _ => at.index() == 1,
        }
    }

    pub(crate) fn input(&mut self, input: Input) -> Ref {
        self.leaf(Op::Input(input), self.point.argument(input))
    }

    /// The sine of an angle: a sum of positions and constants.
    pub(crate) fn sine(&mut self, angle: Ref) -> Ref {
        let (sine, _) = self.turn_image(angle, &self.point);
        self.leaf(Op::Sine(angle), sine)
    }

    /// The cosine of an angle: a sum of positions and constants.
    pub(crate) fn cosine(&mut self, angle: Ref) -> Ref {
        let (_, cosine) = self.turn_image(angle, &self.point);
        self.leaf(Op::Cosine(angle), cosine)
    }

    /// Residues of sine and cosine of an angle at a point.
    fn turn_image(&self, angle: Ref, point: &SamplePoint) -> (Residue, Residue) {
        let (sine, cosine) = match self.op(angle) {
            Op::Input(input) => point.turn(input.index()),
            Op::Constant(_) => self
                .turn(angle.magnitude())
                .map_or((Residue::ZERO, Residue::ONE), |turn| (turn.sin.residue, turn.cos.residue)),
            Op::Sum(a, b) => composed(self.turn_image(a, point), self.turn_image(b, point)),
            Op::Product(a, b) => match (self.op(a), self.op(b)) {
                (Op::Input(input), Op::Constant(_)) => point.turn_times(input.index(), self.residue(b)),
                (Op::Constant(_), Op::Input(input)) => point.turn_times(input.index(), self.residue(a)),
                _ => (Residue::ZERO, Residue::ZERO),
            },
            _ => (Residue::ZERO, Residue::ZERO),
        };
        (sine.signed(angle.is_negative()), cosine)
    }

    /// The residue of a node at a point; `residues` are those of the nodes before it.
    pub(crate) fn image_at(&self, op: Op, residues: &[Residue], point: &SamplePoint) -> Residue {
        let residue = |at: Ref| at.residue(residues);
        match op {
            Op::Constant(place) => self.numbers.get(place).0.residue,
            Op::Input(input) => point.argument(input),
            Op::Sine(angle) => self.turn_image(angle, point).0,
            Op::Cosine(angle) => self.turn_image(angle, point).1,
            Op::Sum(a, b) => residue(a) + residue(b),
            Op::Product(a, b) => residue(a) * residue(b),
            Op::Quotient(a, b) => residue(a) * residue(b).inverse().unwrap_or(Residue::ZERO),
            Op::BySign(operands) => Residue::by_sign(operands.map(residue)),
        }
    }

    /// Returns a node that no operation computes, such as an argument. With policies that look up values, a node with
    /// the same value is used again.
    pub(super) fn leaf(&mut self, op: Op, residue: Residue) -> Ref {
        if self.policy == Policy::Structure {
            return self.intern(op, residue).0;
        }
        if let Some(known) = self.valued(residue) {
            return known;
        }
        let at = self.push(op, residue);
        self.remember_value(at);
        at
    }

    /// Returns the node with this value, or the negative of one, if equal values are one node.
    pub(super) fn numbered(&self, residue: Residue) -> Option<Ref> {
        if self.policy == Policy::Numbered { self.valued(residue) } else { None }
    }

    /// Returns the node with this value, or the negative of one, among the nodes whose values are looked up.
    pub(crate) fn valued(&self, residue: Residue) -> Option<Ref> {
        let (magnitude, negative) = canonical(residue);
        let is_it = |&index: &u32| canonical(self.nodes[index as usize].residue).0 == magnitude;
        let index = *self.values.find(magnitude.key(), is_it)?;
        let at = Ref::new(index as usize);
        Some(at.signed(negative != canonical(self.nodes[at.index()].residue).1))
    }

    fn remember_value(&mut self, at: Ref) {
        let Self { nodes, values, .. } = self;
        let hash = |index: u32| key(nodes[index as usize].residue);
        let index = u32::try_from(at.index()).unwrap_or(u32::MAX);
        values.insert_unique(hash(index), index, |&index| hash(index));
    }

    fn push(&mut self, op: Op, residue: Residue) -> Ref {
        self.nodes.push(Node { op, residue });
        Ref::new(self.nodes.len() - 1)
    }

    /// Returns the node of an operation on operands without signs; `negative` is the sign of the result.
    pub(super) fn node(&mut self, op: Op, residue: Residue, negative: bool) -> (Ref, Outcome) {
        if let Some(known) = self.numbered(residue) {
            return (known.signed(negative), Outcome::Shared);
        }
        let (at, outcome) = self.intern(op, residue);
        (at.signed(negative), outcome)
    }

    pub(super) fn intern(&mut self, op: Op, residue: Residue) -> (Ref, Outcome) {
        if self.policy == Policy::Numbered {
            // no node has this value yet
            let at = self.push(op, residue);
            self.remember_value(at);
            return (at, Outcome::Computed);
        }
        let (hash, sorted) = (op.key(), op.sorted());
        let is_it = |&index: &u32| self.nodes[index as usize].op.sorted() == sorted;
        if let Some(&known) = self.structures.find(hash, is_it) {
            return (Ref::new(known as usize), Outcome::Shared);
        }
        let at = self.push(op, residue);
        let index = u32::try_from(at.index()).unwrap_or(u32::MAX);
        let nodes = &self.nodes;
        self.structures.insert_unique(hash, index, |&index| nodes[index as usize].op.key());
        (at, Outcome::Computed)
    }

    /// Writes an operation of another graph into this one; `map` has the references here for the nodes there. A
    /// constant must have the same place in both graphs.
    pub(crate) fn transcribed(&mut self, op: Op, residue: Residue, map: &[Ref]) -> Ref {
        let mapped = |at: Ref| at.mapped(map);
        match op {
            Op::Constant(place) => self.constant_at(place),
            Op::Input(_) => self.leaf(op, residue),
            Op::Sine(angle) => self.leaf(Op::Sine(mapped(angle)), residue),
            Op::Cosine(angle) => self.leaf(Op::Cosine(mapped(angle)), residue),
            Op::Sum(a, b) => self.sum(mapped(a), mapped(b)).0,
            Op::Product(a, b) => self.product(mapped(a), mapped(b)).0,
            Op::Quotient(a, b) => self.quotient(mapped(a), mapped(b)).0,
            Op::BySign([x, a, b]) => self.by_sign(mapped(x), mapped(a), mapped(b)).0,
        }
    }
}
