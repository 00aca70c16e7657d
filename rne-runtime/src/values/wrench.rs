//! Force and moment at the tip.

use crate::{Dual, Scalar};

/// The lecture's f_{n,n+1} and n_{n,n+1}: exerted BY the last link ON its environment, at the origin of the tip frame
/// (`tool` included), in tip-frame axes. So τ = τ_free + Jᵀ w, and what the environment exerts on the robot is the
/// negative of it: a robot that pushes down on a table has a force pointing down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench<T> {
    /// Force, N.
    pub force: [T; 3],
    /// Moment about the origin of the tip frame, N m.
    pub moment: [T; 3],
}

/// A free tip, as [`Wrench::zero`].
impl<T: Scalar> Default for Wrench<T> {
    fn default() -> Self {
        Self::zero()
    }
}

impl<T: Scalar> Wrench<T> {
    /// A free tip: no force, no moment.
    #[must_use]
    pub fn zero() -> Self {
        Self { force: [T::zero(); 3], moment: [T::zero(); 3] }
    }

    /// The wrench in dual numbers, as a constant: all its derivatives are zero.
    pub(crate) fn still(self) -> Wrench<Dual<T>> {
        Wrench { force: self.force.map(Dual::constant), moment: self.moment.map(Dual::constant) }
    }
}

/// Conversions from and to nalgebra.
#[cfg(feature = "nalgebra")]
impl<T: Scalar> Wrench<T> {
    /// Creates a wrench from nalgebra vectors.
    #[must_use]
    pub fn from_vectors(force: nalgebra::Vector3<T>, moment: nalgebra::Vector3<T>) -> Self {
        Self { force: force.into(), moment: moment.into() }
    }

    /// Force and moment as nalgebra vectors.
    #[must_use]
    pub fn vectors(&self) -> (nalgebra::Vector3<T>, nalgebra::Vector3<T>) {
        (self.force.into(), self.moment.into())
    }
}
