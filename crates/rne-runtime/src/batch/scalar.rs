//! The numbers of a batch, and what a vector of them is computed as.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use crate::Scalar;

/// A number of which vector units hold many: `f32` and `f64`, and no other type.
pub trait BatchScalar: Scalar + Send + Sync + sealed::Machine {}

impl BatchScalar for f32 {}
impl BatchScalar for f64 {}

/// One lane of a vector register: generated code is compiled for this scalar, inside a loop over states that LLVM turns
/// into one over registers.
///
/// So all of its functions must be inlined and none may branch or call another. What cannot be computed so, an angle beyond
/// the range of the kernel of sine and cosine, becomes NaN and is computed again by [`batch`](super), as the scalar it is.
///
/// `FUSED` where the code is compiled with fused multiply-add: elsewhere each would be a call of a library.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lane<T, const FUSED: bool>(pub(super) T);

impl<T: BatchScalar, const FUSED: bool> Scalar for Lane<T, FUSED> {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self(T::rounded(value))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.0.sin_cos_or_nan::<FUSED>();
        (Self(sine), Self(cosine))
    }

    #[inline(always)]
    fn sin_cos_array<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        let pairs = angles.map(Self::sin_cos);
        (pairs.map(|pair| pair.0), pairs.map(|pair| pair.1))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(self.0.times_plus::<FUSED>(factor.0, addend.0))
    }
}

macro_rules! operator {
    ($($Operator:ident :: $operator:ident, $Assign:ident :: $assign:ident, $symbol:tt;)*) => {$(
        impl<T: BatchScalar, const FUSED: bool> $Operator for Lane<T, FUSED> {
            type Output = Self;

            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                Self(self.0 $symbol other.0)
            }
        }

        impl<T: BatchScalar, const FUSED: bool> $Assign for Lane<T, FUSED> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = *self $symbol other;
            }
        }
    )*};
}
operator! {
    Add::add, AddAssign::add_assign, +;
    Sub::sub, SubAssign::sub_assign, -;
    Mul::mul, MulAssign::mul_assign, *;
    Div::div, DivAssign::div_assign, /;
}

impl<T: BatchScalar, const FUSED: bool> Neg for Lane<T, FUSED> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<T: BatchScalar, const FUSED: bool> Zero for Lane<T, FUSED> {
    #[inline(always)]
    fn zero() -> Self {
        Self(T::zero())
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }
}

impl<T: BatchScalar, const FUSED: bool> One for Lane<T, FUSED> {
    #[inline(always)]
    fn one() -> Self {
        Self(T::one())
    }
}

mod sealed {
    use crate::sin_cos::{Lanes, sin_cos_or_nan};

    /// What [`Lane`](super::Lane) needs of its number.
    pub trait Machine: Sized {
        /// The nearest number of this type.
        fn rounded(value: f64) -> Self;
        /// Two NaN for an angle that the kernel is not made for.
        fn sin_cos_or_nan<const FUSED: bool>(self) -> (Self, Self);
        /// `self * factor + addend`
        fn times_plus<const FUSED: bool>(self, factor: Self, addend: Self) -> Self;
        fn is_nan(self) -> bool;
    }

    macro_rules! machine {
        ($($type:ident)*) => {$(
            impl Machine for $type {
                #[inline(always)]
                #[allow(clippy::cast_possible_truncation, trivial_numeric_casts)]
                fn rounded(value: f64) -> Self {
                    value as $type
                }

                #[inline(always)]
                fn sin_cos_or_nan<const FUSED: bool>(self) -> (Self, Self) {
                    sin_cos_or_nan::<$type, FUSED>(self)
                }

                #[inline(always)]
                fn times_plus<const FUSED: bool>(self, factor: Self, addend: Self) -> Self {
                    addend.plus_product::<FUSED>(self, factor)
                }

                #[inline(always)]
                fn is_nan(self) -> bool {
                    self.is_nan()
                }
            }
        )*};
    }
    machine!(f32 f64);
}
