//! The values of a program as they are written: a value with a name by this name, a value without one as an expression
//! where it is used.

use crate::ir::{Name, Operator};
use crate::values::{Negated, Value, ValueId, Values};

/// A value of a program, as it is written in one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expression<'p> {
    values: &'p Values,
    id: ValueId,
    /// Whether it is written where it is computed; elsewhere only its name is written.
    is_definition: bool,
}

/// The way in which a value is written in one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExpressionKind<'p> {
    /// The name of an argument, a constant or an earlier statement.
    Variable(Name),
    /// The constant 0, for a result that is zero.
    Zero,
    /// -a
    Negative(Expression<'p>),
    /// Two operands with an operator between them.
    Binary(Operator, Expression<'p>, Expression<'p>),
    /// x y + z, rounded once: x and y, z, and what is negated.
    Fused([Expression<'p>; 2], Expression<'p>, Option<Negated>),
    /// `[x, a, b]`: a where x is positive, b where x is negative, 0 where x is 0.
    BySign([Expression<'p>; 3]),
}

impl Values {
    /// Returns a value as it is written where it is used.
    #[must_use]
    pub fn used(&self, id: ValueId) -> Expression<'_> {
        Expression { values: self, id, is_definition: false }
    }

    /// Returns a value as it is written where it is computed.
    #[must_use]
    pub fn defined(&self, id: ValueId) -> Expression<'_> {
        Expression { values: self, id, is_definition: true }
    }
}

impl<'p> Expression<'p> {
    /// The way in which the value is written here.
    #[must_use]
    pub fn kind(self) -> ExpressionKind<'p> {
        let used = |id: ValueId| self.values.used(id);
        let name = self.values.name(self.id);
        match (name, self.values.get(self.id)) {
            (Some(name), _) if !self.is_definition => ExpressionKind::Variable(name),
            (Some(name), Value::Argument | Value::Constant(_) | Value::Sine(_) | Value::Cosine(_)) => {
                ExpressionKind::Variable(name)
            }
            (_, Value::Same(a)) => used(a).kind(),
            (_, Value::Negative(a)) => ExpressionKind::Negative(used(a)),
            (_, Value::Binary(operator, a, b)) => ExpressionKind::Binary(operator, used(a), used(b)),
            (_, Value::Fused(fused)) => {
                ExpressionKind::Fused(fused.factors.map(used), used(fused.addend), fused.negated)
            }
            (_, Value::BySign(operands)) => ExpressionKind::BySign(operands.map(used)),
            // leaves have names, except the constant 0
            (None, Value::Argument | Value::Constant(_) | Value::Sine(_) | Value::Cosine(_)) => ExpressionKind::Zero,
        }
    }

    /// The expression and all expressions inside it, from left to right.
    pub fn parts(self) -> impl Iterator<Item = Self> {
        let mut open = vec![self];
        std::iter::from_fn(move || {
            let next = open.pop()?;
            match next.kind() {
                ExpressionKind::Variable(_) | ExpressionKind::Zero => {}
                ExpressionKind::Negative(a) => open.push(a),
                ExpressionKind::Binary(_, a, b) => open.extend([b, a]),
                ExpressionKind::Fused([x, y], z, _) => open.extend([z, y, x]),
                ExpressionKind::BySign(operands) => open.extend(operands.into_iter().rev()),
            }
            Some(next)
        })
    }

    /// The names in the expression.
    pub fn names(self) -> impl Iterator<Item = Name> {
        self.parts().filter_map(|part| if let ExpressionKind::Variable(name) = part.kind() { Some(name) } else { None })
    }
}
