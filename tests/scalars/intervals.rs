//! Intervals: what is rounded on the way is inside, and so is every state near the given one.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use fastrand::Rng;
use inari::Interval;
use num_traits::{One, Zero};
use rne::Scalar;

use crate::robots::{PLANAR_STATE, PUMA_STATE, Planar2, Puma560, Robot, State, all};

/// The numbers between two bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Range(Interval);

impl Range {
    fn between(low: f64, high: f64) -> Self {
        Self(Interval::try_from((low, high)).expect("bounds in order"))
    }

    fn contains(self, x: f64) -> bool {
        self.0.contains(x)
    }

    fn hull(self, other: Self) -> Self {
        Self(self.0.convex_hull(other.0))
    }
}

impl Neg for Range {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident $assigning:ident $assign:ident)*) => {$(
        impl $operator for Range {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self($operator::$method(self.0, other.0))
            }
        }

        impl $assigning for Range {
            fn $assign(&mut self, other: Self) {
                *self = $operator::$method(*self, other);
            }
        }
    )*};
}

operators! {
    Add add AddAssign add_assign
    Sub sub SubAssign sub_assign
    Mul mul MulAssign mul_assign
    Div div DivAssign div_assign
}

impl Zero for Range {
    fn zero() -> Self {
        Self::between(0.0, 0.0)
    }

    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl One for Range {
    fn one() -> Self {
        Self::between(1.0, 1.0)
    }
}

impl Scalar for Range {
    fn from_f64(value: f64) -> Self {
        Self::between(value, value)
    }

    /// Of intervals much shorter than a quarter turn: by the ends, which are right to one unit in the last place, and a
    /// sine moves away from their mean by no more than half of the length.
    fn sin_cos(self) -> (Self, Self) {
        let (low, high) = (self.0.inf(), self.0.sup());
        let reach = 0.5 * (high - low);
        let around = |a: f64, b: f64| {
            let (low, high) = (a.min(b), a.max(b));
            Self::between((low - reach).next_down().next_down(), (high + reach).next_up().next_up())
        };
        let ((s, c), (sine, cosine)) = (Scalar::sin_cos(low), Scalar::sin_cos(high));
        (around(s, sine), around(c, cosine))
    }

    fn by_sign(self, positive: Self, negative: Self) -> Self {
        match (self.0.inf(), self.0.sup()) {
            (low, _) if low > 0.0 => positive,
            (_, high) if high < 0.0 => negative,
            _ => positive.hull(negative).hull(Self::zero()),
        }
    }
}

/// How much wider than the states a result may be, relative to its largest number. Intervals know nothing of how
/// numbers depend on each other, and accelerations divide by small ones.
fn widening(function: &str) -> f64 {
    if function == "forward_dynamics" { 1e8 } else { 1e4 }
}

fn enclosed<const DOF: usize>(robot: &impl Robot<DOF>, state: &State<DOF, f64>, radius: f64) {
    let ranges = all(robot, &state.map(|array| array.map(|x| Range::between(x - radius, x + radius))));
    let mut rng = Rng::with_seed(6);
    for _ in 0..20 {
        let near =
            state.map(|array| array.map(|x| (x + (2.0 * rng.f64() - 1.0) * radius).clamp(x - radius, x + radius)));
        for ((name, ranges), (_, numbers)) in ranges.iter().zip(all(robot, &near)) {
            assert_eq!(ranges.len(), numbers.len());
            let scale = numbers.iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
            for (range, number) in ranges.iter().zip(numbers) {
                assert!(range.contains(number), "{name}: {number} is not in {range:?}");
                let width = range.0.wid();
                assert!(width <= widening(name) * (radius + f64::EPSILON) * scale, "{name}: {width:e} of {scale}");
            }
        }
    }
}

#[test]
fn ranges_contain_what_is_rounded_and_are_narrow() {
    for radius in [0.0, 1e-12] {
        enclosed(&Puma560, &PUMA_STATE, radius);
        enclosed(&Planar2, &PLANAR_STATE, radius);
    }
}
