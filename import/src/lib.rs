//! Converts other descriptions of an arm to a Denavit-Hartenberg table, and back.
//!
//! Functions take and return data and print nothing. Only three open files: [`Description::open`] opens a description,
//! in the same way for every interface, and [`Urdf::read`] and [`repair::bodies_of`] open files that an MJCF file
//! includes. [`Urdf::import`] makes a robot file from a chain of a URDF or of an MJCF file, [`convert()`] writes a
//! table in the other convention, [`export()`] writes it as a URDF, and [`robot_file::write`] writes a robot file.
//! [`import()`] is for programs that read one URDF many times: it keeps the results. [`repair::proposals`] finds the
//! mistake in a mass or an inertia that no body has.
//!
//! Numbers are rotated with twice the precision and rounded once. So a length of 0.4318 in the URDF is 0.4318 in the
//! table, and a number that is zero on paper is zero, which lets the compiler remove it from the code.
#![warn(missing_debug_implementations)]
#![forbid(unsafe_code)]

mod body;
mod chain;
mod closed_loop;
mod comparison;
mod conventions;
mod description;
mod dynamics;
mod export;
mod extended_urdf;
mod frames;
mod geometry;
mod import;
mod kept;
mod mjcf;
mod payload;
mod remark;
pub mod repair;
pub mod robot_file;
mod selection;
mod snap;
mod source;
mod table;
mod transmission;
mod urdf;

pub use comparison::Difference;
pub use conventions::{Converted, convert};
pub use description::{Description, OpenError, shipped, shipped_at};
pub use export::{Exported, NoUrdf, export};
pub use import::{Account, Imported, Options, snapping_in};
pub use kept::{import, import_arm};
pub use payload::{carrying, carrying_at};
pub use remark::Remark;
pub use selection::Selection;
pub use snap::{Snapped, TOLERANCE};
pub use urdf::Urdf;
