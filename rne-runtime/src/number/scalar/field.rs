//! Implements the scalar for every type of numbers that simba knows.

use core::any::Any;

use num_traits::Zero;
use simba::scalar::SupersetOf;
use simba::simd::SimdRealField;

use super::Scalar;
use crate::number::sin_cos::{Lanes, sin_cos};

impl<T: SimdRealField + Copy> Scalar for T {
    #[inline]
    fn from_f64(value: f64) -> Self {
        <Self as SupersetOf<_>>::from_subset(&value)
    }

    #[inline]
    fn from_f32(value: f32) -> Self {
        <Self as SupersetOf<_>>::from_subset(&value)
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let ([sine], [cosine]) = Self::sin_cos_array([self]);
        (sine, cosine)
    }

    // Firmware must not call functions here, but compilers for small processors would share one copy of this code.
    #[cfg_attr(feature = "std", inline)]
    #[cfg_attr(not(feature = "std"), allow(clippy::inline_always), inline(always))]
    fn sin_cos_array<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        let (mut sines, mut cosines) = (angles, angles);
        let results: (&mut dyn Any, &mut dyn Any) = (&mut sines, &mut cosines);
        if let Some(angles) = same::<_, [f64; N]>(angles)
            && let (Some(sines), Some(cosines)) = (results.0.downcast_mut(), results.1.downcast_mut())
        {
            sin_cos(&angles, sines, cosines);
        } else if let Some(angles) = same::<_, [f32; N]>(angles)
            && let (Some(sines), Some(cosines)) = (results.0.downcast_mut(), results.1.downcast_mut())
        {
            sin_cos(&angles, sines, cosines);
        } else {
            for (sine, cosine) in sines.iter_mut().zip(&mut cosines) {
                (*sine, *cosine) = sine.simd_sin_cos();
            }
        }
        (sines, cosines)
    }

    #[inline]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        let terms = [addend, self, factor];
        let double = same(terms).and_then(|[c, a, b]: [f64; 3]| same(c.plus_product(a, b)));
        let single = || same(terms).and_then(|[c, a, b]: [f32; 3]| same(c.plus_product(a, b)));
        double.or_else(single).unwrap_or_else(|| self * factor + addend)
    }

    #[inline]
    fn by_sign(self, positive: Self, negative: Self) -> Self {
        let zero = <Self as Zero>::zero();
        positive.select(self.simd_gt(zero), negative.select(self.simd_lt(zero), zero))
    }

    #[inline]
    fn sqrt(self) -> Self {
        self.simd_sqrt()
    }
}

/// Returns `value` itself if its type is `B`. Stable Rust has no specialisation; this test compares two constants and
/// disappears in release builds.
#[inline]
fn same<A: Any, B: Any + Copy>(value: A) -> Option<B> {
    (&value as &dyn Any).downcast_ref().copied()
}
