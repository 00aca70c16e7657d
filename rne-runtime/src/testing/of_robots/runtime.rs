//! Any function of a robot against the runtime.

use rne_functions::Function;
use rne_model::Robot;

use super::RobotFile;
use super::comparison::{Allowed, are_finite, compare, largest};
use super::random::Random;
use super::state::states;
use crate::values::numbers::Numbers;
use crate::{DynArm, Inputs};

/// How much arguments change, of themselves, to see how much a function does.
const PART: f64 = 1e-7;

/// A list of as many elements as the argument of a function has.
///
/// # Panics
/// When it has another number of elements.
#[must_use]
pub fn array<T, const N: usize>(list: &[T]) -> &[T; N] {
    list.try_into().unwrap_or_else(|_| panic!("{N} elements, not {}", list.len()))
}

/// The numbers of a result, in the order of their layout.
pub fn numbers(result: impl Numbers<f64>) -> Vec<f64> {
    let mut numbers = Vec::new();
    result.each(&mut |number| numbers.push(*number));
    numbers
}

/// Compares a function of derived code, by its name in the table, with the runtime.
///
/// In the seven steps most functions have the bits of the runtime. Elsewhere rounding is allowed, by as much as the
/// function changes where its arguments do, and by rounding of the terms of which it is made.
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
            continue; // of a singular mass matrix, or of an arm without mass
        }
        let change = expected.iter().zip(&beside).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        let scale = terms(&arm, function, &state.inputs()).max(change / PART);
        let allowed = if has_bits { Allowed::Nothing } else { Allowed::Rounding { scale } };
        compare(function.name(), &state, allowed, &call(&state.inputs()), &expected);
    }
    assert!(compared > 0, "the loops of {} stay open at each state", robot.name);
}

/// Whether the seven steps of a function have the bits of the runtime.
fn has_bits(robot: &Robot, function: Function) -> bool {
    // code differentiates through couplings, and eliminates the joints of a tree in the order that fills less
    let is_in_order = robot.is_serial() || !function.inverts_mass() || function.is_of_floating_base();
    function.entry().has_bits_of_runtime && !robot.has_couplings() && is_in_order
}

/// How large the terms of a function are: lengths and directions are about one, dynamics has a part of the torques on a
/// base that moves in all directions under a gravity that no axis is parallel to.
pub(super) fn terms(arm: &DynArm, function: Function, inputs: &Inputs<'_, f64>) -> f64 {
    /// Torques that vanish but for rounding are measured by this part of those that do not.
    const LEAST: f64 = 1e-2;
    if function.entry().is_geometry {
        return 1.0;
    }
    let torques = arm.inverse_dynamics_on_moving_base(inputs.q, inputs.qd, inputs.qdd, inputs.base);
    LEAST * torques.map_or(0.0, |torques| largest(&torques))
}
