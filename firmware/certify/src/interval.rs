//! Interval arithmetic in double precision, rounded outwards.

use std::ops::{Add, Div, Mul, Neg, Sub};

use rne_codegen::Real;

/// All numbers between two bounds. The result of each operation encloses all results for numbers in its operands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
}

impl Interval {
    /// Makes the interval of exactly one number.
    #[must_use]
    pub const fn exactly(x: f64) -> Self {
        Self { low: x, high: x }
    }

    /// Makes an interval that encloses a number that was rounded to the nearest `f64`.
    #[must_use]
    pub const fn rounded(x: f64) -> Self {
        Self { low: x.next_down(), high: x.next_up() }
    }

    fn hull(numbers: [f64; 4]) -> Self {
        if numbers.iter().any(|x| x.is_nan()) {
            return Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
        }
        let low = numbers.into_iter().fold(f64::INFINITY, f64::min);
        let high = numbers.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self { low: low.next_down(), high: high.next_up() }
    }

    /// Returns intervals of sine and cosine of all angles in the interval. The error of the crate `libm` (a port of
    /// musl's) is less than 1 ulp, which is below 2^-51 because results are at most 1. The slope of both functions is
    /// at most 1.
    #[must_use]
    pub fn sin_cos(self) -> (Self, Self) {
        const ERROR: f64 = 2.0 * f64::EPSILON; // 2^-51
        let middle = self.low + (self.high - self.low) / 2.0;
        let slack = (self.high - middle).max(middle - self.low).next_up() + ERROR;
        let around = |x: f64| Self { low: (x - slack).next_down().max(-1.0), high: (x + slack).next_up().min(1.0) };
        (around(libm::sin(middle)), around(libm::cos(middle)))
    }

    /// Returns the interval of 1/√x of all numbers x in the interval, which must be above 0. The square root of an
    /// `f64` is rounded to the nearest.
    #[must_use]
    pub fn inverse_root(self) -> Self {
        Self {
            low: (1.0 / self.high.sqrt().next_up()).next_down(),
            high: (1.0 / self.low.sqrt().next_down()).next_up(),
        }
    }

    /// Clamps all numbers of the interval between -limit and limit.
    #[must_use]
    pub fn limited(self, limit: f64) -> Self {
        Self { low: self.low.clamp(-limit, limit), high: self.high.clamp(-limit, limit) }
    }

    /// Returns the largest distance of a number from the numbers of the interval.
    #[must_use]
    pub fn farthest(self, x: f64) -> f64 {
        let distance = (x - self.low).abs().max((self.high - x).abs());
        // a floating-point difference is zero only if both numbers are equal
        if distance == 0.0 { 0.0 } else { distance.next_up() }
    }
}

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { low: (self.low + other.low).next_down(), high: (self.high + other.high).next_up() }
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self::hull([self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high])
    }
}

impl Div for Interval {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        if other.low <= 0.0 && other.high >= 0.0 {
            return Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
        }
        Self::hull([self.low / other.low, self.low / other.high, self.high / other.low, self.high / other.high])
    }
}

impl Real for Interval {
    fn by_sign(self, positive: Self, negative: Self) -> Self {
        let zero = Self::exactly(0.0);
        let parts =
            [(self.high > 0.0, positive), (self.low < 0.0, negative), (self.low <= 0.0 && self.high >= 0.0, zero)];
        let mut chosen = parts.into_iter().filter(|(is_possible, _)| *is_possible).map(|(_, part)| part);
        let Some(first) = chosen.next() else { return zero };
        chosen.fold(first, |a, b| Self { low: a.low.min(b.low), high: a.high.max(b.high) })
    }
}

#[cfg(test)]
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::float_cmp)] // numbers of 53 bits
mod tests {
    use super::Interval;

    #[test]
    fn results_are_enclosed() {
        let mut rng = fastrand::Rng::with_seed(3);
        for _ in 0..10_000 {
            // whole numbers below 2^50, whose sums and products are exact in i128
            let [a, b] = [0, 1].map(|_| rng.i64(-(1 << 50)..1 << 50));
            let [x, y] = [a, b].map(|n| Interval::exactly(n as f64));
            let exact = i128::from(a) * i128::from(b);
            let product = x * y;
            assert!((product.low as i128) <= exact && exact <= (product.high as i128), "{a} {b}");
            let sum = i128::from(a) + i128::from(b);
            assert!(((x + y).low as i128) <= sum && sum <= ((x + y).high as i128), "{a} {b}");
            assert!((x - y).low <= (a - b) as f64 && (a - b) as f64 <= (x - y).high);
        }
        // 3 (1/3) = 1
        let third = Interval::exactly(1.0) / Interval::exactly(3.0);
        assert!(third.low < third.high && (third * Interval::exactly(3.0)).low < 1.0);
        assert_eq!((Interval::exactly(1.0) / Interval { low: -1.0, high: 1.0 }).high, f64::INFINITY);
    }

    #[test]
    fn turns_are_enclosed() {
        // sin 30° = 1/2
        let sixth =
            Interval { low: std::f64::consts::FRAC_PI_6.next_down(), high: std::f64::consts::FRAC_PI_6.next_up() };
        let (sine, cosine) = sixth.sin_cos();
        assert!(sine.low < 0.5 && 0.5 < sine.high && sine.high - sine.low < 1e-14);
        let square = sine * sine + cosine * cosine;
        assert!(square.low < 1.0 && 1.0 < square.high);
    }

    #[test]
    fn the_farthest_number_bounds_an_error() {
        let interval = Interval { low: 1.0, high: 2.0 };
        assert!((interval.farthest(0.5) - 1.5).abs() < 1e-15 && interval.farthest(3.0) >= 2.0);
    }
}
