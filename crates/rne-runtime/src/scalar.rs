//! The number type that every function of a robot is generic over.

use core::any::Any;
use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};
use simba::simd::SimdRealField;

/// A real number, or a bundle of them: `f32`, `f64`, simba's SIMD lanes, dual numbers, fixed point.
///
/// Implemented for everything that is simba's [`SimdRealField`] and `Copy`. A type of your own that is no such field (an
/// interval, say) implements this trait itself; a foreign one needs a newtype.
///
/// The ring operators come with their assigning forms, `+=` and so on: nalgebra's sums and products of matrices ask for
/// them, and the generic recursion is written in nalgebra.
pub trait Scalar:
    Copy
    + Debug
    + PartialEq
    + 'static
    + Zero
    + One
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// A constant, rounded once to this type.
    #[must_use]
    fn from_f64(value: f64) -> Self;

    /// A constant that is stored in single precision; never passes through `f64` when this type is `f32`. A type of your
    /// own may leave it out.
    #[must_use]
    fn from_f32(value: f32) -> Self {
        Self::from_f64(value.into())
    }

    /// Sine and cosine of an angle in rad.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);

    /// Sines and cosines of several angles in rad, each equal, bit for bit, to [`sin_cos`](Self::sin_cos) of that angle.
    #[must_use]
    fn sin_cos_array<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        let (mut sines, mut cosines) = (angles, angles);
        for (sine, cosine) in sines.iter_mut().zip(&mut cosines) {
            (*sine, *cosine) = sine.sin_cos();
        }
        (sines, cosines)
    }

    /// `self * factor + addend`: rounded once where the compiled target has an instruction for that, else a product and a
    /// sum.
    ///
    /// Of the scalars here only `f32` and `f64` are ever rounded once, and only with `std` (`core` has no such operation
    /// yet): on x86-64 built with the target feature `fma`, and on AArch64. It is never a call of a library.
    #[must_use]
    #[inline]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
}

impl<T: SimdRealField + Copy> Scalar for T {
    #[inline]
    fn from_f64(value: f64) -> Self {
        nalgebra::convert(value)
    }

    #[inline]
    fn from_f32(value: f32) -> Self {
        nalgebra::convert(value)
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        self.simd_sin_cos()
    }

    #[inline]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        let terms = [self, factor, addend];
        let double = same(terms).and_then(|[a, b, c]: [f64; 3]| same(fused::f64(a, b, c)));
        let single = || same(terms).and_then(|[a, b, c]: [f32; 3]| same(fused::f32(a, b, c)));
        double.or_else(single).unwrap_or_else(|| self * factor + addend)
    }
}

/// `value` itself if its type is `B`. There is no specialisation in stable Rust; this test is of two constants and
/// disappears in release builds.
#[inline]
fn same<A: Any, B: Any + Copy>(value: A) -> Option<B> {
    (&value as &dyn Any).downcast_ref().copied()
}

/// `a * b + c`, rounded once where the target has an instruction for that; `core` has no such operation yet, only `std`.
mod fused {
    macro_rules! fused {
        ($type:ident) => {
            #[cfg(all(
                feature = "std",
                any(
                    all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "fma"),
                    target_arch = "aarch64"
                )
            ))]
            #[inline]
            pub(super) fn $type(a: $type, b: $type, c: $type) -> $type {
                a.mul_add(b, c)
            }

            #[cfg(not(all(
                feature = "std",
                any(
                    all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "fma"),
                    target_arch = "aarch64"
                )
            )))]
            #[inline]
            pub(super) fn $type(a: $type, b: $type, c: $type) -> $type {
                a * b + c
            }
        };
    }
    fused!(f32);
    fused!(f64);
}

/// The scalar in which a robot's constants are stored: `f64`, or `f32` to keep double precision off a target without it.
pub trait Constant: Scalar + sealed::Sealed {
    /// This constant in the scalar of a computation.
    #[must_use]
    fn to<T: Scalar>(self) -> T;
}

impl Constant for f64 {
    #[inline]
    fn to<T: Scalar>(self) -> T {
        T::from_f64(self)
    }
}

impl Constant for f32 {
    #[inline]
    fn to<T: Scalar>(self) -> T {
        T::from_f32(self)
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for f32 {}
}
