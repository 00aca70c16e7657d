//! Generated code is quiet where everything is forbidden.
#![no_std]
#![no_implicit_prelude]
#![forbid(unsafe_code, missing_docs, unused, nonstandard_style, rust_2018_idioms, let_underscore)]
#![deny(warnings, unreachable_pub, missing_debug_implementations, missing_copy_implementations, unused_qualifications)]
#![deny(clippy::all, clippy::pedantic, clippy::nursery)]
#![deny(clippy::indexing_slicing, clippy::panic, clippy::unwrap_used, clippy::expect_used, clippy::integer_division)]
#![deny(clippy::shadow_reuse, clippy::shadow_same, clippy::absolute_paths, clippy::min_ident_chars)]
#![deny(clippy::std_instead_of_core, clippy::alloc_instead_of_core, clippy::infinite_loop, clippy::exit)]

use ::core::{clone::Clone, cmp::PartialEq, fmt::Debug, marker::Copy, option::Option, result::Result};
use ::dynamics::{
    Actuation, BatchFloatingInverseDynamics, BatchForwardDynamics, BatchInverseDynamics,
    BatchInverseDynamicsDerivatives, BatchMassMatrix, CentreOfMass, CoriolisMatrix, Energy, FloatingBase,
    ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, JointWrenches, Kinematics, LengthMismatch, MassMatrix,
    MomentumObserver, MovingBase, Regressor, TipWrenches,
};

/// Seven joints, with limits.
#[derive(InverseDynamics, BatchInverseDynamics, Clone, Copy, Debug)]
#[robot(path = "../../../../../robots/panda.yaml", crate = ::dynamics)]
pub struct Panda;

/// Standard rows, with a tool of the user's own.
#[derive(InverseDynamics, BatchInverseDynamics, Clone, Copy, Debug, PartialEq, Eq)]
#[robot(path = "../../../../../robots/puma560.yaml", crate = "::dynamics")]
pub struct Puma560<T, const TOOLS: usize>
where
    T: Copy + PartialEq,
{
    /// The tools.
    #[robot(skip)]
    pub tools: [Option<T>; TOOLS],
}

/// Numbers that look like π and e, and everything that can be derived.
#[derive(
    InverseDynamics,
    BatchInverseDynamics,
    MassMatrix,
    BatchMassMatrix,
    CoriolisMatrix,
    ForwardDynamics,
    BatchForwardDynamics,
    Kinematics,
    Energy,
    CentreOfMass,
    Regressor,
    InverseDynamicsDerivatives,
    BatchInverseDynamicsDerivatives,
    FloatingBase,
    BatchFloatingInverseDynamics,
    JointWrenches,
    MomentumObserver,
    MovingBase,
    Actuation,
    Clone,
    Copy,
    Debug,
)]
#[robot(crate = ::dynamics, yaml = "
    format: 2
    name: slides
    source: own numbers
    convention: standard
    gravity: [0, 0, -9.81]
    floating_base: {name: trunk, link: {mass: 20, com: [0, 0, 0], inertia: {xx: 1, yy: 1, zz: 1}}}
    joints:
      - type: prismatic
        dh: {theta: 0.785398163, d: 3.14159, a: 1.414, alpha: 0.693}
        link: {mass: 3.14, com: [0.318, 0.707, 1.57]}
        limits: {position: [-3.14159, 2.718], velocity: 6.283, effort: 0.434}
        motor: {inertia: 2.0e-4, gear_ratio: -62.6, viscous: 1.5e-3, coulomb: [0.395, 0]}
      - type: revolute
        dh: {theta: 0.785398163, d: 3.14159, a: 1.414, alpha: 0}
        link: {mass: 3.14, com: [0.318, 0.707, 1.57], inertia: {}}
")]
pub struct Slides;

/// A tree with two tips and a body.
#[derive(InverseDynamics, MassMatrix, TipWrenches, Clone, Copy, Debug)]
#[robot(path = "../../../../../docs/dual_arm.yaml", crate = ::dynamics)]
pub struct DualArm;

/// A joint that follows another one.
#[derive(InverseDynamics, MassMatrix, ForwardDynamics, Clone, Copy, Debug)]
#[robot(path = "../../../../../docs/gripper.yaml", crate = ::dynamics, form = "reduced")]
pub struct Gripper;

/// Motors that turn with several joints.
#[derive(InverseDynamics, Clone, Copy, Debug)]
#[robot(path = "../../../../../robots/trees/wam7_coupled.yaml", crate = ::dynamics)]
pub struct Wam;

/// The reduced form of an arm that carries something.
#[derive(
    InverseDynamics,
    MassMatrix,
    CoriolisMatrix,
    ForwardDynamics,
    Kinematics,
    Energy,
    CentreOfMass,
    Regressor,
    InverseDynamicsDerivatives,
    JointWrenches,
    MomentumObserver,
    MovingBase,
    Clone,
    Copy,
    Debug,
)]
#[robot(path = "../../ui/robots/loaded.yaml", crate = ::dynamics, form = "reduced")]
pub struct Loaded {
    /// kg
    pub payload: f32,
    /// m
    pub length: f64,
}

#[derive(InverseDynamics, BatchInverseDynamics)]
#[robot(path = "../../../../../robots/planar1.yaml", crate = ::dynamics)]
struct Private;

/// Something to call it with.
#[must_use]
pub fn torques(angle: f32) -> ([f32; 1], [f64; Panda::DOF]) {
    (Private.gravity_torques(&[angle]), Panda.gravity_torques(&[0.0; Panda::DOF]))
}

/// A batch, without `std`.
///
/// # Errors
///
/// When the arrays differ in length.
pub fn batch(angles: &[f32], rates: &[f32], torques: &mut [f32]) -> Result<(), LengthMismatch> {
    Private.inverse_dynamics_batch([angles], [rates], [rates], [torques])
}
