//! Reads the arguments of a function: the states of the joints, the load at the tip and the motion of the base.

use rne_model::Robot;

use crate::formulate::{Arm, AtTip, JointState, Motion, Payload, Wrench, arm, base_rotation};
use crate::function::{Argument, Function, What};
use crate::ir::{Axis, Builder, Cause, Name, Quantity, Symbol, Vector, all_names_of};

/// Returns the states of all joints. A rate or an acceleration that is not an argument is zero, or is the value that
/// was solved for.
pub(super) fn states<'s>(arm: &Arm<'s>) -> Vec<JointState<'s>> {
    (0..arm.links.len()).map(|joint| state(arm, joint)).collect()
}

fn state<'s>(arm: &Arm<'s>, joint: usize) -> JointState<'s> {
    let (builder, coordinates) = (arm.builder, &arm.coordinates);
    let function = builder.function;
    let of_joint = |quantity| coordinates.of_joint(builder, quantity, joint);
    let given = |argument, quantity, otherwise| -> Symbol<'s> {
        if function.takes(argument) { of_joint(quantity) } else { builder.constant(0.0, otherwise) }
    };
    let turn_of = |quantity| builder.argument(Name::scalar(quantity, joint + 1));
    JointState {
        q: of_joint(Quantity::Position),
        // sin q cannot be computed from the sine of another joint's angle where q is a multiple of that angle
        turn: (function.takes(Argument::Sines) && coordinates.has(joint))
            .then(|| (turn_of(Quantity::Sine), turn_of(Quantity::Cosine))),
        qd: given(Argument::Rates, Quantity::Rate, Cause::AtRest),
        // in a closed loop, the dependent joints accelerate even where the independent joints do not
        qdd: match coordinates.bias(builder, joint) {
            Some(bias) if !function.takes(Argument::Accelerations) => bias,
            _ if builder.has_accelerations() => of_joint(Quantity::RateDot),
            _ => given(Argument::Accelerations, Quantity::RateDot, Cause::NoAcceleration),
        },
    }
}

/// Returns the load at the tip: a payload, a wrench, a wrench at each tip, or nothing.
pub(super) fn tip<'s>(arm: &Arm<'s>) -> AtTip<'s> {
    let (builder, joints) = (arm.builder, arm.links.len());
    if let Some(payload) = Payload::argument(builder, joints) {
        AtTip::Payload(payload)
    } else if builder.function.takes(Argument::Wrench) {
        let [force, moment] =
            [Quantity::JointForce, Quantity::JointMoment].map(|part| vector(builder, part, joints + 1));
        AtTip::Wrench(Wrench { force, moment })
    } else if builder.function.takes(Argument::Wrenches) {
        let wrench = |tip| {
            let [fx, fy, fz, nx, ny, nz] = all_names_of::<6>("wrenches", tip).map(|name| builder.argument(name));
            Wrench { force: Vector([fx, fy, fz]), moment: Vector([nx, ny, nz]) }
        };
        AtTip::Wrenches((1..=arm.tips.len()).map(wrench).collect())
    } else {
        AtTip::Nothing
    }
}

/// Returns the motion of the base, and gravity in frame 0.
pub(super) fn base<'s>(arm: &Arm<'s>, robot: &Robot) -> Motion<'s> {
    let (builder, function) = (arm.builder, arm.builder.function);
    let of_base = |quantity| vector(builder, quantity, 0);
    if function.takes(Argument::Base) {
        let motion = [Quantity::Omega, Quantity::OmegaDot, Quantity::Acceleration];
        return Motion::of_base(arm, motion.map(of_base), of_base(Quantity::Gravity));
    }
    if function.takes(Argument::BaseTwist) && !function.takes(Argument::Step) {
        return Motion::of_twist(arm, [Quantity::OriginVelocity, Quantity::Omega].map(of_base));
    }
    if function.takes(Argument::BaseVelocity) || function.takes(Argument::BaseTwist) {
        // the accelerations do not depend on the linear velocity of the base, so it is not read
        let nothing = builder.zeros(Cause::NoAcceleration);
        let [omega_dot, acceleration] = [Quantity::OmegaDot, Quantity::Acceleration]
            .map(|quantity| builder.solved_of_base(quantity).unwrap_or(nothing));
        let motion = || Motion::of_base(arm, [of_base(Quantity::Omega), omega_dot, acceleration], nothing);
        // this code runs a second time with the solved accelerations; only the second run names its quantities
        let is_first = function == Function::FloatingEulerStepDerivatives && !builder.has_accelerations();
        return if is_first { builder.unnamed(motion) } else { motion() };
    }
    match function.what() {
        What::GravityTorques if function.is_of_floating_base() => {
            let still = builder.zeros(Cause::FixedBase);
            let gravity = base_rotation(builder).transpose() * builder.unnamed(|| arm::gravity(builder, robot));
            Motion::of_base(arm, [still; 3], gravity)
        }
        What::CoriolisTorques => Motion::of_fixed_base(builder, builder.zeros(Cause::NoGravity)),
        _ => Motion::of_fixed_base(builder, arm.gravity),
    }
}

/// Returns an argument that is a vector.
pub(super) fn vector(builder: &Builder, quantity: Quantity, joint: usize) -> Vector<'_> {
    Vector(Axis::ALL.map(|axis| builder.argument(Name::vector(quantity, joint, axis))))
}
