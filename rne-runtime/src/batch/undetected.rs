//! Where no vector unit is looked for: there is none beyond the compiled target.

use super::blocks::States;
use super::{BatchScalar, Torques};

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

    pub(super) fn run<R, T, const DOF: usize, const ANGLES: usize>(self, _: States<'_, R, T, DOF>)
    where
        R: Torques<DOF, ANGLES>,
        T: BatchScalar,
    {
        match self {}
    }
}
