//! Logs of robot arms as runs of joint states.
//!
//! A [`Log`] is one or more files: bags of ROS 2 in SQLite and MCAP, tables in Parquet and CSV, arrays of numpy.
//! [`Log::survey`] says what is in them, [`Log::motions`] hands out runs, filtered, with accelerations. Both read in
//! memory that does not grow with the files.
//!
//! ```no_run
//! use rne_logs::{Log, Options};
//!
//! # fn main() -> Result<(), rne_logs::LogError> {
//! let log = Log::open(&["motion.db3".into()], Options::default())?;
//! let survey = log.survey(|_| ())?;
//! for piece in log.motions(&survey)? {
//!     let piece = piece?;
//!     println!("run {}: {} states from {} s", piece.run, piece.motion.len(), piece.motion.time[0]);
//! }
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]

mod column_checks;
mod column_name;
mod columns;
mod convolution;
mod csv_table;
mod error;
mod format;
mod grid;
mod guard;
#[cfg(feature = "bags")]
mod joint_state;
mod joints;
mod kernel;
mod limits;
#[cfg(feature = "parquet")]
mod list_columns;
mod log;
#[cfg(feature = "bags")]
mod mcap_bag;
mod median;
mod motion;
mod motions;
mod npy;
mod npy_array;
mod number;
mod options;
#[cfg(feature = "parquet")]
mod parquet_column;
#[cfg(feature = "parquet")]
mod parquet_pages;
#[cfg(feature = "parquet")]
mod parquet_table;
mod pass;
mod sample;
mod spectrum;
mod spelling;
mod spikes;
#[cfg(feature = "bags")]
mod sqlite_bag;
mod survey;
mod time_column;
mod time_unit;
#[cfg(feature = "bags")]
mod topic;
mod unit;

pub use crate::error::LogError;
pub use crate::format::Format;
pub use crate::guard::is_guarded;
pub use crate::log::{Layout, Log};
pub use crate::median::median;
pub use crate::motion::Motion;
pub use crate::motions::{Motions, Piece};
pub use crate::npy::Npy;
pub use crate::options::{Angles, Options};
pub use crate::pass::Unusable;
pub use crate::spikes::Spike;
pub use crate::survey::{Counts, Cutoff, Interruption, Run, Survey};
pub use crate::time_unit::TimeUnit;
pub use crate::unit::{Dimension, JointUnits};
