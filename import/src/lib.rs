//! Other descriptions of an arm into a Denavit-Hartenberg table, and back.
//!
//! Strings in, data out: nothing here prints, and only [`Description::open`] opens a file, in one order for every door,
//! and [`Urdf::read`] those that an MJCF file includes. [`Urdf::import`] makes a robot file of a chain of a URDF or of
//! an MJCF file, [`convert()`] writes a table in the other convention, [`export()`] writes it as a URDF,
//! [`robot_file::write`] is the writer of robot files. [`import()`] is for programs that read one URDF many times: it
//! keeps what it made.
//!
//! Numbers are turned in twice the precision and rounded once. So a length that is 0.4318 in the URDF is 0.4318 in the
//! table, and what is zero on paper is zero: the compiler folds it away.
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
