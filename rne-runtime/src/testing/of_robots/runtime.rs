//! Compares any function of a robot with the runtime.

use rne_functions::Function;
use rne_model::Robot;

use super::RobotFile;
use super::comparison::{Allowed, are_finite, compare, largest};
use super::random::Random;
use super::state::states;
use crate::values::numbers::Numbers;
use crate::{DynArm, Inputs};

/// The relative change of the arguments with which the sensitivity of a function is measured.
const PART: f64 = 1e-7;

/// Converts a list to the array that an argument of a function needs.
///
/// # Panics
/// When it has another number of elements.
#[must_use]
pub fn array<T, const N: usize>(list: &[T]) -> &[T; N] {
    list.try_into().unwrap_or_else(|_| panic!("{N} elements, not {}", list.len()))
}

/// Returns the numbers of a result, in the order of its layout.
pub fn numbers(result: impl Numbers<f64>) -> Vec<f64> {
    let mut numbers = Vec::new();
    result.each(&mut |number| numbers.push(*number));
    numbers
}

/// Compares a function of derived code, by its name in the table, with the runtime.
///
/// In the seven steps, most functions have the bits of the runtime. Otherwise rounding is allowed: as much as a
/// relative change of the arguments by rounding would change the function, and rounding of the terms that it adds.
///
/// # Panics
/// When they are different, or when no state closes the loops of the robot.
pub fn is_that_of_the_runtime(file: &RobotFile, function: &str, call: impl Fn(&Inputs<'_, f64>) -> Vec<f64>) {
    let (robot, arm) = file.robot();
    let function = Function::named(function).unwrap_or_else(|| panic!("no function {function}"));
    let has_bits = file.seven_steps && has_bits(&robot, function);
    let (mut compared, changes) = (0, Random::new(0xC4A5, |number| number));
    for state in states(&robot, &arm) {
        compared += 1;
        let changed = state.changed(|number| number * (1.0 + changes.number(PART)));
        let [expected, beside] = [&state, &changed]
            .map(|state| arm.evaluate(function, &state.inputs()).unwrap_or_else(|error| panic!("{error}")));
        if !are_finite(&expected) {
            continue; // the mass matrix is singular, or the arm has no mass
        }
        let change = expected.iter().zip(&beside).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        let scale = terms(&arm, function, &state.inputs()).max(change / PART);
        let allowed = if has_bits { Allowed::Nothing } else { Allowed::Rounding { scale } };
        compare(function.name(), &state, allowed, &call(&state.inputs()), &expected);
    }
    assert!(compared > 0, "the loops of {} stay open at each state", robot.name);
}

/// Whether the code of a function in the form of the seven steps has the bits of the runtime.
fn has_bits(robot: &Robot, function: Function) -> bool {
    // generated code differentiates through couplings, and factors the mass matrix of a tree in another order, with
    // fewer fill-ins
    let is_in_order = robot.is_serial() || !function.inverts_mass() || function.is_of_floating_base();
    function.entry().has_bits_of_runtime && !robot.has_couplings() && is_in_order
}

/// Returns the size of the terms that a function adds: 1 for lengths and directions, and for dynamics a fraction of the
/// torques on a base that moves in all directions under a gravity that is parallel to no axis.
pub(super) fn terms(arm: &DynArm, function: Function, inputs: &Inputs<'_, f64>) -> f64 {
    /// The fraction of these torques with which torques that vanish up to rounding are compared.
    const LEAST: f64 = 1e-2;
    if function.entry().is_geometry {
        return 1.0;
    }
    let torques = arm.inverse_dynamics_on_moving_base(inputs.q, inputs.qd, inputs.qdd, inputs.base);
    LEAST * torques.map_or(0.0, |torques| largest(&torques))
}
