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

/// Every shipped robot, by the order of names.
// A constant would be in every crate that names it, with all its texts.
pub static ROBOTS: &[RobotFile] = include!(concat!(env!("OUT_DIR"), "/robots.rs"));

/// The shipped robot of a name; `None` when there is none.
#[must_use]
pub fn find(name: &str) -> Option<&'static RobotFile> {
    ROBOTS.binary_search_by(|robot| robot.name.cmp(name)).ok().map(|index| &ROBOTS[index])
}
