//! Collects the terms of a polynomial as a person writes it: common factors before parentheses, and all terms with the
//! same sine together.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use num_integer::Integer as _;
use num_traits::{One, Signed, Zero};

use crate::factor::{Class, Factor};
use crate::polynomial::{Monomial, Polynomial};
use crate::rational::{Rational, fraction};
use crate::symbol::{Constants, Kind, Symbol};
use crate::trigonometry::{self, Product};

/// A sum of products, which may contain sums.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sum(pub(crate) Vec<Term>);

/// A product: coefficient · before · powers of sums · after.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Term {
    pub(crate) coefficient: Rational,
    pub(crate) before: Vec<(Factor, i32)>,
    pub(crate) sums: Vec<(Sum, i32)>,
    pub(crate) after: Vec<(Factor, i32)>,
}

/// A term of a polynomial, before collecting.
#[derive(Clone, Debug, PartialEq)]
struct Flat {
    coefficient: Rational,
    factors: BTreeMap<Factor, i32>,
}

impl Flat {
    /// Returns the factors of a class with their exponents.
    fn of_class(&self, class: Class) -> Vec<(Factor, i32)> {
        let factors = self.factors.iter().filter(|(factor, _)| factor.class() == class);
        factors.map(|(factor, exponent)| (factor.clone(), *exponent)).collect()
    }
}

/// Factors, and the terms that have them.
type Group<P> = (P, Vec<Flat>);

/// Known short forms of trigonometric polynomials, which are scaled so that their first coefficient is 1.
type Known = HashMap<Vec<(Monomial, Rational)>, Vec<Product>>;

/// Collects the terms of the polynomials of one arm.
#[derive(Debug)]
pub(crate) struct Collector<'c> {
    constants: &'c Constants,
    known: Known,
}

impl<'c> Collector<'c> {
    pub(crate) fn new(constants: &'c Constants) -> Self {
        Self { constants, known: Known::new() }
    }

    /// Collects the terms of a polynomial; `None` if it is too long.
    pub(crate) fn collected(&mut self, polynomial: &Polynomial) -> Option<Sum> {
        let mut beside: BTreeMap<Monomial, BTreeMap<Monomial, Rational>> = BTreeMap::new();
        for (monomial, value) in polynomial.terms()? {
            let (angles, rest) = monomial.split(|symbol| matches!(symbol, Symbol::Sine(_) | Symbol::Cosine(_)));
            beside.entry(rest).or_default().insert(angles, value.clone());
        }
        let mut terms: BTreeMap<BTreeMap<Factor, i32>, Rational> = BTreeMap::new();
        for (rest, angles) in beside {
            for (value, short) in self.short(&angles) {
                let letters = rest.0.iter().map(|&(symbol, n)| (Factor::of(symbol), n));
                crate::polynomial::enter(&mut terms, letters.chain(short).collect(), value);
            }
        }
        let mut flat: Vec<Flat> =
            terms.into_iter().map(|(factors, coefficient)| Flat { coefficient, factors }).collect();
        flat.sort_by_cached_key(order);
        Some(self.gathered(flat))
    }

    /// Returns the short form of a polynomial in sines and cosines.
    fn short(&mut self, angles: &BTreeMap<Monomial, Rational>) -> Vec<Product> {
        let Some(first) = angles.values().next().cloned() else { return Vec::new() };
        let scaled: Vec<(Monomial, Rational)> = angles.iter().map(|(k, value)| (k.clone(), value / &first)).collect();
        let short = self
            .known
            .entry(scaled)
            .or_insert_with_key(|scaled| trigonometry::shortest(&scaled.iter().cloned().collect()));
        short.iter().map(|(value, factors)| (value * &first, factors.clone())).collect()
    }

    fn gathered(&self, mut terms: Vec<Flat>) -> Sum {
        if terms.len() <= 1 {
            return Sum(terms.into_iter().map(Flat::written).collect());
        }
        let coefficient = common_coefficient(&terms);
        let factors = common_factors(&terms);
        if !coefficient.is_one() || !factors.is_empty() {
            for term in &mut terms {
                term.coefficient = &term.coefficient / &coefficient;
                term.factors.retain(|factor, _| !factors.contains_key(factor));
            }
            let outside = Flat { coefficient, factors };
            return Sum(vec![product(outside, [self.gathered(terms)])]);
        }
        if let Some(square) = square(&terms) {
            return Sum(vec![square]);
        }
        if let Some((left, right)) = two_sums(&terms) {
            let one = Flat { coefficient: fraction(1, 1), factors: BTreeMap::new() };
            return Sum(vec![product(one, [self.gathered(left), self.gathered(right)])]);
        }
        let groups = by_class(&terms).or_else(|| self.by_factor(&terms)).or_else(|| with_square(&terms));
        let sum = match groups {
            Some(groups) => groups.into_iter().flat_map(|group| self.gathered(group).0).collect(),
            None => terms.into_iter().map(Flat::written).collect(),
        };
        Sum(positive_first(sum))
    }

    /// Separates the terms with the most frequent factor from the others; `None` if no two terms have a common factor.
    fn by_factor(&self, terms: &[Flat]) -> Option<Vec<Vec<Flat>>> {
        let mut counts: BTreeMap<&Factor, usize> = BTreeMap::new();
        for factor in terms.iter().flat_map(|term| term.factors.keys()) {
            *counts.entry(factor).or_default() += 1;
        }
        let rank = |factor: &Factor| match factor {
            Factor::Constant(index) => match self.constants.0.get(*index).map(|constant| constant.kind) {
                Some(Kind::Gravity) => 2,
                Some(Kind::Mass) => 1,
                _ => 0,
            },
            _ => 0,
        };
        // Lengths are not chosen, because a² + a b is not shorter as a (a + b). A factor of all terms does not separate
        // them, as m in m a + m² b, where the mass is also a length.
        let tells = 2..terms.len();
        let repeated = counts.into_iter().filter(|(factor, count)| tells.contains(count) && rank(factor) > 0);
        // the first one if several are equal
        let (best, _) = repeated.rev().max_by_key(|(factor, count)| (rank(factor), *count))?;
        let best = best.clone();
        let (with, without): (Vec<Flat>, Vec<Flat>) =
            terms.iter().cloned().partition(|term| term.factors.contains_key(&best));
        let is_first = terms.first().is_some_and(|term| term.factors.contains_key(&best));
        Some(if is_first { vec![with, without] } else { vec![without, with] })
    }
}

/// Groups terms with the same accelerations, otherwise with the same rates, otherwise with the same sines and cosines;
/// `None` if no group has two terms.
fn by_class(terms: &[Flat]) -> Option<Vec<Vec<Flat>>> {
    [Class::Acceleration, Class::Rate, Class::Trigonometric].into_iter().find_map(|class| {
        let mut groups: Vec<Group<Vec<(Factor, i32)>>> = Vec::new();
        for term in terms {
            let part = term.of_class(class);
            match groups.iter_mut().find(|(known, _)| *known == part) {
                Some((_, group)) => group.push(term.clone()),
                None => groups.push((part, vec![term.clone()])),
            }
        }
        let is_worth_it = groups.iter().any(|(part, group)| !part.is_empty() && group.len() >= 2);
        (is_worth_it && groups.len() >= 2).then(|| groups.into_iter().map(|(_, group)| group).collect())
    })
}

/// Returns the sort key of a term: first the classes in the order of collecting, then the letters.
fn order(term: &Flat) -> Vec<(Class, Vec<(Factor, i32)>)> {
    [Class::Acceleration, Class::Rate, Class::Trigonometric, Class::Constant, Class::Position]
        .into_iter()
        .map(|class| {
            // terms without a rate or acceleration come after terms with one; for other classes, terms without a factor
            // come first
            let part: Vec<(Factor, i32)> =
                term.of_class(class).into_iter().map(|(factor, exponent)| (factor, -exponent)).collect();
            let is_last = part.is_empty() && class >= Class::Rate;
            (if is_last { Class::Acceleration } else { Class::Constant }, part)
        })
        .collect()
}

/// Returns the factors that all terms have with the same exponent, so that (1/3) a² + (1/2) a b is not changed.
fn common_factors(terms: &[Flat]) -> BTreeMap<Factor, i32> {
    let Some((first, rest)) = terms.split_first() else { return BTreeMap::new() };
    let mut common = first.factors.clone();
    common.retain(|factor, exponent| rest.iter().all(|term| term.factors.get(factor) == Some(exponent)));
    common
}

/// Returns the coefficient before parentheses: the common magnitude of all coefficients, or the common divisor of
/// integers, with a minus sign if no coefficient is positive.
fn common_coefficient(terms: &[Flat]) -> Rational {
    let magnitudes: BTreeSet<Rational> = terms.iter().map(|term| term.coefficient.abs()).collect();
    let magnitude = match magnitudes.first() {
        Some(only) if magnitudes.len() == 1 => only.clone(),
        Some(first) if magnitudes.iter().all(Rational::is_integer) => {
            let divisor = magnitudes.iter().fold(first.numer().clone(), |divisor, other| divisor.gcd(other.numer()));
            Rational::from_integer(divisor)
        }
        _ => fraction(1, 1),
    };
    if terms.iter().all(|term| term.coefficient.is_negative()) { -magnitude } else { magnitude }
}

impl Flat {
    fn written(self) -> Term {
        product(self, [])
    }
}

/// Makes a product of factors and sums. Factors of a later class than all in the sums are written after them: (m1 + m2)
/// cos θ1.
fn product<const N: usize>(outside: Flat, inside: [Sum; N]) -> Term {
    let Flat { mut coefficient, mut factors } = outside;
    let mut sums = Vec::new();
    for sum in inside {
        match <[Term; 1]>::try_from(sum.0) {
            // a sum with one term is merged into the product
            Ok([term]) => {
                coefficient *= term.coefficient;
                for (factor, exponent) in term.before.into_iter().chain(term.after) {
                    *factors.entry(factor).or_default() += exponent;
                }
                sums.extend(term.sums);
            }
            Err(terms) => sums.push((Sum(terms), 1)),
        }
    }
    factors.retain(|_, exponent| *exponent != 0);
    sums.sort_by_key(|(sum, _)| latest_class(sum));
    let latest = sums.iter().map(|(sum, _)| latest_class(sum)).max().unwrap_or(Class::Acceleration);
    let (after, before) = factors.into_iter().partition(|(factor, _)| factor.class() > latest.max(Class::Position));
    Term { coefficient, before, sums, after }
}

fn latest_class(sum: &Sum) -> Class {
    let of_term = |term: &Term| {
        let own = term.before.iter().chain(&term.after).map(|(factor, _)| factor.class());
        own.chain(term.sums.iter().map(|(sum, _)| latest_class(sum))).max().unwrap_or(Class::Constant)
    };
    sum.0.iter().map(of_term).max().unwrap_or(Class::Constant)
}

/// Returns k p² ± 2 k p q + k q² as k (p ± q)².
fn square(terms: &[Flat]) -> Option<Term> {
    let [first, second, third] = terms else { return None };
    [[first, second, third], [first, third, second], [second, third, first]].into_iter().find_map(
        |[one, other, both]| {
            let root = |term: &Flat| -> Option<BTreeMap<Factor, i32>> {
                let halves = term.factors.iter().map(|(factor, n)| (n % 2 == 0).then(|| (factor.clone(), n / 2)));
                halves.collect()
            };
            let (p, q) = (root(one)?, root(other)?);
            let mut middle = p.clone();
            for (factor, exponent) in &q {
                *middle.entry(factor.clone()).or_default() += exponent;
            }
            let k = &one.coefficient;
            let twice = k * fraction(2, 1);
            if *k != other.coefficient || both.coefficient.abs() != twice.abs() || middle != both.factors {
                return None;
            }
            let sign = &both.coefficient / &twice;
            let flat = |coefficient, factors| Flat { coefficient, factors }.written();
            let root = Sum(vec![flat(fraction(1, 1), p), flat(sign, q)]);
            Some(Term { coefficient: k.clone(), before: Vec::new(), sums: vec![(root, 2)], after: Vec::new() })
        },
    )
}

/// Separates three terms that are a square from the others.
fn with_square(terms: &[Flat]) -> Option<Vec<Vec<Flat>>> {
    let indices = 0..terms.len();
    let triples = indices.clone().flat_map(|i| (i + 1..terms.len()).map(move |j| (i, j)));
    let mut triples = triples.flat_map(|(i, j)| (j + 1..terms.len()).map(move |k| [i, j, k]));
    let found = triples.find(|triple| square(&triple.map(|at| terms[at].clone())).is_some())?;
    let rest = indices.filter(|at| !found.contains(at)).map(|at| terms[at].clone()).collect();
    Some(vec![found.map(|at| terms[at].clone()).to_vec(), rest])
}

/// Finds two sums whose product the terms are: the coefficients of the rates, of the sines or of the powers of a letter
/// are proportional sums.
fn two_sums(terms: &[Flat]) -> Option<(Vec<Flat>, Vec<Flat>)> {
    let classes = [Class::Acceleration, Class::Rate, Class::Trigonometric];
    let letters: BTreeSet<&Factor> =
        terms.iter().flat_map(|term| term.factors.keys()).filter(|factor| factor.class() <= Class::Position).collect();
    let by_class = classes.into_iter().find_map(|class| factored(terms, |factor| factor.class() == class));
    by_class.or_else(|| letters.into_iter().find_map(|letter| factored(terms, |factor| factor == letter)))
}

/// Returns the two sums, if the coefficients of the chosen factors are proportional.
fn factored(terms: &[Flat], is_chosen: impl Fn(&Factor) -> bool) -> Option<(Vec<Flat>, Vec<Flat>)> {
    let mut groups: Vec<Group<BTreeMap<Factor, i32>>> = Vec::new();
    for term in terms {
        let (part, factors): (BTreeMap<_, _>, _) =
            term.factors.clone().into_iter().partition(|(factor, _)| is_chosen(factor));
        let rest = Flat { coefficient: term.coefficient.clone(), factors };
        match groups.iter_mut().find(|(known, _)| *known == part) {
            Some((_, group)) => group.push(rest),
            None => groups.push((part, vec![rest])),
        }
    }
    if groups.len() < 2 || groups.iter().any(|(_, group)| group.len() < 2) {
        return None;
    }
    let mut common: Option<Vec<Flat>> = None;
    let mut contents = Vec::new();
    for (part, mut group) in groups {
        // the smallest exponents, and the first coefficient
        let mut factors = group[0].factors.clone();
        for term in &group {
            for (factor, exponent) in &mut factors {
                *exponent = (*exponent).min(term.factors.get(factor).copied().unwrap_or(0));
            }
            for (factor, exponent) in term.factors.iter().filter(|(_, exponent)| **exponent < 0) {
                let place = factors.entry(factor.clone()).or_insert(0);
                *place = (*place).min(*exponent);
            }
        }
        factors.retain(|_, exponent| *exponent != 0);
        for term in &mut group {
            for (factor, exponent) in &factors {
                *term.factors.entry(factor.clone()).or_default() -= exponent;
            }
            term.factors.retain(|_, exponent| *exponent != 0);
        }
        group.sort_by_cached_key(order);
        let coefficient = group[0].coefficient.clone();
        for term in &mut group {
            term.coefficient = &term.coefficient / &coefficient;
        }
        match &common {
            Some(known) if *known != group => return None,
            _ => common = Some(group),
        }
        for (factor, exponent) in part {
            *factors.entry(factor).or_default() += exponent;
        }
        contents.push(Flat { coefficient, factors });
    }
    contents.sort_by_cached_key(order);
    Some((contents, common?))
}

/// Moves the first positive term to the beginning.
fn positive_first(mut terms: Vec<Term>) -> Vec<Term> {
    if let Some(at) = terms.iter().position(|term| term.coefficient.is_positive()) {
        terms[..=at].rotate_right(1);
    }
    terms
}

impl Sum {
    /// Multiplies the sum by a factor.
    pub(crate) fn times(&self, factor: Factor) -> Vec<Term> {
        let mut sum = self.clone();
        match sum.0.as_mut_slice() {
            [] => Vec::new(),
            [single] => {
                single.after.push((factor, 1));
                sum.0
            }
            _ => {
                let coefficient = fraction(1, 1);
                vec![Term { coefficient, before: Vec::new(), sums: vec![(sum, 1)], after: vec![(factor, 1)] }]
            }
        }
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Multiplies the sum out again, in letters.
    #[cfg(test)]
    pub(crate) fn expanded(&self) -> Polynomial {
        self.0.iter().fold(Polynomial::zero(), |sum, term| {
            let mut product = Polynomial::number(term.coefficient.clone());
            for (factor, exponent) in term.before.iter().chain(&term.after) {
                let letter = factor.expanded();
                let letter = if *exponent < 0 { letter.inverse().unwrap_or_else(Polynomial::zero) } else { letter };
                product = (0..exponent.abs()).fold(product, |product, _| &product * &letter);
            }
            for (inner, power) in &term.sums {
                let inner = inner.expanded();
                product = (0..*power).fold(product, |product, _| &product * &inner);
            }
            sum + product
        })
    }
}

/// Whether a coefficient is 1 or -1, so that its magnitude is not written.
pub(crate) fn is_unit(coefficient: &Rational) -> bool {
    coefficient.abs().is_one() && !coefficient.is_zero()
}
