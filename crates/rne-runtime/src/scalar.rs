//! The number type that every function of a robot is generic over.

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
