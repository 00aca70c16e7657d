//! The nodes of a graph and the references to them.

use std::ops::Neg;

use super::{Input, Residue};

/// A reference to a node or to its negative. Negation costs no operation, so the sign is part of the reference.
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

    /// The residue of the value, if `values` are the residues of the nodes.
    pub(crate) fn residue(self, values: &[Residue]) -> Residue {
        values[self.index()].signed(self.is_negative())
    }

    /// The reference in another graph; `nodes` has the references there for the nodes of this graph.
    pub(crate) fn mapped(self, nodes: &[Self]) -> Self {
        nodes[self.index()].signed(self.is_negative())
    }
}

impl Neg for Ref {
    type Output = Self;

    fn neg(self) -> Self {
        self.signed(true)
    }
}

/// The operation of a node. Operands always come before the nodes that use them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Op {
    /// A constant by its place among the numbers; it is never negative.
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
    /// `[x, a, b]`: a where x is positive, b where x is negative, 0 where x is 0.
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

    /// The operation with operands in another graph; `nodes` has the references there for the nodes of this graph.
    pub(super) fn mapped(self, nodes: &[Ref]) -> Self {
        let mapped = |at: Ref| at.mapped(nodes);
        match self {
            Self::Constant(_) | Self::Input(_) => self,
            Self::Sine(angle) => Self::Sine(mapped(angle)),
            Self::Cosine(angle) => Self::Cosine(mapped(angle)),
            Self::Sum(a, b) => Self::Sum(mapped(a), mapped(b)),
            Self::Product(a, b) => Self::Product(mapped(a), mapped(b)),
            Self::Quotient(a, b) => Self::Quotient(mapped(a), mapped(b)),
            Self::BySign(operands) => Self::BySign(operands.map(mapped)),
        }
    }

    /// Whether it is computed by arithmetic.
    pub(crate) const fn is_operation(self) -> bool {
        matches!(self, Self::Sum(..) | Self::Product(..) | Self::Quotient(..) | Self::BySign(_))
    }

    /// The operation with its operands sorted, where their order does not matter.
    pub(super) fn sorted(self) -> Self {
        match self {
            // a difference has its sign at the second operand, and the swap must keep it there
            Self::Sum(a, b) => {
                let negative = b.is_negative();
                let (a, b) = (a.magnitude().min(b.magnitude()), a.magnitude().max(b.magnitude()));
                Self::Sum(a, b.signed(negative))
            }
            Self::Product(a, b) => Self::Product(a.min(b), a.max(b)),
            other => other,
        }
    }

    /// A hash that equal operations share, whatever the order of their operands.
    pub(super) fn key(self) -> u64 {
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
    pub(crate) residue: Residue,
}
