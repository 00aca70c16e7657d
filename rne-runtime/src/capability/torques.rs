//! Torques of a motion, wrenches in the joints, and torques of motors.

use crate::control::optimisation::{rows_by, still};
use crate::number::ldlt::inverse_of;
use crate::number::smooth_sign::SmoothSign;
use crate::{AccelerationDerivatives, Dual, TorqueDerivatives, Wrench};
#[cfg(feature = "arm")]
use crate::{
    definition::coordinates::Coordinates as _, definition::still_wrenches::AllStill as _, seven_steps::at_tip::AtTip,
};

capability! {
/// Torques from motion: recursive Newton-Euler inverse dynamics, τ(q, q̇, q̈).
///
/// τ is what the actuators must deliver: τ = M(q) q̈ + C(q, q̇) q̇ + g(q). No friction, and no rotor inertia
/// unless the arm is taken with its rotors: `#[robot(rotors)]`, `with_rotors`.
#[diagnostic::on_unimplemented(
    note = "`InverseDynamics` belongs into the same `derive`, for a number of joints that the robot file decides: \
            `#[derive(InverseDynamics)]`, and with batches `#[derive(InverseDynamics, BatchInverseDynamics)]`"
)]
pub trait InverseDynamics<DOF> {
    /// Torques for positions `q`, velocities `qd` and accelerations `qdd` with a free tip.
    #[doc(alias = "torques")]
    #[doc(alias = "rnea")]
    #[doc(alias = "computeTorque")]
    #[doc(alias = "rne")]
    fn inverse_dynamics(q: joints, qd: joints, qdd: joints) -> Vector =
        |robot| robot.torques([q, qd, qdd], AtTip::Nothing);

    /// Torques when the last link exerts `wrench` on its environment: τ = τ_free + Jᵀ w.
    fn inverse_dynamics_with_wrench(q: joints, qd: joints, qdd: joints, wrench: wrench) -> Vector =
        |robot| robot.torques([q, qd, qdd], AtTip::Wrench(wrench));

    /// Torques when `payload` is fixed to the tip: a mass (kg), its centre (m) and the inertia about it (kg m²), all in
    /// tip-frame axes, known when the program runs. They are those of the arm whose last link has the payload too.
    fn inverse_dynamics_with_payload(q: joints, qd: joints, qdd: joints, payload: payload) -> Vector =
        |robot| robot.torques([q, qd, qdd], AtTip::Payload(payload));

    /// Torques for a caller who has the sines and cosines of the joint positions already, from a CORDIC or a kinematics
    /// pass: `sin[i]` and `cos[i]` are those of `q[i]` of a revolute joint, without the constant part of its angle.
    /// Sines and cosines of prismatic joints and `q[i]` of revolute joints are not used.
    fn inverse_dynamics_from_sin_cos(sin: joints, cos: joints, q: joints, qd: joints, qdd: joints) -> Vector =
        |robot| robot.torques_from_turns([sin, cos], [q, qd, qdd]);

    /// Torques that hold the arm still against gravity, τ(q, 0, 0).
    #[doc(alias = "gravity compensation")]
    #[doc(alias = "computeGeneralizedGravity")]
    #[doc(alias = "gravload")]
    fn gravity_torques(q: joints) -> Vector = |robot| robot.gravity(q, AtTip::Nothing);

    /// Coriolis, centrifugal and gravity torques, τ(q, q̇, 0).
    #[doc(alias = "bias")]
    #[doc(alias = "nle")]
    #[doc(alias = "nonLinearEffects")]
    #[doc(alias = "qfrc_bias")]
    fn bias_torques(q: joints, qd: joints) -> Vector = |robot| robot.bias(q, qd, AtTip::Nothing);
}
}

capability! {
/// Torques on a vehicle, a ship or another robot.
pub trait MovingBase<DOF> {
    /// Torques with a free tip when frame 0 moves as `base` says, which replaces the robot's own gravity as well.
    fn inverse_dynamics_on_moving_base(q: joints, qd: joints, qdd: joints, base: motion) -> Vector =
        |robot| robot.torques_on([q, qd, qdd], base, AtTip::Nothing);
}
}

capability! {
/// The robot with a wrench at each of its tips: the frames of the list `tips` of the robot file, in its order. Without
/// that list the tip frame is the only tip.
///
/// A wrench is what the robot exerts on its environment at the tip, in axes of the tip, as in
/// [`inverse_dynamics_with_wrench`](crate::InverseDynamics::inverse_dynamics_with_wrench).
pub trait TipWrenches<DOF, TIPS> {
    /// Torques, N m or N: τ = τ_free + Σ Jₖᵀ wₖ, with the Jacobian Jₖ of tip k.
    fn inverse_dynamics_with_wrenches(q: joints, qd: joints, qdd: joints, wrenches: wrenches) -> Vector =
        |robot| robot.torques([q, qd, qdd], AtTip::Wrenches(wrenches));

    /// Accelerations, rad/s² or m/s². See [`forward_dynamics`](crate::ForwardDynamics::forward_dynamics).
    fn forward_dynamics_with_wrenches(q: joints, qd: joints, tau: joints, wrenches: wrenches) -> Vector =
        |robot| robot.forward_dynamics([q, qd, tau], AtTip::Wrenches(wrenches));

    /// ∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics_with_wrenches`, where the wrenches do not change in axes of their tips.
    /// See [`inverse_dynamics_derivatives`](crate::InverseDynamicsDerivatives::inverse_dynamics_derivatives).
    fn inverse_dynamics_derivatives_with_wrenches(q: joints, qd: joints, qdd: joints, wrenches: wrenches)
        -> TorqueDerivatives<DOF> or |this| {
        let (still_q, still_qd, qdd, wrenches) = (still(q), still(qd), still(qdd), wrenches.map(Wrench::still));
        TorqueDerivatives {
            dq: rows_by(q, |q| this.inverse_dynamics_with_wrenches(q, &still_qd, &qdd, &wrenches)),
            dqd: rows_by(qd, |qd| this.inverse_dynamics_with_wrenches(&still_q, qd, &qdd, &wrenches)),
        }
    } = |robot| robot.torque_derivatives([q, qd, qdd], AtTip::Wrenches(wrenches.all_still().as_ref()));

    /// The derivatives of `forward_dynamics_with_wrenches` with respect to q, q̇ and τ, where the wrenches do not
    /// change in axes of their tips. See
    /// [`forward_dynamics_derivatives`](crate::ForwardDynamicsDerivatives::forward_dynamics_derivatives).
    fn forward_dynamics_derivatives_with_wrenches(q: joints, qd: joints, tau: joints, wrenches: wrenches)
        -> AccelerationDerivatives<DOF> or |this| {
        let (still_q, still_qd, still_tau, wrenches) = (still(q), still(qd), still(tau), wrenches.map(Wrench::still));
        let by_tau = rows_by(tau, |tau| this.forward_dynamics_with_wrenches(&still_q, &still_qd, tau, &wrenches));
        let accelerations = |q: &_, qd: &_| this.forward_dynamics_with_wrenches(q, qd, &still_tau, &wrenches);
        AccelerationDerivatives::by_dual_numbers(q, qd, accelerations, by_tau)
    } = |robot| {
            let still = wrenches.all_still();
            robot.acceleration_derivatives(
                [q, qd, tau],
                AtTip::Wrenches(wrenches),
                AtTip::Wrenches(still.as_ref()),
            )
        };
}
}

capability! {
/// The arm with a payload that is known when the program runs: every function is that of the arm whose last link has
/// the payload too. [`inverse_dynamics_with_payload`](crate::InverseDynamics::inverse_dynamics_with_payload) belongs to
/// [`InverseDynamics`]. A payload of zero gives the numbers of the function without a payload.
pub trait PayloadDynamics<DOF> {
    /// Torques that hold the arm and the payload still against gravity, N m or N. See
    /// [`gravity_torques`](crate::InverseDynamics::gravity_torques).
    fn gravity_torques_with_payload(q: joints, payload: payload) -> Vector =
        |robot| robot.gravity(q, AtTip::Payload(payload));

    /// Coriolis, centrifugal and gravity torques, N m or N. See [`bias_torques`](crate::InverseDynamics::bias_torques).
    fn bias_torques_with_payload(q: joints, qd: joints, payload: payload) -> Vector =
        |robot| robot.bias(q, qd, AtTip::Payload(payload));

    /// The mass matrix, symmetric to the last bit. See [`mass_matrix`](crate::MassMatrix::mass_matrix).
    fn mass_matrix_with_payload(q: joints, payload: payload) -> Matrix =
        |robot| robot.mass_matrix(q, AtTip::Payload(payload));

    /// Accelerations, rad/s² or m/s². See [`forward_dynamics`](crate::ForwardDynamics::forward_dynamics).
    fn forward_dynamics_with_payload(q: joints, qd: joints, tau: joints, payload: payload) -> Vector =
        |robot| robot.forward_dynamics([q, qd, tau], AtTip::Payload(payload));

    /// ∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics_with_payload`. See
    /// [`inverse_dynamics_derivatives`](crate::InverseDynamicsDerivatives::inverse_dynamics_derivatives).
    fn inverse_dynamics_derivatives_with_payload(q: joints, qd: joints, qdd: joints, payload: payload)
        -> TorqueDerivatives<DOF> = |robot| robot.torque_derivatives([q, qd, qdd], AtTip::Payload(&payload.still()));

    /// The momentum of the joints and its rate without external torques, for an observer that does not take the payload
    /// for an external torque. See [`momentum_and_rate`](crate::MomentumObserver::momentum_and_rate).
    fn momentum_and_rate_with_payload(q: joints, qd: joints, tau: joints, payload: payload) -> MomentumAndRate<DOF> =
        |robot| robot.momentum_and_rate([q, qd, tau], Some(payload));

    /// The derivatives of `forward_dynamics_with_payload` with respect to q, q̇ and τ. See
    /// [`forward_dynamics_derivatives`](crate::ForwardDynamicsDerivatives::forward_dynamics_derivatives).
    fn forward_dynamics_derivatives_with_payload(q: joints, qd: joints, tau: joints, payload: payload)
        -> AccelerationDerivatives<DOF> or |this| {
        let inverse = inverse_of(this.mass_matrix_with_payload(q, payload), &[T::zero(); DOF]);
        let (tau, payload) = (still(tau), payload.still());
        let accelerations = |q: &_, qd: &_| this.forward_dynamics_with_payload(q, qd, &tau, &payload);
        AccelerationDerivatives::by_dual_numbers(q, qd, accelerations, inverse)
    } = |robot| robot.acceleration_derivatives([q, qd, tau], AtTip::Payload(payload), AtTip::Payload(&payload.still()));
}
}

capability! {
/// Loads of the joint bearings: the wrenches between links.
pub trait JointWrenches<DOF> {
    /// f_{i-1,i} and n_{i-1,i} with a free tip: exerted BY link i-1 ON link i, about the joint's reference point J_i,
    /// in the axes of form P (fixed to link i, z along joint i). The z element of the moment of a revolute joint, of
    /// the force of a prismatic one, is τ_i.
    ///
    /// J_i is fixed to link i-1: the origin of frame i-1 in a standard table; in a modified one the foot of the common
    /// normal on axis i. Moment in N m, force in N.
    fn joint_wrenches(q: joints, qd: joints, qdd: joints) -> Wrenches = |robot| {
        let [q, qd, qdd] = [q, qd, qdd].map(|values| robot.of_joints(values));
        robot.coordinates.only(robot.mechanism.joint_wrenches(q.as_ref(), qd.as_ref(), qdd.as_ref()))
    };
}
}

capability! {
/// External torques without accelerations: what a momentum observer needs of the arm at every tick. Its state, gain and
/// update are [`ObserverState`](crate::ObserverState).
pub trait MomentumObserver<DOF> {
    /// The momentum p = M(q) q̇, and the rate τ + C(q, q̇)ᵀ q̇ - g(q) with Christoffel's C. The external torques are ṗ
    /// less this rate. `tau`: the torques that the actuators exert on the links, after friction is subtracted.
    ///
    /// Rotors belong to p where the arm is taken with them: `#[robot(rotors)]`, `with_rotors`.
    #[doc(alias = "momentum observer")]
    fn momentum_and_rate(q: joints, qd: joints, tau: joints) -> MomentumAndRate<DOF> =
        |robot| robot.momentum_and_rate([q, qd, tau], None);
}
}

capability! {
/// Torques of rotor inertia and motor friction, at the joints.
pub trait Actuation<DOF> {
    /// The motor terms alone, to be added to the torques of the links: G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇) per joint,
    /// N m or N. A joint without a motor needs nothing, so a robot without motors gets zeros; Coulomb friction is zero
    /// at rest.
    ///
    /// The sign is [`Scalar::by_sign`](crate::Scalar::by_sign), which a scalar of your own must implement for it.
    fn actuator_torques(qd: joints, qdd: joints) -> Vector = |robot| robot.actuator_torques(qd, qdd);

    /// Computes the actuator torques with friction that changes its sign gradually, for optimisers and integrators: s =
    /// q̇ / √(q̇² + width²) in place of the sign, and |G| (½ (Tc⁺ - Tc⁻) s + ½ (Tc⁺ + Tc⁻) s²) for the friction, which
    /// tends to |G| Tc⁺ and |G| Tc⁻ and is zero at rest.
    ///
    /// `width` > 0 is the velocity (rad/s or m/s) at which s is 0.7. A scalar of your own must implement
    /// [`Scalar::sqrt`](crate::Scalar::sqrt).
    fn actuator_torques_smooth(qd: joints, qdd: joints, width: duration) -> Vector or |this| {
        let smooth = |value| SmoothSign { value, width };
        this.actuator_torques(&qd.map(smooth), &qdd.map(smooth)).map(|torque| torque.value)
    } = |robot| robot.smooth_torques(qd, qdd, width);

    /// The derivatives of [`actuator_torques_smooth`](Self::actuator_torques_smooth) with respect to q̇, by rows, N m
    /// s/rad or N s/m: the part of friction in the derivatives of the torques with respect to velocities. The matrix is
    /// diagonal where no joint follows others. The derivative by accelerations, G² Jm, is constant.
    ///
    /// At the joint of a motor it is G² B + |G| (½ (Tc⁺ - Tc⁻) + (Tc⁺ + Tc⁻) s) ds/dq̇, with ds/dq̇ = width² / (q̇² +
    /// width²)^(3/2). `width` > 0: `actuator_torques` itself has no derivative at rest, and a `width` of zero gives
    /// numbers there that are not finite.
    fn actuator_torques_smooth_derivatives(qd: joints, width: duration) -> Matrix or |this| {
        let still_qdd = [Dual::constant(T::zero()); DOF];
        rows_by(qd, |qd| this.actuator_torques_smooth(qd, &still_qdd, Dual::constant(width)))
    } = |robot| {
        let (still, width) = (robot.still(robot.zeros().as_ref()), Dual::constant(width));
        robot.rows_by(qd, |qd| robot.smooth_torques(qd, still.as_ref(), width))
    };
}
}
