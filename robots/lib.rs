//! The robot files that `rne` ships, as texts: what `#[robot(builtin = "puma560")]` and `rne example puma560` take.
//!
//! ```
//! let puma = rne_robots::find("puma560").expect("it is shipped");
//! assert!(puma.yaml.contains("name: puma560"));
//! assert!(rne_robots::ROBOTS.iter().any(|robot| robot.name == "panda"));
//! ```
#![no_std]
#![warn(missing_debug_implementations)]
#![forbid(unsafe_code)]

/// A robot file and its plan, by the robot's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct RobotFile {
    /// What the robot is called: `puma560`.
    pub name: &'static str,
    /// The robot file.
    pub yaml: &'static str,
    /// The plan of its reduced form.
    pub plan: Option<&'static str>,
}

/// Every shipped arm: a serial chain, which needs no more than `format: 1`. By the order of names.
// A constant would be in every crate that names it, with all its texts.
pub static ROBOTS: &[RobotFile] = include!(concat!(env!("OUT_DIR"), "/robots.rs"));

/// Every shipped robot with branches or with joints that follow others, in `format: 2`, by the order of names.
pub static TREES: &[RobotFile] = include!(concat!(env!("OUT_DIR"), "/trees.rs"));

/// All shipped robots: the arms, then the trees.
pub fn all() -> impl Iterator<Item = &'static RobotFile> {
    ROBOTS.iter().chain(TREES)
}

/// The shipped robot of a name; `None` when there is none.
#[must_use]
pub fn find(name: &str) -> Option<&'static RobotFile> {
    all().find(|robot| robot.name == name)
}
