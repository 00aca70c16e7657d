//! Computes many states at once: a structure of arrays, in the widest vector registers of the processor.
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
//! [`inverse_dynamics`](crate::InverseDynamics::inverse_dynamics) gives. On one with it, sines and cosines are rounded
//! less often, and in the reduced forms the terms of sums stand in another order: torques differ in their last bits.
//!
//! # Method
//!
//! The derived code is written once more for the registers of every vector unit, in two parts and, in the reduced
//! forms, for the fewest instructions. Some registers of states are taken at a time: first the sines and cosines of all
//! of them are computed, then the torques. Nothing in the two loops branches, so that a processor with room for some
//! hundred instructions works on several registers at once. Angles that are too large for the branch-free kernel
//! (beyond 10⁵ rad) or are no numbers show in the sum of their squares; the states that have one are computed again by
//! themselves.
#![allow(clippy::inline_always)] // code for a vector unit must be compiled with its instructions

#[cfg(feature = "arm")]
mod arm;
mod blocks;
#[cfg_attr(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")), path = "x86.rs")]
#[cfg_attr(not(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64"))), path = "undetected.rs")]
mod detected;
mod functions;
mod mismatch;
#[cfg(feature = "rayon")]
mod parallel;
mod scalar;
mod unit;
pub(crate) mod vector;

#[doc(hidden)]
pub use blocks::ZERO;
pub use functions::{
    BatchFloatingInverseDynamics, BatchForwardDynamics, BatchInverseDynamics, BatchInverseDynamicsDerivatives,
    BatchMassMatrix,
};
#[doc(hidden)]
pub use mismatch::Argument;
pub use mismatch::LengthMismatch;
pub use scalar::BatchScalar;
pub use unit::VectorUnit;

use crate::Scalar;
use blocks::{OutputsOf, States};

/// Code of a derive for [`run`]: the function once more, in two parts that are `#[inline(always)]`.
///
/// The inputs are the elements of all arguments, one after the other.
#[doc(hidden)]
pub trait BatchFunction<const INPUTS: usize, const ANGLES: usize, const OUTPUTS: usize, const ELEMENTS: usize>:
    Sync
{
    /// The arguments to which the inputs belong.
    const ARGUMENTS: &[Argument];
    /// The arguments to which the elements of the results belong.
    const RESULTS: &[Argument];
    /// How many of the inputs must have a number for each state. The arrays of later inputs may be empty, which means
    /// zero.
    const REQUIRED: usize;
    /// For each element of the results, the index of its output, or [`ZERO`].
    const PLACES: [u16; ELEMENTS];
    /// Whether all elements of the results must be written, and each is an output of its own.
    const IS_WHOLE: bool;

    /// Returns the angles on whose sines and cosines the outputs depend.
    fn angles<T: Scalar>(&self, inputs: &[T; INPUTS]) -> [T; ANGLES];
    /// Computes the outputs from the sines and cosines of the angles and from the inputs.
    fn outputs<T: Scalar>(
        &self,
        sin: &[T; ANGLES],
        cos: &[T; ANGLES],
        inputs: &[T; INPUTS],
        outputs: &mut [T; OUTPUTS],
    );
}

/// Runs a batch. The derived method calls it.
#[doc(hidden)]
pub fn run<R, T: BatchScalar, const INPUTS: usize, const ANGLES: usize, const OUTPUTS: usize, const ELEMENTS: usize>(
    robot: &R,
    unit: VectorUnit,
    inputs: [&[T]; INPUTS],
    elements: [&mut [T]; ELEMENTS],
) -> Result<(), LengthMismatch>
where
    R: BatchFunction<INPUTS, ANGLES, OUTPUTS, ELEMENTS>,
{
    for_each_part(robot, [R::ARGUMENTS, R::RESULTS], [inputs], elements, |states| {
        unit.run(OutputsOf::<_, _, _, ANGLES, OUTPUTS, _>(states));
    })
}

/// Computes the states, all at once or divided among threads.
fn for_each_part<R: Sync, T: BatchScalar, const ARGUMENTS: usize, const INPUTS: usize, const ELEMENTS: usize>(
    robot: &R,
    arguments: [&[Argument]; 2],
    inputs: [[&[T]; INPUTS]; ARGUMENTS],
    elements: [&mut [T]; ELEMENTS],
    run: impl Fn(States<'_, R, T, ARGUMENTS, INPUTS, ELEMENTS>) + Sync,
) -> Result<(), LengthMismatch> {
    let of_inputs = inputs.as_flattened().iter().map(|numbers| numbers.len());
    let lengths = of_inputs.chain(elements.iter().map(|numbers| numbers.len()));
    let count = mismatch::common_length(arguments, lengths)?;
    let states = States { robot, count, inputs, elements };
    #[cfg(feature = "rayon")]
    parallel::for_each_part(states, &run);
    #[cfg(not(feature = "rayon"))]
    run(states);
    Ok(())
}
