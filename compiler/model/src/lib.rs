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

#[cfg(feature = "std")]
mod lints;
#[cfg(feature = "std")]
mod parts;
#[cfg(feature = "std")]
mod text;
#[cfg(feature = "std")]
pub use text::document;
mod angle;
mod table;

pub use angle::{Angle, LARGEST_ANGLE, QuarterTurns};
pub use table::{
    Convention, Dh, FixedFrame, INERTIAL_PARAMETERS, Inertia, JointKind, Link, Model, Motor, PER_LINK, Row, Transform,
};

#[cfg(feature = "std")]
mod check;
mod contact;
#[cfg(feature = "std")]
mod loops;
#[cfg(feature = "std")]
mod robot;

#[cfg(feature = "std")]
pub use check::{Checked, Reader};
pub use contact::{Contact, ContactKind};
#[cfg(feature = "std")]
pub use loops::closed_loop::{ClosedLoop, ClosedLoops, Cut, Pivot};
#[cfg(feature = "std")]
pub use loops::dependents::{Actuation, NoDependents, choose_dependents};
#[cfg(feature = "std")]
pub use parts::body::{Bodies, Body, UnknownBody};
#[cfg(feature = "std")]
pub use parts::coupling::Coupling;
#[cfg(feature = "std")]
pub use parts::double::{Double, decimal_digits};
#[cfg(feature = "std")]
pub use parts::drive::{Drive, Rotor};
#[cfg(feature = "std")]
pub use parts::floating_base::FloatingBase;
#[cfg(feature = "std")]
pub use parts::formula::Formula;
#[cfg(feature = "std")]
pub use parts::frame::{Frame, FrameId, UnknownFrame};
#[cfg(feature = "std")]
pub use parts::friction::{Friction, FrictionTransition, TransitionSign};
#[cfg(feature = "std")]
pub use parts::golden::{GoldenFile, GoldenState};
#[cfg(feature = "std")]
pub use parts::inertia::NegativeMoment;
#[cfg(feature = "std")]
pub use parts::run_time::{Entry, InertiaElement, RunTime};
#[cfg(feature = "std")]
pub use robot::{InertiaReference, Joint, Limits, Robot};
#[cfg(feature = "std")]
pub use text::data_file::{
    MAX_BYTES, golden_of, misnamed_golden_of, open_file, plan_of, read_file, read_limited, robot_of,
};
#[cfg(feature = "std")]
pub use text::diagnostic::{Diagnostic, Remedy, Report, Severity};
#[cfg(feature = "std")]
pub use text::expression::number;
#[cfg(feature = "std")]
pub use text::identifier::JointIdentifier;
#[cfg(feature = "std")]
pub use text::keys::{Key, Mapping, mappings};
#[cfg(feature = "std")]
pub use text::source::{exact_digits, half_of_last_digit, is_control, one_line, six_digits};
#[cfg(feature = "std")]
pub use text::spelling::{did_you_mean, nearest_name, no_shipped_robot};
#[cfg(feature = "std")]
pub use text::urdf::is_urdf;
