//! The runtime side of `rne`: the scalar, the capability traits, and the generic recursion in nalgebra that every
//! generated function is compared with.
#![no_std]
#[cfg(feature = "std")]
extern crate std;

mod capability;
mod scalar;
mod wrench;

pub use capability::InverseDynamics;
pub use scalar::{Constant, Scalar};
pub use wrench::Wrench;
