//! Sine and cosine of `f64` and `f32` without a branch, so that a loop over several angles becomes SIMD instructions.
//!
//! # Promise
//!
//! | | range, rad | error, each of sine and cosine | arithmetic |
//! |---|---|---|---|
//! | `f64` | abs(x) ≤ 10⁵ | < 1 ulp | `f64` |
//! | `f32` | abs(x) ≤ 10⁵ | < 1 ulp | `f32` alone, for hardware without `f64` |
//!
//! An angle has the same bits alone and in an array of any length, and, when compiled for targets without fused
//! multiply-add, the same bits on all of them. The sine is odd and the cosine even to the last bit: sin(-0) = -0. NaN and
//! infinities give NaN. Beyond the range `std`'s functions follow; without `std` results there mean nothing.
//!
//! ```text
//! cargo run --release -p rne-runtime --example sin_cos_accuracy    # every f32 of the range, 10⁸ f64
//! cargo run --release -p rne-runtime --example sin_cos_speed
//! ```
//!
//! # Method
//!
//! 1. [`reduction`]: x = n π/2 + y - e with n the nearest integer to x 2/π, y rounded and e its small excess.
//! 2. [`polynomial`]: sin(y - e) and cos(y - e) for abs(y) ≤ π/4 (a little more when x 2/π is rounded across a half).
//! 3. [`quadrant`]: n mod 4 exchanges and negates the two.
//! 4. [`lanes`]: the three for many angles, and the one test of their range.
#![allow(clippy::inline_always)] // the kernel must be compiled with the target features of its caller

mod lanes;
mod polynomial;
mod quadrant;
mod reduction;

pub(crate) use lanes::sin_cos_lanes;

use crate::fused::{AT_HAND, Fused};

/// `f32` and `f64`: what the steps above need of them.
pub(crate) trait Float: Copy + Fused + 'static {
    const ZERO: Self;
    /// Angles up to this are reduced exactly enough.
    #[cfg(feature = "std")]
    const LIMIT: Self;
    /// Numbers in a register of the compiled target.
    const REGISTER: usize;

    /// The kernel: no branch, and correct up to [`LIMIT`](Self::LIMIT).
    fn reduced_sin_cos<const FMA: bool>(self) -> (Self, Self);
    /// Whether the kernel is correct; false for NaN.
    #[cfg(feature = "std")]
    fn is_within_limit(self) -> bool;
    /// Correct everywhere.
    #[cfg(feature = "std")]
    fn std_sin_cos(self) -> (Self, Self);
}

macro_rules! float {
    ($type:ident, register: $register:expr) => {
        impl Float for $type {
            const ZERO: Self = 0.0;
            #[cfg(feature = "std")]
            const LIMIT: Self = 1e5;
            const REGISTER: usize = $register;

            #[inline(always)]
            fn reduced_sin_cos<const FMA: bool>(self) -> (Self, Self) {
                let angle = reduction::$type::<FMA>(self);
                let (sine, cosine) = polynomial::$type::<FMA>(angle.head, angle.excess);
                quadrant::$type(angle.quadrant, sine, cosine)
            }

            #[cfg(feature = "std")]
            #[inline(always)]
            fn is_within_limit(self) -> bool {
                self.abs() <= Self::LIMIT
            }

            #[cfg(feature = "std")]
            fn std_sin_cos(self) -> (Self, Self) {
                self.sin_cos()
            }
        }
    };
}
float!(f64, register: lanes::REGISTER_BYTES.div_ceil(8));
float!(f32, register: lanes::REGISTER_BYTES.div_ceil(4));

/// Sine and cosine of one angle.
#[inline]
pub(crate) fn pair<T: Float>(angle: T) -> (T, T) {
    let ([sine], [cosine]) = array([angle]);
    (sine, cosine)
}

/// Sines and cosines of several angles, with fused multiply-add if the compiled target has it.
#[inline]
pub(crate) fn array<T: Float, const N: usize>(angles: [T; N]) -> ([T; N], [T; N]) {
    sin_cos_lanes::<T, AT_HAND, N>(&angles)
}
