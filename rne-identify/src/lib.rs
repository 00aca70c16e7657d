//! Inertial parameters and friction of a robot arm from its logs.
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations)]

mod feasible;
mod fit;
mod identification;
mod information;
mod parameters;
mod prediction;
pub mod prior;
pub mod pseudo_inertia;
mod r_factor;
mod smoothing;
mod structure;
mod written;

pub use feasible::{Certificate, Feasible};
pub use fit::Fit;
pub use identification::{BaseReport, Identification, JointReport, OnePass, identify, scales};
pub use information::{Information, MotionError, Weighting, WrongNumbers};
pub use parameters::{Base, Parameters, name, unit};
pub use prediction::{JointError, Prediction, SPEEDS, friction, prediction_errors};
pub use r_factor::{RFactor, WrongColumns};
pub use rne_codegen::Parameter;
pub use structure::{Options, Structure};
pub use written::{written, written_robot};
