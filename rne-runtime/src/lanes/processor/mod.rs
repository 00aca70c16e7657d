//! Single calls that use the instructions of the processor, even those for which the program is not compiled.
//!
//! A plain build for x86-64 knows no fused multiply-add, and only registers of two `f64`. Derived code of the reduced
//! form is the body of a [`Call`], and [`run`] compiles it twice for `f64` and `f32`: for the compiled target, and for
//! AVX2 with fused multiply-add. The processor is tested once, as for [batches](crate::lanes::batch); afterwards a call
//! reads one byte and jumps. The results then have the bits of a program that is compiled for x86-64-v3.
//!
//! There is only one copy, and no test, if the compiled target has these instructions, on other processors, without the
//! feature `batch`, and for all other scalars.
#![allow(clippy::inline_always)] // code for the processor's instructions must be compiled with them

#[cfg_attr(
    all(
        feature = "batch",
        any(target_arch = "x86", target_arch = "x86_64"),
        not(all(target_feature = "avx2", target_feature = "fma"))
    ),
    path = "x86.rs"
)]
#[cfg_attr(
    not(all(
        feature = "batch",
        any(target_arch = "x86", target_arch = "x86_64"),
        not(all(target_feature = "avx2", target_feature = "fma"))
    )),
    path = "compiled.rs"
)]
mod detected;

use core::any::Any;

use crate::Scalar;

/// Operations that derived code needs in addition to the operators of its scalar.
pub trait Arithmetic<T> {
    /// Returns `a * b + c`, as [`Scalar::mul_add`] does.
    fn mul_add(a: T, b: T, c: T) -> T;

    /// Sine and cosine of an angle in rad.
    fn sin_cos(angle: T) -> (T, T);

    /// Returns sines and cosines of several angles in rad.
    fn sin_cos_array<const N: usize>(angles: [T; N]) -> ([T; N], [T; N]);
}

/// The operations of the scalar itself, with the instructions for which the program is compiled.
#[derive(Debug)]
pub enum Compiled {}

impl<T: Scalar> Arithmetic<T> for Compiled {
    #[inline(always)]
    fn mul_add(a: T, b: T, c: T) -> T {
        T::mul_add(a, b, c)
    }

    #[inline(always)]
    fn sin_cos(angle: T) -> (T, T) {
        T::sin_cos(angle)
    }

    #[inline(always)]
    fn sin_cos_array<const N: usize>(angles: [T; N]) -> ([T; N], [T; N]) {
        T::sin_cos_array(angles)
    }
}

/// The body of a derived method.
pub trait Call {
    /// The arguments: a tuple of references.
    type Arguments<'a, T: Scalar>: Copy + OfType<Self::Arguments<'a, f64>> + OfType<Self::Arguments<'a, f32>>;

    /// Result of the method.
    type Result<T: Scalar>: Copy + 'static;

    /// Runs the body. Implementations are `#[inline(always)]`.
    fn run<T: Scalar, A: Arithmetic<T>>(arguments: Self::Arguments<'_, T>) -> Self::Result<T>;
}

/// Runs the body of a derived method with the instructions of the processor.
#[inline(always)]
pub fn run<C: Call, T: Scalar>(arguments: C::Arguments<'_, T>) -> C::Result<T> {
    detected::run::<C, T>(arguments)
}

/// A value that may have the type `B`; the test costs nothing. Stable Rust has no specialisation, so this compares two
/// constants.
pub trait OfType<B> {
    /// Returns the value itself if it has this type.
    fn of_type(self) -> Option<B>;
}

impl<'a, A: Any, B: Any> OfType<&'a B> for &'a A {
    #[inline(always)]
    fn of_type(self) -> Option<&'a B> {
        (self as &dyn Any).downcast_ref()
    }
}

macro_rules! tuple {
    ($($A:ident $B:ident $index:tt),*) => {
        impl<$($A: OfType<$B>, $B),*> OfType<($($B,)*)> for ($($A,)*) {
            #[inline(always)]
            fn of_type(self) -> Option<($($B,)*)> {
                Some(($(self.$index.of_type()?,)*))
            }
        }
    };
}
tuple!(A0 B0 0);
tuple!(A0 B0 0, A1 B1 1);
tuple!(A0 B0 0, A1 B1 1, A2 B2 2);
tuple!(A0 B0 0, A1 B1 1, A2 B2 2, A3 B3 3);
tuple!(A0 B0 0, A1 B1 1, A2 B2 2, A3 B3 3, A4 B4 4);
tuple!(A0 B0 0, A1 B1 1, A2 B2 2, A3 B3 3, A4 B4 4, A5 B5 5);
tuple!(A0 B0 0, A1 B1 1, A2 B2 2, A3 B3 3, A4 B4 4, A5 B5 5, A6 B6 6);
tuple!(A0 B0 0, A1 B1 1, A2 B2 2, A3 B3 3, A4 B4 4, A5 B5 5, A6 B6 6, A7 B7 7);
