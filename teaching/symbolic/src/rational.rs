//! Exact numbers: converts decimals of a robot file to fractions, and writes fractions.

use num_bigint::BigInt;
pub(crate) use num_rational::BigRational as Rational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use rne_model::decimal_digits;

/// Largest denominator of a fraction as which a rounded number is read: 0.08333333333333333 is 1/12.
const LARGEST_DENOMINATOR: u32 = 360;

/// Returns the fraction p/q.
pub(crate) fn fraction(p: i64, q: i64) -> Rational {
    Rational::new(BigInt::from(p), BigInt::from(q))
}

/// Returns the exact value of a finite number of the file: a simple fraction that rounds to it, or the written decimal.
pub(crate) fn exact(value: f64) -> Rational {
    #[allow(clippy::cast_possible_truncation)] // an integer of at most 53 bits
    let simple = (1..=LARGEST_DENOMINATOR).find_map(|q| {
        let p = (value * f64::from(q)).round();
        (p.abs() < 9e15 && p / f64::from(q) == value).then(|| fraction(p as i64, i64::from(q)))
    });
    simple.unwrap_or_else(|| {
        let (digits, exponent) = decimal_digits(value.abs());
        let magnitude = Rational::from_integer(BigInt::from(digits)) * Rational::from_integer(10.into()).pow(exponent);
        if value < 0.0 { -magnitude } else { magnitude }
    })
}

/// Returns the nearest floating-point number; infinite if it is too large.
pub(crate) fn nearest(rational: &Rational) -> f64 {
    rational.to_f64().unwrap_or(f64::NAN)
}

/// The spelling of a magnitude: an integer, a decimal such as 0.4318, or numerator and denominator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Spelling {
    /// An integer or a decimal.
    Plain(String),
    /// Numerator and denominator.
    Fraction(String, String),
}

/// Returns the spelling of the magnitude of a number.
pub(crate) fn spelling(rational: &Rational) -> Spelling {
    let (p, q) = (rational.numer().abs(), rational.denom());
    if q.is_one() {
        return Spelling::Plain(p.to_string());
    }
    let is_half_of_halves = q <= &BigInt::from(64) && (q & (q - BigInt::one())).is_zero();
    match decimal(&p, q) {
        Some(decimal) if !is_half_of_halves => Spelling::Plain(decimal),
        _ => Spelling::Fraction(p.to_string(), q.to_string()),
    }
}

/// Returns p/q as a decimal, if it has finitely many digits.
fn decimal(p: &BigInt, q: &BigInt) -> Option<String> {
    const MOST_DIGITS: usize = 20;
    let ten = BigInt::from(10);
    let mut scaled = p.clone();
    for digits in 0..=MOST_DIGITS {
        if (&scaled % q).is_zero() {
            let text = (&scaled / q).to_string();
            let text = format!("{}{text}", "0".repeat((digits + 1).saturating_sub(text.len())));
            let (whole, rest) = text.split_at(text.len() - digits);
            return Some(if rest.is_empty() { whole.to_owned() } else { format!("{whole}.{rest}") });
        }
        scaled *= &ten;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_what_they_stand_for() {
        assert_eq!(exact(1.0 / 12.0), fraction(1, 12));
        assert_eq!(exact(-0.5), fraction(-1, 2));
        assert_eq!(exact(0.4318), fraction(4318, 10_000));
        assert_eq!(exact(9.81), fraction(981, 100));
        assert_eq!(exact(1e-7), fraction(1, 10_000_000));
        assert_eq!(exact(3e20), Rational::from_integer(BigInt::from(3)) * Rational::from_integer(10.into()).pow(20));
        assert!(exact(0.0).is_zero());
        for value in [0.1, 2.0 / 3.0, 0.067_183, 1e-12, 12_345.678_9] {
            assert_eq!(nearest(&exact(value)), value);
        }
    }

    #[test]
    fn fractions_are_written_as_a_person_would() {
        let plain = |text: &str| Spelling::Plain(text.to_owned());
        let as_fraction = |p: &str, q: &str| Spelling::Fraction(p.to_owned(), q.to_owned());
        assert_eq!(spelling(&fraction(-6, 3)), plain("2"));
        assert_eq!(spelling(&fraction(1, 3)), as_fraction("1", "3"));
        assert_eq!(spelling(&fraction(3, 4)), as_fraction("3", "4"));
        assert_eq!(spelling(&fraction(981, 100)), plain("9.81"));
        assert_eq!(spelling(&fraction(1, 20)), plain("0.05"));
        assert_eq!(spelling(&fraction(5, 12)), as_fraction("5", "12"));
    }
}
