//! The robot file: one YAML document per robot, with its Denavit-Hartenberg table and inertial data.
//!
//! [`Reader`] reads a document and returns the validated [`Robot`] with its lints, or a [`Report`] of every mistake
//! with line, column and what is allowed. Strings in, data out: nothing here opens a file; who does reads it with
//! [`read_file`].
//!
//! ```
//! # #[cfg(feature = "std")] {
//! let text = "
//! format: 1
//! name: pendulum
//! source: a lecture
//! convention: standard
//! gravity: [0, -9.81, 0]
//! joints:
//!   - {type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mas: 2, inertia: {yy: 0.1, zz: 0.1}}}
//! ";
//! let report = rne_model::Reader::new("pendulum.yaml").read(text).unwrap_err();
//! assert_eq!(
//!     report.short(),
//!     "pendulum.yaml:8:69: error: unknown key `mas`; a link has the keys mass, com, first_moment, \
//!      inertia, inertia_about, physical"
//! );
//! assert_eq!(report.diagnostics[0].help.as_deref(), Some("did you mean `mass`?"));
//!
//! let checked = rne_model::Reader::new("pendulum.yaml").read(&text.replace("mas:", "mass:")).unwrap();
//! assert_eq!(checked.robot.joints[0].row.link.mass, 2.0);
//! assert!(checked.lints.is_empty());
//! # }
//! ```
//!
//! Parameters of the file may stay free until run time: [`Reader::run_time`] gives the numbers that depend on
//! them as a [`Formula`] each.
//!
//! The plain types of the table ([`Row`], [`Angle`], [`Link`], [`Model`], …) need neither `std` nor an allocator.
#![warn(missing_debug_implementations)]
#![forbid(unsafe_code)]
#![cfg_attr(not(feature = "std"), no_std)]

mod angle;
#[cfg(feature = "std")]
mod check;
mod contact;
#[cfg(feature = "std")]
mod exports;
#[cfg(feature = "std")]
mod lints;
#[cfg(feature = "std")]
mod loops;
#[cfg(feature = "std")]
mod parts;
#[cfg(feature = "std")]
mod readers;
#[cfg(feature = "std")]
mod robot;
mod table;
#[cfg(feature = "std")]
mod text;

pub use angle::{Angle, LARGEST_ANGLE, QuarterTurns};
pub use contact::{Contact, ContactKind};
#[cfg(feature = "std")]
pub use exports::*;
pub use table::{
    Convention, Dh, FixedFrame, INERTIAL_PARAMETERS, Inertia, JointKind, Link, Model, Motor, PER_LINK, Row, Transform,
};
