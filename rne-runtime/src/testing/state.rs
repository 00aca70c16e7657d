//! States at which tests compare: the same ones in each run.

use core::{array, fmt};

use crate::{BaseMotion, Payload, Wrench};

/// Number of states to try.
const STATES: usize = 48;

/// A state of an arm, and what acts on it.
pub(super) struct State<const DOF: usize> {
    pub(super) q: [f64; DOF],
    pub(super) qd: [f64; DOF],
    pub(super) qdd: [f64; DOF],
    pub(super) tau: [f64; DOF],
    pub(super) wrench: Wrench<f64>,
    pub(super) payload: Payload<f64>,
    pub(super) base: BaseMotion<f64>,
}

impl<const DOF: usize> fmt::Display for State<DOF> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { q, qd, qdd, tau, .. } = self;
        write!(f, "  q   = {q:?}\n  qd  = {qd:?}\n  qdd = {qdd:?}\n  tau = {tau:?}")
    }
}

/// The states, seeded.
pub(super) fn states<const DOF: usize>() -> impl Iterator<Item = State<DOF>> {
    let mut random = Random(0x5EED);
    (0..STATES).map(move |_| State {
        q: random.array(3.0),
        qd: random.array(2.0),
        qdd: random.array(5.0),
        tau: random.array(20.0),
        wrench: Wrench { force: random.array(10.0), moment: random.array(10.0) },
        payload: Payload { mass: 1.0 + random.number(1.0), com: random.array(0.1), ..Payload::default() },
        base: BaseMotion {
            omega: random.array(1.0),
            omega_dot: random.array(2.0),
            velocity: random.array(1.0),
            acceleration: random.array(5.0),
            gravity: random.array(10.0),
        },
    })
}

/// A linear congruential generator, with Knuth's constants.
struct Random(u64);

impl Random {
    /// Between `-limit` and `limit`.
    fn number(&mut self, limit: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // the upper bits are the random ones
        let [a, b, c, d, ..] = self.0.to_be_bytes();
        limit * (2.0 * f64::from(u32::from_be_bytes([a, b, c, d])) / f64::from(u32::MAX) - 1.0)
    }

    fn array<const N: usize>(&mut self, limit: f64) -> [f64; N] {
        array::from_fn(|_| self.number(limit))
    }
}
