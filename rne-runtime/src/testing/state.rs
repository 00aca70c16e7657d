//! States at which tests compare: the same ones in each run.

use core::cell::Cell;
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
    let random = Random::new(0x5EED, |number| number);
    (0..STATES).map(move |_| {
        let [q, qd, qdd, tau] = JOINTS.map(|limit| random.array(limit));
        let (wrench, payload) = (random.wrench(), random.payload());
        State { q, qd, qdd, tau, wrench, payload, base: BaseMotion { velocity: random.array(1.0), ..random.base() } }
    })
}

/// The largest positions, velocities, accelerations and torques of a joint: rad or m, N m or N.
pub const JOINTS: [f64; 4] = [3.0, 2.0, 5.0, 20.0];

/// Numbers that are the same in each run and on each machine: a linear congruential generator, with Knuth's constants.
#[derive(Clone, Debug)]
pub struct Random {
    state: Cell<u64>,
    rounded: fn(f64) -> f64,
}

impl Random {
    /// Numbers that depend on a seed, and that `rounded` rounds, each.
    #[must_use]
    pub const fn new(seed: u64, rounded: fn(f64) -> f64) -> Self {
        Self { state: Cell::new(seed), rounded }
    }

    /// Between `-limit` and `limit`.
    #[must_use]
    pub fn number(&self, limit: f64) -> f64 {
        let next = self.state.get().wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.state.set(next);
        // the upper bits are the random ones
        let [a, b, c, d, ..] = next.to_be_bytes();
        (self.rounded)(limit * (2.0 * f64::from(u32::from_be_bytes([a, b, c, d])) / f64::from(u32::MAX) - 1.0))
    }

    /// Each between `-limit` and `limit`.
    #[must_use]
    pub fn array<const N: usize>(&self, limit: f64) -> [f64; N] {
        array::from_fn(|_| self.number(limit))
    }

    /// N and N m.
    #[must_use]
    pub fn wrench(&self) -> Wrench<f64> {
        Wrench { force: self.array(10.0), moment: self.array(10.0) }
    }

    /// A point mass, kg and m.
    #[must_use]
    pub fn payload(&self) -> Payload<f64> {
        Payload { mass: (self.rounded)(1.5 + self.number(1.0)), com: self.array(0.1), ..Payload::default() }
    }

    /// A base without a velocity of its origin, which no torque depends on.
    #[must_use]
    pub fn base(&self) -> BaseMotion<f64> {
        BaseMotion {
            omega: self.array(1.0),
            omega_dot: self.array(2.0),
            velocity: [0.0; 3],
            acceleration: self.array(5.0),
            gravity: self.array(10.0),
        }
    }
}
