//! The vector units of the processor, which are detected at run time.

use core::fmt;

use super::BatchScalar;
use super::detected::Detected;
use super::vector::Work;
use crate::lanes::registers::compiled;

/// A vector unit of the processor on which the program runs. A value only exists if the processor has this unit, so it
/// can always be used.
///
/// ```
/// use rne_runtime::VectorUnit;
///
/// for unit in VectorUnit::all() {
///     println!("{unit}"); // SSE2, AVX2, AVX-512
/// }
/// ```
#[derive(Clone, Copy)]
pub struct VectorUnit(Unit);

#[derive(Clone, Copy)]
enum Unit {
    /// Instructions of the compiled target: SSE2 on x86-64, NEON on AArch64, more with
    /// `-C target-cpu`.
    Target,
    /// Instructions of this processor beyond the compiled target.
    Detected(Detected),
}

impl VectorUnit {
    /// Returns the widest unit. The processor is tested once; afterwards this costs a nanosecond.
    #[must_use]
    pub fn widest() -> Self {
        Self(Detected::widest().map_or(Unit::Target, Unit::Detected))
    }

    /// Returns all units, the widest last. The first is that of the compiled target; without the feature `batch` it is
    /// the only one.
    pub fn all() -> impl Iterator<Item = Self> {
        core::iter::once(Unit::Target).chain(Detected::all().map(Unit::Detected)).map(Self)
    }

    /// Returns the name of the unit, such as `AVX-512`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.0 {
            Unit::Target => compiled::NAME,
            Unit::Detected(unit) => unit.name(),
        }
    }

    /// Runs a computation with this unit.
    pub(crate) fn run<T: BatchScalar, W: Work<T>>(self, work: W) {
        match self.0 {
            Unit::Target => work.run::<T::Compiled>(()),
            Unit::Detected(unit) => unit.run(work),
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
