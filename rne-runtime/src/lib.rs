//! The runtime side of `rne`: the scalar, the capability traits, and the generic recursion in nalgebra that every
//! generated function is compared with.
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(all(feature = "core_float_math", not(feature = "std")), feature(core_float_math))]
#![allow(clippy::doc_markdown)] // formulas: R_i, f_{i-1,i}

mod actuation;
mod arm;
mod base_motion;
#[cfg(feature = "std")]
mod base_parameters;
pub mod batch;
mod capability;
mod centre_of_mass;
mod coriolis_matrix;
mod derivatives;
mod dual;
#[cfg(feature = "std")]
mod dyn_arm;
mod energy;
#[cfg(feature = "std")]
mod error;
mod forward_dynamics;
mod joint;
mod joint_wrenches;
mod kinematics;
mod link_frame;
mod link_state;
#[cfg(feature = "std")]
mod load;
mod mass_matrix;
mod mechanism;
mod mount;
mod operations;
mod payload;
mod per_joint;
mod pose;
mod regressor;
mod scalar;
mod seven_steps;
mod sin_cos;
mod smooth_sign;
mod trace;
mod wrench;

pub use arm::Arm;
pub use base_motion::BaseMotion;
#[cfg(feature = "std")]
pub use base_parameters::{BaseParameter, BaseParameters, LinkParameter};
pub use batch::{BatchInverseDynamics, BatchScalar, LengthMismatch, VectorUnit};
pub use capability::{
    Actuation, CoriolisMatrix, Energy, ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, JointWrenches,
    Kinematics, MassMatrix, MovingBase, Regressor,
};
pub use centre_of_mass::CentreOfMass;
#[cfg(feature = "std")]
pub use derivatives::DynTorqueDerivatives;
pub use derivatives::TorqueDerivatives;
pub use dual::Dual;
#[cfg(feature = "std")]
pub use dyn_arm::{DynArm, DynTrace};
#[cfg(feature = "std")]
pub use error::{LoadError, WrongJointCount, WrongLength};
pub use operations::Operations;
pub use payload::Payload;
pub use pose::Pose;
pub use scalar::{Constant, RunTimeParameter, Scalar};
pub use trace::{LinkTrace, Trace};
pub use wrench::Wrench;
