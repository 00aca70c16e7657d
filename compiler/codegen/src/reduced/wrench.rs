//! Forces and moments of the reduced form.

use crate::ir::{Builder, Vector};

/// A force, times μ, and a moment about the origin of a frame.
#[derive(Clone, Copy)]
pub(crate) struct Wrench<'s> {
    pub(crate) force: Vector<'s>,
    pub(crate) moment: Vector<'s>,
}

impl<'s> Wrench<'s> {
    pub(crate) fn zero(builder: &'s Builder) -> Self {
        Self { force: builder.no_vector(), moment: builder.no_vector() }
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self { force: self.force + other.force, moment: self.moment + other.moment }
    }

    pub(crate) fn map(self, f: impl Fn(Vector<'s>) -> Vector<'s>) -> Self {
        Self { force: f(self.force), moment: f(self.moment) }
    }

    pub(crate) fn is_zero(self) -> bool {
        self.force.is_zero() && self.moment.is_zero()
    }

    /// Returns the wrench about another point, from which the old one is at `p`: its moment is n + p × f.
    pub(crate) fn about(self, p: Vector<'s>) -> Self {
        Self { moment: self.moment + p.cross(self.force), ..self }
    }
}
