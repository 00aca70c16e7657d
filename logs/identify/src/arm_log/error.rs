//! The errors of reading the logs of an arm.

use std::fmt;

use rne_logs::number::rounded;
use rne_logs::{LeftOut, LogError, Quantity};
use rne_model::{JointKind, one_line};

/// Largest number of names that a message lists.
pub(crate) const SHOWN: usize = 16;

/// Why logs cannot be read as logs of an arm. `Display` says it without the options of any interface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ArmLogError {
    /// A log cannot be read, or not with these options.
    Log {
        /// The error, with its remedies.
        error: LogError,
        /// The joints of the robot, where they help to word a remedy.
        joints: Vec<String>,
    },
    /// The number of joints that the options name differs from that of the robot.
    NamedJoints {
        /// How many joints are named.
        named: usize,
        /// The joints of the log, where it can be read.
        logged: Vec<String>,
        /// The joints of the robot, base to tip.
        joints: Vec<String>,
    },
    /// It is unclear which joints of the log are those of the robot.
    Unmatched {
        /// The joints of the log.
        logged: Vec<String>,
        /// The joints of the robot, base to tip.
        joints: Vec<String>,
        /// The difference.
        mismatch: Mismatch,
    },
    /// A joint of the robot turns and that of the log slides, or the other way round, by the names of the columns.
    Kind {
        /// The joint of the robot.
        joint: String,
        /// The joint of the log.
        logged: String,
        /// The kind of the robot's joint.
        kind: JointKind,
        /// The quantity whose unit belongs to the other kind of joint.
        quantity: Quantity,
    },
    /// The log has no efforts.
    NoEfforts {
        /// The joints of the log.
        logged: Vec<String>,
        /// The columns of the log that are not read.
        unread: Vec<String>,
    },
    /// The log has efforts, but none of these joints.
    MissingEfforts {
        /// The joints of the log.
        logged: Vec<String>,
    },
    /// No message or row of the log is a state of the arm.
    NoStates {
        /// Numbers of messages or rows that are left out, with the reasons.
        left_out: Vec<LeftOut>,
    },
    /// No run is long enough to choose the cut-off of the low-pass filter, and none is given.
    NoCutoff,
    /// The cut-off of the low-pass filter is not possible for these logs.
    Cutoff {
        /// The cut-off, Hz.
        cutoff: f64,
        /// States per second of the log.
        rate: f64,
        /// The longest run, s.
        longest: f64,
        /// The lowest and the highest possible cut-off, Hz; `None` if the runs are too short for any.
        possible: Option<[f64; 2]>,
    },
}

/// Why joints of a log are not matched with those of a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Mismatch {
    /// The log has fewer joints.
    Fewer,
    /// The log has more joints than the robot, and some names of the robot's joints are missing.
    More,
    /// The log has as many joints as the robot. Some have names of the robot's joints, but in another order.
    Order {
        /// A joint of the robot whose position in the order of the log is another one.
        joint: String,
    },
}

impl ArmLogError {
    /// Whether the files are valid but the options do not fit them, so that other options help.
    #[must_use]
    pub fn is_of_request(&self) -> bool {
        match self {
            Self::Log { error, .. } => error.is_of_request(),
            Self::NamedJoints { .. } | Self::Unmatched { .. } | Self::Kind { .. } => true,
            Self::NoEfforts { .. } | Self::MissingEfforts { .. } | Self::NoStates { .. } | Self::NoCutoff => false,
            Self::Cutoff { possible, .. } => possible.is_some(),
        }
    }
}

impl From<LogError> for ArmLogError {
    fn from(error: LogError) -> Self {
        Self::Log { error, joints: Vec::new() }
    }
}

impl std::error::Error for ArmLogError {}

impl fmt::Display for ArmLogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Log { error, .. } => error.fmt(f),
            Self::NamedJoints { named, logged, joints } => f.write_str(&wrong_names(*named, logged, joints)),
            Self::Unmatched { logged, joints, mismatch } => {
                write!(
                    f,
                    "the log has {} ({}), but the robot has {} ({})",
                    of_joints(logged.len()),
                    shown(logged),
                    joints.len(),
                    shown(joints)
                )?;
                match mismatch {
                    Mismatch::Fewer => write!(f, "; {ALL_NEEDED}"),
                    Mismatch::More => Ok(()),
                    Mismatch::Order { joint } => write!(f, "; {} has another place in the two lists", one_line(joint)),
                }
            }
            Self::Kind { joint, logged, kind, quantity } => write!(
                f,
                "the joint {} of the robot {}, but by the names of the columns of the log, the {} of {} belong to a \
                 joint of the other kind",
                one_line(joint),
                if *kind == JointKind::Revolute { "turns" } else { "slides" },
                quantity.plural(),
                one_line(logged)
            ),
            Self::NoEfforts { unread, .. } => f.write_str(&no_efforts(unread)),
            Self::MissingEfforts { logged } => {
                let names: Vec<String> = logged.iter().map(|name| one_line(name)).collect();
                write!(
                    f,
                    "the log has no efforts of {}, but rne must compare the model with the torques of every joint",
                    names.join(", ")
                )
            }
            Self::NoStates { left_out } => {
                let why = left_out.iter().map(|left_out| format!("{} {}", left_out.count, left_out.why()));
                let record = left_out.first().map_or("message", LeftOut::record);
                let why = one_line(&why.collect::<Vec<_>>().join("; "));
                write!(f, "no {record} of the log contains a state of the arm: {why}")
            }
            Self::NoCutoff => {
                f.write_str("no run (a part of the log without gaps) is long enough to choose a low-pass filter")
            }
            Self::Cutoff { cutoff, rate, longest, possible } => {
                write!(
                    f,
                    "{} Hz is not possible as a low-pass for samples at {rate:.4} Hz, because the runs (parts of the \
                     log without gaps) have {} s at most{}",
                    rounded(*cutoff, 3),
                    rounded(*longest, 2),
                    possible_cutoffs(*possible)
                )
            }
        }
    }
}

fn wrong_names(named: usize, logged: &[String], joints: &[String]) -> String {
    let there = if logged.is_empty() { String::new() } else { format!(", which has {}", shown(logged)) };
    let advice = if (1..joints.len()).contains(&logged.len()) {
        ALL_NEEDED
    } else {
        "name one joint of the log for each joint of the robot, from base to tip"
    };
    format!(
        "the list of joints names {} of the log{there}, but the robot has {}: {}; {advice}",
        of_joints(named),
        of_joints(joints.len()),
        shown(joints)
    )
}

fn no_efforts(unread: &[String]) -> String {
    let what = "the log has no efforts, but rne must compare the model with torques";
    if unread.is_empty() {
        return what.to_owned();
    }
    let unread: Vec<String> = unread.iter().take(SHOWN).map(|name| one_line(name)).collect();
    format!(
        "{what}; rne does not read the columns {}, because columns of efforts have names such as tau1 or \
         elbow/effort: see docs/control/logs.md",
        unread.join(", ")
    )
}

fn possible_cutoffs(possible: Option<[f64; 2]>) -> String {
    let Some([lowest, highest]) = possible else {
        return ", and no other cut-off is possible: the runs are too short".to_owned();
    };
    format!(
        "; the cut-off can be from {} to {} Hz for this log; a lower cut-off drops more samples at the ends of runs",
        rounded((lowest * 1e3).ceil() * 1e-3, 3),
        rounded((highest * 1e3).floor() * 1e-3, 3)
    )
}

/// Advice for a log that has fewer joints than the robot.
const ALL_NEEDED: &str = "the positions and torques of all joints are needed, so use a log with all joints, or a robot \
    file of the logged joints";

/// Lists the first names of joints, separated by commas.
pub(crate) fn shown(names: &[String]) -> String {
    let first: Vec<String> = names.iter().take(SHOWN).map(|name| one_line(name)).collect();
    let more = if names.len() > SHOWN { ", …" } else { "" };
    first.join(", ") + more
}

fn of_joints(count: usize) -> String {
    if count == 1 { "1 joint".to_owned() } else { format!("{count} joints") }
}

/// The reason why reading the logs of an arm stopped.
#[derive(Clone, Debug, PartialEq)]
pub enum PassError<E> {
    /// A log cannot be read to its end.
    Log(ArmLogError),
    /// The caller's function returned this error for a motion.
    Motion(E),
}

impl<E> From<E> for PassError<E> {
    fn from(error: E) -> Self {
        Self::Motion(error)
    }
}

impl<E: fmt::Display> fmt::Display for PassError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Log(error) => error.fmt(f),
            Self::Motion(error) => error.fmt(f),
        }
    }
}

impl<E: std::error::Error> std::error::Error for PassError<E> {}
