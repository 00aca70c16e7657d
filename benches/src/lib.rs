//! What both benchmarks share: derived robots in each form, states, and the same arms for the crate `dynibo`.

mod robots;
mod states;
mod urdf;

pub use robots::*;
pub use states::{State, states};
pub use urdf::{GRAVITY, urdf};
