//! What motors behind gears add: G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇). Rotor gyroscopics are left out.

use rne_model::Robot;

use crate::ledger::Cause;
use crate::quantity::{Name, Quantity};
use crate::seven_steps::JointState;
use crate::symbol::Symbol;
use crate::worksheet::Worksheet;

/// The torques of the motors, base to tip; zero where a joint has none.
pub(crate) fn torques<'s>(sheet: &'s Worksheet, robot: &Robot, states: &[JointState<'s>]) -> Vec<Symbol<'s>> {
    let torque = |(index, state): (usize, &JointState<'s>)| {
        let joint = index + 1;
        let Some(motor) = robot.joints.get(index).and_then(|joint| joint.motor) else {
            return sheet.constant(0.0, Cause::Arithmetic);
        };
        let number = |quantity, value| sheet.entry(Name::scalar(quantity, joint), value);
        let (squared, ratio) = (motor.gear_ratio * motor.gear_ratio, motor.gear_ratio.abs());
        let inertia = number(Quantity::RotorInertia, squared * motor.inertia);
        let viscous = number(Quantity::ViscousFriction, squared * motor.viscous);
        let [positive, negative] = [0, 1].map(|side| {
            let name = Name { part: side + 1, ..Name::scalar(Quantity::CoulombFriction, joint) };
            sheet.entry(name, ratio * motor.coulomb[side])
        });
        let value = sheet.joint(joint).within(Quantity::ActuatorTorque, || {
            inertia * state.qdd + viscous * state.qd + sheet.by_sign(state.qd, positive, negative)
        });
        sheet.name(Name::scalar(Quantity::ActuatorTorque, joint), value)
    };
    states.iter().enumerate().map(torque).collect()
}
