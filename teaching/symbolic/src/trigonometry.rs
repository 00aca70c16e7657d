//! Finds short forms of polynomials in sines and cosines, by sums of angles and by sin² + cos² = 1.
//!
//! A polynomial is converted to a sum of e^{ik·θ}. From this sum, it is written in other angles, such as θ1 and θ1 + θ2
//! instead of θ1 and θ2, with squares of either the sines or the cosines, and as a plain sum of sines and cosines. The
//! shortest form is chosen.

use std::collections::BTreeMap;

use num_traits::{One, Signed, Zero};

use crate::factor::{Argument, Factor};
use crate::polynomial::{Monomial, enter};
use crate::rational::{Rational, fraction};
use crate::symbol::{Angle, Symbol};

/// A coefficient with its factors.
pub(crate) type Product = (Rational, Vec<(Factor, i32)>);

/// Largest number of angles that are added and subtracted in all combinations; if there are more, only consecutive
/// angles are added.
const MOST_COMBINED: usize = 3;

/// Largest number of terms of a sum that is shortened.
const MOST_TERMS: usize = 24;

/// Largest work: the number of forms that are tried times the waves of each. The plain forms come first.
const MOST_WORK: usize = 3_000;

/// A sum Σ (x + iy) e^{ik·θ}: the coefficients (x, y) by k, which has one entry for each angle.
type Waves = BTreeMap<Vec<i32>, (Rational, Rational)>;

/// Exponents of sine and cosine, one pair for each angle.
type Powers = Vec<(i32, i32)>;

/// Returns the shortest form of a polynomial in sines and cosines.
pub(crate) fn shortest(terms: &BTreeMap<Monomial, Rational>) -> Vec<Product> {
    let mut angles: Vec<Angle> = terms.keys().flat_map(|monomial| &monomial.0).filter_map(angle).collect();
    angles.sort_unstable();
    angles.dedup();
    let plain: Vec<Product> = terms
        .iter()
        .map(|(monomial, value)| {
            (value.clone(), monomial.0.iter().map(|&(symbol, n)| (Factor::of(symbol), n)).collect())
        })
        .collect();
    if plain.len() <= 1 || plain.len() > MOST_TERMS {
        return plain;
    }
    let waves = waves(terms, &angles);
    let bases = bases(&angles);
    let mut best = plain;
    let better = |candidate: Vec<Product>, best: &mut Vec<Product>| {
        if length(&candidate) < length(best) {
            *best = candidate;
        }
    };
    // of equally short forms, the earlier one is kept
    let mut forms = 0;
    for basis in &bases {
        if forms * waves.len() > MOST_WORK || best.len() == 1 {
            break;
        }
        let turned = in_basis(&waves, basis);
        // skips angles for which the exponents k become larger, because the products become longer
        if order(&turned) > order(&waves) {
            continue;
        }
        let largest: Vec<i32> =
            (0..angles.len()).map(|at| turned.keys().map(|k| k[at].abs()).max().unwrap_or(0)).collect();
        let squared: Vec<usize> = (0..angles.len()).filter(|at| largest[*at] >= 2).collect();
        for choice in 0..1_usize << squared.len().min(4) {
            forms += 1;
            let keeps_sine: Vec<bool> = (0..angles.len())
                .map(|at| squared.iter().position(|of| *of == at).is_some_and(|bit| choice >> bit & 1 == 1))
                .collect();
            let arguments: Vec<Argument> = basis.iter().map(|row| argument(row, &angles)).collect();
            better(products(&turned, &arguments, &keeps_sine), &mut best);
        }
    }
    better(sum_of_waves(&waves, &angles), &mut best);
    best
}

fn angle((symbol, _): &(Symbol, i32)) -> Option<Angle> {
    match symbol {
        Symbol::Sine(angle) | Symbol::Cosine(angle) => Some(*angle),
        _ => None,
    }
}

/// Returns the length of a form: the number of terms, then of factors.
fn length(products: &[Product]) -> (usize, usize) {
    let of_factor = |(factor, power): &(Factor, i32)| match factor {
        Factor::Sine(argument) | Factor::Cosine(argument) => {
            let is_multiple = argument.iter().any(|(_, times)| times.abs() > 1);
            1 + argument.len() + usize::from(*power != 1) + if is_multiple { 3 } else { 0 }
        }
        _ => 1,
    };
    (products.len(), products.iter().flat_map(|(_, factors)| factors).map(of_factor).sum())
}

/// Converts a polynomial to waves: cos x = (e^{ix} + e^{-ix})/2, sin x = (e^{ix} - e^{-ix})/2i.
fn waves(terms: &BTreeMap<Monomial, Rational>, angles: &[Angle]) -> Waves {
    let half = fraction(1, 2);
    let mut sum = Waves::new();
    for (monomial, value) in terms {
        let mut product = Waves::from([(vec![0; angles.len()], (value.clone(), Rational::zero()))]);
        for &(symbol, exponent) in &monomial.0 {
            let Some(at) = angle(&(symbol, 1)).and_then(|angle| angles.iter().position(|known| *known == angle)) else {
                continue;
            };
            for _ in 0..exponent {
                let mut next = Waves::new();
                for (k, (x, y)) in &product {
                    for sign in [1, -1] {
                        let mut k = k.clone();
                        k[at] += sign;
                        let (x, y) = (x * &half, y * &half);
                        let sign = fraction(i64::from(sign), 1);
                        // times -i for the sine: (x + iy)(-i) = y - ix
                        let (x, y) = if matches!(symbol, Symbol::Sine(_)) { (y * &sign, -x * &sign) } else { (x, y) };
                        add(&mut next, k, (x, y));
                    }
                }
                product = next;
            }
        }
        for (k, value) in product {
            add(&mut sum, k, value);
        }
    }
    sum.retain(|_, (x, y)| !x.is_zero() || !y.is_zero());
    sum
}

/// Returns the sum of the magnitudes of all numbers k.
fn order(waves: &Waves) -> i32 {
    waves.keys().flatten().map(Signed::abs).sum()
}

fn add(waves: &mut Waves, k: Vec<i32>, (x, y): (Rational, Rational)) {
    let place = waves.entry(k).or_insert_with(|| (Rational::zero(), Rational::zero()));
    place.0 += x;
    place.1 += y;
}

/// Returns sets of independent sums of angles, one sum for each angle: each row has earlier angles and ends with its
/// own.
fn bases(angles: &[Angle]) -> Vec<Vec<Vec<i32>>> {
    let joints = angles.iter().filter(|angle| matches!(angle, Angle::Joint(_))).count();
    let unit = |at: usize| (0..angles.len()).map(|other| i32::from(other == at)).collect::<Vec<i32>>();
    let rows = |at: usize| {
        let mut rows = vec![unit(at)];
        // only angles of joints are combined; they come first
        if at >= joints || joints > 2 * MOST_COMBINED {
            return rows;
        }
        for start in (0..at).rev() {
            let before = at - start;
            let all_signs = if joints <= MOST_COMBINED { 1_usize << before } else { 1 };
            for signs in 0..all_signs {
                let mut row = unit(at);
                for (bit, place) in row[start..at].iter_mut().enumerate() {
                    *place = if signs >> bit & 1 == 1 { -1 } else { 1 };
                }
                rows.push(row);
            }
        }
        rows
    };
    (0..angles.len()).fold(vec![Vec::new()], |bases, at| {
        let more = |basis: &Vec<Vec<i32>>| {
            let basis = basis.clone();
            rows(at).into_iter().map(move |row| [basis.clone(), vec![row]].concat()).collect::<Vec<_>>()
        };
        bases.iter().flat_map(more).collect()
    })
}

/// Expresses the waves by other angles φ = A θ: k·θ = k'·φ with k = Aᵀ k'.
fn in_basis(waves: &Waves, basis: &[Vec<i32>]) -> Waves {
    let turned = waves.iter().map(|(k, value)| {
        let mut left = k.clone();
        for (at, row) in basis.iter().enumerate().rev() {
            let times = left[at];
            for (place, step) in left.iter_mut().zip(row).take(at) {
                *place -= times * step;
            }
        }
        (left, value.clone())
    });
    turned.collect()
}

/// Returns the sum of angles of a row of a basis.
fn argument(row: &[i32], angles: &[Angle]) -> Argument {
    angles.iter().copied().zip(row.iter().copied()).filter(|(_, times)| *times != 0).collect()
}

/// Returns an argument whose first factor is positive, and whether its sign was changed.
fn with_sign(argument: &Argument) -> (Argument, bool) {
    let is_negative = argument.first().is_some_and(|(_, times)| *times < 0);
    let argument = argument.iter().map(|&(angle, times)| (angle, if is_negative { -times } else { times })).collect();
    (argument, is_negative)
}

/// Returns cos nx and sin nx in powers of sin x and cos x, without squares of the cosine (`keeps_sine`) or of the sine.
fn multiple(n: i32, keeps_sine: bool) -> [BTreeMap<(i32, i32), Rational>; 2] {
    let one = BTreeMap::from([((0, 0), Rational::one())]);
    let mut parts = [one, BTreeMap::new()];
    for _ in 0..n.abs() {
        let mut next = [BTreeMap::new(), BTreeMap::new()];
        for (part, terms) in parts.iter().enumerate() {
            for ((s, c), value) in terms {
                // (C + iS)(c + is) = Cc - Ss + i(Sc + Cs)
                into(&mut next[part], (*s, c + 1), value.clone(), keeps_sine);
                let sign = if part == 1 { -value } else { value.clone() };
                into(&mut next[1 - part], (s + 1, *c), sign, keeps_sine);
            }
        }
        parts = next;
    }
    if n < 0 {
        for value in parts[1].values_mut() {
            *value = -value.clone();
        }
    }
    parts
}

/// Adds a term, and replaces squares of the cosine (`keeps_sine`) or of the sine.
fn into(terms: &mut BTreeMap<(i32, i32), Rational>, (s, c): (i32, i32), value: Rational, keeps_sine: bool) {
    match keeps_sine {
        true if c >= 2 => {
            into(terms, (s + 2, c - 2), -&value, keeps_sine);
            into(terms, (s, c - 2), value, keeps_sine);
        }
        false if s >= 2 => {
            into(terms, (s - 2, c + 2), -&value, keeps_sine);
            into(terms, (s - 2, c), value, keeps_sine);
        }
        _ => enter(terms, (s, c), value),
    }
}

/// Writes waves as products of sines and cosines of their angles.
fn products(waves: &Waves, arguments: &[Argument], keeps_sine: &[bool]) -> Vec<Product> {
    let mut sum: BTreeMap<Powers, Rational> = BTreeMap::new();
    for (k, (x, y)) in waves {
        // real and imaginary part of the product so far, by powers
        let mut product: BTreeMap<Powers, [Rational; 2]> = BTreeMap::from([(Vec::new(), [x.clone(), y.clone()])]);
        for (n, keeps_sine) in k.iter().zip(keeps_sine) {
            let [cosine, sine] = multiple(*n, *keeps_sine);
            let mut next: BTreeMap<Powers, [Rational; 2]> = BTreeMap::new();
            for (powers, [x, y]) in &product {
                let of_cosine = cosine.iter().map(|(pair, value)| (pair, [x * value, y * value]));
                let of_sine = sine.iter().map(|(pair, value)| (pair, [-(y * value), x * value]));
                for (pair, [x, y]) in of_cosine.chain(of_sine) {
                    let powers = [powers.as_slice(), &[*pair]].concat();
                    let place = next.entry(powers).or_insert_with(|| [Rational::zero(), Rational::zero()]);
                    place[0] += x;
                    place[1] += y;
                }
            }
            product = next;
        }
        // waves of k and -k are conjugate, so imaginary parts cancel
        for (powers, [x, _]) in product {
            enter(&mut sum, powers, x);
        }
    }
    let written = |(powers, value): (Powers, Rational)| {
        let mut value = value;
        let mut factors = Vec::new();
        for ((s, c), argument) in powers.iter().zip(arguments) {
            let (argument, is_negative) = with_sign(argument);
            if is_negative && s % 2 == 1 {
                value = -value;
            }
            if *s != 0 {
                factors.push((Factor::Sine(argument.clone()), *s));
            }
            if *c != 0 {
                factors.push((Factor::Cosine(argument), *c));
            }
        }
        factors.sort();
        (value, factors)
    };
    sum.into_iter().map(written).collect()
}

/// Writes waves as a sum of cosines and sines.
fn sum_of_waves(waves: &Waves, angles: &[Angle]) -> Vec<Product> {
    let two = fraction(2, 1);
    let mut sum = Vec::new();
    for (k, (x, y)) in waves {
        let argument = argument(k, angles);
        match argument.first() {
            None => sum.push((x.clone(), Vec::new())),
            // one of k and -k is enough
            Some((_, times)) if times.is_negative() => {}
            Some(_) => {
                let terms = [(Factor::Sine(argument.clone()), -y * &two), (Factor::Cosine(argument), x * &two)];
                sum.extend(
                    terms
                        .into_iter()
                        .filter(|(_, value)| !value.is_zero())
                        .map(|(factor, value)| (value, vec![(factor, 1)])),
                );
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polynomial::Polynomial;

    fn sine(joint: usize) -> Polynomial {
        Polynomial::symbol(Symbol::Sine(Angle::Joint(joint)))
    }

    fn cosine(joint: usize) -> Polynomial {
        Polynomial::symbol(Symbol::Cosine(Angle::Joint(joint)))
    }

    fn sum(joints: &[(usize, i32)]) -> Argument {
        joints.iter().map(|&(joint, times)| (Angle::Joint(joint), times)).collect()
    }

    /// Returns the shortest form of a polynomial, and checks that it equals the polynomial.
    fn short(polynomial: &Polynomial) -> Vec<Product> {
        let short = shortest(polynomial.terms().expect("short"));
        let back = short.iter().fold(Polynomial::zero(), |sum, (value, factors)| {
            let product = factors.iter().fold(Polynomial::number(value.clone()), |product, (factor, power)| {
                (0..*power).fold(product, |product, _| &product * &factor.expanded())
            });
            sum + product
        });
        assert_eq!(back, *polynomial);
        short
    }

    fn single_product(factors: &[(Factor, i32)]) -> Vec<Product> {
        vec![(fraction(1, 1), factors.to_vec())]
    }

    #[test]
    fn sums_of_angles_are_found() {
        let cosine_12 = cosine(0) * cosine(1) - sine(0) * sine(1);
        let sine_12 = sine(0) * cosine(1) + cosine(0) * sine(1);
        assert_eq!(short(&cosine_12), single_product(&[(Factor::Cosine(sum(&[(0, 1), (1, 1)])), 1)]));
        assert_eq!(short(&sine_12), single_product(&[(Factor::Sine(sum(&[(0, 1), (1, 1)])), 1)]));
        let cosine_123 = &cosine_12 * &cosine(2) - &sine_12 * &sine(2);
        assert_eq!(short(&cosine_123), single_product(&[(Factor::Cosine(sum(&[(0, 1), (1, 1), (2, 1)])), 1)]));
        let sine_1_minus_2 = sine(0) * cosine(1) - cosine(0) * sine(1);
        assert_eq!(short(&sine_1_minus_2), single_product(&[(Factor::Sine(sum(&[(0, 1), (1, -1)])), 1)]));
        // sin θ2 cos(θ2 + θ3), as for an elbow
        let elbow = sine(1) * (cosine(1) * cosine(2) - sine(1) * sine(2));
        let factors = [(Factor::Sine(sum(&[(1, 1)])), 1), (Factor::Cosine(sum(&[(1, 1), (2, 1)])), 1)];
        assert_eq!(short(&elbow), single_product(&factors));
        // cos²(θ2 + θ3)
        let square = cosine_12.clone() * cosine_12;
        assert_eq!(short(&square), single_product(&[(Factor::Cosine(sum(&[(0, 1), (1, 1)])), 2)]));
    }

    #[test]
    fn pythagoras_shortens() {
        let square = Polynomial::integer(1) - cosine(1) * cosine(1);
        assert_eq!(short(&square), single_product(&[(Factor::Sine(sum(&[(1, 1)])), 2)]));
        let double = cosine(1) * cosine(1) - sine(1) * sine(1);
        assert_eq!(short(&double), single_product(&[(Factor::Cosine(sum(&[(1, 2)])), 1)]));
        // sin θ cos θ stays a product
        let product = sine(1) * cosine(1);
        assert_eq!(
            short(&product),
            single_product(&[(Factor::Sine(sum(&[(1, 1)])), 1), (Factor::Cosine(sum(&[(1, 1)])), 1)])
        );
    }
}
