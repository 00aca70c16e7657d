//! Reasons why a message is not used, or only for some results.

use std::fmt;

use rne_identify::Mismatch;

/// The largest number of names that a text lists.
const SHOWN: usize = 16;

/// Reason why a message is not used at all. `Display` gives the sentence for the diagnostics.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// The message has none of the arm's joints, so it is about another part of the robot. This is not an error.
    Foreign,
    /// The message has some of the arm's joints, but not this one.
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
    /// The number of positions differs from the number of names.
    Positions {
        /// The number of names.
        names: usize,
        /// The number of positions.
        positions: usize,
    },
    /// A position is not finite.
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
    /// The gravity torques are not finite, or cannot be computed.
    Torques(String),
}

/// Reason why a message gives no external torques, although it gives gravity torques.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Lacking {
    /// It is the first message, or the first one after a gap, with which the observer starts.
    First,
    /// The message has no velocities, or no efforts.
    Missing {
        /// `velocities` or `efforts`.
        what: &'static str,
    },
    /// The number of velocities or efforts differs from the number of names.
    Length {
        /// `velocities` or `efforts`.
        what: &'static str,
        /// The number of names.
        names: usize,
        /// The number of velocities or efforts.
        found: usize,
    },
    /// A velocity or an effort is not finite.
    Number {
        /// `velocity` or `effort`.
        what: &'static str,
        /// The joint, by the name in the message.
        joint: String,
        /// Its value.
        value: f64,
    },
    /// The external torques are not finite, or cannot be computed.
    Torques(String),
}

impl Fault {
    /// The key under which the diagnostics count this fault.
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
    /// The key under which the diagnostics count this reason.
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

/// Returns the names of joints as a text, at most the first [`SHOWN`] of them.
pub(crate) fn listed(names: &[String]) -> String {
    let first: Vec<&str> = names.iter().take(SHOWN).map(String::as_str).collect();
    first.join(", ") + if names.len() > SHOWN { ", …" } else { "" }
}
