//! Many states at once: structure of arrays, as wide as the processor is.
#![allow(clippy::inline_always)] // what a vector unit computes must be compiled with its instructions

mod blocks;
mod mismatch;
#[cfg(feature = "rayon")]
mod parallel;
mod scalar;
mod unit;

pub use mismatch::LengthMismatch;
pub use scalar::BatchScalar;
pub use unit::VectorUnit;

use crate::{InverseDynamics, Scalar};
use blocks::States;

/// Torques from motion for many states at once.
pub trait BatchInverseDynamics<const DOF: usize>: InverseDynamics<DOF> {
    /// Torques on the widest vector unit.
    fn inverse_dynamics_batch<T: BatchScalar>(
        &self,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        tau: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch> {
        self.inverse_dynamics_batch_on(VectorUnit::widest(), q, qd, qdd, tau)
    }

    /// The same on a vector unit of your choice.
    fn inverse_dynamics_batch_on<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        tau: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch>;
}

/// What the derive writes.
#[doc(hidden)]
pub trait Torques<const DOF: usize>: Sync {
    fn torques<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], qdd: &[T; DOF]) -> [T; DOF];
}

/// What the derived method calls.
#[doc(hidden)]
pub fn run<K: Torques<DOF>, T: BatchScalar, const DOF: usize>(
    robot: &K,
    unit: VectorUnit,
    q: [&[T]; DOF],
    qd: [&[T]; DOF],
    qdd: [&[T]; DOF],
    tau: [&mut [T]; DOF],
) -> Result<(), LengthMismatch> {
    let lengths = core::array::from_fn(|joint| tau[joint].len());
    let states = mismatch::common_length([("q", &q), ("qd", &qd), ("qdd", &qdd)], lengths)?;
    let states = States { robot, states, inputs: [q, qd, qdd], tau };
    #[cfg(feature = "rayon")]
    parallel::run(unit, states);
    #[cfg(not(feature = "rayon"))]
    unit.run(states);
    Ok(())
}
