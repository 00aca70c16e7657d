//! The vector unit: what the processor has, found at run time.

use core::fmt;

#[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
use pulp::NullaryFnOnce;
#[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
use pulp::x86::{V3, V4};

use crate::sin_cos::FUSED;

/// A vector unit of the processor this runs on. Every value of this type can be computed with.
#[derive(Clone, Copy)]
pub struct VectorUnit(Unit);

#[derive(Clone, Copy)]
enum Unit {
    /// What the compiled target has for certain: SSE2 on x86-64, NEON on AArch64, more with `-C target-cpu`.
    Target,
    /// AVX2 and fused multiply-add: 4 `f64` or 8 `f32`.
    #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
    Avx2(V3),
    /// AVX-512 (F, BW, CD, DQ, VL): 8 `f64` or 16 `f32`.
    #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
    Avx512(V4),
}

impl VectorUnit {
    /// The widest one. Looking for it costs a nanosecond.
    #[must_use]
    pub fn widest() -> Self {
        Self::all().last().unwrap_or(Self(Unit::Target))
    }

    /// All of them, the narrowest first: that of the compiled target, which every processor that runs this has.
    pub fn all() -> impl Iterator<Item = Self> {
        let target = [Some(Unit::Target)];
        #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
        let detected = [V3::try_new().map(Unit::Avx2), V4::try_new().map(Unit::Avx512)];
        #[cfg(not(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64"))))]
        let detected = [];
        target.into_iter().chain(detected).flatten().map(Self)
    }

    /// Its name: `AVX-512`, say.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.0 {
            Unit::Target if cfg!(target_arch = "aarch64") => "NEON",
            Unit::Target if cfg!(target_feature = "avx512f") => "AVX-512 of the compiled target",
            Unit::Target if cfg!(target_feature = "avx") => "AVX of the compiled target",
            Unit::Target if cfg!(target_feature = "sse2") => "SSE2",
            Unit::Target => "compiled target",
            #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
            Unit::Avx2(_) => "AVX2",
            #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
            Unit::Avx512(_) => "AVX-512",
        }
    }

    /// Runs a task that has been compiled with the instructions of this unit.
    pub(super) fn run(self, task: impl Task) {
        match self.0 {
            Unit::Target => task.run::<FUSED>(),
            #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
            Unit::Avx2(unit) => unit.vectorize(Fused(task)),
            #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
            Unit::Avx512(unit) => unit.vectorize(Fused(task)),
        }
    }
}

impl fmt::Display for VectorUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl fmt::Debug for VectorUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "VectorUnit({})", self.name())
    }
}

/// What is compiled once for each unit: its method is `#[inline(always)]`, and so is all that it calls.
pub(super) trait Task {
    fn run<const FUSED: bool>(self);
}

#[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
struct Fused<T>(T);

#[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
impl<T: Task> NullaryFnOnce for Fused<T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.run::<true>();
    }
}
