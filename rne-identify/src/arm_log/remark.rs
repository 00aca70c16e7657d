//! Remarks on the logs of an arm, as data.

use std::fmt;

use crate::arm_log::error::shown;

/// A remark on the logs of an arm. `Display` says it without the options of any interface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ArmLogRemark {
    /// The log has other names of joints: its joints are taken for those of the robot by their order.
    MatchedByOrder {
        /// The joints of the log, base to tip.
        logged: Vec<String>,
    },
    /// A remark on the log alone.
    Log(rne_logs::Remark),
    /// All efforts of a joint are the same number.
    ConstantEffort {
        /// The joint by the log's name.
        joint: String,
        /// N m or N
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
            Self::MatchedByOrder { .. } => false,
            Self::Log(remark) => remark.is_warning(),
            Self::ConstantEffort { .. } | Self::LeftOut(_) => true,
        }
    }
}

impl fmt::Display for ArmLogRemark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MatchedByOrder { logged } => {
                write!(f, "joints of the log are matched by their order: {}", shown(logged))
            }
            Self::Log(remark) => remark.fmt(f),
            Self::ConstantEffort { joint, effort } => {
                write!(f, "efforts of {joint} are {} throughout: are they measured?", rounded(*effort, 3))
            }
            Self::LeftOut(left_out) => write!(f, "left out: {left_out}"),
        }
    }
}

/// A number with some digits after the decimal point; tiny and huge ones with a power of ten.
pub(crate) fn rounded(value: f64, digits: usize) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if value.abs() < 1e-4 || value.abs() >= 1e6 {
        format!("{value:.2e}")
    } else {
        format!("{value:.digits$}")
    }
}
