//! Errors of motions that give no information on a robot.

use std::fmt;

use rne_logs::Motion;
use rne_machine::EvaluationError;

/// The reason why a motion gives no information on a robot.
#[derive(Debug)]
#[non_exhaustive]
pub enum MotionError {
    /// The motion has another number of joints than the robot.
    Joints {
        /// Joints of the robot.
        expected: usize,
        /// Joints of the motion.
        found: usize,
    },
    /// A list of values has another length than the list of times.
    Lengths,
    /// A number of the state with this index is not finite.
    NotFinite(usize),
    /// The regressor cannot be computed.
    Evaluation(EvaluationError),
    /// All motions together give fewer rows than standard deviations need.
    TooFew {
        /// Number of rows of each joint.
        rows: u64,
        /// The number of states that are needed.
        needed: u64,
        /// Duration of all motions together, s.
        duration: f64,
    },
    /// The efforts of all joints are zero throughout.
    NoEfforts,
    /// An identified number of the joint with this index, from 0, is not finite.
    NotANumber(usize),
}

impl fmt::Display for MotionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joints { expected, found } => {
                write!(
                    f,
                    "the log has {found} joints, but the robot has {expected}; name the joints of the log that belong \
                     to the robot"
                )
            }
            Self::Lengths => f.write_str("there must be as many positions, rates, accelerations and torques as times"),
            Self::NotFinite(state) => write!(f, "state {state} has a number that is not finite"),
            Self::Evaluation(error) => error.fmt(f),
            Self::TooFew { rows, needed, duration } => write!(
                f,
                "{duration:.2} s of logs after the filter give {rows} rows for each joint, but {needed} are needed to \
                 estimate the deviations: use more of the log, a longer log, or a higher cut-off"
            ),
            Self::NoEfforts => f.write_str(
                "the efforts of all joints are zero throughout, or less than any sensor measures: they are not torques",
            ),
            Self::NotANumber(joint) => write!(
                f,
                "no finite values of the link, friction and rotor of joint {} explain the log: check that its efforts \
                 are torques in N m and its positions radians, and that the links of the robot file are as large as \
                 those of an arm",
                joint + 1
            ),
        }
    }
}

impl std::error::Error for MotionError {}

impl From<EvaluationError> for MotionError {
    fn from(error: EvaluationError) -> Self {
        Self::Evaluation(error)
    }
}

pub(crate) fn checked(dof: usize, motion: &Motion) -> Result<(), MotionError> {
    let lists = [&motion.q, &motion.qd, &motion.qdd, &motion.tau];
    if let Some(list) = lists.iter().find(|list| list.len() != dof) {
        return Err(MotionError::Joints { expected: dof, found: list.len() });
    }
    if !motion.recorded.is_empty() && motion.recorded.len() != dof {
        return Err(MotionError::Joints { expected: dof, found: motion.recorded.len() });
    }
    let lists = [&lists[..], &[&motion.recorded]].concat();
    let mut columns = lists.iter().flat_map(|list| list.iter());
    if columns.any(|column| column.len() != motion.len()) {
        return Err(MotionError::Lengths);
    }
    let columns = lists.iter().flat_map(|list| list.iter()).chain([&motion.time]);
    match columns.filter_map(|column| column.iter().position(|x| !x.is_finite())).min() {
        Some(state) => Err(MotionError::NotFinite(state)),
        None => Ok(()),
    }
}
