//! Derivatives of torques, accelerations and the Jacobian.

#[cfg(feature = "arm")]
use crate::seven_steps::at_tip::AtTip;

capability! {
/// The derivatives of the torques with respect to the state.
#[diagnostic::on_unimplemented(
    note = "`InverseDynamicsDerivatives` belongs into the same `derive`: `#[derive(InverseDynamicsDerivatives)]`, and \
            with batches `#[derive(InverseDynamicsDerivatives, BatchInverseDynamicsDerivatives)]`"
)]
pub trait InverseDynamicsDerivatives<DOF> {
    /// ∂τ/∂q and ∂τ/∂q̇ of [`inverse_dynamics`](crate::InverseDynamics::inverse_dynamics) at a state, row = torque,
    /// column = joint. ∂τ/∂q̈ is the [mass matrix](crate::MassMatrix::mass_matrix).
    #[doc(alias = "computeRNEADerivatives")]
    #[doc(alias = "IDSVA")]
    fn inverse_dynamics_derivatives(q: joints, qd: joints, qdd: joints) -> TorqueDerivatives<DOF> =
        |robot| robot.torque_derivatives([q, qd, qdd], AtTip::Nothing);
}
}

capability! {
/// The gradient of a weighted sum of the torques with respect to the motion, as the gradient of a Lagrangian contains
/// it: the product of the weights and the Jacobian of the inverse dynamics.
pub trait InverseDynamicsGradient<DOF> {
    /// The derivatives of λᵀτ with respect to q, q̇ and q̈, with τ of
    /// [`inverse_dynamics`](crate::InverseDynamics::inverse_dynamics) and the `multipliers` λ.
    ///
    /// They are λᵀ times the matrices of
    /// [`inverse_dynamics_derivatives`](crate::InverseDynamicsDerivatives::inverse_dynamics_derivatives), and M(q) λ.
    /// Derived code computes them in reverse mode, with a few times the operations of the torques.
    fn torque_gradient(q: joints, qd: joints, qdd: joints, multipliers: joints) -> TorqueGradient<DOF> =
        |robot| robot.gradient([q, qd, qdd], multipliers);
}
}

capability! {
/// The Hessian of a weighted sum of the torques with respect to the motion, as the Hessian of a Lagrangian with the
/// equations of motion contains it.
pub trait InverseDynamicsHessian<DOF> {
    /// The second derivatives of λᵀτ with respect to q, q̇ and q̈, with τ of
    /// [`inverse_dynamics`](crate::InverseDynamics::inverse_dynamics) and the `multipliers` λ.
    ///
    /// They are the derivatives of [`torque_gradient`](crate::InverseDynamicsGradient::torque_gradient). Derived code
    /// in the reduced form computes them by composite bodies. If some joints follow others, rows and columns belong to
    /// the joints that follow no other.
    #[doc(alias = "ComputeRNEASecondOrderDerivatives")]
    fn torque_hessian(q: joints, qd: joints, qdd: joints, multipliers: joints) -> TorqueHessian<DOF> =
        |robot| robot.hessian([q, qd, qdd], multipliers);
}
}

capability! {
/// The derivatives of the accelerations with respect to the state and the torques: the linear model that shooting
/// methods and linear quadratic regulators use.
pub trait ForwardDynamicsDerivatives<DOF> {
    /// The derivatives of [`forward_dynamics`](crate::ForwardDynamics::forward_dynamics) with respect to q, q̇ and τ,
    /// at a state.
    ///
    /// With the accelerations q̈ of this state, ∂q̈/∂q = -M⁻¹ ∂τ/∂q, ∂q̈/∂q̇ = -M⁻¹ ∂τ/∂q̇ and ∂q̈/∂τ = M⁻¹. A singular
    /// mass matrix (a joint that moves nothing) gives numbers that are not finite.
    ///
    /// Source: J. Carpentier, N. Mansard, "Analytical derivatives of rigid body dynamics algorithms", 2018.
    #[doc(alias = "computeABADerivatives")]
    fn forward_dynamics_derivatives(q: joints, qd: joints, tau: joints) -> AccelerationDerivatives<DOF> =
        |robot| robot.acceleration_derivatives([q, qd, tau], AtTip::Nothing, AtTip::Nothing);
}
}

capability! {
/// The derivatives of the geometric Jacobian J of the tip, for tasks in accelerations of the tip and for their
/// derivatives. Rows and axes are those of [`jacobian`](crate::Kinematics::jacobian): three linear ones, then three
/// angular ones, in world axes.
pub trait JacobianDerivatives<DOF> {
    /// J̇ at velocities `qd` (rad/s, prismatic: m/s): linear rows in m/s² per rad/s or m/s, angular ones in rad/s² per
    /// rad/s or m/s. J̇ q̇ alone is [`jacobian_rate_times_velocity`](crate::Kinematics::jacobian_rate_times_velocity),
    /// in fewer operations.
    #[doc(alias = "computeJointJacobiansTimeVariation")]
    fn jacobian_rate(q: joints, qd: joints) -> SpatialRows = |robot| robot.jacobian_rate(q, qd);

    /// ∂J/∂q: element (r, i, j) is the derivative of element (r, i) of J with respect to the position of joint j, per
    /// rad or m.
    ///
    /// The first three matrices, the second derivatives of the position of the tip, are symmetric. J̇ is the sum over j
    /// of element (r, i, j) times q̇_j.
    fn jacobian_derivatives(q: joints) -> SpatialMatrices = |robot| robot.jacobian_derivatives(q);
}
}
