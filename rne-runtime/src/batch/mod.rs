//! Many states at once: structure of arrays, as wide as the processor is.
//!
//! | | |
//! |---|---|
//! | layout | one slice per joint and quantity, one number per state: `q[joint][state]` |
//! | length | any, none included; the last states are computed in a register that is filled up |
//! | numbers | `f64` and `f32` |
//! | vector unit | AVX-512, AVX2 with fused multiply-add, SSE2 or NEON: the widest the processor has, found at run time, whatever the program is compiled for (feature `batch`) |
//! | threads | as many as rayon has, for more than some thousand states (feature `rayon`) |
//!
//! ```
//! # #[cfg(feature = "std")] {
//! use rne_runtime::{Arm, BatchInverseDynamics};
//!
//! // One joint that is loaded here; `#[derive(BatchInverseDynamics)]` makes a robot that is fast.
//! let robot = Arm::<1>::from_yaml(
//!     "{format: 1, name: rod, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
//!         {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}]}",
//! )?;
//! let q = [0.0, 0.1, 0.2]; // rad, three states
//! let (qd, qdd) = ([0.5; 3], [0.0; 3]); // rad/s, rad/s²
//! let mut tau = [0.0_f64; 3]; // N m
//! robot.inverse_dynamics_batch([&q], [&qd], [&qdd], [&mut tau])?;
//! assert!((tau[0] - 2.5 * 9.81 * 0.4).abs() < 1e-12);
//!
//! let error = robot.inverse_dynamics_batch([&q], [&qd[1..]], [&qdd], [&mut tau]).unwrap_err();
//! assert_eq!(error.to_string(), "`qd[0]` has length 2 and `q[0]` 3: each holds one number per state");
//! # }
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! # Results
//!
//! A torque depends on its state and on the vector unit, not on the states beside it, the length of the arrays or the
//! number of threads. In the form `seven_steps`, on a unit without fused multiply-add (SSE2), it has the bits that
//! [`inverse_dynamics`](InverseDynamics::inverse_dynamics) gives. On one with it, sines and cosines are rounded less
//! often, and in the reduced forms the terms of sums stand in another order: torques differ in their last bits.
//!
//! # Method
//!
//! The derived code is written once more for the registers of every vector unit, in two parts and, in the reduced
//! forms, for the fewest instructions. Some registers of states are taken at a time: first the sines and cosines of all
//! of them are computed, then the torques. Nothing in the two loops branches, so that a processor with room for some
//! hundred instructions works on several registers at once. Angles that are too large for the branch-free kernel
//! (beyond 10⁵ rad) or are no numbers show in the sum of their squares; the states that have one are computed again by
//! themselves.
#![allow(clippy::inline_always)] // what a vector unit computes must be compiled with its instructions

mod blocks;
#[cfg_attr(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")), path = "x86.rs")]
#[cfg_attr(not(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64"))), path = "undetected.rs")]
mod detected;
mod mismatch;
#[cfg(feature = "rayon")]
mod parallel;
mod scalar;
mod unit;
pub(crate) mod vector;

pub use mismatch::LengthMismatch;
pub use scalar::BatchScalar;
pub use unit::VectorUnit;

use core::array::from_fn;

#[cfg(feature = "arm")]
use crate::{Arm, Constant};
use crate::{InverseDynamics, Scalar};
#[cfg(feature = "arm")]
use blocks::one_by_one;
use blocks::{States, TorquesOf};

/// Torques from motion for many states at once.
///
/// One slice per joint, base to tip, and in it one number per state: rad, rad/s, rad/s² and N m for revolute joints, m,
/// m/s, m/s² and N for prismatic ones. All slices have the same length.
pub trait BatchInverseDynamics<const DOF: usize>: InverseDynamics<DOF> {
    /// Writes to `tau` the torques for positions `q`, velocities `qd` and accelerations `qdd` with a free tip, on the
    /// widest vector unit that the processor has.
    ///
    /// # Errors
    ///
    /// When two slices differ in length. No torque is written then.
    fn inverse_dynamics_batch<T: BatchScalar>(
        &self,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        tau: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch> {
        self.inverse_dynamics_batch_on(VectorUnit::widest(), q, qd, qdd, tau)
    }

    /// Computes the batch on a given vector unit: for comparisons, or for the same bits on every processor.
    ///
    /// # Errors
    ///
    /// When two slices differ in length. No torque is written then.
    fn inverse_dynamics_batch_on<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        tau: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch>;
}

#[cfg(feature = "arm")]
/// One state after the other: a robot that is known at run time is loops, in which no vector unit finds work.
impl<const DOF: usize, S: Constant + Sync> BatchInverseDynamics<DOF> for Arm<DOF, S> {
    fn inverse_dynamics_batch_on<T: BatchScalar>(
        &self,
        _: VectorUnit,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        tau: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch> {
        for_each_part(self, [q, qd, qdd], tau, one_by_one)
    }
}

/// Code of the derive: [`InverseDynamics::inverse_dynamics`] once more, in two parts and `#[inline(always)]` for
/// [`run`].
#[doc(hidden)]
pub trait Torques<const DOF: usize, const ANGLES: usize>: Sync {
    /// The angles whose sines and cosines the torques depend on.
    fn angles<T: Scalar>(&self, q: &[T; DOF]) -> [T; ANGLES];
    fn torques<T: Scalar>(
        &self,
        sin: &[T; ANGLES],
        cos: &[T; ANGLES],
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
    ) -> [T; DOF];
}

/// Runs a batch; the derived method calls it.
#[doc(hidden)]
pub fn run<R: Torques<DOF, ANGLES>, T: BatchScalar, const DOF: usize, const ANGLES: usize>(
    robot: &R,
    unit: VectorUnit,
    q: [&[T]; DOF],
    qd: [&[T]; DOF],
    qdd: [&[T]; DOF],
    tau: [&mut [T]; DOF],
) -> Result<(), LengthMismatch> {
    for_each_part(robot, [q, qd, qdd], tau, |states| unit.run(TorquesOf::<_, _, _, ANGLES>(states)))
}

/// Runs the states, all at once or divided among threads.
fn for_each_part<R: Sync, T: BatchScalar, const DOF: usize>(
    robot: &R,
    inputs: [[&[T]; DOF]; 3],
    tau: [&mut [T]; DOF],
    run: impl Fn(States<'_, R, T, DOF>) + Sync,
) -> Result<(), LengthMismatch> {
    let count = mismatch::common_length(inputs.each_ref(), from_fn(|joint| tau[joint].len()))?;
    let states = States { robot, count, inputs, tau };
    #[cfg(feature = "rayon")]
    parallel::for_each_part(states, &run);
    #[cfg(not(feature = "rayon"))]
    run(states);
    Ok(())
}
