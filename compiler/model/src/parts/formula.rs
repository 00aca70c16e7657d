//! Numbers of the table that are only known at run time: arithmetic over parameters.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number of the table as arithmetic over the run-time parameters.
///
/// The operators `+ - * /` build a formula and fold constants, by rules that change no value: two numbers give a
/// number, `x + 0`, `x * 1` and `x / 1` are `x`; `0 * x`, `0 / x` and `x - x` are 0. Only the sign of a zero may
/// differ, and in a table it carries no meaning.
///
/// ```
/// use rne_model::Formula;
///
/// let payload = Formula::Parameter(0);
/// let mass = Formula::Number(1.2) + payload.clone();
/// assert_eq!(mass.evaluate(&[0.5]), 1.2 + 0.5);
/// assert_eq!(Formula::Number(0.0) * payload, Formula::Number(0.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// A constant.
    Number(f64),
    /// A run-time parameter: its index into [`RunTime::names`](crate::RunTime::names).
    Parameter(usize),
    /// -x
    Negative(Box<Formula>),
    /// x + y
    Sum(Box<Formula>, Box<Formula>),
    /// x - y
    Difference(Box<Formula>, Box<Formula>),
    /// x y
    Product(Box<Formula>, Box<Formula>),
    /// x / y
    Quotient(Box<Formula>, Box<Formula>),
}

impl Formula {
    /// Evaluates the formula at given parameters, with exactly its operations in their order. A parameter that is
    /// missing counts as not-a-number.
    #[must_use]
    pub fn evaluate(&self, parameters: &[f64]) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Parameter(index) => parameters.get(*index).copied().unwrap_or(f64::NAN),
            Self::Negative(x) => -x.evaluate(parameters),
            Self::Sum(x, y) => x.evaluate(parameters) + y.evaluate(parameters),
            Self::Difference(x, y) => x.evaluate(parameters) - y.evaluate(parameters),
            Self::Product(x, y) => x.evaluate(parameters) * y.evaluate(parameters),
            Self::Quotient(x, y) => x.evaluate(parameters) / y.evaluate(parameters),
        }
    }

    /// Returns whether a parameter occurs in the formula.
    #[must_use]
    pub fn depends_on(&self, parameter: usize) -> bool {
        match self {
            Self::Parameter(index) => *index == parameter,
            _ => self.operands().any(|operand| operand.depends_on(parameter)),
        }
    }

    /// Returns the first parameter of the formula; `None` for a constant.
    pub(crate) fn first_parameter(&self) -> Option<usize> {
        match self {
            Self::Parameter(index) => Some(*index),
            _ => self.operands().find_map(Self::first_parameter),
        }
    }

    /// Counts the numbers, parameters and operations of the formula.
    pub(crate) fn parts(&self) -> usize {
        1 + self.operands().map(Self::parts).sum::<usize>()
    }

    fn operands(&self) -> impl Iterator<Item = &Self> {
        let (first, second) = match self {
            Self::Number(_) | Self::Parameter(_) => (None, None),
            Self::Negative(x) => (Some(x), None),
            Self::Sum(x, y) | Self::Difference(x, y) | Self::Product(x, y) | Self::Quotient(x, y) => (Some(x), Some(y)),
        };
        first.into_iter().chain(second).map(|operand| &**operand)
    }

    fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            _ => None,
        }
    }

    /// Returns whether two formulas give the same bits for all parameters: they are equal except for the order within
    /// sums and products.
    fn same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Sum(a, b), Self::Sum(x, y)) | (Self::Product(a, b), Self::Product(x, y)) => {
                (b.same(y) && a.same(x)) || (b.same(x) && a.same(y))
            }
            (Self::Difference(a, b), Self::Difference(x, y)) | (Self::Quotient(a, b), Self::Quotient(x, y)) => {
                b.same(y) && a.same(x)
            }
            (Self::Negative(a), Self::Negative(x)) => a.same(x),
            _ => self == other,
        }
    }
}

impl Neg for Formula {
    type Output = Self;

    fn neg(self) -> Self {
        match self {
            Self::Number(value) => Self::Number(-value),
            Self::Negative(x) => *x,
            x => Self::Negative(Box::new(x)),
        }
    }
}

impl Add for Formula {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        match (self.number(), other.number()) {
            (Some(x), Some(y)) => Self::Number(x + y),
            (Some(0.0), None) => other,
            (None, Some(0.0)) => self,
            _ => Self::Sum(Box::new(self), Box::new(other)),
        }
    }
}

impl Sub for Formula {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        match (self.number(), other.number()) {
            (Some(x), Some(y)) => Self::Number(x - y),
            (Some(0.0), None) => -other,
            (None, Some(0.0)) => self,
            (None, None) if self.same(&other) => Self::Number(0.0),
            _ => Self::Difference(Box::new(self), Box::new(other)),
        }
    }
}

impl Mul for Formula {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        match (self.number(), other.number()) {
            (Some(x), Some(y)) => Self::Number(x * y),
            (Some(0.0), None) | (None, Some(0.0)) => Self::Number(0.0),
            (Some(1.0), None) => other,
            (None, Some(1.0)) => self,
            (Some(-1.0), None) => -other,
            (None, Some(-1.0)) => -self,
            _ => Self::Product(Box::new(self), Box::new(other)),
        }
    }
}

impl Div for Formula {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        match (self.number(), other.number()) {
            (Some(x), Some(y)) => Self::Number(x / y),
            (Some(0.0), None) => Self::Number(0.0),
            (None, Some(1.0)) => self,
            (None, Some(-1.0)) => -self,
            _ => Self::Quotient(Box::new(self), Box::new(other)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(value: f64) -> Formula {
        Formula::Number(value)
    }

    fn x() -> Formula {
        Formula::Parameter(0)
    }

    fn y() -> Formula {
        Formula::Parameter(1)
    }

    #[test]
    fn evaluates_in_order() {
        let formula = -(x() * number(3.0) - y()) / (number(0.1) + x());
        assert_eq!(formula.evaluate(&[0.7, 0.2]), -(0.7 * 3.0 - 0.2) / (0.1 + 0.7));
        assert!(formula.evaluate(&[0.7]).is_nan());
        assert_eq!(formula.parts(), 10);
        // The operations keep the written order: the two constants are not added first.
        let third = (x() + number(0.1)) + number(0.2);
        assert_eq!(third.evaluate(&[1e16]), 1e16 + 0.1 + 0.2);
        assert_eq!((x() * number(3.0) * number(0.1)).evaluate(&[0.7]), 0.7 * 3.0 * 0.1);
    }

    #[test]
    fn constants_fold() {
        for (formula, folded) in [
            (number(0.1) + number(0.2), number(0.1 + 0.2)),
            (number(0.1) - number(0.3), number(0.1 - 0.3)),
            (number(0.1) * number(0.3), number(0.1 * 0.3)),
            (number(0.1) / number(0.3), number(0.1 / 0.3)),
            (-number(2.0), number(-2.0)),
            (x() + number(0.0), x()),
            (number(-0.0) + x(), x()),
            (x() - number(0.0), x()),
            (number(0.0) - x(), -x()),
            (x() * number(0.0), number(0.0)),
            (number(0.0) * x(), number(0.0)),
            (x() * number(1.0), x()),
            (number(1.0) * x(), x()),
            (x() * number(-1.0), -x()),
            (number(-1.0) * x(), -x()),
            (number(0.0) / x(), number(0.0)),
            (x() / number(1.0), x()),
            (x() / number(-1.0), -x()),
            (-(-x()), x()),
            (x() * y() - y() * x(), number(0.0)),
            (-(x() * (y() + number(2.0))) - -((number(2.0) + y()) * x()), number(0.0)),
            ((x() - y()) / x() - (x() - y()) / x(), number(0.0)),
        ] {
            assert_eq!(formula, folded);
        }
        for (formula, parts) in
            [((x() - y()) - (y() - x()), 7), (x() / y() - y() / x(), 7), (x() - y(), 3), (number(1.0) / x(), 3)]
        {
            assert_eq!(formula.parts(), parts, "{formula:?}");
        }
    }

    #[test]
    fn knows_its_parameters() {
        let formula = number(2.0) * (number(1.0) + y());
        assert!(formula.depends_on(1) && !formula.depends_on(0));
        assert_eq!((formula.first_parameter(), number(1.0).first_parameter()), (Some(1), None));
        assert_eq!((y() * x()).first_parameter(), Some(1));
    }
}
