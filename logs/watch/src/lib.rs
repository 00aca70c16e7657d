//! Watches an arm by its logs: finds parameters that have changed against a quiet log ([`Baseline`], [`Changes`]) and
//! contacts ([`contacts`]), reports both as events with one cause each ([`watch`], [`Event`]), and compares the
//! parameters from log to log ([`Trend`]).
//!
//! A change is estimated by least squares over both logs, which have all parameters in common except the changed ones.
//! The module `score` has the equations, and `selection` chooses among possible causes. Contacts are found by the
//! momentum observer after the torques of the changes have been subtracted.
//!
//! ```no_run
//! use rne_identify::{ArmLog, ArmLogOptions, Purpose};
//! use rne_watch::{Baseline, Settings, watch};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = std::fs::read_to_string("arm.yaml")?;
//! let robot = rne_model::Robot::from_yaml(&text).map_err(|report| report.to_string())?;
//! let mut options = ArmLogOptions { purpose: Purpose::Watch, ..ArmLogOptions::default() };
//! let quiet = ArmLog::open(&["quiet.csv".into()], &robot, &options)?;
//! let settings = Settings::default();
//! let baseline = Baseline::of_logs(&robot, &quiet, &settings, &mut |_| ())?;
//! // both logs pass the same filter
//! options.log.cutoff = Some(baseline.cutoff);
//! let log = ArmLog::open(&["today.csv".into()], &robot, &options)?;
//! let report = watch(&robot, &baseline, &log, &settings, false, &mut |_| ())?;
//! for event in &report.events {
//!     println!("{}: {} {} since {} s", event.cause, event.value, event.unit, event.since);
//! }
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations)]

mod baseline;
mod baseline_file;
mod candidate;
mod changes;
mod contact;
mod dates;
mod error;
mod event;
mod picture;
mod reply;
mod report;
mod rivals;
mod score;
mod selection;
mod sensor;
mod settings;
mod signals;
mod trend;

pub use crate::baseline::Baseline;
pub use crate::candidate::{Candidate, Scale};
pub use crate::changes::Changes;
pub use crate::contact::{Contact, ContactNoise, JointNoise, contact_limits, contacts};
pub use crate::error::WatchError;
pub use crate::event::{Cause, Event, unit};

pub use crate::picture::svg;
pub use crate::reply::{TrendReply, WatchReply};
pub use crate::report::{Report, changes, watch};
pub use crate::selection::Statistic;
pub use crate::sensor::exchanged_efforts;
pub use crate::settings::Settings;
pub use crate::signals::Signals;
pub use crate::trend::{Trend, TrendRow, TrendValue};
