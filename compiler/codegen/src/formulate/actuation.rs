//! Joint torques due to motors with gears: G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇), with the gear ratio G, the rotor
//! inertia Jm, the viscous friction B and the Coulomb friction Tc of the motor. The gyroscopic moments of rotors are
//! left out.

use rne_model::{Entry, Robot};

use crate::formulate::JointState;
use crate::formulate::arm::number;
use crate::ir::{Builder, Cause, Name, Quantity, Symbol};

/// Returns the torque that each joint's motor adds, base to tip; zero where a joint has no motor. Where the rotors
/// belong to the arm, their inertia is left out here, because the torques of the arm include it.
pub(crate) fn torques<'s>(builder: &'s Builder, robot: &Robot, states: &[JointState<'s>]) -> Vec<Symbol<'s>> {
    let torque = |(index, state): (usize, &JointState<'s>)| {
        let joint = index + 1;
        let Some(motor) = robot.joints.get(index).and_then(|joint| joint.motor) else {
            return builder.constant(0.0, Cause::Arithmetic);
        };
        let number = |entry, value| number(builder, robot, entry, value);
        let ratio = number(Entry::GearRatio(index), motor.gear_ratio);
        let squared = ratio * ratio;
        let magnitude = match robot.run_time.formula(Entry::GearRatio(index)) {
            Some(_) => builder.by_sign(ratio, ratio, -ratio),
            None if motor.gear_ratio < 0.0 => -ratio,
            None => ratio,
        };
        let named = |name, symbol| builder.name(name, symbol);
        let own = if robot.rotors {
            builder.constant(0.0, Cause::Arithmetic)
        } else {
            number(Entry::MotorInertia(index), motor.inertia)
        };
        let inertia = squared * own;
        let inertia = named(Name::scalar(Quantity::RotorInertia, joint), inertia);
        let viscous = squared * number(Entry::Viscous(index), motor.viscous);
        let viscous = named(Name::scalar(Quantity::ViscousFriction, joint), viscous);
        let entries = [Entry::CoulombPositive(index), Entry::CoulombNegative(index)];
        let [positive, negative] = [0, 1].map(|side| {
            let name = Name::indexed(Quantity::CoulombFriction, joint, side + 1);
            named(name, magnitude * number(entries[side], motor.coulomb[side]))
        });
        let value = builder.joint(joint).within(Quantity::ActuatorTorque, || {
            inertia * state.qdd + viscous * state.qd + builder.by_sign(state.qd, positive, negative)
        });
        builder.name(Name::scalar(Quantity::ActuatorTorque, joint), value)
    };
    states.iter().enumerate().map(torque).collect()
}
