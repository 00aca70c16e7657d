//! Which functions of a robot are worth listing.

use rne_codegen::Function;
use rne_model::Robot;

/// The functions that a robot has something to compute for, in the order of the traits: without motors,
/// `actuator_torques` is zero, and there for who asks for it by name.
pub(crate) fn of(robot: &Robot) -> impl Iterator<Item = Function> {
    let has_motors = robot.joints.iter().any(|joint| joint.motor.is_some());
    Function::ALL.into_iter().filter(move |&function| function != Function::ActuatorTorques || has_motors)
}
