//! A number whose sign changes gradually.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use crate::Scalar;
use crate::number::dual::assigning;

/// A number that computes as `value` does, except for [`by_sign`](Scalar::by_sign). There s = x / √(x² + width²)
/// replaces the sign, and ½ (p - n) s + ½ (p + n) s² replaces the choice between p and n: p at s = 1, n at s = -1, 0 at
/// s = 0.
///
/// A result has the width of its left operand; a constant has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SmoothSign<T> {
    pub(crate) value: T,
    pub(crate) width: T,
}

impl<T: Scalar> SmoothSign<T> {
    fn with(self, value: T) -> Self {
        Self { value, width: self.width }
    }

    fn constant(value: T) -> Self {
        Self { value, width: T::zero() }
    }
}

impl<T: Scalar> Scalar for SmoothSign<T> {
    fn from_f64(value: f64) -> Self {
        Self::constant(T::from_f64(value))
    }

    fn from_f32(value: f32) -> Self {
        Self::constant(T::from_f32(value))
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.with(sin), self.with(cos))
    }

    fn by_sign(self, positive: Self, negative: Self) -> Self {
        let Self { value, width } = self;
        let s = value / (value * value + width * width).sqrt();
        let half = T::from_f64(0.5);
        let odd = (positive.value - negative.value) * half;
        let even = (positive.value + negative.value) * half;
        self.with(odd * s + even * (s * s))
    }

    fn sqrt(self) -> Self {
        self.with(self.value.sqrt())
    }
}

impl<T: Scalar> Zero for SmoothSign<T> {
    fn zero() -> Self {
        Self::constant(T::zero())
    }

    fn is_zero(&self) -> bool {
        self.value.is_zero()
    }
}

impl<T: Scalar> One for SmoothSign<T> {
    fn one() -> Self {
        Self::constant(T::one())
    }
}

impl<T: Scalar> Neg for SmoothSign<T> {
    type Output = Self;
    fn neg(self) -> Self {
        self.with(-self.value)
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident $sign:tt,)*) => {
        $(
            impl<T: Scalar> $operator for SmoothSign<T> {
                type Output = Self;
                fn $method(self, other: Self) -> Self {
                    self.with(self.value $sign other.value)
                }
            }
        )*
    };
}

operators! {
    Add add +,
    Sub sub -,
    Mul mul *,
    Div div /,
}

assigning! {
    SmoothSign:
    AddAssign add_assign +,
    SubAssign sub_assign -,
    MulAssign mul_assign *,
    DivAssign div_assign /,
}
