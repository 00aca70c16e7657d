//! Logs of robot arms as runs of joint states.
//!
//! A [`Log`] is one or more files: bags of ROS 2 in SQLite and MCAP, tables in Parquet and CSV, arrays of numpy.
//! [`Log::survey`] reports their content, [`Log::motions`] returns filtered runs with accelerations, and
//! [`Log::recorded`] returns unfiltered states. The memory of all of these does not grow with the files.
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

mod columns;
mod error;
mod formats;
mod limits;
mod log;
pub mod number;
mod options;
mod remedy;
mod signal;
mod spelling;
mod utc;

pub use crate::columns::heading::Heading;
pub use crate::columns::mapping::{Mapping, Target, suggested};
pub use crate::columns::quantity::Quantity;
pub use crate::columns::time_unit::TimeUnit;
pub use crate::columns::unit::{Dimension, JointUnits};
pub use crate::error::LogError;
pub use crate::formats::csv_rows::CsvRows;
pub use crate::formats::format::Format;
pub use crate::formats::guard::is_guarded;
pub use crate::formats::npy::Npy;
#[cfg(feature = "parquet")]
pub use crate::formats::parquet::motion_parquet::MotionParquet;
pub use crate::log::Log;
pub use crate::log::frozen_position::FrozenPosition;
pub use crate::log::layout::Layout;
pub use crate::log::motion::Motion;
pub use crate::log::motions::{Motions, Piece};
pub use crate::log::pass::{Counts, Interruption, InvalidSample};
pub use crate::log::recorded::{Recorded, RecordedState};
pub use crate::log::remark::{LeftOut, Reason, Remark};
pub use crate::log::survey::{Cutoff, Run, Survey};
pub use crate::log::values::LabelValue;
pub use crate::options::{Angles, Options};
pub use crate::remedy::{Remedy, Setting};
pub use crate::signal::median::median;
pub use crate::signal::spikes::Spike;
pub use crate::utc::UtcTime;
