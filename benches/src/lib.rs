//! What both benchmarks share: derived robots in each form, and states.

mod robots;
mod states;

pub use robots::*;
pub use states::{State, states};
