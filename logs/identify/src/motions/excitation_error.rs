//! Errors of the search for a motion that excites an arm.

use std::fmt;

use rne_machine::EvaluationError;

/// Why there is no motion that excites an arm.
#[derive(Debug)]
#[non_exhaustive]
pub enum ExcitationError {
    /// The period is not a number of seconds above 0.
    Period,
    /// There are fewer than two harmonics: one harmonic that starts at rest without acceleration does not move.
    Harmonics,
    /// A list of limits does not have the number of joints as its length.
    Length {
        /// The kind of limits, such as `velocity`.
        what: &'static str,
        /// The length of the list.
        found: usize,
        /// The number of joints.
        joints: usize,
    },
    /// A limit of this kind is not a number above 0.
    NotPositive(&'static str),
    /// A prismatic joint has no position limits.
    NoPosition {
        /// Name of the joint.
        joint: String,
    },
    /// Limits of the file do not allow a joint to move.
    NoRoom {
        /// Name of the joint.
        joint: String,
        /// The kind of limits: `position`, `velocity` or `effort`.
        what: &'static str,
    },
    /// No motion was found within the effort limit of a joint.
    Effort {
        /// Name of the joint.
        joint: String,
        /// The effort of the motion that exceeds the limit least, N m or N.
        needed: f64,
        /// The effort limit, N m or N.
        limit: f64,
    },
    /// No motion was found that distinguishes all base parameters.
    Indistinct,
    /// The equations of motion cannot be computed.
    Evaluation(EvaluationError),
}

impl ExcitationError {
    /// Whether the options are at fault, not the robot file.
    #[must_use]
    pub fn is_of_request(&self) -> bool {
        matches!(self, Self::Period | Self::Harmonics | Self::Length { .. } | Self::NotPositive(_))
    }
}

impl fmt::Display for ExcitationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Period => f.write_str("the period must be a number of seconds above 0"),
            Self::Harmonics => f.write_str("a motion from rest to rest needs 2 harmonics or more"),
            Self::Length { what, found, joints } => {
                write!(
                    f,
                    "{what} has {found} numbers, but the robot has {joints} joints; give one number for all joints, or \
                     one for each"
                )
            }
            Self::NotPositive(what) => write!(f, "{what} needs finite numbers above 0"),
            Self::NoPosition { joint } => write!(
                f,
                "{joint} slides and has no position limits; write `limits: {{position: [LOWER, UPPER]}}` (m) in the \
                 robot file, or give a range"
            ),
            Self::NoRoom { joint, what } => write!(f, "the {what} limits of {joint} leave it no room to move"),
            Self::Effort { joint, needed, limit } => write!(
                f,
                "no motion was found within the effort limits: {joint} would need {needed:.3} of {limit:.3}; a slower \
                 or smaller motion needs less"
            ),
            Self::Indistinct => f.write_str(
                "no motion was found that distinguishes the base parameters from each other: the limits are too \
                 narrow, or numbers of the robot file are too large or too small",
            ),
            Self::Evaluation(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ExcitationError {}

impl From<EvaluationError> for ExcitationError {
    fn from(error: EvaluationError) -> Self {
        Self::Evaluation(error)
    }
}
