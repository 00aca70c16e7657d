//! The robot file: one YAML document per robot, with its Denavit-Hartenberg table and inertial data.
//!
//! [`check`] reads a document and returns the validated [`Robot`] with its lints, or a [`Report`] of every
//! mistake with line, column and what is allowed. Strings in, data out: nothing here opens a file.
//!
//! The plain types of the table ([`Row`], [`Angle`], [`Link`], [`Model`], …) need neither `std` nor an allocator.
#![cfg_attr(not(feature = "std"), no_std)]

mod angle;
mod table;

pub use angle::{Angle, QuarterTurns};
pub use table::{Convention, Dh, Inertia, JointKind, Link, Model, Row, Transform};

#[cfg(feature = "std")]
mod robot;
#[cfg(feature = "std")]
pub use robot::{InertiaReference, Joint, Limits, Motor, Robot};
