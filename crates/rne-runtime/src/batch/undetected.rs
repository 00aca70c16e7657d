//! Where no vector unit is looked for: there is none beyond the compiled target.

use super::unit::Task;

/// None.
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

    pub(super) fn run(self, _: impl Task) {
        match self {}
    }
}
