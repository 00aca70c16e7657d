//! Inertial parameters and friction of a robot arm from its logs.
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations)]

mod arm_log;
mod design;
mod effort;
mod excitation;
mod excitation_error;
mod feasible;
mod fitted_model;
mod fourier;
mod friction;
mod identifiability;
mod identification;
mod information;
mod least_squares;
mod log_reply;
mod motion_limits;
mod parameters;
mod payload;
mod payload_reply;
mod prediction;
pub mod prior;
pub mod pseudo_inertia;
mod r_factor;
mod random;
mod regressor;
mod reply;
mod smoothing;
mod steady;
mod stretches;
mod structure;
mod verdict;
mod written;

pub use arm_log::{
    ArmLog, ArmLogError, ArmLogOptions, ArmLogRemark, JointMatch, Mismatch, Part, PassError, Purpose, check_units,
    joint_options, match_joints,
};
pub use excitation::{BaseExcitation, Excitation, ExcitationOptions, ExcitationProgress, JointUse, excite};
pub use excitation_error::ExcitationError;
pub use feasible::{Certificate, Feasible};
pub use fitted_model::{FittedModel, FrictionParameter, inverse_of_information};
pub use fourier::{Fourier, MotionBounds, Series};
pub use friction::FrictionExcitation;
pub use identifiability::{Identifiability, Parameter, Visibility};
pub use identification::{BaseReport, Fit, Identification, JointReport, identify};
pub use information::{Information, MotionError, Rejected, Weighting, WrongNumbers};
pub use least_squares::{LeastSquares, student};
pub use log_reply::LogReply;
pub use motion_limits::{AskedLimits, MotionLimits};
pub use parameters::{Base, Parameters};
pub use payload::{LEAST_FRICTION, LIGHT_ARM, LIGHTEST_PAYLOAD, PAYLOAD_REACH, Payload, PayloadNumber, SLOWEST};
pub use payload_reply::PayloadReply;
pub use prediction::{JointError, Prediction, SPEEDS, Standstill, prediction_errors};
pub use r_factor::{RFactor, WrongColumns};
pub use reply::{IdentificationReply, JudgedPart};
pub use stretches::{Stretch, Stretches};
pub use structure::{Options, Structure};
pub use verdict::{Doubt, Evidence, Excited, JointVerdict, Verdict};
