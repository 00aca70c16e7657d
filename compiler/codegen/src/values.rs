//! The values of a program in one list, in the order in which they are computed.
//!
//! Every pass and every renderer reads this list. The arrangement for a target and fusing write a new list, machines
//! and native code use it as it is, and text writes a value without a name inside the expression that uses it
//! ([`Expression`](crate::Expression)).

use crate::ir::{Name, Operator};

/// A value of a program, by its place in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ValueId(u32);

impl ValueId {
    /// The value at a place in the list.
    #[allow(clippy::cast_possible_truncation)] // `push` refuses a larger index
    pub(crate) const fn at(index: usize) -> Self {
        Self(index as u32)
    }

    /// The place in the list.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// How a value is computed. Its operands come before it in the list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// An argument of the function.
    Argument,
    /// A number. Without a name it is the constant 0, for a result that is zero.
    Constant(f64),
    /// The sine of an angle.
    Sine(ValueId),
    /// The cosine of an angle.
    Cosine(ValueId),
    /// The same value under another name.
    Same(ValueId),
    /// -a
    Negative(ValueId),
    /// Two operands with an operator between them.
    Binary(Operator, ValueId, ValueId),
    /// A product plus an addend, rounded once if the processor has this instruction.
    Fused(Contraction),
    /// `[x, a, b]`: a where x is positive, b where x is negative, 0 where x is 0.
    BySign([ValueId; 3]),
}

/// A sum or difference with a product, x y + z, which a processor may compute by one instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contraction {
    /// The factors x and y.
    pub factors: [ValueId; 2],
    /// The addend z.
    pub addend: ValueId,
    /// The part that a difference negates; `None` for a sum.
    pub negated: Option<Negated>,
}

/// The part of a contraction that is negated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Negated {
    /// The factor x, as in z - x y.
    Factor,
    /// The addend z, as in x y - z.
    Addend,
}

impl Value {
    /// The values that it is computed from.
    pub fn operands(self) -> impl DoubleEndedIterator<Item = ValueId> {
        let operands = match self {
            Self::Argument | Self::Constant(_) => [None; 3],
            Self::Sine(a) | Self::Cosine(a) | Self::Same(a) | Self::Negative(a) => [Some(a), None, None],
            Self::Binary(_, a, b) => [Some(a), Some(b), None],
            Self::Fused(Contraction { factors: [x, y], addend, .. }) => [Some(addend), Some(x), Some(y)],
            Self::BySign(operands) => operands.map(Some),
        };
        operands.into_iter().flatten()
    }

    /// Returns the value with each operand changed by `change`.
    #[must_use]
    pub fn map(self, mut change: impl FnMut(ValueId) -> ValueId) -> Self {
        match self {
            Self::Argument | Self::Constant(_) => self,
            Self::Sine(a) => Self::Sine(change(a)),
            Self::Cosine(a) => Self::Cosine(change(a)),
            Self::Same(a) => Self::Same(change(a)),
            Self::Negative(a) => Self::Negative(change(a)),
            Self::Binary(operator, a, b) => Self::Binary(operator, change(a), change(b)),
            Self::Fused(Contraction { factors, addend, negated }) => {
                Self::Fused(Contraction { addend: change(addend), factors: factors.map(change), negated })
            }
            Self::BySign(operands) => Self::BySign(operands.map(change)),
        }
    }
}

/// The values of a program. A value without a name is used only once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values {
    list: Vec<Value>,
    names: Vec<Option<Name>>,
}

impl Values {
    /// How many values there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there is no value.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// How a value is computed.
    #[must_use]
    pub fn get(&self, id: ValueId) -> Value {
        self.list[id.index()]
    }

    /// The name of a value; `None` if its expression is written where it is used.
    #[must_use]
    pub fn name(&self, id: ValueId) -> Option<Name> {
        self.names[id.index()]
    }

    /// All values, in the order in which they are computed.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = (ValueId, Value)> + ExactSizeIterator {
        self.list.iter().enumerate().map(|(index, value)| (ValueId::at(index), *value))
    }

    /// Adds a value to the end of the list.
    ///
    /// # Panics
    /// When there are 2³² values already.
    pub fn push(&mut self, name: Option<Name>, value: Value) -> ValueId {
        let id = ValueId(u32::try_from(self.list.len()).expect("code is refused long before it has 2^32 values"));
        self.list.push(value);
        self.names.push(name);
        id
    }

    /// Replaces the way in which a value is computed.
    pub fn replace(&mut self, id: ValueId, value: Value) {
        self.list[id.index()] = value;
    }

    /// A copy of the first `count` values.
    pub(crate) fn first(&self, count: usize) -> Self {
        Self { list: self.list[..count].to_vec(), names: self.names[..count].to_vec() }
    }

    /// Names a value. If it has a name or is a number, a new value that is equal gets the name.
    pub(crate) fn named(&mut self, name: Name, id: ValueId) -> ValueId {
        if self.name(id).is_some() || matches!(self.get(id), Value::Constant(_)) {
            return self.push(Some(name), Value::Same(id));
        }
        self.names[id.index()] = Some(name);
        id
    }

    /// Returns the contraction of a sum or difference with a product that nothing else uses, and this product; of two
    /// products the right one.
    #[must_use]
    pub fn contraction(&self, id: ValueId) -> Option<(Contraction, ValueId)> {
        let Value::Binary(operator @ (Operator::Sum | Operator::Difference), a, b) = self.get(id) else { return None };
        let factors = |id: ValueId| match self.get(id) {
            Value::Binary(Operator::Product, x, y) if self.name(id).is_none() => Some([x, y]),
            _ => None,
        };
        let (factors, product, addend, negated) = match (factors(a), factors(b)) {
            (_, Some(factors)) => (factors, b, a, Negated::Factor),
            (Some(factors), None) => (factors, a, b, Negated::Addend),
            (None, None) => return None,
        };
        let negated = (operator == Operator::Difference).then_some(negated);
        Some((Contraction { factors, addend, negated }, product))
    }
}
