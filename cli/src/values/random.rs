//! Makes random numbers and states, the same in each run.

use rne::Pose;
use rne::testing::{JOINTS, Random};
use rne_certify::accuracy::BASE_ROTATION;
use rne_codegen::Function;
use rne_emit::Precision;
use rne_model::Robot;

use crate::values::state::State;

/// Makes a generator of numbers that a number type represents exactly.
pub(crate) const fn of(precision: Precision) -> Random {
    Random::new(0x5EED, rounding(precision))
}

/// Returns a function that rounds to the nearest number of a number type.
#[allow(clippy::cast_possible_truncation)] // rounded
pub(crate) const fn rounding(precision: Precision) -> fn(f64) -> f64 {
    match precision {
        Precision::Single => |number| f64::from(number as f32),
        Precision::Double => |number| number,
    }
}

/// Makes a random state of an arm, with wrenches and a payload; in rad, m, kg, N.
pub(crate) fn state(random: &Random, robot: &Robot) -> State {
    let dof = robot.dof();
    let [mut q, qd, qdd, tau] = JOINTS.map(|limit| (0..dof).map(|_| random.number(limit)).collect::<Vec<f64>>());
    // a random q would not close the loops, so one of the known closures is used
    let mut passive = Vec::new();
    let closures = &robot.closed.closures;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a place in a list
    let place = if closures.is_empty() { 0 } else { random.number(1000.0).abs() as usize % closures.len() };
    if let Some(closure) = closures.get(place) {
        let of = |joints: &mut dyn Iterator<Item = usize>| joints.map(|joint| closure[joint]).collect();
        (q, passive) = (of(&mut robot.coordinates()), of(&mut robot.closed.passive.iter().copied()));
    }
    let (wrench, payload) = (Some(random.wrench()), Some(random.payload()));
    let base = random.base();
    // without named tips, the only wrench is that at the tip
    let wrenches = match robot.tips.len() {
        0 => wrench.into_iter().collect(),
        tips => (0..tips).map(|_| random.wrench()).collect(),
    };
    // rounded to hundredths and then to single precision, the rotation is the same for the code and for the runtime
    let rounded = BASE_ROTATION.map(|x| (f64::from(x) * 100.0).round() / 100.0);
    let base_rotation = [0, 1, 2].map(|row| [0, 1, 2].map(|column| rounded[3 * row + column]));
    let pose = Pose { rotation: base_rotation, translation: base.velocity };
    // drawn last, so that earlier numbers do not change
    let multipliers = (0..dof).map(|_| random.number(1.0)).collect();
    let step = random.number(0.1);
    let function = Function::InverseDynamics;
    State {
        function,
        q,
        passive,
        qd,
        qdd,
        tau,
        step,
        multipliers,
        wrench,
        wrenches,
        payload,
        base,
        pose,
        base_rotation,
    }
}
