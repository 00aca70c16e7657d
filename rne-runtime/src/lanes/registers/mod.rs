//! Vector registers, by the instructions of `core::arch`, and the vector units that are found when the program runs.
//!
//! | registers | unit | lanes |
//! |---|---|---|
//! | [`compiled`] | that of the compiled target: AVX2 and fused multiply-add, else SSE2; NEON; elsewhere one number | 4 or 8, 2 or 4, 1 |
//! | `avx2` | AVX2 and fused multiply-add (x86-64-v3), found | 4 `f64`, 8 `f32` |
//! | `avx512` | AVX-512 (x86-64-v4), found | 8 `f64`, 16 `f32` |
//!
//! This is the one module with `unsafe` in it, for three things:
//!
//! - A register and an array of its numbers are the same bytes, as `transmute` has them.
//! - A unit compiles code with its instructions (`vectorize`). Such a function may be called on a processor alone that
//!   has them; a unit is the proof, for its one constructor asks the processor.
//! - An instruction is executed. Every operation would want the proof, a value of no size. Generic code cannot hand it
//!   on: a constant is made from nothing. A register that carried a proof or none would be a byte longer, and the
//!   processor would stall on every copy. So operations take it for granted, and nobody has a register without having
//!   shown that the unit is there:
//!   - Registers are made by [`Lanes::splat`](crate::number::sin_cos::Lanes::splat), `Register::padded` and
//!     [`Vector::load`](crate::lanes::batch::vector::Vector::load). These traits are private to this crate, so that no
//!     other can call them, although it can name the types (as what the public `BatchScalar` computes with).
//!   - Within this crate the types of a found unit are a parameter of
//!     [`Work::run`](crate::lanes::batch::vector::Work::run), which takes the proof as an argument, of the single calls
//!     of `processor`, which hold it, and of what these call: generated code, which makes constants of the scalar that
//!     it is given, the loop of the machine, and the kernel of sine and cosine.
//!   - The registers of the compiled target are those without which the program would not run.
//!   - A processor that has a unit keeps it.
#![allow(unsafe_code)]

mod number;
#[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64", target_arch = "aarch64")))]
mod register;

#[cfg(all(feature = "std", target_arch = "aarch64", target_feature = "neon"))]
mod aarch64;
#[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
mod unit;
#[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64")))]
mod x86;

#[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
pub(crate) use unit::{Avx2, Avx512, Computation};
#[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
pub(crate) use x86::{avx2, avx512};

/// The registers of the compiled target: the widest ones up to 256 bits. A single call has too few angles for wider
/// ones, and during an instruction of 512 bits, Intel's processors do not use one of their three arithmetic units for
/// other instructions.
pub(crate) mod compiled {
    #[cfg(all(feature = "std", target_arch = "aarch64", target_feature = "neon"))]
    pub(crate) use super::aarch64::{Doubles, Singles};
    #[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
    pub(crate) use super::x86::compiled::{Doubles, Singles};

    /// Registers of one number: without `std`, and on processors whose registers are not known here.
    #[cfg(not(all(
        feature = "std",
        any(
            all(target_arch = "aarch64", target_feature = "neon"),
            all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2")
        )
    )))]
    mod numbers {
        pub(crate) type Doubles = f64;
        pub(crate) type Singles = f32;
    }
    #[cfg(not(all(
        feature = "std",
        any(
            all(target_arch = "aarch64", target_feature = "neon"),
            all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2")
        )
    )))]
    pub(crate) use numbers::{Doubles, Singles};

    /// Name of the unit.
    pub(crate) const NAME: &str = match size_of::<Doubles>() {
        8 => "one by one",
        16 if cfg!(target_arch = "aarch64") => "NEON",
        16 => "SSE2",
        _ => "AVX2 (compiled)",
    };
}
