//! Writes the values of a program, statement by statement, with signs where they cost nothing.

use rustc_hash::FxHashMap;

use super::{Definition, Lowering, Returned};
use crate::ir::{Name, Op, Operator, Place, Quantity, Ref, Step};
use crate::program::{Output, SineCosine, Statement};
use crate::values::{Value, ValueId, Values};

/// Writes the values of a program.
pub(super) struct Writing<'w> {
    pub(super) lowering: &'w Lowering<'w>,
    pub(super) values: Values,
    pub(super) known: FxHashMap<Name, ValueId>,
}

impl Writing<'_> {
    pub(super) fn leaf(&mut self, name: Name, value: Value) {
        let id = self.values.push(Some(name), value);
        self.known.insert(name, id);
    }

    pub(super) fn statement(&mut self, definition: &Definition) -> Statement {
        let Definition { place, name, at, .. } = *definition;
        let value = if definition.is_node {
            let (negative, value) = self.operation(at.magnitude());
            self.signed(negative != at.is_negative(), value)
        } else {
            self.value(at)
        };
        let value = self.values.named(name, value);
        self.known.insert(name, value);
        Statement { place, name, value }
    }

    pub(super) fn output(&mut self, name: Name, returned: &Returned) -> Output {
        let value = match *returned {
            Returned::Statement => self.known(name),
            Returned::Value(at) => self.value(at),
        };
        Output { name, value }
    }

    fn known(&self, name: Name) -> ValueId {
        *self.known.get(&name).expect("what has a name is written before it is used")
    }

    /// The sines and cosines, in the order in which they were asked for.
    pub(super) fn sines_and_cosines(&mut self) -> Vec<SineCosine> {
        let mut turns: Vec<(Ref, SineCosine)> = Vec::new();
        for (id, node) in self.lowering.live_nodes() {
            let (Op::Sine(angle) | Op::Cosine(angle)) = node else { continue };
            let name = self.lowering.names[id.index()].map(|given| given.name);
            let known = turns.iter().position(|(other, _)| *other == angle);
            let index = known.unwrap_or_else(|| {
                let joint = name.map_or(0, |name| name.joint);
                let place = Place { joint, step: Step::AngularVelocity, quantity: Quantity::Sine, by: None };
                turns.push((angle, SineCosine { place, sine: None, cosine: None, angle: self.value(angle) }));
                turns.len() - 1
            });
            let turn = &mut turns[index].1;
            *(if matches!(node, Op::Sine(_)) { &mut turn.sine } else { &mut turn.cosine }) = name;
        }
        let turns: Vec<SineCosine> = turns.into_iter().map(|(_, turn)| turn).collect();
        for SineCosine { sine, cosine, angle, .. } in &turns {
            for (name, value) in [(sine, Value::Sine(*angle)), (cosine, Value::Cosine(*angle))] {
                name.iter().copied().for_each(|name| self.leaf(name, value));
            }
        }
        turns
    }

    /// Writes a term: as the name of its node, or as the expression that computes the node.
    fn value(&mut self, term: Ref) -> ValueId {
        let (negative, value) = self.operand(None, term.magnitude());
        self.signed(negative != term.is_negative(), value)
    }

    /// Returns a node, as `user` uses it, as a sign and a value. Signs move outwards in an expression, to where they
    /// cost nothing.
    fn operand(&mut self, user: Option<Ref>, id: Ref) -> (bool, ValueId) {
        let lowering = self.lowering;
        if lowering.is_zero(id) {
            return (false, self.values.push(None, Value::Constant(0.0)));
        }
        let given = user.map_or(lowering.names[id.index()], |user| lowering.name_where_used(user, id));
        match given {
            Some(given) => (given.negative, self.known(given.name)),
            None => self.operation(id),
        }
    }

    fn operation(&mut self, id: Ref) -> (bool, ValueId) {
        let lowering = self.lowering;
        let mut operand = |at: Ref| {
            let (negative, value) = self.operand(Some(id), at.magnitude());
            (negative != at.is_negative(), value)
        };
        let (negative, value) = match lowering.written.graph.op(id) {
            Op::Sum(a, b) => match (operand(a), operand(b)) {
                ((false, a), (false, b)) => (false, Value::Binary(Operator::Sum, a, b)),
                ((false, a), (true, b)) | ((true, b), (false, a)) => (false, Value::Binary(Operator::Difference, a, b)),
                ((true, a), (true, b)) => (true, Value::Binary(Operator::Sum, a, b)),
            },
            op @ (Op::Product(a, b) | Op::Quotient(a, b)) => {
                let operator = if matches!(op, Op::Product(..)) { Operator::Product } else { Operator::Quotient };
                let ((a_negative, a), (b_negative, b)) = (operand(a), operand(b));
                (a_negative != b_negative, Value::Binary(operator, a, b))
            }
            Op::BySign(operands) => {
                let operands = operands.map(operand).map(|(negative, value)| self.signed(negative, value));
                (false, Value::BySign(operands))
            }
            // leaves always have a name, except the constant 0, which no operation keeps
            Op::Constant(_) | Op::Input(_) | Op::Sine(_) | Op::Cosine(_) => (false, Value::Constant(0.0)),
        };
        (negative, self.values.push(None, value))
    }

    /// Applies a sign to a value. The sign moves inwards if it costs nothing there: -(a - b) is b - a.
    fn signed(&mut self, negative: bool, value: ValueId) -> ValueId {
        if !negative {
            return value;
        }
        if let Some(value) = self.negated(value) { value } else { self.values.push(None, Value::Negative(value)) }
    }

    /// Returns the negative of a value without a minus sign in front, if there is one. It is exact, because rounding is
    /// symmetric. A value without a name is used only here, so it is changed in place.
    fn negated(&mut self, id: ValueId) -> Option<ValueId> {
        if self.values.name(id).is_some() {
            return None;
        }
        let negated = match self.values.get(id) {
            Value::Constant(_) => return Some(id),
            Value::Negative(a) => return Some(a),
            Value::Binary(Operator::Difference, a, b) => Value::Binary(Operator::Difference, b, a),
            Value::Binary(Operator::Sum, a, b) => match self.negated(a) {
                Some(a) => Value::Binary(Operator::Difference, a, b),
                None => Value::Binary(Operator::Difference, self.negated(b)?, a),
            },
            Value::Binary(operator, a, b) => match self.negated(a) {
                Some(a) => Value::Binary(operator, a, b),
                None if operator == Operator::Product => Value::Binary(operator, a, self.negated(b)?),
                None => return None,
            },
            Value::BySign([x, a, b]) if self.is_negatable(a) && self.is_negatable(b) => {
                Value::BySign([x, self.negated(a)?, self.negated(b)?])
            }
            _ => return None,
        };
        self.values.replace(id, negated);
        Some(id)
    }

    fn is_negatable(&self, id: ValueId) -> bool {
        self.values.name(id).is_none()
            && match self.values.get(id) {
                Value::Constant(_) | Value::Negative(_) | Value::Binary(Operator::Difference, ..) => true,
                Value::Binary(Operator::Sum | Operator::Product, a, b) => self.is_negatable(a) || self.is_negatable(b),
                Value::Binary(Operator::Quotient, a, _) => self.is_negatable(a),
                Value::BySign([_, a, b]) => self.is_negatable(a) && self.is_negatable(b),
                _ => false,
            }
    }
}
