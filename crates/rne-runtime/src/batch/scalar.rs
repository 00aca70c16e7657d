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
        let (mut sines, mut cosines) = (angles, angles);
        // A loop here would be one within the loop over states, which LLVM then leaves alone: six times slower.
        macro_rules! unrolled {
            ($($index:literal)*) => {
                $(if $index < N {
                    (sines[$index], cosines[$index]) = angles[$index].sin_cos();
                })*
            };
        }
        unrolled!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31);
        for index in 32..N {
            (sines[index], cosines[index]) = angles[index].sin_cos();
        }
        (sines, cosines)
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
    pub trait Machine: Copy {
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

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::Lane;
    use crate::Scalar;

    #[test]
    fn a_lane_has_the_sine_and_cosine_of_its_number() {
        let angles = [-0.0, 0.3, -1.7, 99_999.0].map(Lane::<f64, false>);
        let (sines, cosines) = Lane::sin_cos_array(angles);
        for ((angle, sine), cosine) in angles.into_iter().zip(sines).zip(cosines) {
            assert_eq!(angle.sin_cos(), (sine, cosine));
            if !crate::sin_cos::FUSED {
                assert_eq!(angle.0.sin_cos(), (sine.0, cosine.0));
            }
        }
    }

    #[test]
    fn an_angle_beyond_the_kernel_s_limit_is_nan() {
        let (sine, cosine) = Lane::<f32, true>(100_001.0).sin_cos();
        assert!(sine.0.is_nan() && cosine.0.is_nan());
    }

    #[test]
    fn a_product_and_a_sum_are_rounded_once_where_they_are_fused() {
        let (x, tiny) = (1.0 + f64::EPSILON, f64::EPSILON * f64::EPSILON);
        let square = -(1.0 + 2.0 * f64::EPSILON);
        assert_eq!(Lane::<f64, true>(x).mul_add(Lane(x), Lane(square)).0, tiny);
        assert_eq!(Lane::<f64, false>(x).mul_add(Lane(x), Lane(square)).0, 0.0);
    }
}
