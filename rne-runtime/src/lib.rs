//! The runtime side of `rne`: the scalar, the capability traits, and the generic recursion in nalgebra that every
//! generated function is compared with.
#![warn(missing_debug_implementations)]
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(all(feature = "core_float_math", not(feature = "std")), feature(core_float_math))]
#![allow(clippy::doc_markdown)] // formulas: R_i, f_{i-1,i}

mod control;
mod lanes;
mod number;
mod values;
pub use lanes::batch;
#[cfg(feature = "machine")]
#[doc(hidden)]
pub use lanes::machine;
#[doc(hidden)]
pub use lanes::processor;
#[cfg(feature = "arm")]
mod arm;
#[macro_use]
mod capability;
#[cfg(feature = "arm")]
mod definition;
#[cfg(all(feature = "arm", feature = "std"))]
mod dyn_arm;
/// Steps and derivatives for robots with a floating base, with lists of joints. The Python package needs them, because
/// its robots have any number of joints.
#[doc(hidden)]
pub mod floating_integrator_of_lists {
    pub use crate::integrators::floating_integrator::{Stage, runge_kutta};
    pub use crate::integrators::floating_runge_kutta::{Linear, Turning, derivatives};
    pub use crate::integrators::moved;
    pub use crate::number::ldlt::factor;
}
#[doc(hidden)]
pub mod integrators;
#[cfg(feature = "arm")]
mod seven_steps;
#[doc(hidden)]
pub mod testing;

#[cfg(feature = "arm")]
pub use arm::{Arm, ArmWithTips};
pub use capability::*;
pub use control::computed_torque::{ComputedTorque, Desired};
#[cfg(all(feature = "arm", feature = "std"))]
pub use control::observer::DynObserverState;
pub use control::observer::ObserverState;
#[doc(hidden)]
pub use control::operational_space::operational_space;
pub use control::operational_space::{dynamically_consistent_inverse, operational_space_inertia};
#[cfg(all(feature = "arm", feature = "std"))]
pub use definition::base_parameters::{BaseParameter, BaseParameters, LinkParameter};
#[cfg(all(feature = "arm", feature = "std"))]
#[doc(hidden)]
pub use dyn_arm::Inputs;
#[cfg(all(feature = "arm", feature = "std"))]
pub use dyn_arm::{DynArm, DynTrace, LoadError, WrongJointCount, WrongLength};
pub use integrators::floating_integrator::{FloatingIntegratorStep, FloatingState};
pub use integrators::floating_runge_kutta::FloatingRungeKuttaStepDerivatives;
pub use integrators::runge_kutta::{RungeKuttaStep, RungeKuttaStepDerivatives};
pub use lanes::batch::{
    BatchFloatingInverseDynamics, BatchForwardDynamics, BatchInverseDynamics, BatchInverseDynamicsDerivatives,
    BatchMassMatrix, BatchScalar, LengthMismatch, VectorUnit,
};
pub use number::dual::Dual;
pub use number::scalar::{Constant, RunTimeParameter, Scalar};
#[cfg(feature = "arm")]
pub use seven_steps::trace::{LinkTrace, Trace};
pub use values::base_motion::BaseMotion;
pub use values::base_state::BaseTwist;
pub use values::joint_order::{JointOrderError, joint_order};
#[doc(hidden)]
pub use values::names::unknown_frame;
#[doc(hidden)]
pub use values::numbers::Numbers;
#[cfg(feature = "machine")]
#[doc(hidden)]
pub use values::numbers::Shaped;
pub use values::operations::Operations;
pub use values::payload::{NegativeMass, Payload};
pub use values::pose::Pose;
pub use values::quaternion::Quaternion;
pub use values::records::*;
pub use values::wrench::Wrench;
