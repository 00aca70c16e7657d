//! The robot files that `rne` ships, as texts. `#[robot(builtin = "puma560")]` and `rne example puma560` read them.
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
    /// Name of the robot, such as `puma560`.
    pub name: &'static str,
    /// Text of the robot file.
    pub yaml: &'static str,
    /// Text of the plan file for its reduced form, if it has one.
    pub plan: Option<&'static str>,
}

/// All shipped serial arms, which need no more than `format: 1`, sorted by name.
// A static, because a constant would be copied, with all its texts, into every crate that uses it.
pub static ROBOTS: &[RobotFile] = include!(concat!(env!("OUT_DIR"), "/robots.rs"));

/// All shipped robots with branches or with joints that follow others, in `format: 2`, sorted by name.
pub static TREES: &[RobotFile] = include!(concat!(env!("OUT_DIR"), "/trees.rs"));

/// All shipped robots: the arms, then the trees.
pub fn all() -> impl Iterator<Item = &'static RobotFile> {
    ROBOTS.iter().chain(TREES)
}

/// Returns the shipped robot with this name; `None` if no robot has it.
#[must_use]
pub fn find(name: &str) -> Option<&'static RobotFile> {
    all().find(|robot| robot.name == name)
}
