//! The value of an expression together with the formula that computes it from run-time parameters.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Formula;

/// The largest whole power of a run-time parameter, because powers become products.
pub(crate) const LARGEST_POWER: f64 = 16.0;

/// A value and how it depends on the run-time parameters; the value is that of the formula for the parameters' values
/// in the file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Quantity {
    pub(crate) value: f64,
    formula: Formula,
}

impl Quantity {
    pub(crate) fn constant(value: f64) -> Self {
        Self { value, formula: Formula::Number(value) }
    }

    /// Makes the quantity of a run-time parameter from its index and its value in the file.
    pub(crate) fn parameter(index: usize, value: f64) -> Self {
        Self { value, formula: Formula::Parameter(index) }
    }

    /// Makes a quantity from a value and its formula; without a formula it is a constant.
    pub(crate) fn known(value: f64, formula: Option<&Formula>) -> Self {
        formula.map_or(Self::constant(value), |formula| Self::new(value, formula.clone()))
    }

    fn new(value: f64, formula: Formula) -> Self {
        match formula {
            // A value that is not finite in the file, such as 0/p for p = 0, keeps its formula and is refused later.
            Formula::Number(number) if value.is_finite() => Self::constant(number),
            _ => Self { value, formula },
        }
    }

    /// Returns the formula, unless the quantity is a constant.
    pub(crate) fn varying(&self) -> Option<&Formula> {
        (!matches!(self.formula, Formula::Number(_))).then_some(&self.formula)
    }

    /// Counts the numbers, parameters and operations of the formula.
    pub(crate) fn parts(&self) -> usize {
        self.formula.parts()
    }

    /// Returns the first run-time parameter on which the quantity depends.
    pub(crate) fn first_parameter(&self) -> Option<usize> {
        self.formula.first_parameter()
    }

    /// Rewrites a power with a constant exponent as products; `None` where that is not possible.
    pub(crate) fn whole_power(self, exponent: f64) -> Option<Self> {
        let mut factors = exponent.abs();
        if factors > LARGEST_POWER || factors != libm::floor(factors) {
            return None;
        }
        if factors == 0.0 {
            return Some(Self::constant(1.0));
        }
        let mut power = self.clone();
        while factors > 1.0 {
            power = power * self.clone();
            factors -= 1.0;
        }
        Some(if exponent < 0.0 { Self::constant(1.0) / power } else { power })
    }

    /// Removes the sign of a zero, which carries no meaning in a table.
    pub(crate) fn without_negative_zero(self) -> Self {
        let value = self.value + 0.0;
        match self.formula {
            Formula::Number(_) => Self::constant(value),
            formula => Self { value, formula },
        }
    }
}

impl PartialEq<f64> for Quantity {
    fn eq(&self, other: &f64) -> bool {
        self.value == *other
    }
}

impl Neg for Quantity {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(-self.value, -self.formula)
    }
}

macro_rules! operations {
    ($($operation:ident $method:ident,)*) => {$(
        impl $operation for Quantity {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self::new(self.value.$method(other.value), self.formula.$method(other.formula))
            }
        }
    )*};
}
operations! { Add add, Sub sub, Mul mul, Div div, }
