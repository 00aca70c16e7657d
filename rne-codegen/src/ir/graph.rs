//! The expression graph: sums and products with free signs, every constant an exact number, every node with its residue
//! at one sample point of two prime fields.
//!
//! Who opens a graph chooses what its constructors may fold:
//!
//! - [`Policy::Structure`] folds only what is exact for finite values, up to the sign of zero: 0·x, 1·x, x + 0, x - x,
//!   a sign pulled out of a product or a sum, the order of two operands, and an operation of two constants, rounded as
//!   the runtime rounds it. So the graph computes the same bits as the unfolded formula.
//! - [`Policy::Value`] folds what is equal as numbers: what vanishes is zero whatever cancels, constant factors are
//!   gathered, c₁ x + c₂ x = (c₁ + c₂) x. With [`Policy::Numbered`] two nodes of one value, up to sign, are one node
//!   besides, however they came about: the first one written stays.

use std::collections::HashMap;
use std::ops::Neg;

use hashbrown::HashTable;
use rne_model::Angle;

use super::numbers::{Numbers, Source, canonical, key};
use super::{Image, Input, Number, Point, Reading, Turn, mark_live};

/// A node or its negative: negation costs no operation, so it lives in the reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Ref(u32);

impl Ref {
    pub(crate) fn new(index: usize) -> Self {
        Self(u32::try_from(index << 1).expect("a robot has at most 64 joints, its graph far fewer than 2^31 nodes"))
    }

    pub(crate) fn index(self) -> usize {
        (self.0 >> 1) as usize
    }

    pub(crate) fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    pub(crate) fn magnitude(self) -> Self {
        Self(self.0 & !1)
    }

    /// The reference, negated if `negative`.
    pub(crate) fn signed(self, negative: bool) -> Self {
        Self(self.0 ^ u32::from(negative))
    }

    /// What stands for it among `images` of nodes in another graph.
    pub(crate) fn mapped(self, images: &[Self]) -> Self {
        images[self.index()].signed(self.is_negative())
    }
}

impl Neg for Ref {
    type Output = Self;

    fn neg(self) -> Self {
        self.signed(true)
    }
}

/// What a node is. Operands always stand before the nodes that use them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Op {
    /// A constant, never negative: its place among the numbers.
    Constant(u32),
    /// An argument of the function.
    Input(Input),
    /// Sine of an angle.
    Sine(Ref),
    /// Cosine of an angle.
    Cosine(Ref),
    /// A sum; a difference has a negative operand.
    Sum(Ref, Ref),
    /// A product of two nodes, without signs.
    Product(Ref, Ref),
    /// A quotient of two nodes, without signs.
    Quotient(Ref, Ref),
    /// One of two values, by the sign of the first; 0 where that is 0.
    BySign([Ref; 3]),
}

impl Op {
    /// The references to other nodes.
    pub(crate) fn operands(self) -> impl Iterator<Item = Ref> {
        let operands = match self {
            Self::Constant(_) | Self::Input(_) => [None; 3],
            Self::Sine(angle) | Self::Cosine(angle) => [Some(angle), None, None],
            Self::Sum(a, b) | Self::Product(a, b) | Self::Quotient(a, b) => [Some(a), Some(b), None],
            Self::BySign(operands) => operands.map(Some),
        };
        operands.into_iter().flatten()
    }

    /// Whether it is computed by arithmetic.
    pub(crate) const fn is_operation(self) -> bool {
        matches!(self, Self::Sum(..) | Self::Product(..) | Self::Quotient(..) | Self::BySign(_))
    }

    /// The same for operations that are one whatever the order of their operands.
    fn sorted(self) -> Self {
        match self {
            // the sign of a difference is that of the second operand, which a swap would move
            Self::Sum(a, b) => {
                let negative = b.is_negative();
                let (a, b) = (a.magnitude().min(b.magnitude()), a.magnitude().max(b.magnitude()));
                Self::Sum(a, b.signed(negative))
            }
            Self::Product(a, b) => Self::Product(a.min(b), a.max(b)),
            other => other,
        }
    }

    /// A key under which an equal operation is found again.
    fn key(self) -> u64 {
        let (kind, a, b) = match self.sorted() {
            Self::Sum(a, b) => (1_u64, a.0, b.0),
            Self::Product(a, b) => (2, a.0, b.0),
            Self::Quotient(a, b) => (3, a.0, b.0),
            Self::Constant(place) => (4, place, 0),
            Self::Sine(angle) => (5, angle.0, 0),
            Self::Cosine(angle) => (6, angle.0, 0),
            Self::BySign([x, a, b]) => (7, x.0, a.0 ^ b.0.rotate_left(16)),
            Self::Input(input) => {
                (8, u32::try_from(input.index() & 0xFFFF).unwrap_or_default(), input.quantity() as u32)
            }
        };
        let mixed = ((kind << 60) ^ (u64::from(a) << 30) ^ u64::from(b)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        mixed ^ (mixed >> 32)
    }
}

/// A node and its residue at the sample point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) op: Op,
    pub(crate) image: Image,
}

/// What the constructors of a graph may fold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Policy {
    /// What is exact in floating point.
    Structure,
    /// What is equal as numbers.
    Value,
    /// The same, and equal values are one node.
    Numbered,
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

/// Nodes in order of creation, which is an order of evaluation too, and what is returned of them.
#[derive(Clone, Debug)]
pub(crate) struct Graph {
    pub(crate) nodes: Vec<Node>,
    pub(crate) numbers: Numbers,
    pub(crate) outputs: Vec<Ref>,
    policy: Policy,
    /// Where the residues are taken, and how constants are read there.
    pub(crate) point: Point,
    /// What constants are that are angles, by their places.
    turns: HashMap<u32, Turn>,
    /// Indices of nodes by operation and by value. Looked up, never iterated.
    structures: HashTable<u32>,
    values: HashTable<u32>,
}

impl Graph {
    pub(crate) fn new(policy: Policy, reading: Reading) -> Self {
        let mut graph = Self {
            nodes: Vec::new(),
            numbers: Numbers::default(),
            outputs: Vec::new(),
            policy,
            point: Point::new(reading, 0),
            turns: HashMap::new(),
            structures: HashTable::new(),
            values: HashTable::new(),
        };
        graph.clear(reading);
        graph
    }

    /// Empties the graph and keeps its memory.
    pub(crate) fn clear(&mut self, reading: Reading) {
        self.point = Point::new(reading, 0);
        self.numbers.clear();
        self.turns.clear();
        self.clear_nodes();
    }

    /// Empties the graph but for its constants, which keep their places. Where values are looked up, zero and one are
    /// always there, as the first two nodes.
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

    pub(crate) fn reading(&self) -> Reading {
        self.point.reading()
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Sums, products and quotients.
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

    /// The residue of a reference.
    pub(crate) fn image(&self, at: Ref) -> Image {
        let image = self.nodes[at.index()].image;
        if at.is_negative() { -image } else { image }
    }

    /// What a reference to a constant is exactly.
    pub(crate) fn number(&self, at: Ref) -> Option<Number> {
        let Op::Constant(place) = self.op(at) else { return None };
        let (number, _) = self.numbers.get(place);
        Some(if at.is_negative() { -number } else { number })
    }

    pub(crate) fn is_constant(&self, at: Ref) -> bool {
        matches!(self.op(at), Op::Constant(_))
    }

    /// Whether it is the constant 0: the number, not what rounds to it.
    pub(crate) fn is_zero(&self, at: Ref) -> bool {
        match self.policy {
            Policy::Structure => self.number(at).is_some_and(|number| number.is_zero() && number.to_f64() == 0.0),
            _ => at.index() == 0,
        }
    }

    /// Whether it is the constant 1 or -1.
    fn is_unit(&self, at: Ref) -> bool {
        match self.policy {
            Policy::Structure => self.number(at).is_some_and(|number| number.is_unit() && number.to_f64().abs() == 1.0),
            _ => at.index() == 1,
        }
    }

    /// The constant 0.
    pub(crate) fn zero(&mut self) -> Ref {
        self.constant(Number::ZERO)
    }

    /// The constant 1.
    pub(crate) fn one(&mut self) -> Ref {
        self.constant(Number::ONE)
    }

    pub(crate) fn constant(&mut self, number: Number) -> Ref {
        self.derived(number, Source::Given)
    }

    /// A constant that is an angle.
    pub(crate) fn angle(&mut self, turn: Turn) -> Ref {
        let at = self.constant(turn.angle());
        if let Op::Constant(place) = self.op(at) {
            self.turns.insert(place, if at.is_negative() { turn.back() } else { turn });
        }
        at
    }

    /// A constant of another graph, and what it is if it is an angle.
    pub(crate) fn constant_like(&mut self, other: &Self, place: u32) -> Ref {
        let at = self.constant(other.numbers.get(place).0);
        if let (Some(turn), Op::Constant(own)) = (other.turns.get(&place), self.op(at)) {
            self.turns.insert(own, *turn);
        }
        at
    }

    /// The places of its constants so far, without those that are angles.
    pub(crate) fn factors(&self) -> Vec<u32> {
        let places = (0..self.numbers.len()).filter_map(|place| u32::try_from(place).ok());
        places.filter(|place| !self.turns.contains_key(place)).collect()
    }

    /// What a constant is as an angle.
    pub(crate) fn turn(&self, at: Ref) -> Option<Turn> {
        let Op::Constant(place) = self.op(at) else { return None };
        let magnitude = || self.reading().turn(&Angle::new(self.numbers.get(place).0.to_f64()));
        let turn = self.turns.get(&place).copied().unwrap_or_else(magnitude);
        Some(if at.is_negative() { turn.back() } else { turn })
    }

    /// A constant made from others.
    fn derived(&mut self, number: Number, source: Source) -> Ref {
        let number =
            if self.policy == Policy::Structure { Number::rounded(number.to_f64(), number.image) } else { number };
        if let Some(known) = self.looked_up(number.image) {
            return known;
        }
        let place = if self.policy == Policy::Structure {
            self.numbers.intern(number.abs(), source, |a, b| a == b)
        } else {
            self.numbers.intern(number.abs(), source, |a, b| canonical(a.image).0 == canonical(b.image).0)
        };
        let negative = match self.policy {
            Policy::Structure => number.is_negative(),
            // what is there already may be the negative: the residue tells, as it does everywhere
            _ => self.numbers.get(place).0.image != number.image,
        };
        self.constant_at(place).signed(negative)
    }

    /// The constant of that place.
    pub(crate) fn constant_at(&mut self, place: u32) -> Ref {
        let image = self.numbers.get(place).0.image;
        self.leaf(Op::Constant(place), image)
    }

    /// The place of a constant, with the sign of the reference to it.
    fn place(&self, at: Ref) -> Option<Ref> {
        match self.op(at) {
            Op::Constant(place) => Some(Ref::new(place as usize).signed(at.is_negative())),
            _ => None,
        }
    }

    fn constant_sum(&mut self, a: Ref, b: Ref) -> Option<Ref> {
        let (x, y) = (self.number(a)?, self.number(b)?);
        let source = Source::Sum(self.place(a)?, self.place(b)?);
        let sum = match self.policy {
            Policy::Structure => Number::rounded(x.to_f64() + y.to_f64(), x.image + y.image),
            _ => x + y,
        };
        Some(self.derived(sum, source))
    }

    fn constant_product(&mut self, a: Ref, b: Ref) -> Option<Ref> {
        let (x, y) = (self.number(a)?, self.number(b)?);
        let source = Source::Product(self.place(a)?, self.place(b)?);
        let product = match self.policy {
            Policy::Structure => Number::rounded(x.to_f64() * y.to_f64(), x.image * y.image),
            _ => x * y,
        };
        Some(self.derived(product, source))
    }

    /// 1/a of a constant.
    pub(crate) fn constant_inverse(&mut self, a: Ref) -> Option<Ref> {
        let (x, place) = (self.number(a)?.inverse()?, self.place(a)?);
        Some(self.derived(x, Source::Inverse(u32::try_from(place.index()).ok()?)))
    }

    pub(crate) fn input(&mut self, input: Input) -> Ref {
        self.leaf(Op::Input(input), self.point.argument(input))
    }

    /// The sine of an angle: a sum of positions and constants.
    pub(crate) fn sine(&mut self, angle: Ref) -> Ref {
        let (sine, _) = self.turn_image(angle, &self.point);
        self.leaf(Op::Sine(angle), sine)
    }

    /// Its cosine.
    pub(crate) fn cosine(&mut self, angle: Ref) -> Ref {
        let (_, cosine) = self.turn_image(angle, &self.point);
        self.leaf(Op::Cosine(angle), cosine)
    }

    /// Residues of sine and cosine of an angle at a point.
    fn turn_image(&self, angle: Ref, point: &Point) -> (Image, Image) {
        let (sine, cosine) = match self.op(angle) {
            Op::Input(input) => point.turn(input.index()),
            Op::Constant(_) => {
                self.turn(angle.magnitude()).map_or((Image::ZERO, Image::ONE), |turn| (turn.sin.image, turn.cos.image))
            }
            Op::Sum(a, b) => {
                let ((s, c), (sine, cosine)) = (self.turn_image(a, point), self.turn_image(b, point));
                (s * cosine + c * sine, c * cosine - s * sine)
            }
            _ => (Image::ZERO, Image::ZERO),
        };
        (if angle.is_negative() { -sine } else { sine }, cosine)
    }

    /// The residue of a node at a point, when those before it are `images`.
    pub(crate) fn image_at(&self, op: Op, images: &[Image], point: &Point) -> Image {
        let of = |at: Ref| {
            let image = images[at.index()];
            if at.is_negative() { -image } else { image }
        };
        match op {
            Op::Constant(place) => self.numbers.get(place).0.image,
            Op::Input(input) => point.argument(input),
            Op::Sine(angle) => self.turn_image(angle, point).0,
            Op::Cosine(angle) => self.turn_image(angle, point).1,
            Op::Sum(a, b) => of(a) + of(b),
            Op::Product(a, b) => of(a) * of(b),
            Op::Quotient(a, b) => of(a) * of(b).inverse().unwrap_or(Image::ZERO),
            Op::BySign(operands) => Image::by_sign(operands.map(of)),
        }
    }

    /// a + b
    pub(crate) fn sum(&mut self, a: Ref, b: Ref) -> (Ref, Outcome) {
        if self.is_zero(b) {
            return (a, Outcome::Zero(Side::Right));
        }
        if self.is_zero(a) {
            return (b, Outcome::Zero(Side::Left));
        }
        if let Some(constant) = self.constant_sum(a, b) {
            return (constant, Outcome::Constants);
        }
        if a == -b {
            return (self.zero(), Outcome::Cancelled);
        }
        let image = self.image(a) + self.image(b);
        if self.policy == Policy::Structure {
            return self.sum_as_written(a, b, image);
        }
        if image.is_zero() {
            return (self.zero(), Outcome::Cancelled);
        }
        if let Some(known) = self.numbered(image) {
            return (known, Outcome::Shared);
        }
        // c₁ x + c₂ x = (c₁ + c₂) x
        let ((x, u), (y, v)) = (self.factored(a), self.factored(b));
        if x == y
            && let Some(factor) = self.constant_sum(u, v)
        {
            return self.product(factor, x);
        }
        let (a, b) = if a.index() > b.index() { (b, a) } else { (a, b) };
        let negative = a.is_negative();
        let op = Op::Sum(a.signed(negative), b.signed(negative));
        let (at, outcome) = self.intern(op, if negative { -image } else { image });
        (at.signed(negative), outcome)
    }

    /// A sum that keeps the order of its operands, for those who read it.
    fn sum_as_written(&mut self, a: Ref, b: Ref, image: Image) -> (Ref, Outcome) {
        // pull out the sign of the first operand: (-a) + b = -(a - b)
        let mut negative = a.is_negative();
        let (mut a, mut b) = (a.signed(negative), b.signed(negative));
        // a - b and b - a are one node: the one whose first operand is older
        if b.is_negative() && a.index() > b.index() {
            (a, b) = (-b, -a);
            negative = !negative;
        }
        let (at, outcome) = self.intern(Op::Sum(a, b), if negative { -image } else { image });
        (at.signed(negative), outcome)
    }

    /// a · b
    pub(crate) fn product(&mut self, a: Ref, b: Ref) -> (Ref, Outcome) {
        if self.is_zero(b) {
            return (b.magnitude(), Outcome::Zero(Side::Right));
        }
        if self.is_zero(a) {
            return (a.magnitude(), Outcome::Zero(Side::Left));
        }
        if self.is_unit(b) {
            return (a.signed(b.is_negative()), Outcome::One(Side::Right));
        }
        if self.is_unit(a) {
            return (b.signed(a.is_negative()), Outcome::One(Side::Left));
        }
        let negative = a.is_negative() != b.is_negative();
        let (mut a, mut b) = (a.magnitude(), b.magnitude());
        if let Some(constant) = self.constant_product(a, b) {
            return (constant.signed(negative), Outcome::Constants);
        }
        if self.policy != Policy::Structure {
            // a constant factor comes first, then the older one
            let is_factor = (self.is_constant(a), self.is_constant(b));
            if is_factor.1 || !is_factor.0 && a > b {
                (a, b) = (b, a);
            }
            // c₁ (c₂ x) = (c₁ c₂) x
            if (is_factor.0 || is_factor.1)
                && let Op::Product(inner, rest) = self.op(b)
                && let Some(factor) = self.constant_product(a, inner)
            {
                let (at, outcome) = self.product(factor, rest);
                return (at.signed(negative), outcome);
            }
        }
        let image = self.image(a) * self.image(b);
        if let Some(known) = self.numbered(image) {
            return (known.signed(negative), Outcome::Shared);
        }
        let (at, outcome) = self.intern(Op::Product(a, b), image);
        (at.signed(negative), outcome)
    }

    /// a / b. Only what is exact whatever b is folds; what is divided by zero is left to the code, whose result is not
    /// finite.
    pub(crate) fn quotient(&mut self, a: Ref, b: Ref) -> (Ref, Outcome) {
        if self.is_unit(b) {
            return (a.signed(b.is_negative()), Outcome::One(Side::Right));
        }
        if let Some(quotient) = self.constant_quotient(a, b) {
            return (quotient, Outcome::Constants);
        }
        let negative = a.is_negative() != b.is_negative();
        let (a, b) = (a.magnitude(), b.magnitude());
        let image = self.image(a) * self.image(b).inverse().unwrap_or(Image::ZERO);
        if let Some(known) = self.numbered(image) {
            return (known.signed(negative), Outcome::Shared);
        }
        let (at, outcome) = self.intern(Op::Quotient(a, b), image);
        (at.signed(negative), outcome)
    }

    fn constant_quotient(&mut self, a: Ref, b: Ref) -> Option<Ref> {
        let (x, y) = (self.number(a)?, self.number(b)?);
        if self.policy != Policy::Structure {
            let inverse = self.constant_inverse(b)?;
            return Some(self.product(a, inverse).0);
        }
        if y.to_f64() == 0.0 {
            return None;
        }
        Some(self.constant(Number::rounded(x.to_f64() / y.to_f64(), x.image * y.image.inverse()?)))
    }

    /// `positive` where x > 0, `negative` where x < 0, else 0.
    pub(crate) fn by_sign(&mut self, x: Ref, positive: Ref, negative: Ref) -> (Ref, Outcome) {
        if self.is_zero(positive) && self.is_zero(negative) {
            return (self.zero(), Outcome::Constants);
        }
        let operands = [x, positive, negative];
        let image = Image::by_sign(operands.map(|at| self.image(at)));
        self.intern(Op::BySign(operands), image)
    }

    /// A term as a constant times something: the something, and the constant as a reference.
    fn factored(&self, at: Ref) -> (Ref, Ref) {
        if let Op::Product(factor, rest) = self.op(at)
            && let Op::Constant(_) = self.op(factor)
        {
            return (rest, factor.signed(at.is_negative()));
        }
        (at.magnitude(), Ref::new(1).signed(at.is_negative()))
    }

    /// What no operation computes: by value where values are looked up.
    fn leaf(&mut self, op: Op, image: Image) -> Ref {
        if self.policy == Policy::Structure {
            return self.intern(op, image).0;
        }
        if let Some(known) = self.valued(image) {
            return known;
        }
        let at = self.push(op, image);
        self.remember_value(at);
        at
    }

    /// A constant of that value; where structure decides, numbers do.
    fn looked_up(&self, image: Image) -> Option<Ref> {
        if self.policy == Policy::Structure { None } else { self.valued(image) }
    }

    /// The node of that value, or the negative of one, where equal values are one node.
    fn numbered(&self, image: Image) -> Option<Ref> {
        if self.policy == Policy::Numbered { self.valued(image) } else { None }
    }

    /// The node of that value, or the negative of one, among those whose values are looked up.
    pub(crate) fn valued(&self, image: Image) -> Option<Ref> {
        let (magnitude, negative) = canonical(image);
        let is_it = |&index: &u32| canonical(self.nodes[index as usize].image).0 == magnitude;
        let index = *self.values.find(magnitude.key(), is_it)?;
        let at = Ref::new(index as usize);
        Some(at.signed(negative != canonical(self.nodes[at.index()].image).1))
    }

    fn remember_value(&mut self, at: Ref) {
        let Self { nodes, values, .. } = self;
        let hash = |index: u32| key(nodes[index as usize].image);
        let index = u32::try_from(at.index()).unwrap_or(u32::MAX);
        values.insert_unique(hash(index), index, |&index| hash(index));
    }

    fn push(&mut self, op: Op, image: Image) -> Ref {
        self.nodes.push(Node { op, image });
        Ref::new(self.nodes.len() - 1)
    }

    fn intern(&mut self, op: Op, image: Image) -> (Ref, Outcome) {
        if self.policy == Policy::Numbered {
            // nothing of that value was there
            let at = self.push(op, image);
            self.remember_value(at);
            return (at, Outcome::Computed);
        }
        let (hash, sorted) = (op.key(), op.sorted());
        let is_it = |&index: &u32| self.nodes[index as usize].op.sorted() == sorted;
        if let Some(&known) = self.structures.find(hash, is_it) {
            return (Ref::new(known as usize), Outcome::Shared);
        }
        let at = self.push(op, image);
        let index = u32::try_from(at.index()).unwrap_or(u32::MAX);
        let nodes = &self.nodes;
        self.structures.insert_unique(hash, index, |&index| nodes[index as usize].op.key());
        (at, Outcome::Computed)
    }

    /// An operation of another graph, whose operands are `map` here. Constants have places of their own.
    pub(crate) fn transcribed(&mut self, op: Op, image: Image, map: &[Ref]) -> Ref {
        let mapped = |at: Ref| at.mapped(map);
        match op {
            Op::Constant(place) => self.constant_at(place),
            Op::Input(_) => self.leaf(op, image),
            Op::Sine(angle) => self.leaf(Op::Sine(mapped(angle)), image),
            Op::Cosine(angle) => self.leaf(Op::Cosine(mapped(angle)), image),
            Op::Sum(a, b) => self.sum(mapped(a), mapped(b)).0,
            Op::Product(a, b) => self.product(mapped(a), mapped(b)).0,
            Op::Quotient(a, b) => self.quotient(mapped(a), mapped(b)).0,
            Op::BySign([x, a, b]) => self.by_sign(mapped(x), mapped(a), mapped(b)).0,
        }
    }

    /// Operations of what is returned.
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

/// Products, sums and angles of a graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cost {
    /// Products.
    pub mul: usize,
    /// Sums, those of angles included.
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

    /// What a search makes small.
    #[must_use]
    pub const fn weight(&self) -> usize {
        self.total() + Self::ANGLE * self.sincos
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ir::name::Name;
    use crate::ir::quantity::Quantity;

    fn inputs(policy: Policy) -> (Graph, Ref, Ref) {
        let mut graph = Graph::new(policy, Reading::default());
        let [a, b] = [0, 1].map(|joint| graph.input(Input::new(Name::scalar(Quantity::Rate, joint + 1))));
        (graph, a, b)
    }

    fn constant(graph: &mut Graph, value: f64) -> Ref {
        graph.constant(graph.reading().decimal(value))
    }

    #[test]
    fn exact_identities_fold() {
        for policy in [Policy::Structure, Policy::Value, Policy::Numbered] {
            let (mut graph, a, _) = inputs(policy);
            let [zero, one, two] = [0.0, 1.0, 2.0].map(|value| constant(&mut graph, value));
            assert_eq!(graph.product(zero, a), (zero, Outcome::Zero(Side::Left)));
            assert_eq!(graph.product(a, zero), (zero, Outcome::Zero(Side::Right)));
            assert_eq!(graph.product(one, a), (a, Outcome::One(Side::Left)));
            assert_eq!(graph.product(a, -one), (-a, Outcome::One(Side::Right)));
            assert_eq!(graph.sum(a, zero), (a, Outcome::Zero(Side::Right)));
            assert_eq!(graph.sum(zero, -a), (-a, Outcome::Zero(Side::Left)));
            assert_eq!(graph.sum(a, -a), (zero, Outcome::Cancelled));
            assert_eq!(graph.sum(one, one), (two, Outcome::Constants));
        }
    }

    #[test]
    fn signs_and_order_do_not_make_new_nodes() {
        for policy in [Policy::Structure, Policy::Value, Policy::Numbered] {
            let (mut graph, a, b) = inputs(policy);
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
    }

    #[test]
    fn structure_leaves_alone_what_is_not_exact() {
        let (mut graph, a, b) = inputs(Policy::Structure);
        let (two, three) = (constant(&mut graph, 2.0), constant(&mut graph, 3.0));
        let (inner, _) = graph.product(three, a);
        assert_eq!(graph.product(two, inner).1, Outcome::Computed, "2·(3·a) is not 6·a in floating point");
        let (sum, _) = graph.sum(a, b);
        let (other, _) = graph.sum(sum, -b);
        assert_ne!(other, a, "(a + b) - b is not a");
        let [zero, one] = [0.0, 1.0].map(|value| constant(&mut graph, value));
        assert_eq!(graph.quotient(one, zero).1, Outcome::Computed, "infinity is no number of the table");
        let [x, y] = [0.1, 0.2].map(|value| constant(&mut graph, value));
        let (sum, _) = graph.sum(x, y);
        assert_eq!(graph.number(sum).map(Number::to_f64), Some(0.1 + 0.2), "constants are rounded as the runtime does");
    }

    #[test]
    fn values_fold_what_is_equal() {
        let (mut graph, a, b) = inputs(Policy::Value);
        let (two, three, six) = (constant(&mut graph, 2.0), constant(&mut graph, 3.0), constant(&mut graph, 6.0));
        let (inner, _) = graph.product(three, a);
        assert_eq!(graph.product(two, inner).0, graph.product(six, a).0);
        let (twice, _) = graph.product(two, a);
        assert_eq!(graph.sum(inner, -twice).0, a);
        let (sum, _) = graph.sum(a, b);
        assert_ne!(graph.sum(sum, -b).0, a, "only a numbered graph looks at values");
        let (mut graph, a, b) = inputs(Policy::Numbered);
        let (sum, _) = graph.sum(a, b);
        assert_eq!(graph.sum(sum, -b), (a, Outcome::Shared));
        // (a + b)(a - b) = a² - b²
        let (difference, _) = graph.sum(a, -b);
        let (product, _) = graph.product(sum, difference);
        let (squares, _) = (graph.product(a, a), graph.product(b, b));
        let (b_squared, _) = graph.product(b, b);
        assert_eq!(graph.sum(squares.0, -b_squared), (product, Outcome::Shared));
    }
}
