//! The functions of a robot: one trait per capability, implemented by generated code and by [`Arm`](crate::Arm) alike.
//!
//! A trait gets a new method only with a default, or in a breaking version.
//!
//! Joint arrays run from base to tip. Revolute joints: rad, rad/s, rad/s², N m. Prismatic joints: m, m/s, m/s², N.

#[macro_use]
mod definitions;

mod closed_loops;
mod derivatives;
mod floating_base;
mod kinematics;
mod motion;
mod steps;
mod torques;

pub use closed_loops::*;
pub use derivatives::*;
pub use floating_base::*;
pub use kinematics::*;
pub use motion::*;
pub use steps::*;
pub use torques::*;
