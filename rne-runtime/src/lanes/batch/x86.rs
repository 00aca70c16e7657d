//! The vector units that an x86 processor may have beyond the compiled target.

use core::marker::PhantomData;

use super::BatchScalar;
use super::vector::Work;
use crate::lanes::registers::{self, Computation};

/// A vector unit that was detected; the value proves that the processor has it.
#[derive(Clone, Copy)]
pub(super) enum Detected {
    /// AVX2 and fused multiply-add (x86-64-v3): registers of 4 `f64` or 8 `f32`.
    Avx2(registers::Avx2),
    /// AVX-512 F, BW, CD, DQ and VL (x86-64-v4): registers of 8 `f64` or 16 `f32`.
    Avx512(registers::Avx512),
}

impl Detected {
    pub(super) fn widest() -> Option<Self> {
        registers::Avx512::try_new().map(Self::Avx512).or_else(|| registers::Avx2::try_new().map(Self::Avx2))
    }

    pub(super) fn all() -> impl Iterator<Item = Self> {
        [registers::Avx2::try_new().map(Self::Avx2), registers::Avx512::try_new().map(Self::Avx512)]
            .into_iter()
            .flatten()
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Avx2(_) => "AVX2",
            Self::Avx512(_) => "AVX-512",
        }
    }

    pub(super) fn run<T: BatchScalar, W: Work<T>>(self, work: W) {
        match self {
            Self::Avx2(unit) => unit.vectorize(Call { work, unit, number: PhantomData }),
            Self::Avx512(unit) => unit.vectorize(Call { work, unit, number: PhantomData }),
        }
    }
}

/// A computation in registers, and the unit on which it runs.
struct Call<W, Unit, T> {
    work: W,
    unit: Unit,
    number: PhantomData<T>,
}

macro_rules! calls {
    ($($Unit:ident)*) => {$(
        impl<T: BatchScalar, W: Work<T>> Computation for Call<W, registers::$Unit, T> {
            type Result = ();

            #[inline(always)]
            fn compute(self) {
                self.work.run::<T::$Unit>(self.unit);
            }
        }
    )*};
}
calls! { Avx2 Avx512 }
