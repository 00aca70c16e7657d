//! Why a message is not used, or not for everything.

use std::fmt;

use rne_identify::Mismatch;

/// The names that a text lists at most.
const SHOWN: usize = 16;

/// Why a message is not used at all. `Display` is the sentence of the diagnostics.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// The message has none of the joints of the arm: it is of another part of the robot. This is no fault.
    Foreign,
    /// The message has some joints of the arm, and lacks this one.
    Incomplete {
        /// The joint that is missing.
        joint: String,
    },
    /// The joints cannot be matched with those of the robot.
    Unmatched {
        /// The joints of the message.
        measured: Vec<String>,
        /// The joints of the robot, base to tip.
        joints: Vec<String>,
        /// The difference.
        mismatch: Mismatch,
    },
    /// The message has another number of positions than of names.
    Positions {
        /// The number of names.
        names: usize,
        /// The number of positions.
        positions: usize,
    },
    /// A position is no finite number.
    Position {
        /// The joint, by the name in the message.
        joint: String,
        /// Its position.
        value: f64,
    },
    /// The message has no stamp.
    NoStamp,
    /// The stamp is not later than the last one.
    NotLater {
        /// How much earlier it is, s.
        by: f64,
    },
    /// The stamp is too far from the clock of the node.
    Stale {
        /// Age of the message, s; below zero where its stamp is in the future.
        age: f64,
        /// The limit, s.
        limit: f64,
    },
    /// The gravity torques are no finite numbers, or cannot be computed.
    Torques(String),
}

/// Why a message gives no external torques, though it gives gravity torques.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Lacking {
    /// It is the first message, or the first one after a gap: the observer begins with it.
    First,
    /// The message has no velocities, or no efforts.
    Missing {
        /// `velocities` or `efforts`.
        what: &'static str,
    },
    /// The message has another number of velocities or efforts than of names.
    Length {
        /// `velocities` or `efforts`.
        what: &'static str,
        /// The number of names.
        names: usize,
        /// The number of velocities or efforts.
        found: usize,
    },
    /// A velocity or an effort is no finite number.
    Number {
        /// `velocity` or `effort`.
        what: &'static str,
        /// The joint, by the name in the message.
        joint: String,
        /// Its value.
        value: f64,
    },
    /// The external torques are no finite numbers, or cannot be computed.
    Torques(String),
}

impl Fault {
    /// The key of its count in the diagnostics.
    pub(crate) fn key(&self) -> &'static str {
        match self {
            Self::Foreign => "messages of other joints",
            Self::Incomplete { .. } => "rejected: joint missing",
            Self::Unmatched { .. } => "rejected: joints not matched",
            Self::Positions { .. } => "rejected: number of positions",
            Self::Position { .. } => "rejected: position not finite",
            Self::NoStamp => "rejected: no stamp",
            Self::NotLater { .. } => "rejected: stamp not later",
            Self::Stale { .. } => "rejected: stale stamp",
            Self::Torques(_) => "rejected: torques not finite",
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign => f.write_str("the message has no joint of the arm"),
            Self::Incomplete { joint } => write!(f, "the message lacks the joint {joint} of the arm"),
            Self::Unmatched { measured, joints, mismatch } => {
                let (robot, there) = (listed(joints), listed(measured));
                write!(
                    f,
                    "the message has the {} joints {there}, but the arm has the {}",
                    measured.len(),
                    joints.len()
                )?;
                write!(f, " joints {robot}; ")?;
                match mismatch {
                    Mismatch::Order { joint } => write!(f, "{joint} has another place in the two lists; "),
                    _ => Ok(()),
                }?;
                f.write_str("name the joints of the messages, base to tip, by --joints")
            }
            Self::Positions { names, positions } => {
                write!(f, "the message has {names} names of joints, but {positions} positions")
            }
            Self::Position { joint, value } => write!(f, "the position of {joint} is {value}, which is not finite"),
            Self::NoStamp => f.write_str("header.stamp of the message is 0; its publisher must set the stamp"),
            Self::NotLater { by } => {
                write!(f, "header.stamp of the message is {by:.6} s before that of the message before, or the same")
            }
            Self::Stale { age, limit } if *age < 0.0 => write!(
                f,
                "header.stamp of the message is {:.3} s in the future, more than {limit} s; do the clocks differ?",
                -age
            ),
            Self::Stale { age, limit } => write!(
                f,
                "header.stamp of the message is {age:.3} s old, more than {limit} s; for simulated time and bags, \
                 start the node with --stale-after 0"
            ),
            Self::Torques(why) => write!(f, "no gravity torques: {why}"),
        }
    }
}

impl Lacking {
    /// The key of its count in the diagnostics.
    pub(crate) fn key(&self) -> &'static str {
        match self {
            Self::First => "beginnings of the observer",
            Self::Missing { what: "velocities" } => "without velocities",
            Self::Missing { .. } => "without efforts",
            Self::Length { .. } => "wrong number of velocities or efforts",
            Self::Number { .. } => "velocity or effort not finite",
            Self::Torques(_) => "external torques not finite",
        }
    }
}

impl fmt::Display for Lacking {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::First => f.write_str("the observer begins"),
            Self::Missing { what } => {
                write!(f, "the messages have no {what}; external torques need positions, velocities and efforts")
            }
            Self::Length { what, names, found } => {
                write!(f, "the message has {names} names of joints, but {found} {what}")
            }
            Self::Number { what, joint, value } => write!(f, "the {what} of {joint} is {value}, which is not finite"),
            Self::Torques(why) => write!(f, "no external torques: {why}"),
        }
    }
}

/// Names of joints, the first of them.
pub(crate) fn listed(names: &[String]) -> String {
    let first: Vec<&str> = names.iter().take(SHOWN).map(String::as_str).collect();
    first.join(", ") + if names.len() > SHOWN { ", …" } else { "" }
}
