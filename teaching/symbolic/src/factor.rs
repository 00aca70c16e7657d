//! The factors of a written product: letters, and sines and cosines of sums of angles.

#[cfg(test)]
use crate::polynomial::Polynomial;
#[cfg(test)]
use crate::rational::fraction;
use crate::symbol::{Angle, Symbol};

/// A sum of angles with integer factors, sorted; the first factor is positive.
pub(crate) type Argument = Vec<(Angle, i32)>;

/// A factor of a product. Factors are written in this order.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Factor {
    /// A constant, by its index in [`Constants`](crate::symbol::Constants).
    Constant(usize),
    /// The variable d of a prismatic joint.
    Position(usize),
    /// The sine of a sum of angles.
    Sine(Argument),
    /// The cosine of a sum of angles.
    Cosine(Argument),
    /// The rate q̇ of a joint.
    Rate(usize),
    /// The acceleration q̈ of a joint.
    Acceleration(usize),
}

/// The class of a factor; terms are collected by later classes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Class {
    Constant,
    Position,
    Trigonometric,
    Rate,
    Acceleration,
}

impl Factor {
    pub(crate) fn class(&self) -> Class {
        match self {
            Self::Constant(_) => Class::Constant,
            Self::Position(_) => Class::Position,
            Self::Sine(_) | Self::Cosine(_) => Class::Trigonometric,
            Self::Rate(_) => Class::Rate,
            Self::Acceleration(_) => Class::Acceleration,
        }
    }

    /// Makes the factor of a letter.
    pub(crate) fn of(symbol: Symbol) -> Self {
        match symbol {
            Symbol::Constant(index) => Self::Constant(index),
            Symbol::Position(joint) => Self::Position(joint),
            Symbol::Sine(angle) => Self::Sine(vec![(angle, 1)]),
            Symbol::Cosine(angle) => Self::Cosine(vec![(angle, 1)]),
            Symbol::Rate(joint) => Self::Rate(joint),
            Symbol::Acceleration(joint) => Self::Acceleration(joint),
        }
    }

    /// Returns the factor as a polynomial in letters.
    #[cfg(test)]
    pub(crate) fn expanded(&self) -> Polynomial {
        match self {
            Self::Constant(index) => Polynomial::symbol(Symbol::Constant(*index)),
            Self::Position(joint) => Polynomial::symbol(Symbol::Position(*joint)),
            Self::Rate(joint) => Polynomial::symbol(Symbol::Rate(*joint)),
            Self::Acceleration(joint) => Polynomial::symbol(Symbol::Acceleration(*joint)),
            Self::Sine(argument) => sine_cosine(argument).0,
            Self::Cosine(argument) => sine_cosine(argument).1,
        }
    }
}

/// Returns sine and cosine of a sum of angles, by the addition theorems.
#[cfg(test)]
fn sine_cosine(argument: &Argument) -> (Polynomial, Polynomial) {
    let mut sum = (Polynomial::zero(), Polynomial::integer(1));
    for &(angle, times) in argument {
        let sine = Polynomial::symbol(Symbol::Sine(angle)).scaled(&fraction(i64::from(times.signum()), 1));
        let cosine = Polynomial::symbol(Symbol::Cosine(angle));
        for _ in 0..times.abs() {
            sum = (&sum.0 * &cosine + &sum.1 * &sine, &sum.1 * &cosine - &sum.0 * &sine);
        }
    }
    sum
}
