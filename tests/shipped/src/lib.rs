//! The shipped robots, as lists that are not typed: a new file in robots/ is in them.
//!
//! A derive needs a type per robot, hence macros beside the list.
#![no_std]

#[cfg(feature = "list")]
mod tried;

#[cfg(feature = "list")]
pub use list::{is_exhaustive, tried};

include!(concat!(env!("OUT_DIR"), "/robots.rs"));

#[cfg(feature = "list")]
mod list {
    extern crate std;

    use rne_robots::{ROBOTS, RobotFile};

    use crate::tried::is_tried;

    /// Whether tests try all that they can: `RNE_EXHAUSTIVE` is set, as `cargo xtask verify exhaustive` sets it.
    pub fn is_exhaustive() -> bool {
        std::env::var_os("RNE_EXHAUSTIVE").is_some()
    }

    /// The shipped robots that a test tries, by the order of names: the robots of few joints and some others, or all.
    pub fn tried() -> impl Iterator<Item = &'static RobotFile> {
        ROBOTS.iter().filter(|robot| is_exhaustive() || is_tried(robot))
    }
}
