//! The seven steps of one robot, written on a sheet for one function of it.

use rne_model::Robot;

use crate::function::Function;
use crate::ledger::Cause;
use crate::links::Arm;
use crate::quantity::{Axis, Name, Quantity};
use crate::seven_steps::{self, JointState, Wrench};
use crate::symbol::{Symbol, Vector};
use crate::worksheet::Worksheet;

/// The torques of a robot, base to tip. Zeros of the function are put in before anything is folded.
pub(crate) fn torques<'s>(sheet: &'s Worksheet, robot: &Robot, function: Function) -> Vec<Symbol<'s>> {
    let arm = Arm::new(sheet, robot);
    let dof = robot.dof();
    let states: Vec<JointState<'_>> = (1..=dof)
        .map(|joint| {
            let argument = |quantity| sheet.argument(Name::scalar(quantity, joint));
            JointState {
                q: argument(Quantity::Position),
                turn: function.has_turns().then(|| (argument(Quantity::Sine), argument(Quantity::Cosine))),
                qd: if function.has_rates() { argument(Quantity::Rate) } else { sheet.constant(0.0, Cause::AtRest) },
                qdd: if function.has_accelerations() {
                    argument(Quantity::RateDot)
                } else {
                    sheet.constant(0.0, Cause::NoAcceleration)
                },
            }
        })
        .collect();
    let tip = if function.has_wrench() {
        let argument = |quantity| Vector(Axis::ALL.map(|axis| sheet.argument(Name::vector(quantity, dof + 1, axis))));
        Wrench { force: argument(Quantity::JointForce), moment: argument(Quantity::JointMoment) }
    } else {
        Wrench { force: sheet.zeros(Cause::FreeTip), moment: sheet.zeros(Cause::FreeTip) }
    };

    seven_steps::inverse_dynamics(sheet, &arm, &states, tip)
}
