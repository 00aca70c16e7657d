//! Torques and accelerations of a robot with a wrench at each of its named tips.

use crate::at_tip::AtTip;
use crate::definition::definitions;
use crate::wrench::AllStill as _;
use crate::{ArmWithTips, Constant, Scalar, TipWrenches, Wrench};

definitions! { TipWrenches<DOF, TIPS> {
    /// As [`TipWrenches::inverse_dynamics_with_wrenches`]: torques when the robot exerts `wrenches`, one at each of its
    /// [tips](Self::tips), in axes of the tip.
    fn inverse_dynamics_with_wrenches(q: joints, qd: joints, qdd: joints, wrenches: wrenches) -> vector =
        |robot| robot.torques([q, qd, qdd], AtTip::Wrenches(wrenches));
    /// As [`TipWrenches::forward_dynamics_with_wrenches`]: accelerations when the robot exerts `wrenches`, one at each
    /// of its [tips](Self::tips), in axes of the tip.
    fn forward_dynamics_with_wrenches(q: joints, qd: joints, tau: joints, wrenches: wrenches) -> vector =
        |robot| robot.forward_dynamics([q, qd, tau], AtTip::Wrenches(wrenches));
    /// As [`TipWrenches::inverse_dynamics_derivatives_with_wrenches`], with one of `wrenches` for each of the
    /// [tips](Self::tips).
    fn inverse_dynamics_derivatives_with_wrenches(q: joints, qd: joints, qdd: joints, wrenches: wrenches)
        -> TorqueDerivatives<DOF> =
        |robot| robot.torque_derivatives([q, qd, qdd], AtTip::Wrenches(wrenches.all_still().as_ref()));
    /// As [`TipWrenches::forward_dynamics_derivatives_with_wrenches`], with one of `wrenches` for each of the
    /// [tips](Self::tips).
    fn forward_dynamics_derivatives_with_wrenches(q: joints, qd: joints, tau: joints, wrenches: wrenches)
        -> AccelerationDerivatives<DOF> = |robot| {
            let still = wrenches.all_still();
            robot.acceleration_derivatives(
                [q, qd, tau],
                AtTip::Wrenches(wrenches),
                AtTip::Wrenches(still.as_ref()),
            )
        };
} }
