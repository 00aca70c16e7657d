//! Errors of a robot file or of a call at run time.

use core::error::Error;
use core::fmt;
use std::io;
use std::path::PathBuf;

use rne_model::Report;

/// Why a robot file gave no robot.
#[derive(Debug)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        error: io::Error,
    },
    /// The file describes no robot; the report has line, column and what is allowed.
    Invalid(Report),
    /// The robot has another number of joints than the type for which it was loaded.
    WrongJointCount(WrongJointCount),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable { path, error } => write!(f, "cannot read {}: {error}", path.display()),
            Self::Invalid(report) => report.fmt(f),
            Self::WrongJointCount(error) => error.fmt(f),
        }
    }
}

impl Error for LoadError {
    /// Returns the error of the operating system. The other two errors are displayed without additional words, so they
    /// have no source.
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Unreadable { error, .. } => Some(error),
            Self::Invalid(report) => report.source(),
            Self::WrongJointCount(error) => error.source(),
        }
    }
}

impl From<Report> for LoadError {
    fn from(report: Report) -> Self {
        Self::Invalid(report)
    }
}

impl From<WrongJointCount> for LoadError {
    fn from(error: WrongJointCount) -> Self {
        Self::WrongJointCount(error)
    }
}

/// The error that a robot file has another number of joints than the type for which it was loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongJointCount {
    /// Number of joints of the type, its `DOF`.
    pub expected: usize,
    /// Number of joints of the robot.
    pub found: usize,
    /// How many of these joints follow others; an `Arm` cannot have any.
    pub followers: usize,
    /// How many motors the list `motors` of the robot file has; an `Arm` cannot have any.
    pub drives: usize,
}

impl fmt::Display for WrongJointCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { expected, found, followers, drives } = self;
        if *followers > 0 {
            return write!(
                f,
                "{followers} of the robot's {} follow others; an `Arm` cannot have such joints, so use a `DynArm`",
                Count(*found, "joint")
            );
        }
        if *drives > 0 {
            return write!(f, "the robot has a list `motors`; an `Arm` cannot have one, so use a `DynArm`");
        }
        write!(f, "the robot has {}, but an `Arm<{expected}>` was asked for", Count(*found, "joint"))
    }
}

impl Error for WrongJointCount {}

/// An argument of a [`DynArm`](crate::DynArm) does not have one element per joint, or `wrenches` not one per tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongLength {
    /// Name of the argument: `q`, `qd`, `qdd`, `sin`, `cos`, `tau`, `motors`, `motor_torques` or `wrenches`.
    pub argument: &'static str,
    /// The number of elements that it must have: joints of the robot; motors, for `motor_torques`; tips, for
    /// `wrenches`.
    pub expected: usize,
    /// The number of elements that it has.
    pub found: usize,
}

impl fmt::Display for WrongLength {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { argument, expected, found } = self;
        let thing = match *argument {
            "motor_torques" => "motor",
            "wrenches" => "tip",
            _ => "joint",
        };
        write!(f, "`{argument}` has {}, but the robot has {}", Count(*found, "element"), Count(*expected, thing))
    }
}

impl Error for WrongLength {}

/// A number of things, written in English, with the plural where it is needed.
struct Count(usize, &'static str);

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(number, thing) = self;
        write!(f, "{number} {thing}{}", if *number == 1 { "" } else { "s" })
    }
}
