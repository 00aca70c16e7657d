//! The runtime side of `rne`: the scalar, the capability traits, and the generic recursion in nalgebra that every
//! generated function is compared with.
#![warn(missing_debug_implementations)]
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(all(feature = "core_float_math", not(feature = "std")), feature(core_float_math))]
#![allow(clippy::doc_markdown)] // formulas: R_i, f_{i-1,i}

#[cfg(feature = "arm")]
mod actuation;
#[cfg(feature = "arm")]
mod arm;
#[cfg(feature = "arm")]
mod at_tip;
mod base_motion;
#[cfg(all(feature = "arm", feature = "std"))]
mod base_parameters;
mod base_state;
pub mod batch;
#[macro_use]
mod capability;
#[cfg(feature = "arm")]
mod centre_of_mass;
#[cfg(all(feature = "arm", feature = "std"))]
mod closed_loops;
mod computed_torque;
#[cfg(feature = "arm")]
mod contact_dynamics;
#[cfg(feature = "arm")]
mod coordinates;
#[cfg(all(feature = "arm", feature = "std"))]
mod couplings;
#[cfg(feature = "arm")]
mod definition;
#[cfg(feature = "arm")]
mod derivatives;
mod dual;
#[cfg(all(feature = "arm", feature = "std"))]
mod dyn_arm;
#[cfg(feature = "arm")]
mod energy;
#[cfg(all(feature = "arm", feature = "std"))]
mod error;
#[cfg(all(feature = "arm", feature = "std"))]
mod evaluate;
#[cfg(feature = "arm")]
mod floating_base;
#[cfg(feature = "arm")]
mod floating_change;
mod floating_derivatives;
#[cfg(feature = "arm")]
mod floating_euler_step;
mod floating_integrator;
#[cfg(feature = "arm")]
mod floating_kinematics;
mod floating_runge_kutta;
#[cfg(feature = "arm")]
mod forward_dynamics;
/// Steps and their derivatives of a robot with a floating base, with lists of joints: the Python package has robots
/// of any number of joints.
#[doc(hidden)]
pub mod floating_integrator_of_lists {
    pub use crate::floating_integrator::{Stage, runge_kutta};
    pub use crate::floating_runge_kutta::{Linear, Turning, derivatives};
    pub use crate::ldlt::factor;
    pub use crate::steps::moved;
}
mod jacobian_derivatives;
#[cfg(feature = "arm")]
mod joint;
mod joint_order;
#[cfg(feature = "arm")]
mod joint_wrenches;
#[cfg(feature = "arm")]
mod kinematics;
mod ldlt;
#[cfg(feature = "arm")]
mod link_frame;
#[cfg(feature = "arm")]
mod link_state;
#[cfg(all(feature = "arm", feature = "std"))]
mod load;
#[cfg(feature = "machine")]
#[doc(hidden)]
pub mod machine;
#[cfg(feature = "arm")]
mod mass_matrix;
#[cfg(feature = "arm")]
mod mechanism;
#[cfg(feature = "arm")]
mod momentum;
#[cfg(all(feature = "arm", feature = "std"))]
mod motors;
#[cfg(feature = "arm")]
mod mount;
mod names;
mod numbers;
mod observer;
mod operational_space;
mod operations;
mod optimisation;
mod payload;
#[cfg(feature = "arm")]
mod per_joint;
mod pose;
mod pose_log;
#[doc(hidden)]
pub mod processor;
mod quaternion;
mod records;
mod registers;
#[cfg(feature = "arm")]
mod regressor;
mod runge_kutta;
mod scalar;
#[cfg(feature = "arm")]
mod seven_steps;
mod shapes;
mod sin_cos;
mod smooth_sign;
#[cfg(feature = "arm")]
mod spin;
#[doc(hidden)]
pub mod steps;
#[doc(hidden)]
pub mod testing;
#[cfg(feature = "rayon")]
mod threads;
#[cfg(feature = "arm")]
mod trace;
mod wrench;

#[cfg(feature = "arm")]
pub use arm::{Arm, ArmWithTips};
pub use base_motion::BaseMotion;
#[cfg(all(feature = "arm", feature = "std"))]
pub use base_parameters::{BaseParameter, BaseParameters, LinkParameter};
pub use base_state::BaseTwist;
pub use batch::{
    BatchFloatingInverseDynamics, BatchForwardDynamics, BatchInverseDynamics, BatchInverseDynamicsDerivatives,
    BatchMassMatrix, BatchScalar, LengthMismatch, VectorUnit,
};
pub use capability::*;
pub use computed_torque::{ComputedTorque, Desired};
pub use dual::Dual;
#[cfg(all(feature = "arm", feature = "std"))]
pub use dyn_arm::{DynArm, DynTrace};
#[cfg(all(feature = "arm", feature = "std"))]
pub use error::{LoadError, WrongJointCount, WrongLength};
#[cfg(all(feature = "arm", feature = "std"))]
#[doc(hidden)]
pub use evaluate::Inputs;
pub use floating_integrator::{FloatingIntegratorStep, FloatingState};
pub use floating_runge_kutta::FloatingRungeKuttaStepDerivatives;
pub use joint_order::{JointOrderError, joint_order};
#[doc(hidden)]
pub use names::unknown_frame;
#[doc(hidden)]
pub use numbers::Numbers;
#[cfg(feature = "machine")]
#[doc(hidden)]
pub use numbers::Shaped;
#[cfg(all(feature = "arm", feature = "std"))]
pub use observer::DynObserverState;
pub use observer::ObserverState;
#[doc(hidden)]
pub use operational_space::operational_space;
pub use operational_space::{dynamically_consistent_inverse, operational_space_inertia};
pub use operations::Operations;
pub use payload::{NegativeMass, Payload};
pub use pose::Pose;
pub use quaternion::Quaternion;
pub use records::*;
pub use runge_kutta::{RungeKuttaStep, RungeKuttaStepDerivatives};
pub use scalar::{Constant, RunTimeParameter, Scalar};
#[cfg(feature = "arm")]
pub use trace::{LinkTrace, Trace};
pub use wrench::Wrench;
