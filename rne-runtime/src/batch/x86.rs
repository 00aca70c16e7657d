//! The vector units that an x86 processor may have beyond the compiled target.

use core::marker::PhantomData;

use pulp::NullaryFnOnce;
use pulp::x86::{V3, V4};

use super::BatchScalar;
use super::vector::Work;
use super::x86_register::Shift;

/// A unit and, in pulp's token, the proof that the processor has it.
#[derive(Clone, Copy)]
pub(super) enum Detected {
    /// AVX2 and fused multiply-add (x86-64-v3): registers of 4 `f64` or 8 `f32`.
    Avx2(V3),
    /// AVX-512 F, BW, CD, DQ and VL (x86-64-v4): registers of 8 `f64` or 16 `f32`.
    Avx512(V4),
}

impl Detected {
    pub(super) fn widest() -> Option<Self> {
        V4::try_new().map(Self::Avx512).or_else(|| V3::try_new().map(Self::Avx2))
    }

    pub(super) fn all() -> impl Iterator<Item = Self> {
        [V3::try_new().map(Self::Avx2), V4::try_new().map(Self::Avx512)].into_iter().flatten()
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

/// Work and a unit as what pulp calls. Not a closure: this can be inlined always.
struct Call<W, Unit, T> {
    work: W,
    unit: Unit,
    number: PhantomData<T>,
}

impl<T: BatchScalar, W: Work<T>, S: Shift> NullaryFnOnce for Call<W, S, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.work.run::<T::Detected<S>>(self.unit);
    }
}
