//! Random numbers and states that are the same in each run.

use rne::testing::{JOINTS, Random};
use rne_codegen::Function;
use rne_emit::Precision;

use crate::values::state::State;

/// Numbers that a number type holds.
pub(crate) const fn of(precision: Precision) -> Random {
    Random::new(0x5EED, rounding(precision))
}

/// The nearest number of a number type.
#[allow(clippy::cast_possible_truncation)] // rounded
pub(crate) const fn rounding(precision: Precision) -> fn(f64) -> f64 {
    match precision {
        Precision::Single => |number| f64::from(number as f32),
        Precision::Double => |number| number,
    }
}

/// A state of an arm, and what acts on it: rad, m, kg, N.
pub(crate) fn state(random: &Random, dof: usize) -> State {
    let [q, qd, qdd, tau] = JOINTS.map(|limit| (0..dof).map(|_| random.number(limit)).collect());
    let (wrench, payload) = (Some(random.wrench()), Some(random.payload()));
    State { function: Function::InverseDynamics, q, qd, qdd, tau, wrench, payload, base: random.base() }
}
