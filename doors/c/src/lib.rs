//! The C library of `rne`: an arm from a robot file, a URDF or the shipped robots, and its functions over plain arrays.
//!
//! C programs include `include/rne.h`, which is generated from the module [`border`]; `docs/firmware/c-library.md`
//! shows how it is used. All code that needs `unsafe` is in that module: it turns pointers into slices and texts, and
//! has no logic. The rest is safe Rust.
#![warn(missing_debug_implementations)]

pub mod border;
mod evaluation;
mod handle;
mod status;

pub use handle::{Arm, JointKind, Limits};
pub use status::Status;
