//! The constants of a graph: exact numbers, each stored once, and the operations on them.

use rne_model::Angle;

use super::{ExactAngle, Graph, Number, Op, Policy, Ref, numbers::Source, numbers::canonical};

impl Graph {
    /// The exact number of a reference to a constant.
    pub(crate) fn number(&self, at: Ref) -> Option<Number> {
        let Op::Constant(place) = self.op(at) else { return None };
        let (number, _) = self.numbers.get(place);
        Some(if at.is_negative() { -number } else { number })
    }

    pub(crate) fn is_constant(&self, at: Ref) -> bool {
        matches!(self.op(at), Op::Constant(_))
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
    pub(crate) fn angle(&mut self, turn: ExactAngle) -> Ref {
        let at = self.constant(turn.angle());
        if let Op::Constant(place) = self.op(at) {
            self.turns.insert(place, if at.is_negative() { turn.back() } else { turn });
        }
        at
    }

    /// Copies a constant of another graph, with its sine and cosine if it is an angle.
    pub(crate) fn constant_like(&mut self, other: &Self, place: u32) -> Ref {
        let at = self.constant(other.numbers.get(place).0);
        if let (Some(turn), Op::Constant(own)) = (other.turns.get(&place), self.op(at)) {
            self.turns.insert(own, *turn);
        }
        at
    }

    /// The places of the constants that the graph has now, without angles.
    pub(crate) fn factors(&self) -> Vec<u32> {
        let places = (0..self.numbers.len()).filter_map(|place| u32::try_from(place).ok());
        places.filter(|place| !self.turns.contains_key(place)).collect()
    }

    /// Returns sine and cosine of a constant, if it was made as an angle.
    pub(crate) fn known_turn(&self, at: Ref) -> Option<ExactAngle> {
        let Op::Constant(place) = self.op(at) else { return None };
        self.turns.get(&place).map(|&turn| if at.is_negative() { turn.back() } else { turn })
    }

    /// Returns sine and cosine of a constant that is an angle.
    pub(crate) fn turn(&self, at: Ref) -> Option<ExactAngle> {
        let Op::Constant(place) = self.op(at) else { return None };
        let magnitude = || self.embedding().turn(&Angle::new(self.numbers.get(place).0.to_f64()));
        let turn = self.turns.get(&place).copied().unwrap_or_else(magnitude);
        Some(if at.is_negative() { turn.back() } else { turn })
    }

    /// Returns the constant with this number; `source` says how the number was computed.
    fn derived(&mut self, number: Number, source: Source) -> Ref {
        let number =
            if self.policy == Policy::Structure { Number::rounded(number.to_f64(), number.residue) } else { number };
        if self.policy != Policy::Structure
            && let Some(known) = self.valued(number.residue)
        {
            return known;
        }
        let place = if self.policy == Policy::Structure {
            self.numbers.intern(number.abs(), source, |a, b| a == b)
        } else {
            self.numbers.intern(number.abs(), source, |a, b| canonical(a.residue).0 == canonical(b.residue).0)
        };
        let negative = match self.policy {
            Policy::Structure => number.is_negative(),
            // the number at this place may be the negative one: residues decide, as everywhere
            _ => self.numbers.get(place).0.residue != number.residue,
        };
        self.constant_at(place).signed(negative)
    }

    /// Returns the constant at a place in the list of numbers.
    pub(crate) fn constant_at(&mut self, place: u32) -> Ref {
        let residue = self.numbers.get(place).0.residue;
        self.leaf(Op::Constant(place), residue)
    }

    /// The place of a constant, with the sign of the reference to it.
    fn place(&self, at: Ref) -> Option<Ref> {
        let Op::Constant(place) = self.op(at) else { return None };
        Some(Ref::new(place as usize).signed(at.is_negative()))
    }

    pub(super) fn constant_sum(&mut self, a: Ref, b: Ref) -> Option<Ref> {
        let (x, y) = (self.number(a)?, self.number(b)?);
        let source = Source::Sum(self.place(a)?, self.place(b)?);
        let sum = match self.policy {
            Policy::Structure => Number::rounded(x.to_f64() + y.to_f64(), x.residue + y.residue),
            _ => x + y,
        };
        Some(self.derived(sum, source))
    }

    pub(super) fn constant_product(&mut self, a: Ref, b: Ref) -> Option<Ref> {
        let (x, y) = (self.number(a)?, self.number(b)?);
        let source = Source::Product(self.place(a)?, self.place(b)?);
        let product = match self.policy {
            Policy::Structure => Number::rounded(x.to_f64() * y.to_f64(), x.residue * y.residue),
            _ => x * y,
        };
        Some(self.derived(product, source))
    }

    /// 1/a, if a is a constant that is not zero.
    pub(crate) fn constant_inverse(&mut self, a: Ref) -> Option<Ref> {
        let (x, place) = (self.number(a)?.inverse()?, self.place(a)?);
        Some(self.derived(x, Source::Inverse(u32::try_from(place.index()).ok()?)))
    }

    pub(super) fn constant_quotient(&mut self, a: Ref, b: Ref) -> Option<Ref> {
        let (x, y) = (self.number(a)?, self.number(b)?);
        if self.policy != Policy::Structure {
            let inverse = self.constant_inverse(b)?;
            return Some(self.product(a, inverse).0);
        }
        if y.to_f64() == 0.0 {
            return None;
        }
        Some(self.constant(Number::rounded(x.to_f64() / y.to_f64(), x.residue * y.residue.inverse()?)))
    }
}
