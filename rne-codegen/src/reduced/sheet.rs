//! The graph on which the reduced form is written: sums and products that know what they are equal to.
//!
//! Every node carries its image at one random point of two prime fields. What is identically zero is zero there, whatever
//! cancels, and two nodes that are equal up to sign have one image up to sign. Signs live in references and cost nothing.

use std::ops::Neg;

use super::numbers::{Numbers, Source, canonical, value_slot};
use crate::exact::{Image, Number};

/// A node or its negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Ref(u32);

impl Ref {
    pub(crate) fn new(index: usize) -> Self {
        Self(u32::try_from(index << 1).unwrap_or(u32::MAX))
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

    pub(crate) fn signed(self, negative: bool) -> Self {
        Self(self.0 ^ u32::from(negative))
    }
}

impl Neg for Ref {
    type Output = Self;

    fn neg(self) -> Self {
        self.signed(true)
    }
}

/// What a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Op {
    /// A constant: its place among the numbers.
    Constant(u32),
    /// An argument, or the sine or cosine of an angle.
    Leaf(Leaf),
    Sum(Ref, Ref),
    /// A constant factor comes first.
    Product(Ref, Ref),
    /// 1/a
    Inverse(Ref),
}

/// Where the numbers come from that no operation makes. Joints count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Leaf {
    Position(u8),
    Rate(u8),
    RateDot(u8),
    /// τ of an actuator.
    Torque(u8),
    Force(u8),
    Moment(u8),
    /// Sine of the position of a joint, as an argument.
    GivenSine(u8),
    GivenCosine(u8),
    /// Sine of the summed angle of these joints, the first one counted positive.
    Sine(u8, u8),
    Cosine(u8, u8),
}

/// A node and its image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) op: Op,
    pub(crate) image: Image,
}

/// When two nodes are one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) enum Identity {
    /// The same operation on the same operands.
    #[default]
    Structure,
    /// The same value up to sign, however it was computed: the first one written stays.
    Value,
}

/// Operands always stand before the nodes that use them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sheet {
    pub(crate) nodes: Vec<Node>,
    pub(crate) numbers: Numbers,
    identity: Identity,
    /// Open addressing; 0 is empty, otherwise the index of a node plus one. Never iterated.
    structures: Vec<u32>,
    values: Vec<u32>,
    valued: usize,
}

impl Sheet {
    pub(crate) fn new(identity: Identity) -> Self {
        let mut sheet = Self { identity, structures: vec![0; 4096], values: vec![0; 2048], ..Self::default() };
        sheet.clear();
        sheet
    }

    /// Empties the sheet and keeps its memory. Zero and one are always there.
    pub(crate) fn clear(&mut self) {
        self.numbers.clear();
        self.clear_nodes();
    }

    /// Empties the sheet but for its constants, which keep their places.
    pub(crate) fn clear_nodes(&mut self) {
        self.nodes.clear();
        self.structures.fill(0);
        self.values.fill(0);
        self.valued = 0;
        let _ = (self.constant(Number::ZERO), self.constant(Number::ONE));
    }

    pub(crate) fn zero() -> Ref {
        Ref::new(0)
    }

    pub(crate) fn op(&self, at: Ref) -> Op {
        self.nodes[at.index()].op
    }

    pub(crate) fn image(&self, at: Ref) -> Image {
        let image = self.nodes[at.index()].image;
        if at.is_negative() { -image } else { image }
    }

    /// The value of a reference to a constant.
    pub(crate) fn number(&self, at: Ref) -> Option<Number> {
        match self.op(at) {
            Op::Constant(index) => {
                let (number, _) = self.numbers.get(index);
                Some(if at.is_negative() { -number } else { number })
            }
            _ => None,
        }
    }

    pub(crate) fn constant(&mut self, number: Number) -> Ref {
        self.derived(number, Source::Given)
    }

    /// A constant made from others.
    pub(crate) fn derived(&mut self, number: Number, source: Source) -> Ref {
        if let Some(known) = self.valued(number.image) {
            return known;
        }
        let place = self.numbers.intern(number.abs(), source);
        self.constant_at(place).signed(number.is_negative())
    }

    /// The constant of that place.
    pub(crate) fn constant_at(&mut self, place: u32) -> Ref {
        let (number, _) = self.numbers.get(place);
        if let Some(known) = self.valued(number.image) {
            return known;
        }
        let at = self.push(Op::Constant(place), number.image);
        self.remember_value(at.index());
        at
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
        Some(self.derived(x + y, source))
    }

    fn constant_product(&mut self, a: Ref, b: Ref) -> Option<Ref> {
        let (x, y) = (self.number(a)?, self.number(b)?);
        let source = Source::Product(self.place(a)?, self.place(b)?);
        Some(self.derived(x * y, source))
    }

    /// 1/a of a constant.
    pub(crate) fn constant_inverse(&mut self, a: Ref) -> Option<Ref> {
        let (x, place) = (self.number(a)?.inverse()?, self.place(a)?);
        Some(self.derived(x, Source::Inverse(u32::try_from(place.index()).ok()?)))
    }

    pub(crate) fn leaf(&mut self, leaf: Leaf, image: Image) -> Ref {
        if let Some(known) = self.valued(image) {
            return known;
        }
        let at = self.push(Op::Leaf(leaf), image);
        self.remember_value(at.index());
        at
    }

    /// a + b
    pub(crate) fn sum(&mut self, a: Ref, b: Ref) -> Ref {
        if b == Self::zero() {
            return a;
        }
        if a == Self::zero() {
            return b;
        }
        if let Some(constant) = self.constant_sum(a, b) {
            return constant;
        }
        let image = self.image(a) + self.image(b);
        if image.is_zero() {
            return Self::zero();
        }
        if self.identity == Identity::Value
            && let Some(known) = self.valued(image)
        {
            return known;
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
        self.intern(Op::Sum(a.signed(negative), b.signed(negative)), if negative { -image } else { image })
            .signed(negative)
    }

    /// a · b
    pub(crate) fn product(&mut self, a: Ref, b: Ref) -> Ref {
        if a.magnitude() == Self::zero() || b.magnitude() == Self::zero() {
            return Self::zero();
        }
        let negative = a.is_negative() != b.is_negative();
        let (a, b) = (a.magnitude(), b.magnitude());
        let one = Ref::new(1);
        if a == one || b == one {
            return (if a == one { b } else { a }).signed(negative);
        }
        if let Some(constant) = self.constant_product(a, b) {
            return constant.signed(negative);
        }
        let (a, b) = if self.is_constant(b) { (b, a) } else { (a, b) };
        let has_factor = self.is_constant(a);
        // c₁ (c₂ x) = (c₁ c₂) x
        if has_factor
            && let Op::Product(inner, rest) = self.op(b)
            && let Some(factor) = self.constant_product(a, inner)
        {
            return self.product(factor, rest).signed(negative);
        }
        let image = self.image(a) * self.image(b);
        if self.identity == Identity::Value
            && let Some(known) = self.valued(image)
        {
            return known.signed(negative);
        }
        let (a, b) = if !has_factor && a > b { (b, a) } else { (a, b) };
        self.intern(Op::Product(a, b), image).signed(negative)
    }

    /// 1/a
    pub(crate) fn inverse(&mut self, a: Ref) -> Ref {
        if let Some(constant) = self.constant_inverse(a) {
            return constant;
        }
        let (negative, a) = (a.is_negative(), a.magnitude());
        let image = self.image(a).inverse().unwrap_or(Image::ZERO);
        if self.identity == Identity::Value
            && let Some(known) = self.valued(image)
        {
            return known.signed(negative);
        }
        self.intern(Op::Inverse(a), image).signed(negative)
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

    pub(crate) fn is_constant(&self, at: Ref) -> bool {
        matches!(self.op(at), Op::Constant(_))
    }

    fn push(&mut self, op: Op, image: Image) -> Ref {
        self.nodes.push(Node { op, image });
        Ref::new(self.nodes.len() - 1)
    }

    fn intern(&mut self, op: Op, image: Image) -> Ref {
        if self.identity == Identity::Value {
            let at = self.push(op, image);
            self.remember_value(at.index());
            return at;
        }
        let mask = self.structures.len() - 1;
        let mut slot = hash(op) & mask;
        loop {
            match self.structures[slot] {
                0 => break,
                entry => {
                    let index = entry as usize - 1;
                    if self.nodes[index].op == op {
                        return Ref::new(index);
                    }
                }
            }
            slot = (slot + 1) & mask;
        }
        let at = self.push(op, image);
        self.structures[slot] = u32::try_from(at.index() + 1).unwrap_or(u32::MAX);
        if self.nodes.len() * 2 > self.structures.len() {
            self.grow_structures();
        }
        at
    }

    fn grow_structures(&mut self) {
        self.structures = vec![0; self.structures.len() * 2];
        let mask = self.structures.len() - 1;
        for (index, node) in self.nodes.iter().enumerate() {
            if matches!(node.op, Op::Sum(..) | Op::Product(..) | Op::Inverse(_)) {
                let mut slot = hash(node.op) & mask;
                while self.structures[slot] != 0 {
                    slot = (slot + 1) & mask;
                }
                self.structures[slot] = u32::try_from(index + 1).unwrap_or(u32::MAX);
            }
        }
    }

    /// The node of that value, or the negative of one.
    pub(crate) fn valued(&self, image: Image) -> Option<Ref> {
        let (magnitude, negative) = canonical(image);
        let mask = self.values.len() - 1;
        let mut slot = value_slot(magnitude, mask);
        loop {
            match self.values[slot] {
                0 => return None,
                entry => {
                    let at = Ref::new(entry as usize - 1);
                    let (other, other_negative) = canonical(self.nodes[at.index()].image);
                    if other == magnitude {
                        return Some(at.signed(negative != other_negative));
                    }
                }
            }
            slot = (slot + 1) & mask;
        }
    }

    fn remember_value(&mut self, index: usize) {
        let mask = self.values.len() - 1;
        let mut slot = value_slot(canonical(self.nodes[index].image).0, mask);
        while self.values[slot] != 0 {
            slot = (slot + 1) & mask;
        }
        self.values[slot] = u32::try_from(index + 1).unwrap_or(u32::MAX);
        self.valued += 1;
        if self.valued * 2 > self.values.len() {
            let entries: Vec<u32> = self.values.iter().copied().filter(|&entry| entry != 0).collect();
            self.values = vec![0; self.values.len() * 2];
            let mask = self.values.len() - 1;
            for entry in entries {
                let mut slot = value_slot(canonical(self.nodes[entry as usize - 1].image).0, mask);
                while self.values[slot] != 0 {
                    slot = (slot + 1) & mask;
                }
                self.values[slot] = entry;
            }
        }
    }
}

fn hash(op: Op) -> usize {
    let (kind, a, b) = match op {
        Op::Sum(a, b) => (1_u64, a.0, b.0),
        Op::Product(a, b) => (2, a.0, b.0),
        Op::Constant(index) => (3, index, 0),
        Op::Leaf(_) => (4, 0, 0),
        Op::Inverse(a) => (5, a.0, 0),
    };
    let key = (kind << 62) ^ (u64::from(a) << 31) ^ u64::from(b);
    #[allow(clippy::cast_possible_truncation)] // the upper half is mixed best
    let hash = (key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32) as usize;
    hash
}

/// What is live of a sheet, with equal values merged.
#[derive(Clone, Debug)]
pub(crate) struct Dag {
    pub(crate) sheet: Sheet,
    pub(crate) outputs: Vec<Ref>,
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

impl Dag {
    /// The live nodes of a sheet, written once more in their order with values as identity.
    pub(crate) fn rewrite_from(&mut self, sheet: &Sheet, outputs: &[Ref], live: &mut Vec<bool>) {
        mark_live(&sheet.nodes, outputs, live);
        let target = &mut self.sheet;
        target.clear();
        let mut map: Vec<Ref> = vec![Sheet::zero(); sheet.nodes.len()];
        for (index, node) in sheet.nodes.iter().enumerate() {
            if !live[index] {
                continue;
            }
            let mapped = |at: Ref| map[at.index()].signed(at.is_negative());
            map[index] = match node.op {
                Op::Constant(place) => target.constant(sheet.numbers.get(place).0),
                Op::Leaf(leaf) => target.leaf(leaf, node.image),
                Op::Sum(a, b) => target.sum(mapped(a), mapped(b)),
                Op::Product(a, b) => target.product(mapped(a), mapped(b)),
                Op::Inverse(a) => target.inverse(mapped(a)),
            };
        }
        self.outputs.clear();
        self.outputs.extend(outputs.iter().map(|at| map[at.index()].signed(at.is_negative())));
    }

    /// Operations of what is live. `has_constant` tells whether the angle of these joints has a constant part.
    pub(crate) fn cost(&self, live: &mut Vec<bool>, has_constant: impl Fn(u8, u8) -> bool) -> Cost {
        mark_live(&self.sheet.nodes, &self.outputs, live);
        let mut cost = Cost::default();
        let mut angles: Vec<(u8, u8)> = Vec::new();
        for (node, _) in self.sheet.nodes.iter().zip(live.iter()).filter(|(_, live)| **live) {
            match node.op {
                Op::Sum(..) => cost.add += 1,
                Op::Product(..) => cost.mul += 1,
                Op::Leaf(Leaf::Sine(first, last) | Leaf::Cosine(first, last)) if !angles.contains(&(first, last)) => {
                    angles.push((first, last));
                }
                _ => {}
            }
        }
        cost.sincos = angles.len();
        for &(first, last) in &angles {
            cost.add += usize::from(has_constant(first, last));
            // the sums of a group share their beginnings
            let longest = angles.iter().filter(|other| other.0 == first).map(|other| other.1).max();
            if longest == Some(last) {
                cost.add += usize::from(last - first);
            }
        }
        cost
    }
}

/// Marks what the outputs depend on.
pub(crate) fn mark_live(nodes: &[Node], outputs: &[Ref], live: &mut Vec<bool>) {
    live.clear();
    live.resize(nodes.len(), false);
    for at in outputs {
        live[at.index()] = true;
    }
    for (index, node) in nodes.iter().enumerate().rev() {
        match node.op {
            Op::Sum(a, b) | Op::Product(a, b) if live[index] => {
                live[a.index()] = true;
                live[b.index()] = true;
            }
            Op::Inverse(a) if live[index] => live[a.index()] = true,
            _ => {}
        }
    }
}
