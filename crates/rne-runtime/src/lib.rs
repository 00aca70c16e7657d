//! The runtime side of `rne`: the scalar, the capability traits, and the generic recursion in nalgebra that every
//! generated function is compared with.
#![no_std]
#[cfg(feature = "std")]
extern crate std;

mod arm;
mod base_motion;
mod capability;
#[cfg(feature = "std")]
mod error;
mod link_frame;
mod scalar;
mod seven_steps;
mod wrench;

pub use arm::Arm;
pub use base_motion::BaseMotion;
pub use capability::InverseDynamics;
#[cfg(feature = "std")]
pub use error::WrongJointCount;
pub use scalar::{Constant, Scalar};
pub use wrench::Wrench;
