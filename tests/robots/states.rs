//! States at which robots are compared.

use fastrand::Rng;
use rne::Wrench;
use std::f64::consts::{FRAC_PI_2, PI};

use crate::shipped::Shipped;

/// States per robot.
pub(crate) fn count() -> usize {
    if shipped::is_exhaustive() { 10_000 } else { 500 }
}

/// Joint arrays and a wrench.
pub(crate) struct State<const DOF: usize> {
    pub(crate) q: [f64; DOF],
    pub(crate) qd: [f64; DOF],
    pub(crate) qdd: [f64; DOF],
    pub(crate) wrench: Wrench<f64>,
}

/// A moderate state: positions in the limits (±π rad or m without), |q̇| ≤ 2, |q̈| ≤ 5.
pub(crate) fn moderate<const DOF: usize, R: Shipped<DOF>>(rng: &mut Rng) -> State<DOF> {
    let mut between = |low: f64, high: f64| low + (high - low) * rng.f64();
    State {
        q: R::POSITION_LIMITS.map(|(low, high)| between(low.max(-PI), high.min(PI))),
        qd: [(); DOF].map(|()| between(-2.0, 2.0)),
        qdd: [(); DOF].map(|()| between(-5.0, 5.0)),
        wrench: Wrench {
            force: [(); 3].map(|()| between(-10.0, 10.0)),
            moment: [(); 3].map(|()| between(-10.0, 10.0)),
        },
    }
}

/// The `index`-th state of a comparison for bits: moderate ones, and among them positions at multiples of π/2, rates
/// and accelerations of any magnitude from 1e-100 to 1e100, and the arm at rest.
pub(crate) fn any<const DOF: usize, R: Shipped<DOF>>(rng: &mut Rng, index: usize) -> State<DOF> {
    let mut state = moderate::<DOF, R>(rng);
    let right = [0.0, FRAC_PI_2, -FRAC_PI_2, PI, -PI];
    match index % 10 {
        0 => state.q = [right[(index / 10) % right.len()]; DOF],
        1 => state.q = [(); DOF].map(|()| right[rng.usize(..right.len())]),
        _ => {}
    }
    let mut magnitude = || {
        let value = 10_f64.powf(200.0 * rng.f64() - 100.0);
        if rng.bool() { value } else { -value }
    };
    match index % 7 {
        0 => (state.qd, state.qdd) = ([0.0; DOF], [0.0; DOF]),
        1 => state.qd = [(); DOF].map(|()| magnitude()),
        2 => state.qdd = [(); DOF].map(|()| magnitude()),
        3 => {
            let (rate, acceleration) = (magnitude(), magnitude());
            (state.qd, state.qdd) = ([rate; DOF], [acceleration; DOF]);
        }
        _ => {}
    }
    state
}
