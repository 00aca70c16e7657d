//! A ROS 2 node for a robot arm: from the joint states it computes gravity torques, external torques by the momentum
//! observer, and diagnostics.
//!
//! [`Monitor`] computes all this from messages and needs no ROS: data in, data out. [`node::run`] connects it with the
//! topics, by the crate ros2-client. `docs/control/ros2.md` describes the node.
#![warn(missing_debug_implementations)]

pub mod arm;
mod diagnosis;
mod fault;
pub mod messages;
mod monitor;
pub mod node;
mod sequence;

pub use diagnosis::Source;
pub use fault::{Fault, Lacking};
pub use monitor::{Monitor, Settings, Torques};
pub use sequence::Sequences;
