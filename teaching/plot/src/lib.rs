//! Torques along a trajectory and their parts: the inertia, velocity and gravity parts of a torque ([`TorqueParts`]), a
//! [`Trajectory`], the [`TorqueHistory`] of an arm along it, and its picture ([`svg`]). [`panels`] draws other signals
//! of joints in the same way.
//!
//! This crate does not read files and does not print.
//!
//! ```
//! use rne_plot::{TorqueHistory, Trajectory, svg};
//!
//! let file = rne_robots::find("planar2").expect("it is shipped");
//! let robot = rne_model::Robot::from_yaml(file.yaml)?;
//! let swing = Trajectory::quintic(&[-1.0, 0.0], &[0.5, 1.0], 2.0, 201)?;
//! let history = TorqueHistory::new(&robot, &swing)?;
//! let sample = &history.parts[100];
//! assert!((sample.inertia[0] + sample.velocity[0] + sample.gravity[0] - sample.total[0]).abs() < 1e-12);
//! assert!(svg(&robot, &swing, &history, "a swing").starts_with("<svg"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod chart;
mod clipped;
mod comparison;
mod elements;
mod history;
mod panels;
mod parts;
mod scale;
mod trajectory;

pub use crate::chart::svg;
pub use crate::comparison::{Comparison, comparison_svg};
pub use crate::history::{Peak, TorqueHistory};
pub use crate::panels::{Band, Panel, PanelCurve, panels, panels_over};
pub use crate::parts::TorqueParts;
pub use crate::scale::significant;
pub use crate::trajectory::{Trajectory, TrajectoryError};
