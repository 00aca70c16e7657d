//! Targets on which no vector unit is detected at run time: only the compiled target is used.

use super::BatchScalar;
use super::vector::Work;

/// No unit is detected at run time on this target.
#[derive(Clone, Copy)]
pub(super) enum Detected {}

impl Detected {
    pub(super) fn widest() -> Option<Self> {
        None
    }

    pub(super) fn all() -> impl Iterator<Item = Self> {
        core::iter::empty()
    }

    pub(super) fn name(self) -> &'static str {
        match self {}
    }

    pub(super) fn run<T: BatchScalar, W: Work<T>>(self, _: W) {
        match self {}
    }
}
