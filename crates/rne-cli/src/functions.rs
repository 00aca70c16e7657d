//! Which functions a robot has.

use std::path::Path;

use rne_codegen::{CompileError, Form, Function, Quantity, compile};
use rne_model::Robot;

use crate::outcome::Failure;
use crate::terminal::TYPED;

/// The functions that a robot has, in the order of the traits: what motors add needs motors, and motion follows from torques
/// where each joint moves something.
pub(crate) fn of(robot: &Robot) -> impl Iterator<Item = Function> {
    Function::ALL.into_iter().filter(|&function| match function {
        Function::ActuatorTorques => has_motors(robot),
        Function::ForwardDynamics => {
            !compile(robot, function, Form::SevenSteps).is_err_and(|error| is_singular(&error))
        }
        _ => true,
    })
}

/// Refuses a function that asks for motors which a robot does not have.
pub(crate) fn check(file: &Path, robot: &Robot, function: Function) -> Result<(), Failure> {
    if function != Function::ActuatorTorques || has_motors(robot) {
        return Ok(());
    }
    Err(Failure::input(format_args!(
        "{} has no motors: no joint of {} has a {TYPED}motor: {{inertia, gear_ratio, viscous, coulomb}}{TYPED:#}",
        robot.name,
        file.display()
    )))
}

/// Whether the mass matrix is singular in every position: a pivot is the constant 0.
pub(crate) fn is_singular(error: &CompileError) -> bool {
    matches!(error, CompileError::NotFinite { name } if name.quantity == Quantity::InversePivot)
}

fn has_motors(robot: &Robot) -> bool {
    robot.joints.iter().any(|joint| joint.motor.is_some())
}
