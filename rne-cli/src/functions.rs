//! Which functions a robot has.

use std::path::Path;

use rne_codegen::Function;
use rne_model::Robot;

use crate::outcome::Failure;
use crate::terminal::TYPED;

/// The functions that a robot has, in the order of the traits: what motors add needs motors.
pub(crate) fn of(robot: &Robot) -> impl Iterator<Item = Function> {
    Function::ALL.into_iter().filter(|&function| function != Function::ActuatorTorques || has_motors(robot))
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

fn has_motors(robot: &Robot) -> bool {
    robot.joints.iter().any(|joint| joint.motor.is_some())
}
