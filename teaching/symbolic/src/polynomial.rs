//! Polynomials with exact coefficients, in a normal form: two are equal if and only if their terms are.
//!
//! The normal form has no square of a sine: sin² x is 1 - cos² x. Constants may have negative exponents, because a file
//! may divide by a parameter.

use std::collections::BTreeMap;
use std::ops::{Add, Mul, Neg, Sub};

use num_traits::{One, Zero};

use crate::rational::{Rational, fraction};
use crate::symbol::{Angle, Symbol};

/// Largest number of terms of a polynomial, more than fit on a page.
const MOST_TERMS: usize = 3_000;

/// Largest number of products of terms for one product of polynomials.
const MOST_PRODUCTS: usize = 60_000;

/// A product of powers of letters, sorted by the letters, without exponents 0.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub(crate) struct Monomial(pub(crate) Vec<(Symbol, i32)>);

impl Monomial {
    fn times(&self, other: &Self) -> Self {
        let mut product = Vec::with_capacity(self.0.len() + other.0.len());
        let (mut left, mut right) = (self.0.iter().peekable(), other.0.iter().peekable());
        while let (Some(&&(x, m)), Some(&&(y, n))) = (left.peek(), right.peek()) {
            if x <= y {
                left.next();
            }
            if y <= x {
                right.next();
            }
            match x.cmp(&y) {
                std::cmp::Ordering::Less => product.push((x, m)),
                std::cmp::Ordering::Greater => product.push((y, n)),
                std::cmp::Ordering::Equal if m + n != 0 => product.push((x, m + n)),
                std::cmp::Ordering::Equal => {}
            }
        }
        product.extend(left);
        product.extend(right);
        Self(product)
    }

    pub(crate) fn exponent(&self, symbol: Symbol) -> i32 {
        self.0.iter().find(|(known, _)| *known == symbol).map_or(0, |(_, exponent)| *exponent)
    }

    /// Splits the factors into those for which `is_in` is true, and the others.
    pub(crate) fn split(&self, is_in: impl Fn(Symbol) -> bool) -> (Self, Self) {
        let (inside, outside) = self.0.iter().partition(|(symbol, _)| is_in(*symbol));
        (Self(inside), Self(outside))
    }

    /// Returns the angle of a squared sine, which may occur in products of normal forms.
    fn squared_sine(&self) -> Option<Angle> {
        self.0.iter().find_map(|(symbol, exponent)| match symbol {
            Symbol::Sine(angle) if *exponent >= 2 => Some(*angle),
            _ => None,
        })
    }
}

/// A polynomial, or the mark that it became too long. Results of computations with a marked polynomial are marked, too.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Polynomial {
    /// The terms; `None` if there were too many.
    terms: Option<BTreeMap<Monomial, Rational>>,
}

impl Polynomial {
    pub(crate) fn zero() -> Self {
        Self { terms: Some(BTreeMap::new()) }
    }

    pub(crate) fn number(value: Rational) -> Self {
        Self::term(value, Monomial::default())
    }

    pub(crate) fn integer(value: i64) -> Self {
        Self::number(fraction(value, 1))
    }

    pub(crate) fn symbol(symbol: Symbol) -> Self {
        Self::term(Rational::one(), Monomial(vec![(symbol, 1)]))
    }

    pub(crate) fn term(coefficient: Rational, monomial: Monomial) -> Self {
        let mut terms = BTreeMap::new();
        enter(&mut terms, monomial, coefficient);
        Self { terms: Some(terms) }
    }

    /// Returns the terms; `None` if there were too many.
    pub(crate) fn terms(&self) -> Option<&BTreeMap<Monomial, Rational>> {
        self.terms.as_ref()
    }

    pub(crate) fn is_too_long(&self) -> bool {
        self.terms.is_none()
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.terms.as_ref().is_some_and(BTreeMap::is_empty)
    }

    /// Returns the only term, if there is exactly one.
    pub(crate) fn single(&self) -> Option<(&Monomial, &Rational)> {
        self.terms.as_ref().filter(|terms| terms.len() == 1)?.iter().next()
    }

    /// Returns the reciprocal of a single term of constants; `None` for any other polynomial.
    pub(crate) fn inverse(&self) -> Option<Self> {
        let (monomial, coefficient) = self.single()?;
        let factors = monomial.0.iter().map(|&(symbol, exponent)| match symbol {
            Symbol::Constant(_) => Some((symbol, -exponent)),
            _ => None,
        });
        Some(Self::term(coefficient.recip(), Monomial(factors.collect::<Option<_>>()?)))
    }

    /// Returns the coefficient of the product `of`, where `is_in` tells the letters of such products. The sum of
    /// products times coefficients is the polynomial.
    pub(crate) fn coefficient(&self, of: &[(Symbol, i32)], is_in: impl Fn(Symbol) -> bool + Copy) -> Self {
        self.map(|terms| {
            let beside = terms.iter().filter_map(|(monomial, value)| {
                let (inside, outside) = monomial.split(is_in);
                (inside.0 == of).then(|| (outside, value.clone()))
            });
            beside.collect()
        })
    }

    /// Returns the derivative with respect to the variable of a joint.
    pub(crate) fn by_joint(&self, joint: usize) -> Self {
        let angle = Angle::Joint(joint);
        let (sine, cosine) = (Symbol::Sine(angle), Symbol::Cosine(angle));
        let Some(terms) = &self.terms else { return self.clone() };
        let mut sum = Self::zero();
        let mut add = |monomial: &Monomial, symbol: Symbol, instead: Option<(Symbol, i64)>, value: &Rational| {
            let exponent = monomial.exponent(symbol);
            if exponent == 0 {
                return;
            }
            let mut factor = Monomial(vec![(symbol, -1)]);
            let mut sign = 1;
            if let Some((symbol, with)) = instead {
                factor = factor.times(&Monomial(vec![(symbol, 1)]));
                sign = with;
            }
            let factor = Self::term(fraction(i64::from(exponent) * sign, 1), factor);
            sum = &sum + &(&factor * &Self::term(value.clone(), monomial.clone()));
        };
        for (monomial, value) in terms {
            add(monomial, sine, Some((cosine, 1)), value);
            add(monomial, cosine, Some((sine, -1)), value);
            add(monomial, Symbol::Position(joint), None, value);
        }
        sum
    }

    /// Evaluates the polynomial for values of the letters.
    pub(crate) fn evaluate(&self, value: impl Fn(Symbol) -> f64) -> f64 {
        let Some(terms) = &self.terms else { return f64::NAN };
        let evaluated =
            |monomial: &Monomial| monomial.0.iter().map(|&(symbol, n)| value(symbol).powi(n)).product::<f64>();
        terms.iter().map(|(monomial, factor)| crate::rational::nearest(factor) * evaluated(monomial)).sum()
    }

    pub(crate) fn scaled(&self, factor: &Rational) -> Self {
        if factor.is_zero() {
            return Self::zero();
        }
        self.map(|terms| terms.iter().map(|(monomial, value)| (monomial.clone(), value * factor)).collect())
    }

    fn map(&self, of: impl FnOnce(&BTreeMap<Monomial, Rational>) -> BTreeMap<Monomial, Rational>) -> Self {
        Self { terms: self.terms.as_ref().map(of) }
    }
}

/// Adds a term to a sum.
pub(crate) fn enter<K: Ord>(terms: &mut BTreeMap<K, Rational>, key: K, value: Rational) {
    if value.is_zero() {
        return;
    }
    match terms.entry(key) {
        std::collections::btree_map::Entry::Vacant(place) => {
            place.insert(value);
        }
        std::collections::btree_map::Entry::Occupied(mut place) => {
            *place.get_mut() += value;
            if place.get().is_zero() {
                place.remove();
            }
        }
    }
}

/// Adds a term that may have squared sines.
fn enter_reduced(terms: &mut BTreeMap<Monomial, Rational>, monomial: Monomial, value: Rational) {
    let Some(angle) = monomial.squared_sine() else { return enter(terms, monomial, value) };
    // s² = 1 - c²
    let without = monomial.times(&Monomial(vec![(Symbol::Sine(angle), -2)]));
    let squared = without.times(&Monomial(vec![(Symbol::Cosine(angle), 2)]));
    enter_reduced(terms, without, value.clone());
    enter_reduced(terms, squared, -value);
}

impl Add for &Polynomial {
    type Output = Polynomial;

    fn add(self, other: Self) -> Polynomial {
        let (Some(left), Some(right)) = (&self.terms, &other.terms) else { return Polynomial { terms: None } };
        let (mut sum, less) = if left.len() >= right.len() { (left.clone(), right) } else { (right.clone(), left) };
        for (monomial, value) in less {
            enter(&mut sum, monomial.clone(), value.clone());
        }
        Polynomial { terms: (sum.len() <= MOST_TERMS).then_some(sum) }
    }
}

impl Neg for &Polynomial {
    type Output = Polynomial;

    fn neg(self) -> Polynomial {
        self.map(|terms| terms.iter().map(|(monomial, value)| (monomial.clone(), -value)).collect())
    }
}

impl Sub for &Polynomial {
    type Output = Polynomial;

    fn sub(self, other: Self) -> Polynomial {
        self + &-other
    }
}

impl Mul for &Polynomial {
    type Output = Polynomial;

    fn mul(self, other: Self) -> Polynomial {
        // zero times a polynomial that is too long is zero
        if self.is_zero() || other.is_zero() {
            return Polynomial::zero();
        }
        let (Some(left), Some(right)) = (&self.terms, &other.terms) else { return Polynomial { terms: None } };
        if left.len() * right.len() > MOST_PRODUCTS {
            return Polynomial { terms: None };
        }
        let mut product = BTreeMap::new();
        for (x, a) in left {
            for (y, b) in right {
                enter_reduced(&mut product, x.times(y), a * b);
            }
            if product.len() > MOST_TERMS {
                return Polynomial { terms: None };
            }
        }
        Polynomial { terms: Some(product) }
    }
}

/// Implements operators that take their operands by value.
macro_rules! owned {
    ($($operation:ident $method:ident),*) => {$(
        impl $operation for Polynomial {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                (&self).$method(&other)
            }
        }
    )*};
}
owned! { Add add, Sub sub, Mul mul }

impl Neg for Polynomial {
    type Output = Self;

    fn neg(self) -> Self {
        -&self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine() -> Polynomial {
        Polynomial::symbol(Symbol::Sine(Angle::Joint(0)))
    }

    fn cosine() -> Polynomial {
        Polynomial::symbol(Symbol::Cosine(Angle::Joint(0)))
    }

    fn m() -> Polynomial {
        Polynomial::symbol(Symbol::Constant(0))
    }

    #[test]
    fn sine_and_cosine_are_on_the_circle() {
        assert_eq!(sine() * sine() + cosine() * cosine(), Polynomial::integer(1));
        // sin⁴ - cos⁴ = sin² - cos²
        let [s2, c2] = [sine() * sine(), cosine() * cosine()];
        assert_eq!(&s2 * &s2 - &c2 * &c2, s2 - c2);
        assert!((sine() - sine()).is_zero());
    }

    #[test]
    fn derivatives_are_those_of_the_circle() {
        let product = m() * sine() * cosine();
        assert_eq!(product.by_joint(0), m() * (cosine() * cosine() - sine() * sine()));
        assert!(product.by_joint(1).is_zero());
        let slide = Polynomial::symbol(Symbol::Position(2));
        assert_eq!((&slide * &(&slide * &slide)).by_joint(2), (&slide * &slide).scaled(&fraction(3, 1)));
    }

    #[test]
    fn a_constant_can_be_divided_by() {
        let inverse = m().scaled(&fraction(2, 1)).inverse().expect("one term");
        assert_eq!(&inverse * &m(), Polynomial::number(fraction(1, 2)));
        assert_eq!((m() + sine()).inverse(), None);
        assert_eq!(sine().inverse(), None, "a sine may be zero");
    }

    #[test]
    fn what_is_too_long_stays_so_unless_it_is_multiplied_by_zero() {
        let long = (0..=MOST_TERMS).fold(Polynomial::zero(), |sum, i| &sum + &Polynomial::symbol(Symbol::Constant(i)));
        assert!(long.is_too_long() && (&long * &m()).is_too_long() && (&long - &long).is_too_long());
        assert!((&long * &Polynomial::zero()).is_zero());
    }
}
