//! Steps of the semi-implicit Euler method, and their derivatives.

#[cfg(feature = "arm")]
use crate::{
    definition::floating_euler_step::next_of_base,
    definition::still_wrenches::AllStill as _,
    integrators::{POSITION, RATE, moved, moved_by},
    seven_steps::at_tip::AtTip,
};

capability! {
/// A step of the semi-implicit Euler method under torques that do not change during the step.
pub trait EulerStep<DOF> {
    /// Positions and velocities after a step of the duration `step`, s: q̇' = q̇ + h q̈ with the accelerations q̈ of q,
    /// q̇ and τ ([`forward_dynamics`](crate::ForwardDynamics::forward_dynamics)), then q' = q + h q̇'. The error of a
    /// motion is of order h.
    ///
    /// The tip is free, and joints have no friction and no limits. A singular mass matrix (a joint that moves nothing)
    /// gives numbers that are not finite. Source: E. Hairer, C. Lubich, G. Wanner, "Geometric numerical integration",
    /// 2006, section I.1.2.
    #[doc(alias = "mj_step")]
    fn euler_step(q: joints, qd: joints, tau: joints, step: duration) -> NextState<DOF> = |robot| {
        let [position, rate] = [q, qd].map(|x| robot.list(x));
        let next = moved(&rate, &robot.forward_dynamics([q, qd, tau], AtTip::Nothing), step);
        (moved(&position, &next, step), next)
    };
}
}

capability! {
/// Derivatives of a step of the semi-implicit Euler method, for optimisers.
pub trait EulerStepDerivatives<DOF> {
    /// The derivatives of [`euler_step`](crate::EulerStep::euler_step) with respect to q, q̇ and τ: those of the
    /// velocities are h times those of the accelerations, plus 1 with respect to the velocity itself; those of the
    /// positions are h times those of the next velocities, plus 1 with respect to the position itself.
    ///
    /// They are exact up to rounding. `step` is the duration h, s.
    fn euler_step_derivatives(q: joints, qd: joints, tau: joints, step: duration)
        -> NextStateDerivatives<DOF> = |robot| {
        let (dq, dqd, dtau) = robot.acceleration_derivatives([q, qd, tau], AtTip::Nothing, AtTip::Nothing);
        let rates = moved_by(RATE, &[dq, dqd, dtau], step);
        let [by_q, by_qd, by_tau] = moved_by(POSITION, &rates, step);
        let [dq, dqd, dtau] = rates;
        (From::from((by_q, by_qd, by_tau)), From::from((dq, dqd, dtau)))
    };
}
}

capability! {
/// A step of the semi-implicit Euler method of a robot with a floating base, under torques and wrenches that do not
/// change during the step. The base, the tips and the wrenches are those of [`FloatingBase`](crate::FloatingBase).
pub trait FloatingEulerStep<DOF, TIPS> {
    /// The state after a step of the duration `step`, s. `pose` is that of frame 0 in the world, `twist` its velocity
    /// in its axes. Gravity is that of the robot file, in axes of the world.
    ///
    /// The velocities come first, by the accelerations of [`floating_forward_dynamics`](
    /// crate::FloatingBase::floating_forward_dynamics), those of the origin of frame 0 in world axes. Then this origin
    /// and the joints move with the new velocities, and the base turns by the new angular velocity in its axes. The
    /// error of a motion is of order h.
    ///
    /// The base turns by the unit quaternion (1 - s, 2 u) / (1 + s) with u = h ω / 4 and s = u·u. It needs no root, no
    /// sine and no quotient by an angle, so it is smooth at ω = 0; its angle is h |ω| less (h |ω|)³ / 48, an error of
    /// higher order than that of the method. The rotation after the step is orthogonal to rounding, however many steps
    /// came before. A `pose` that is no rotation, or a base without mass, gives numbers without a meaning.
    fn floating_euler_step(
        q: joints, qd: joints, tau: joints, pose: pose, twist: twist, step: duration, wrenches: wrenches
    ) -> FloatingNextState<DOF> = |robot| {
        let (base, qdd) = robot.floating_forward_dynamics([q, qd, tau], &twist.angular, AtTip::Wrenches(wrenches));
        let (pose, twist) = next_of_base((pose, twist), &base, &robot.mechanism.gravity.map(S::to), step);
        let [q, qd] = [q, qd].map(|x| robot.list(x));
        let qd = moved(&qd, &qdd, step);
        (pose, twist, moved(&q, &qd, step), qd)
    };
}
}

capability! {
/// Derivatives of a step of the semi-implicit Euler method of a robot with a floating base, for optimisers. The
/// base, the tips and the wrenches are those of [`FloatingBase`](crate::FloatingBase).
pub trait FloatingEulerStepDerivatives<DOF, NV, TIPS> {
    /// The derivatives of [`floating_euler_step`](crate::FloatingEulerStep::floating_euler_step) with respect to the
    /// state and the torques. The arguments are those of this step.
    ///
    /// They are exact up to rounding where `pose` is a rotation. The origin of frame 0 in `pose` has no effect, and its
    /// rotation only turns gravity.
    fn floating_euler_step_derivatives(
        q: joints, qd: joints, tau: joints, pose: pose, twist: twist, step: duration, wrenches: wrenches
    ) -> FloatingStepDerivatives<DOF, NV> = |robot| {
        let still = wrenches.all_still();
        robot.floating_step_derivatives([q, qd, tau], (pose, twist), step, wrenches, still.as_ref())
    };
}
}
