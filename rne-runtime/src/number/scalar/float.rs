//! Implements the scalar for `f32` and `f64` without the feature `simba`, with the same bits as with it.

use super::Scalar;
use crate::number::sin_cos::{Lanes, sin_cos};

macro_rules! float {
    ($($float:ident)*) => { $(
        impl Scalar for $float {
            #[inline]
            #[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
            fn from_f64(value: f64) -> Self {
                value as Self
            }

            #[inline]
            #[allow(clippy::cast_lossless)]
            fn from_f32(value: f32) -> Self {
                value as Self
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                let ([sine], [cosine]) = Self::sin_cos_array([self]);
                (sine, cosine)
            }

            // Firmware must not call functions here, but compilers for small processors would share one copy of this
            // code.
            #[cfg_attr(feature = "std", inline)]
            #[cfg_attr(not(feature = "std"), allow(clippy::inline_always), inline(always))]
            fn sin_cos_array<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
                let (mut sines, mut cosines) = (angles, angles);
                sin_cos(&angles, &mut sines, &mut cosines);
                (sines, cosines)
            }

            #[inline]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                addend.plus_product(self, factor)
            }

            #[inline]
            fn by_sign(self, positive: Self, negative: Self) -> Self {
                if self > 0.0 {
                    positive
                } else if self < 0.0 {
                    negative
                } else {
                    0.0
                }
            }

            #[inline]
            fn sqrt(self) -> Self {
                num_traits::Float::sqrt(self)
            }
        }
    )* };
}

float!(f32 f64);
