//! Watches an arm by its motions: what its efforts are beyond the model ([`Signals`]), how large that is while nothing
//! happens ([`Baseline`]), and where more happens ([`watch`], [`Event`]), with a picture ([`svg`]).
//!
//! Three tests look at every joint. Each may raise so many false alarms in an hour, and no more:
//!
//! | test | looks at | finds | threshold |
//! |---|---|---|---|
//! | [`Test::External`] | the momentum observer | collisions, a hand, a payload | k deviations for a time of hold |
//! | [`Test::Offset`] | the residual, measured less model | a payload, an offset of a sensor | a cumulative sum |
//! | [`Test::Friction`] | the residual in the direction of motion | wear, a brake, cold grease | a cumulative sum |
//!
//! How the thresholds follow from the rate is in the modules' words: [`Thresholds`].
//!
//! ```
//! use rne_logs::Motion;
//! use rne_watch::{Baseline, Settings, Signals, watch};
//!
//! let file = rne_robots::find("planar2").expect("it is shipped");
//! let robot = rne_model::Robot::from_yaml(file.yaml)?;
//! // ten seconds at rest, where the model explains all but a ripple
//! let time: Vec<f64> = (0..1000).map(|tick| 0.01 * f64::from(tick)).collect();
//! let weight = rne_runtime::DynArm::from_robot(&robot).gravity_torques(&[0.3, -0.5])?;
//! let still = |value: f64| vec![value; 1000];
//! let ripple = |mean: f64| time.iter().map(|t| mean + 0.02 * (1e4 * t * t).sin()).collect::<Vec<_>>();
//! let motion = Motion {
//!     q: vec![still(0.3), still(-0.5)],
//!     qd: vec![still(0.0), still(0.0)],
//!     qdd: vec![still(0.0), still(0.0)],
//!     tau: vec![ripple(weight[0]), ripple(weight[1])],
//!     time,
//!     ..Motion::default()
//! };
//! let settings = Settings::default();
//! let signals = Signals::new(&robot, &motion, settings.gain)?;
//! let baseline = Baseline::of(&signals, 0..500)?;
//! let report = watch(&signals, &baseline, &settings)?;
//! assert!(report.events.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations)]

mod baseline;
mod baseline_file;
mod candidate;
mod changes;
mod contact;
mod error;
mod event;
mod picture;
mod report;

mod score;
mod selection;
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
pub use crate::report::{Report, changes, watch};
pub use crate::selection::Statistic;
pub use crate::settings::Settings;
pub use crate::signals::Signals;
pub use crate::trend::{Trend, TrendRow, TrendValue};
