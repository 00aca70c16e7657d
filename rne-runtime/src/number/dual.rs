//! A number with its derivative.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use crate::Scalar;

/// A dual number: a value and its derivative in one direction, over any [`Scalar`]. Arithmetic follows the rules of
/// differentiation (forward mode), so every function of a robot gives its derivative as well.
///
/// ```
/// use rne_runtime::{Dual, Scalar};
///
/// let x = Dual { value: 0.5, derivative: 1.0 }; // d/dx of x
/// let (sin, _) = (x * x).sin_cos();
/// assert_eq!(sin.derivative, 2.0 * 0.5 * Scalar::sin_cos(0.25_f64).1);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dual<T> {
    /// The number.
    pub value: T,
    /// Its derivative.
    pub derivative: T,
}

impl<T: Scalar> Dual<T> {
    /// A number that does not change.
    #[must_use]
    pub fn constant(value: T) -> Self {
        Self { value, derivative: T::zero() }
    }
}

impl<T: Scalar> Zero for Dual<T> {
    fn zero() -> Self {
        Self::constant(T::zero())
    }

    fn is_zero(&self) -> bool {
        self.value.is_zero() && self.derivative.is_zero()
    }
}

impl<T: Scalar> One for Dual<T> {
    fn one() -> Self {
        Self::constant(T::one())
    }
}

impl<T: Scalar> Neg for Dual<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, derivative: -self.derivative }
    }
}

impl<T: Scalar> Add for Dual<T> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, derivative: self.derivative + other.derivative }
    }
}

impl<T: Scalar> Sub for Dual<T> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, derivative: self.derivative - other.derivative }
    }
}

impl<T: Scalar> Mul for Dual<T> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let derivative = self.derivative * other.value + self.value * other.derivative;
        Self { value: self.value * other.value, derivative }
    }
}

impl<T: Scalar> Div for Dual<T> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self { value, derivative: (self.derivative - value * other.derivative) / other.value }
    }
}

/// Defines the assigning operators of a generic scalar, such as `+=`.
macro_rules! assigning {
    ($type:ident: $($operator:ident $assign:ident $sign:tt,)*) => {
        $(
            impl<T: Scalar> $operator for $type<T> {
                fn $assign(&mut self, other: Self) {
                    *self = *self $sign other;
                }
            }
        )*
    };
}
pub(crate) use assigning;

assigning! {
    Dual:
    AddAssign add_assign +,
    SubAssign sub_assign -,
    MulAssign mul_assign *,
    DivAssign div_assign /,
}

impl<T: Scalar> Scalar for Dual<T> {
    fn from_f64(value: f64) -> Self {
        Self::constant(T::from_f64(value))
    }

    fn from_f32(value: f32) -> Self {
        Self::constant(T::from_f32(value))
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (
            Self { value: sin, derivative: cos * self.derivative },
            Self { value: cos, derivative: -(sin * self.derivative) },
        )
    }

    fn by_sign(self, positive: Self, negative: Self) -> Self {
        Self {
            value: self.value.by_sign(positive.value, negative.value),
            derivative: self.value.by_sign(positive.derivative, negative.derivative),
        }
    }

    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        Self { value, derivative: self.derivative / (value + value) }
    }
}
