//! Numbers of twice the precision: the unevaluated sum of two `f64`, about 106 bits.
//!
//! The compiler compares values with them. Conversions between robot descriptions compute with them, so that a number
//! that is the same in both descriptions keeps its digits, and a structural zero stays zero.
//!
//! T. J. Dekker, "A floating-point technique for extending the available precision", Numer. Math. 18, 1971.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// `high + low`, with |low| at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Double {
    /// The number, rounded to an `f64`.
    pub high: f64,
    /// The rest that this rounding removed.
    pub low: f64,
}

/// π/2 to 106 bits.
const HALF_PI: Double = Double { high: std::f64::consts::FRAC_PI_2, low: 6.123_233_995_736_766e-17 };

/// The powers of ten from 1 to 10²², each of which an `f64` represents exactly.
const POWERS_OF_TEN: [f64; 23] = {
    let mut powers = [1.0; 23];
    let mut places = 1;
    while places < powers.len() {
        powers[places] = 10.0 * powers[places - 1];
        places += 1;
    }
    powers
};

impl Double {
    /// Makes the number `value`, exactly.
    #[must_use]
    pub const fn new(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }

    /// Makes the number that the shortest decimal of `value` means: 0.1 is one tenth, not the binary fraction next to
    /// it.
    #[must_use]
    pub fn decimal(value: f64) -> Self {
        let (digits, exponent) = decimal_digits(value.abs());
        let number = Self::of_digits(digits, exponent);
        if value < 0.0 { -number } else { number }
    }

    /// Returns `digits` times ten to the power of `exponent`.
    #[must_use]
    pub fn of_digits(digits: u64, exponent: i32) -> Self {
        #[allow(clippy::cast_precision_loss)] // the rest of the digits is in `low`
        let high = digits as f64;
        #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)] // integers of at most 17 digits
        let low = (i128::from(digits) - high as i128) as f64;
        let mut number = quick_sum(high, low);
        let mut rest = exponent.unsigned_abs() as usize;
        while rest > 0 {
            let places = rest.min(POWERS_OF_TEN.len() - 1);
            let power = Self::new(POWERS_OF_TEN[places]);
            number = if exponent > 0 { number * power } else { number / power };
            rest -= places;
        }
        number
    }

    /// Returns the nearest `f64`.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        self.high + self.low
    }

    /// Returns the square root; 0 for numbers that are not positive.
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::default();
        }
        // one step of Newton's method, from the rounded root
        let root = Self::new(self.high.sqrt());
        root + (self - root * root) / (root + root)
    }

    /// Returns the sine and the cosine of an angle of a few turns, rad.
    #[must_use]
    pub fn sin_cos(self) -> (Self, Self) {
        let quarters = (self.high / HALF_PI.high).round();
        let r = self - HALF_PI * Self::new(quarters);
        let square = r * r;
        // Taylor series; |r| ≤ π/4, so that the last term is below 1e-33
        let (mut sine, mut cosine) = (r, Self::new(1.0));
        let (mut sine_term, mut cosine_term) = (r, Self::new(1.0));
        for k in 1..14 {
            // stop where further terms change no bit: early for most angles of a robot, because they are right angles
            // up to rounding
            if cosine_term.high.abs() <= 1e-36 * cosine.high.abs() && sine_term.high.abs() <= 1e-36 * sine.high.abs() {
                break;
            }
            let k = f64::from(k);
            cosine_term = -(cosine_term * square / Self::new((2.0 * k - 1.0) * (2.0 * k)));
            sine_term = -(sine_term * square / Self::new((2.0 * k) * (2.0 * k + 1.0)));
            cosine = cosine + cosine_term;
            sine = sine + sine_term;
        }
        match quarters.rem_euclid(4.0) {
            0.0 => (sine, cosine),
            1.0 => (cosine, -sine),
            2.0 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }
}

/// Returns the digits and the decimal exponent of the shortest decimal that reads back as `value`, which is not
/// negative. Whole numbers that an `f64` represents exactly have the exponent 0.
#[must_use]
pub fn decimal_digits(value: f64) -> (u64, i32) {
    const COUNTED: f64 = 9_007_199_254_740_992.0; // 2⁵³
    if value < COUNTED && value.fract() == 0.0 {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // whole, and neither negative nor large
        return (value as u64, 0);
    }
    let text = format!("{value:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = mantissa.bytes().filter(u8::is_ascii_digit);
    let number = digits.fold(0, |number, digit| 10 * number + u64::from(digit - b'0'));
    let places = mantissa.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    (number, exponent.parse().unwrap_or(0) - i32::try_from(places).unwrap_or(0))
}

/// Returns a + b exactly, for |a| ≥ |b|.
fn quick_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    Double { high, low: b - (high - a) }
}

/// Returns a + b exactly.
fn two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    let back = high - a;
    Double { high, low: (a - (high - back)) + (b - back) }
}

/// Returns a · b exactly, by splitting each factor into halves of 26 bits.
fn two_product(a: f64, b: f64) -> Double {
    let split = |x: f64| {
        let big = 134_217_729.0 * x; // 2²⁷ + 1
        let high = big - (big - x);
        (high, x - high)
    };
    let high = a * b;
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    Double { high, low: ((a_high * b_high - high) + a_high * b_low + a_low * b_high) + a_low * b_low }
}

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (s, t) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let s = quick_sum(s.high, s.low + t.high);
        quick_sum(s.high, s.low + t.low)
    }
}

impl Neg for Double {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let p = two_product(self.high, other.high);
        quick_sum(p.high, p.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Double {
    type Output = Self;

    #[allow(clippy::suspicious_arithmetic_impl)] // three digits of a quotient, each of 53 bits
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::new(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::new(second);
        quick_sum(first, second) + Self::new(rest.high / other.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Double, b: Double) -> bool {
        (a - b).to_f64().abs() <= 1e-30 * b.to_f64().abs().max(1e-3)
    }

    #[test]
    fn decimals_are_what_they_say() {
        let tenth = Double::decimal(0.1);
        assert!(close(tenth * Double::new(10.0), Double::new(1.0)));
        assert_ne!(tenth.low, 0.0, "the f64 next to a tenth is not a tenth");
        assert!(close(Double::decimal(-2.5e-3) * Double::new(400.0), Double::new(-1.0)));
        assert!(close(Double::decimal(1e30) * Double::decimal(1e-30), Double::new(1.0)), "two steps of powers of ten");
        assert_eq!(decimal_digits(0.4318), (4318, -4));
        assert_eq!(decimal_digits(1.2e300), (12, 299));
        assert_eq!(decimal_digits(0.0), (0, 0));
        assert_eq!(decimal_digits(1200.0), (1200, 0));
        assert_eq!(decimal_digits(1e16), (1, 16), "an `f64` does not count so far");
    }

    #[test]
    fn quotients_and_roots_have_twice_the_digits() {
        let third = Double::new(1.0) / Double::new(3.0);
        assert!(close(third * Double::new(3.0), Double::new(1.0)));
        let root = Double::new(2.0).sqrt();
        assert!(close(root * root, Double::new(2.0)));
    }

    #[test]
    fn sine_and_cosine_hold_their_identities() {
        for angle in [0.3, 1.0, 2.0, -2.5, 3.0, 5.9] {
            let (s, c) = Double::new(angle).sin_cos();
            assert!(close(s * s + c * c, Double::new(1.0)), "{angle}");
            assert!((s.to_f64() - angle.sin()).abs() < 2e-16 && (c.to_f64() - angle.cos()).abs() < 2e-16, "{angle}");
            let (twice, _) = Double::new(2.0 * angle).sin_cos();
            assert!(close(twice, s * c * Double::new(2.0)), "{angle}");
        }
    }
}
