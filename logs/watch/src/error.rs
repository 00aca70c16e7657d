//! Errors of watching.

use std::fmt;

use rne_identify::{ArmLogError, MotionError, PassError};

/// The reason why logs cannot be watched.
#[derive(Debug)]
#[non_exhaustive]
pub enum WatchError {
    /// A motion or a baseline has another number of joints than the robot.
    Joints {
        /// Number of joints of the robot.
        expected: usize,
        /// Number of joints of the motion or of the baseline.
        found: usize,
    },
    /// A list of a motion is not as long as its times: the name of the list, and its joint, counted from 1.
    Length(&'static str, usize),
    /// The sample with this index has a number that is not finite, or a time that is not later than the previous one.
    Sample(usize),
    /// There are too few samples.
    TooFew {
        /// The number of samples.
        found: usize,
        /// The smallest number of samples that is needed.
        needed: usize,
    },
    /// The efforts of all joints are zero.
    NoEffort,
    /// A log is too short to be compared with the baseline.
    ShortLog {
        /// The duration of its motions, s.
        duration: f64,
        /// A longer duration than this is needed, s.
        needed: f64,
        /// Cut-off of the low-pass filter, Hz.
        cutoff: f64,
    },
    /// The logs of the baseline are too short to determine the parameters of the arm.
    ShortBaseline {
        /// The duration of the motions, s.
        duration: f64,
        /// The duration that is needed, s.
        needed: f64,
        /// Cut-off of the low-pass filter, Hz.
        cutoff: f64,
    },
    /// The setting with this name is not a number above zero.
    Setting(&'static str),
    /// A motion does not fit the robot.
    Motion(MotionError),
    /// A log cannot be read to its end.
    Log(ArmLogError),
}

impl fmt::Display for WatchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joints { expected, found } => {
                write!(f, "the motion has {found} joints, but the robot has {expected}")
            }
            Self::Length(list, joint) => {
                write!(f, "`{list}` of joint {joint} does not have one number for each time")
            }
            Self::Sample(index) => write!(
                f,
                "sample {} has a number that is not finite, or is not later than the one before it",
                index + 1
            ),
            Self::TooFew { found, needed } => write!(
                f,
                "the motion has {found} samples, but at least {needed} are \
                                                         needed"
            ),
            Self::NoEffort => f.write_str(
                "the efforts of all joints are zero throughout, or less than any sensor measures: they are not torques",
            ),
            Self::ShortLog { duration, needed, cutoff } => write!(
                f,
                "the motion is too short: after the low-pass filter of {cutoff:.1} Hz, {duration:.1} s are left, but \
                 more than {needed:.1} s are needed"
            ),
            Self::ShortBaseline { duration, needed, cutoff } => write!(
                f,
                "the motion is too short for a baseline of this arm: after the low-pass filter of {cutoff:.1} Hz, \
                 {duration:.1} s are left, but at least {needed:.1} s are needed"
            ),
            Self::Setting(name) => write!(f, "{name} must be a finite number above 0"),
            Self::Motion(error) => error.fmt(f),
            Self::Log(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for WatchError {}

impl From<MotionError> for WatchError {
    fn from(error: MotionError) -> Self {
        Self::Motion(error)
    }
}

impl<E: Into<Self>> From<PassError<E>> for WatchError {
    fn from(error: PassError<E>) -> Self {
        match error {
            PassError::Log(error) => Self::Log(error),
            PassError::Motion(error) => error.into(),
        }
    }
}
