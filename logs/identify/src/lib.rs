//! Inertial parameters and friction of a robot arm from its logs.
#![forbid(unsafe_code)]
#![warn(missing_debug_implementations)]

mod fit;
mod motions;
mod replies;
pub use fit::prior;
pub use fit::pseudo_inertia;
mod arm_log;

pub use arm_log::{
    ArmLog, ArmLogError, ArmLogOptions, ArmLogRemark, JointMatch, Mismatch, Part, PassError, Purpose, check_units,
    joint_options, match_joints,
};
pub use fit::feasible::{Certificate, Feasible};
pub use fit::fitted_model::{FittedModel, FrictionParameter, inverse_of_information};
pub use fit::friction::FrictionExcitation;
pub use fit::identifiability::{Identifiability, Parameter, Visibility};
pub use fit::identification::{BaseReport, Fit, Identification, JointReport, identify};
pub use fit::information::{Information, MotionError, Rejected, Weighting, WrongNumbers};
pub use fit::least_squares::{LeastSquares, student};
pub use fit::parameters::{Base, Parameters};
pub use fit::payload::{LEAST_FRICTION, LIGHT_ARM, LIGHTEST_PAYLOAD, PAYLOAD_REACH, Payload, PayloadNumber, SLOWEST};
pub use fit::r_factor::{RFactor, WrongColumns};
pub use fit::stretches::{Stretch, Stretches};
pub use fit::structure::{Options, Structure};
pub use motions::excitation::{BaseExcitation, Excitation, ExcitationOptions, ExcitationProgress, JointUse, excite};
pub use motions::excitation_error::ExcitationError;
pub use motions::fourier::{Fourier, MotionBounds, Series};
pub use motions::motion_limits::{AskedLimits, MotionLimits};
pub use replies::log_reply::LogReply;
pub use replies::payload_reply::PayloadReply;
pub use replies::prediction::{JointError, Prediction, SPEEDS, Standstill, prediction_errors};
pub use replies::reply::{IdentificationReply, JudgedPart};
pub use replies::verdict::{Doubt, Evidence, Excited, JointVerdict, Verdict};
