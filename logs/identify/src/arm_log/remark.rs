//! Remarks on the logs of an arm.

use std::fmt;

use rne_logs::number::rounded;
use rne_model::one_line;

use crate::arm_log::error::SHOWN;

/// A remark on the logs of an arm. `Display` says it without the options of any interface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ArmLogRemark {
    /// The log has other names of joints, or only numbers: its joints are matched with those of the robot by their
    /// order.
    MatchedByOrder {
        /// The joints of the log, base to tip.
        logged: Vec<String>,
        /// The joints of the robot, base to tip.
        joints: Vec<String>,
    },
    /// A remark on the log alone.
    Log(rne_logs::Remark),
    /// All efforts of a joint are the same number.
    ConstantEffort {
        /// The name of the joint in the log.
        joint: String,
        /// The effort, N m or N.
        effort: f64,
    },
    /// Messages or rows that are left out.
    LeftOut(rne_logs::LeftOut),
}

impl ArmLogRemark {
    /// Whether the remark is a warning: the result may be wrong because of it.
    #[must_use]
    pub fn is_warning(&self) -> bool {
        match self {
            // if the order is wrong, the results look like those of a bad model
            Self::MatchedByOrder { logged, .. } => logged.len() > 1 && are_numbers(logged),
            Self::Log(remark) => remark.is_warning(),
            Self::ConstantEffort { .. } | Self::LeftOut(_) => true,
        }
    }
}

impl fmt::Display for ArmLogRemark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MatchedByOrder { logged, joints } => {
                let column = if are_numbers(logged) { "q" } else { "" };
                let pairs = logged.iter().zip(joints).take(SHOWN);
                let pairs = pairs.map(|(logged, joint)| format!("{column}{} is {}", one_line(logged), one_line(joint)));
                let more = if logged.len() > SHOWN { ", …" } else { "" };
                let pairs = pairs.collect::<Vec<_>>().join(", ") + more;
                if column.is_empty() {
                    write!(f, "joints of the log are matched by their order: {pairs}")
                } else {
                    write!(f, "the log does not name its joints, so their order decides: {pairs}")
                }
            }
            Self::Log(remark) => remark.fmt(f),
            Self::ConstantEffort { joint, effort } => {
                write!(f, "efforts of {joint} are {} in the whole log: are they measured?", rounded(*effort, 3))
            }
            Self::LeftOut(left_out) => write!(f, "left out: {left_out}"),
        }
    }
}

/// Whether the names of joints are numbers, as in a table with the columns `q1`, `q2` and so on.
fn are_numbers(joints: &[String]) -> bool {
    joints.iter().all(|joint| !joint.is_empty() && joint.bytes().all(|byte| byte.is_ascii_digit()))
}
