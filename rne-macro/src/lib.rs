//! The derive macros of `rne`; use them through that crate.
//!
//! A shell: the attribute, the file and the messages are handled here, everything else is `rne-codegen`. The examples
//! in the documentation use `rne`, which runs them.
#![forbid(unsafe_code)]

mod attribute;
mod batch;
mod description;
mod error;
mod expand;
mod frames;
mod implementation;
mod inspection;
mod joints;
mod location;
mod motors;
mod own_tests;
mod parameters;
#[cfg(test)]
mod tests;
mod tips;
mod warning;

use proc_macro::TokenStream;
use rne_codegen::{Capability, Function};

#[cfg_attr(not(doctest), doc = include_str!("inverse_dynamics.md"))] // `rne` runs the examples
#[proc_macro_derive(InverseDynamics, attributes(robot))]
pub fn derive_inverse_dynamics(input: TokenStream) -> TokenStream {
    expand::capability(Capability::InverseDynamics, input.into()).into()
}

#[cfg_attr(not(doctest), doc = include_str!("batch_inverse_dynamics.md"))]
#[proc_macro_derive(BatchInverseDynamics, attributes(robot))]
pub fn derive_batch_inverse_dynamics(input: TokenStream) -> TokenStream {
    batch::batch(Function::InverseDynamics, input.into()).into()
}

/// Implements the trait `BatchMassMatrix` for a struct that derives `MassMatrix` too: M(q) of many states at once.
///
/// As [`BatchInverseDynamics`](macro@BatchInverseDynamics), with an array for each element of the matrix; elements with
/// an empty array are not written.
#[proc_macro_derive(BatchMassMatrix, attributes(robot))]
pub fn derive_batch_mass_matrix(input: TokenStream) -> TokenStream {
    batch::batch(Function::MassMatrix, input.into()).into()
}

/// Implements the trait `BatchForwardDynamics` for a struct that derives `ForwardDynamics` too: accelerations of many
/// states at once.
///
/// As [`BatchInverseDynamics`](macro@BatchInverseDynamics).
#[proc_macro_derive(BatchForwardDynamics, attributes(robot))]
pub fn derive_batch_forward_dynamics(input: TokenStream) -> TokenStream {
    batch::batch(Function::ForwardDynamics, input.into()).into()
}

/// Implements the trait `BatchInverseDynamicsDerivatives` for a struct that derives `InverseDynamicsDerivatives` too:
/// ∂τ/∂q and ∂τ/∂q̇ of many states at once.
///
/// As [`BatchMassMatrix`](macro@BatchMassMatrix).
#[proc_macro_derive(BatchInverseDynamicsDerivatives, attributes(robot))]
pub fn derive_batch_inverse_dynamics_derivatives(input: TokenStream) -> TokenStream {
    batch::batch(Function::InverseDynamicsDerivatives, input.into()).into()
}

/// Implements the trait `BatchFloatingInverseDynamics` for a struct that derives `FloatingBase` too: torques, and the
/// wrench on the base, of many states of a robot whose base nothing holds.
///
/// As [`BatchInverseDynamics`](macro@BatchInverseDynamics).
#[proc_macro_derive(BatchFloatingInverseDynamics, attributes(robot))]
pub fn derive_batch_floating_inverse_dynamics(input: TokenStream) -> TokenStream {
    batch::batch(Function::InverseDynamicsOfFloatingBase, input.into()).into()
}

/// Implements the trait `MassMatrix` for a struct: the mass matrix M(q).
///
/// Symmetric by construction: each element off the diagonal is computed once.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `MASS_MATRIX_OPERATIONS` and so on; `DOF`, names and limits come
/// with `InverseDynamics`.
#[proc_macro_derive(MassMatrix, attributes(robot))]
pub fn derive_mass_matrix(input: TokenStream) -> TokenStream {
    expand::capability(Capability::MassMatrix, input.into()).into()
}

/// Implements the trait `CoriolisMatrix` for a struct: the Coriolis matrix C(q, q̇) of Christoffel.
///
/// Ṁ - 2C is skew.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `CORIOLIS_MATRIX_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(CoriolisMatrix, attributes(robot))]
pub fn derive_coriolis_matrix(input: TokenStream) -> TokenStream {
    expand::capability(Capability::CoriolisMatrix, input.into()).into()
}

/// Implements the trait `ForwardDynamics` for a struct: accelerations from torques.
///
/// A singular mass matrix gives numbers that are not finite, never a panic.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `FORWARD_DYNAMICS_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(ForwardDynamics, attributes(robot))]
pub fn derive_forward_dynamics(input: TokenStream) -> TokenStream {
    expand::capability(Capability::ForwardDynamics, input.into()).into()
}

/// Implements the trait `Kinematics` for a struct: tip pose, link poses, Jacobian, J̇ q̇ and torques of a wrench.
///
/// `base` and `tool` of the robot file included.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `FORWARD_KINEMATICS_OPERATIONS` and so on; `DOF`, names and
/// limits come with `InverseDynamics`.
#[proc_macro_derive(Kinematics, attributes(robot))]
pub fn derive_kinematics(input: TokenStream) -> TokenStream {
    expand::capability(Capability::Kinematics, input.into()).into()
}

/// Implements the traits `AtFrame` and `FrameKinematics` for a struct: pose, Jacobian, its rate and derivatives, J̇ q̇
/// and torques of a wrench of every frame in the list `frames` of the robot file, and of every link frame.
///
/// The type gets the function `frame`, which turns a name into the constant that the methods take, and the constant
/// `FRAME_NAMES`. A name is that of a frame, or that of a joint for its link frame:
///
/// ```ignore
/// let jacobian = MyArm.jacobian_of::<{ MyArm::frame("camera") }, _>(&q);
/// ```
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops`, `tests` and `inspect` concern other
/// derives.
#[proc_macro_derive(FrameKinematics, attributes(robot))]
pub fn derive_frame_kinematics(input: TokenStream) -> TokenStream {
    expand::frame_kinematics(input.into()).into()
}

/// Implements the trait `Energy` for a struct: kinetic and potential energy.
///
/// Links alone, without rotors.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `KINETIC_ENERGY_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(Energy, attributes(robot))]
pub fn derive_energy(input: TokenStream) -> TokenStream {
    expand::capability(Capability::Energy, input.into()).into()
}

/// Implements the trait `CentreOfMass` for a struct: the centre of mass of the whole arm, and its Jacobian.
///
/// In the world, `base` of the robot file included. Links alone, without rotors.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `CENTRE_OF_MASS_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(CentreOfMass, attributes(robot))]
pub fn derive_centre_of_mass(input: TokenStream) -> TokenStream {
    expand::capability(Capability::CentreOfMass, input.into()).into()
}

/// Implements the trait `Regressor` for a struct: torques per inertial parameter, τ = Y π.
///
/// Ten parameters per link; the masses of the file have no part in it.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `REGRESSOR_OPERATIONS` and so on; `DOF`, names and limits come
/// with `InverseDynamics`.
#[proc_macro_derive(Regressor, attributes(robot))]
pub fn derive_regressor(input: TokenStream) -> TokenStream {
    expand::capability(Capability::Regressor, input.into()).into()
}

/// Implements the trait `InverseDynamicsDerivatives` for a struct: ∂τ/∂q and ∂τ/∂q̇.
///
/// In the seven steps by the product rule on the graph of the torques, which they share; in the reduced form that or
/// composite bodies, whatever takes fewer operations.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `INVERSE_DYNAMICS_DERIVATIVES_OPERATIONS` and so on; `DOF`,
/// names and limits come with `InverseDynamics`.
#[proc_macro_derive(InverseDynamicsDerivatives, attributes(robot))]
pub fn derive_inverse_dynamics_derivatives(input: TokenStream) -> TokenStream {
    expand::capability(Capability::InverseDynamicsDerivatives, input.into()).into()
}

/// Implements the trait `JointWrenches` for a struct: the force and moment that each link exerts on the next.
///
/// Bearing loads; always in the seven steps, whose forces have a meaning.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `JOINT_WRENCHES_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(JointWrenches, attributes(robot))]
pub fn derive_joint_wrenches(input: TokenStream) -> TokenStream {
    expand::capability(Capability::JointWrenches, input.into()).into()
}

/// Implements the trait `MomentumObserver` for a struct: the momentum of the joints and its rate, from which
/// `ObserverState` makes external torques without accelerations.
///
/// In the reduced form by the recursion of the torques, with velocities in the place of accelerations.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `MOMENTUM_AND_RATE_OPERATIONS`; `DOF`, names and limits come
/// with `InverseDynamics`.
#[proc_macro_derive(MomentumObserver, attributes(robot))]
pub fn derive_momentum_observer(input: TokenStream) -> TokenStream {
    expand::capability(Capability::MomentumObserver, input.into()).into()
}

/// Implements the trait `MovingBase` for a struct: torques on a base that moves.
///
/// Its motion (ω₀, ω̇₀, c̈₀) and gravity are arguments.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `INVERSE_DYNAMICS_ON_MOVING_BASE_OPERATIONS` and so on; `DOF`,
/// names and limits come with `InverseDynamics`.
#[proc_macro_derive(MovingBase, attributes(robot))]
pub fn derive_moving_base(input: TokenStream) -> TokenStream {
    expand::capability(Capability::MovingBase, input.into()).into()
}

/// Implements the trait `PayloadDynamics` for a struct: gravity, bias, mass matrix, accelerations, momenta, and
/// derivatives of torques and accelerations, of the arm with a payload at its tip.
///
/// The payload (mass, centre of mass, inertia) is an argument.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `GRAVITY_TORQUES_WITH_PAYLOAD_OPERATIONS` and so on; `DOF`,
/// names
/// and limits come with `InverseDynamics`.
#[proc_macro_derive(PayloadDynamics, attributes(robot))]
pub fn derive_payload_dynamics(input: TokenStream) -> TokenStream {
    expand::capability(Capability::PayloadDynamics, input.into()).into()
}

/// Implements the trait `TipWrenches` for a struct: torques and accelerations of a robot with a wrench at each tip.
///
/// The tips are the frames of the list `tips` of the robot file; without the list, the tip frame is the only tip. The
/// struct gets the names of the tips, `TIPS`, and an enum of the tips: for `struct Torso;` it is `TorsoTip`.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `INVERSE_DYNAMICS_WITH_WRENCHES_OPERATIONS` and so on; `DOF`,
/// names and limits come with `InverseDynamics`.
#[proc_macro_derive(TipWrenches, attributes(robot))]
pub fn derive_tip_wrenches(input: TokenStream) -> TokenStream {
    expand::capability(Capability::TipWrenches, input.into()).into()
}

/// Implements the trait `FloatingBase` for a struct: the torques of a robot whose base nothing holds, and the wrench
/// that must act on the base.
///
/// The base is the link `floating_base` of the robot file; a file without that key is an error, unless the attribute
/// has `allow_lints`: then the base has no mass. The tips are those of [`TipWrenches`](macro@TipWrenches), whose derive
/// also makes the enum of the tips.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `INVERSE_DYNAMICS_OF_FLOATING_BASE_OPERATIONS`; `DOF`, names and limits come
/// with `InverseDynamics`.
#[proc_macro_derive(FloatingBase, attributes(robot))]
pub fn derive_floating_base(input: TokenStream) -> TokenStream {
    expand::capability(Capability::FloatingBase, input.into()).into()
}

/// Implements the trait `CentroidalMomentum` for a struct: the momentum of a robot whose base nothing holds, about its
/// centre of mass, and its rate.
///
/// The base is the link `floating_base` of the robot file; a file without that key is an error, unless the attribute
/// has `allow_lints`: then the base has no mass.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets constants with the operations, `CENTROIDAL_MOMENTUM_MATRIX_OPERATIONS`, `CENTROIDAL_BIAS_OPERATIONS` and
/// `CENTROIDAL_MOMENTUM_OPERATIONS`; `DOF`, names and limits come with `InverseDynamics`.
#[proc_macro_derive(CentroidalMomentum, attributes(robot))]
pub fn derive_centroidal_momentum(input: TokenStream) -> TokenStream {
    expand::capability(Capability::CentroidalMomentum, input.into()).into()
}

/// Implements the trait `FloatingEnergy` for a struct: kinetic and potential energy where nothing holds the base.
///
/// The base is the link `floating_base` of the robot file; a file without that key is an error, unless the attribute
/// has `allow_lints`: then the base has no mass.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets constants with the operations, `FLOATING_KINETIC_ENERGY_OPERATIONS` and `FLOATING_POTENTIAL_ENERGY_OPERATIONS`;
/// `DOF`, names and limits come with `InverseDynamics`.
#[proc_macro_derive(FloatingEnergy, attributes(robot))]
pub fn derive_floating_energy(input: TokenStream) -> TokenStream {
    expand::capability(Capability::FloatingEnergy, input.into()).into()
}

/// Implements the trait `FloatingPayloadDynamics` for a struct: torques, mass matrix, bias and accelerations of a robot
/// with a floating base and a payload that is known when the program runs.
///
/// The base is the link `floating_base` of the robot file; a file without that key is an error, unless the attribute
/// has `allow_lints`: then the base has no mass.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each function, such as
/// `FLOATING_MASS_MATRIX_WITH_PAYLOAD_OPERATIONS`; `DOF`, names and limits come with `InverseDynamics`.
#[proc_macro_derive(FloatingPayloadDynamics, attributes(robot))]
pub fn derive_floating_payload_dynamics(input: TokenStream) -> TokenStream {
    expand::capability(Capability::FloatingPayloadDynamics, input.into()).into()
}

/// Implements the trait `FloatingRegressor` for a struct: the wrench on a base that nothing holds and the torques per
/// inertial parameter of the base and of each link.
///
/// The base is frame 0, whether or not the robot file has a `floating_base`: no inertial parameter enters.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `FLOATING_REGRESSOR_OPERATIONS`; `DOF`, names and limits come with
/// `InverseDynamics`.
#[proc_macro_derive(FloatingRegressor, attributes(robot))]
pub fn derive_floating_regressor(input: TokenStream) -> TokenStream {
    expand::capability(Capability::FloatingRegressor, input.into()).into()
}

/// Implements the trait `FloatingKinematics` for a struct: Jacobians and accelerations of the tips of a robot whose
/// base nothing holds.
///
/// The tips are those of [`TipWrenches`](macro@TipWrenches), whose derive also makes the enum of the tips.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets constants with the operations, `TIP_JACOBIANS_OPERATIONS` and `TIP_ACCELERATIONS_OPERATIONS`; `DOF`, names and
/// limits come with `InverseDynamics`.
#[proc_macro_derive(FloatingKinematics, attributes(robot))]
pub fn derive_floating_kinematics(input: TokenStream) -> TokenStream {
    expand::capability(Capability::FloatingKinematics, input.into()).into()
}

/// Implements the trait `ContactDynamics` for a struct: the motion of a robot whose base nothing holds while contacts
/// hold some of its tips.
///
/// The contacts are those of the list `contacts` of the robot file. The tips are those of
/// [`TipWrenches`](macro@TipWrenches), whose derive also makes the enum of the tips.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `FORWARD_DYNAMICS_IN_CONTACT_OPERATIONS`; `DOF`, names and limits come with
/// `InverseDynamics`.
#[proc_macro_derive(ContactDynamics, attributes(robot))]
pub fn derive_contact_dynamics(input: TokenStream) -> TokenStream {
    expand::capability(Capability::ContactDynamics, input.into()).into()
}

/// Implements the trait `InverseDynamicsGradient` for a struct: the derivatives of a weighted sum of the torques.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `TORQUE_GRADIENT_OPERATIONS`; `DOF`, names and limits come with
/// `InverseDynamics`.
#[proc_macro_derive(InverseDynamicsGradient, attributes(robot))]
pub fn derive_inverse_dynamics_gradient(input: TokenStream) -> TokenStream {
    expand::capability(Capability::InverseDynamicsGradient, input.into()).into()
}

/// Implements the trait `ForwardDynamicsDerivatives` for a struct: the derivatives of the accelerations by positions,
/// velocities and torques.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `FORWARD_DYNAMICS_DERIVATIVES_OPERATIONS`; `DOF`, names and limits come with
/// `InverseDynamics`.
#[proc_macro_derive(ForwardDynamicsDerivatives, attributes(robot))]
pub fn derive_forward_dynamics_derivatives(input: TokenStream) -> TokenStream {
    expand::capability(Capability::ForwardDynamicsDerivatives, input.into()).into()
}

/// Implements the trait `JacobianDerivatives` for a struct: the rate of the Jacobian, and its derivatives by the
/// positions.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets constants with the operations, `JACOBIAN_RATE_OPERATIONS` and `JACOBIAN_DERIVATIVES_OPERATIONS`; `DOF`, names
/// and limits come with `InverseDynamics`.
#[proc_macro_derive(JacobianDerivatives, attributes(robot))]
pub fn derive_jacobian_derivatives(input: TokenStream) -> TokenStream {
    expand::capability(Capability::JacobianDerivatives, input.into()).into()
}

/// Implements the trait `InverseDynamicsHessian` for a struct: the second derivatives of a weighted sum of the torques.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `TORQUE_HESSIAN_OPERATIONS`; `DOF`, names and limits come with
/// `InverseDynamics`.
#[proc_macro_derive(InverseDynamicsHessian, attributes(robot))]
pub fn derive_inverse_dynamics_hessian(input: TokenStream) -> TokenStream {
    expand::capability(Capability::InverseDynamicsHessian, input.into()).into()
}

/// Implements the trait `EulerStep` for a struct: a step of the semi-implicit Euler method, in the operations of the
/// accelerations and four more for each joint.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `EULER_STEP_OPERATIONS`; `DOF`, names and limits come with `InverseDynamics`.
#[proc_macro_derive(EulerStep, attributes(robot))]
pub fn derive_euler_step(input: TokenStream) -> TokenStream {
    expand::capability(Capability::EulerStep, input.into()).into()
}

/// Implements the trait `EulerStepDerivatives` for a struct: the derivatives of a step of the semi-implicit Euler
/// method by positions, velocities and torques.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `EULER_STEP_DERIVATIVES_OPERATIONS`; `DOF`, names and limits come with
/// `InverseDynamics`.
#[proc_macro_derive(EulerStepDerivatives, attributes(robot))]
pub fn derive_euler_step_derivatives(input: TokenStream) -> TokenStream {
    expand::capability(Capability::EulerStepDerivatives, input.into()).into()
}

/// Implements the trait `FloatingEulerStep` for a struct: a step of the semi-implicit Euler method where nothing holds
/// the base.
///
/// The base is the link `floating_base` of the robot file; a file without that key is an error, unless the attribute
/// has `allow_lints`: then the base has no mass. The tips are those of `FloatingBase`.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `FLOATING_EULER_STEP_OPERATIONS`; `DOF`, names and limits come with
/// `InverseDynamics`.
#[proc_macro_derive(FloatingEulerStep, attributes(robot))]
pub fn derive_floating_euler_step(input: TokenStream) -> TokenStream {
    expand::capability(Capability::FloatingEulerStep, input.into()).into()
}

/// Implements the trait `FloatingEulerStepDerivatives` for a struct: the derivatives of a step of the semi-implicit
/// Euler method where nothing holds the base.
///
/// The base and the tips are those of `FloatingEulerStep`.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `FLOATING_EULER_STEP_DERIVATIVES_OPERATIONS`; `DOF`, names and limits come with
/// `InverseDynamics`.
#[proc_macro_derive(FloatingEulerStepDerivatives, attributes(robot))]
pub fn derive_floating_euler_step_derivatives(input: TokenStream) -> TokenStream {
    expand::capability(Capability::FloatingEulerStepDerivatives, input.into()).into()
}

/// Implements the trait `ClosedLoops` for a struct: a robot whose file has `loops` with a cut joint.
///
/// The tips are the frames of the list `tips` of the robot file in its order, or the tip frame alone. Other derives
/// refuse such a robot; so the constants `DOF`, `NAME`, `JOINT_NAMES` and the limits come with this one, beside
/// `PASSIVE`, `EQUATIONS` and `PASSIVE_NAMES`.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics). The type gets a constant with the operations of
/// each method, `LOOP_MAP_OPERATIONS` and so on.
#[proc_macro_derive(ClosedLoops, attributes(robot))]
pub fn derive_closed_loops(input: TokenStream) -> TokenStream {
    expand::capability(Capability::ClosedLoops, input.into()).into()
}

/// Implements the trait `FloatingClosedLoops` for a struct: a robot with closed loops whose base nothing holds.
///
/// It belongs beside [`ClosedLoops`](macro@ClosedLoops), whose functions close the loops, and with which `DOF`,
/// `PASSIVE`, names and limits come. The tips are the same.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics). The type gets a constant with the operations of
/// each method, `FLOATING_MASS_MATRIX_OF_LOOPS_OPERATIONS` and so on.
#[proc_macro_derive(FloatingClosedLoops, attributes(robot))]
pub fn derive_floating_closed_loops(input: TokenStream) -> TokenStream {
    expand::capability(Capability::FloatingClosedLoops, input.into()).into()
}

/// Implements the trait `FloatingInverseDynamicsDerivatives` for a struct: the derivatives of the wrench on a base that
/// nothing holds and of the torques.
///
/// The tips are those of [`TipWrenches`](macro@TipWrenches), whose derive also makes the enum of the tips.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations, `FLOATING_INVERSE_DYNAMICS_DERIVATIVES_OPERATIONS`; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(FloatingInverseDynamicsDerivatives, attributes(robot))]
pub fn derive_floating_inverse_dynamics_derivatives(input: TokenStream) -> TokenStream {
    expand::capability(Capability::FloatingInverseDynamicsDerivatives, input.into()).into()
}

/// Implements the trait `Actuation` for a struct: what rotors behind gears and friction add to the torques.
///
/// The robot file needs a `motor` at one joint at least.
///
/// The attribute is that of [`InverseDynamics`](macro@InverseDynamics); `max_ops` concerns that derive alone. The type
/// gets a constant with the operations of each method, `ACTUATOR_TORQUES_OPERATIONS` and so on; `DOF`, names and limits
/// come with `InverseDynamics`.
#[proc_macro_derive(Actuation, attributes(robot))]
pub fn derive_actuation(input: TokenStream) -> TokenStream {
    expand::capability(Capability::Actuation, input.into()).into()
}
