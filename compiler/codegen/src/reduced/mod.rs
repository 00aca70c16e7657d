//! The reduced form: the same torques with far fewer operations.
//!
//! It uses regrouped parameters, one matrix U for all accelerations of a link, rotations in two steps, gravity in the
//! acceleration of the base, and choices for each joint that a search makes. Only the torques keep a physical meaning.
//!
//! `joint_frames`, `link_parameters` and `regrouping` prepare the numbers under a plan. `forward` and `backward` write
//! the Newton-Euler recursion (RNEA) with them; `crba`, `aba`, `momentum`, `rnea_derivatives` and `hessian` write other
//! recursions. `algorithm` lists the algorithms of each function, and `results` writes a function by one of them.

pub(crate) mod aba;
pub(crate) mod algorithm;
pub(crate) mod arguments;
pub(crate) mod attitudes;
pub(crate) mod backward;
pub(crate) mod choices;
pub(crate) mod crba;
pub(crate) mod forward;
pub(crate) mod gyrostats;
pub(crate) mod hessian;
pub(crate) mod inward;
pub(crate) mod joint_frames;
pub(crate) mod joint_motion;
pub(crate) mod link_parameters;
pub(crate) mod momentum;
pub(crate) mod payload;
pub(crate) mod regrouping;
pub(crate) mod results;
pub(crate) mod rnea_derivatives;
pub(crate) mod siblings;
pub(crate) mod wrench;

pub(crate) use algorithm::Algorithm;
pub(crate) use arguments::SymbolicTurn;
pub(crate) use choices::{JointPlan, Moment, OriginShift, Plan, RegroupingTarget, Scale, Side};
pub(crate) use crba::Composite;
pub(crate) use forward::{Arm, Gradient, Motion, Moved, ScaledTwist, Twist};
pub(crate) use gyrostats::{Carrier, Gyrostat};
pub(crate) use inward::{Body, FirstMoment, Inward, Outward, Symmetric, Turned};
pub(crate) use joint_frames::{FrameChoice, JointFrame, JointFrames, near_origins};
pub(crate) use joint_motion::JointMotion;
pub(crate) use link_parameters::{Entry, IDENTITY, PseudoInertia, Square, Triple};
pub(crate) use payload::Load;
pub(crate) use regrouping::{Offers, Parameters};
pub(crate) use wrench::Wrench;
