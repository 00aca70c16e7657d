//! Sine and cosine of `f64` and `f32` without a branch, for one angle or, in SIMD registers, for several at once.
//!
//! # Promise
//!
//! | | range, rad | error, each of sine and cosine | arithmetic |
//! |---|---|---|---|
//! | `f64` | abs(x) ≤ 10⁵ | < 1 ulp | `f64` |
//! | `f32` | abs(x) ≤ 10⁵ | < 1 ulp | `f32` alone, for hardware without `f64` |
//!
//! An angle has the same bits alone and in an array of any length, and the same bits on all targets that are compiled
//! without fused multiply-add. The sine is odd and the cosine even, to the last bit: sin(-0) = -0. NaN and infinities
//! give NaN. Beyond the range `std`'s functions follow; without `std` results there mean nothing.
//!
//! ```text
//! cargo run --release -p rne-runtime --features batch --example sin_cos_accuracy    # every f32 of the range, 10⁸ f64
//! cargo run --release -p rne-runtime --example sin_cos_speed
//! ```
//!
//! # Method
//!
//! 1. [`reduction`]: x = n π/2 + y - e with n the nearest integer to x 2/π, y rounded and e its small excess.
//! 2. [`polynomial`]: sin(y - e) and cos(y - e) for abs(y) ≤ π/4 (a little more where x 2/π is rounded across a half).
//! 3. [`lanes`]: n mod 4 exchanges and negates the two. All is written once, for a number or a register of numbers.
//! 4. [`array`](mod@array): the three for many angles, and the one test of their range.
#![allow(clippy::inline_always)] // the kernel must be compiled with the target features of its caller

pub(crate) mod array;
mod lanes;
mod polynomial;
mod reduction;
#[cfg(feature = "std")]
pub(crate) mod registers;

pub(crate) use array::sin_cos;
pub(crate) use lanes::Lanes;

use core::fmt::Debug;

#[cfg(feature = "std")]
use crate::lanes::registers::compiled;
use reduction::Reduced;

/// Whether Rust offers a fused multiply-add: `std` does, and `core` with a nightly compiler.
const IS_THERE: bool = cfg!(any(feature = "std", feature = "core_float_math"));

/// Whether fused multiply-add is one instruction for `f32` on the compiled target. Cortex-M with registers for numbers
/// (`eabihf`) has it in single precision.
pub(crate) const FUSED_F32: bool = FUSED_F64
    || IS_THERE
        && cfg!(any(
            all(target_arch = "arm", target_feature = "mclass", target_abi = "eabihf"),
            all(any(target_arch = "riscv32", target_arch = "riscv64"), target_feature = "f"),
        ));

/// Whether `f64` is computed with fused multiply-add.
pub(crate) const FUSED_F64: bool = IS_THERE
    && cfg!(any(
        all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "fma"),
        target_arch = "aarch64",
        all(any(target_arch = "riscv32", target_arch = "riscv64"), target_feature = "d"),
    ));

/// The properties of `f32` and `f64` that differ: the constants, and the reduction of the angle.
pub trait Float: Lanes<Element = Self> + Debug + PartialOrd + 'static {
    const ZERO: Self;
    const MINUS_TWO: Self;
    const HALF: Self;
    const ONE: Self;
    const P: &'static [Self];
    const Q: &'static [Self];
    /// A register of the compiled target.
    #[cfg(feature = "std")]
    type Register: registers::Register<Element = Self>;

    /// Returns the nearest number of this type.
    fn rounded(value: f64) -> Self;

    /// Reduces an angle, the first of the three steps.
    fn reduced<V: Lanes<Element = Self>>(angle: V) -> Reduced<V>;

    /// Whether the kernel is correct for this angle; false for NaN.
    fn is_within_limit(self) -> bool;
    /// Whether the kernel is certainly correct for all angles whose squares have this sum; false for NaN. A sum of
    /// correct angles may be too large.
    fn is_square_within_limit(self) -> bool;
    /// Returns sine and cosine by `std`, which are correct for every angle.
    #[cfg(feature = "std")]
    fn std_sin_cos(self) -> (Self, Self);
}

/// The largest angle, rad, that is reduced with sufficient accuracy.
pub(crate) const LIMIT: f32 = 1e5;

/// If the squares of angles have a sum of at most this, rad², then each angle is below the limit.
pub(crate) const SQUARE_LIMIT: f32 = 0.99 * LIMIT * LIMIT;

macro_rules! float {
    ($type:ident, $reduction:ident, $P:ident, $Q:ident, $Register:ident) => {
        impl Float for $type {
            const ZERO: Self = 0.0;
            const MINUS_TWO: Self = -2.0;
            const HALF: Self = 0.5;
            const ONE: Self = 1.0;
            const P: &'static [Self] = &polynomial::$P;
            const Q: &'static [Self] = &polynomial::$Q;

            #[cfg(feature = "std")]
            type Register = compiled::$Register;

            #[inline(always)]
            #[allow(clippy::cast_possible_truncation, trivial_numeric_casts)]
            fn rounded(value: f64) -> Self {
                value as $type
            }

            #[inline(always)]
            fn reduced<V: Lanes<Element = Self>>(angle: V) -> Reduced<V> {
                reduction::$reduction(angle)
            }

            #[inline(always)]
            fn is_within_limit(self) -> bool {
                self.abs() <= LIMIT.into()
            }

            #[inline(always)]
            fn is_square_within_limit(self) -> bool {
                self <= SQUARE_LIMIT.into()
            }

            #[cfg(feature = "std")]
            fn std_sin_cos(self) -> (Self, Self) {
                self.sin_cos()
            }
        }
    };
}
float!(f64, double, P_F64, Q_F64, Doubles);
float!(f32, single, P_F32, Q_F32, Singles);

/// Computes sine and cosine without a branch; they are correct up to the limit.
#[inline(always)]
pub(crate) fn kernel<V: Lanes>(angle: V) -> (V, V) {
    let Reduced { rounded, head, excess } = V::Element::reduced(angle);
    let (sine, cosine) = polynomial::sine_and_cosine(head, excess);
    V::in_quadrant(rounded, sine, cosine)
}

/// Evaluates one angle whose result the caller waits for, as fast as possible even for registers that are otherwise
/// used for [many](Lanes::MANY).
#[cfg(feature = "std")]
#[inline(always)]
fn kernel_of_one_call<V: Lanes>(angle: V) -> (V, V) {
    let Reduced { rounded, head, excess } = V::Element::reduced(angle);
    let (sine, cosine) = polynomial::soon(head, excess);
    V::in_quadrant(rounded, sine, cosine)
}
