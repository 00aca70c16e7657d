//! The functions that are certified.
//!
//! Each is a separate function that is never inlined, so that its instructions can be read and counted:
//! `robots::NAME::FORM::FUNCTION`, in `f32`.
#![no_std]
#![recursion_limit = "256"]

#[cfg(feature = "methods")]
pub mod puma560;
pub mod runtime;
mod states;
pub mod torques;

pub use rne::Numbers;
pub use states::{STATES, State};
#[cfg(feature = "methods")]
pub use torques::each_controller;
#[cfg(feature = "double")]
pub use torques::each_double;
pub use torques::{Torques, Visitor, each};
