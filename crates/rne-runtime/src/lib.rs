//! The runtime side of `rne`: the scalar, the capability traits, and the generic recursion in nalgebra that every
//! generated function is compared with.
#![cfg_attr(not(feature = "std"), no_std)]
#![allow(clippy::doc_markdown)] // formulas: R_i, f_{i-1,i}

mod arm;
mod base_motion;
pub mod batch;
mod capability;
#[cfg(feature = "std")]
mod dyn_arm;
#[cfg(feature = "std")]
mod error;
mod link_frame;
mod link_state;
#[cfg(feature = "std")]
mod load;
mod operations;
mod scalar;
mod seven_steps;
mod sin_cos;
mod trace;
mod wrench;

pub use arm::Arm;
pub use base_motion::BaseMotion;
pub use batch::{BatchInverseDynamics, BatchScalar, LengthMismatch, VectorUnit};
pub use capability::InverseDynamics;
#[cfg(feature = "std")]
pub use dyn_arm::{DynArm, DynTrace};
#[cfg(feature = "std")]
pub use error::{LoadError, WrongJointCount, WrongLength};
pub use operations::Operations;
pub use scalar::{Constant, Scalar};
pub use trace::{LinkTrace, Trace};
pub use wrench::Wrench;
