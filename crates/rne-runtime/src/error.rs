//! What can be wrong with a call at run time.

use core::error::Error;
use core::fmt;

/// A robot file has another number of joints than the type that was to hold it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongJointCount {
    /// Joints that the type has, its `DOF`.
    pub expected: usize,
    /// Joints that the robot has.
    pub found: usize,
}

impl fmt::Display for WrongJointCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { expected, found } = self;
        write!(f, "the robot has {}, but an `Arm<{expected}>` was asked for", Count(*found, "joint"))
    }
}

impl Error for WrongJointCount {}

/// A joint argument of a [`DynArm`](crate::DynArm) does not have one element per joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongLength {
    /// Which argument: `q`, `qd` or `qdd`.
    pub argument: &'static str,
    /// Joints of the robot.
    pub expected: usize,
    /// Elements of the argument.
    pub found: usize,
}

impl fmt::Display for WrongLength {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { argument, expected, found } = self;
        write!(f, "`{argument}` has {}, but the robot has {}", Count(*found, "element"), Count(*expected, "joint"))
    }
}

impl Error for WrongLength {}

/// A number of things, in English.
struct Count(usize, &'static str);

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(number, thing) = self;
        write!(f, "{number} {thing}{}", if *number == 1 { "" } else { "s" })
    }
}
