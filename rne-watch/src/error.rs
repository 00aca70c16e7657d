//! The reason why nothing can be watched.

use std::fmt;

/// The reason why a motion cannot be watched.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum WatchError {
    /// A motion of another number of joints than the robot's.
    Joints {
        /// Joints of the robot.
        expected: usize,
        /// Joints of the motion, or of the baseline.
        found: usize,
    },
    /// A list of a motion that is not as long as its times: which one, and of which joint, counted from 1.
    Length(&'static str, usize),
    /// A number that is not finite, or a time that is not later than the one before: the index of its sample.
    Sample(usize),
    /// Fewer samples than there must be.
    TooFew {
        /// The number of samples.
        found: usize,
        /// The least number of samples.
        needed: usize,
    },
    /// A setting that is not a number above zero: its name.
    Setting(&'static str),
}

impl fmt::Display for WatchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joints { expected, found } => write!(f, "{found} joints, and the robot has {expected}"),
            Self::Length(list, joint) => {
                write!(f, "`{list}` of joint {joint} does not have one number for each time")
            }
            Self::Sample(index) => write!(
                f,
                "sample {} has a number that is not finite, or is not later than the one before it",
                index + 1
            ),
            Self::TooFew { found, needed } => write!(f, "{found} samples, and at least {needed} are needed"),
            Self::Setting(name) => write!(f, "{name} must be a finite number above 0"),
        }
    }
}

impl std::error::Error for WatchError {}
