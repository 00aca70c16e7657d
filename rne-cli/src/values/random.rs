//! Random numbers and states that are the same in each run.

use rne::{BaseMotion, Payload, Wrench};
use rne_codegen::Function;
use rne_emit::Precision;

use crate::values::state::State;

/// Numbers that are the same in each run and on each machine: a linear congruential generator, with Knuth's constants.
pub(crate) struct Random {
    state: std::cell::Cell<u64>,
    precision: Precision,
}

impl Random {
    /// Numbers that this number type holds.
    pub(crate) const fn new(precision: Precision) -> Self {
        Self { state: std::cell::Cell::new(0x5EED), precision }
    }

    /// Numbers that depend on a seed.
    pub(crate) const fn seeded(seed: u64) -> Self {
        Self { state: std::cell::Cell::new(seed), precision: Precision::Double }
    }

    /// Between `-limit` and `limit`.
    pub(crate) fn number(&self, limit: f64) -> f64 {
        let next = self.state.get().wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.state.set(next);
        // the upper bits are the random ones
        let [a, b, c, d, ..] = next.to_be_bytes();
        self.rounded(limit * (2.0 * f64::from(u32::from_be_bytes([a, b, c, d])) / f64::from(u32::MAX) - 1.0))
    }

    #[allow(clippy::cast_possible_truncation)] // rounded
    pub(crate) fn rounded(&self, number: f64) -> f64 {
        match self.precision {
            Precision::Single => f64::from(number as f32),
            Precision::Double => number,
        }
    }

    fn vector(&self, limit: f64) -> [f64; 3] {
        [0; 3].map(|_| self.number(limit))
    }

    /// A state of an arm, and what acts on it: rad, m, kg, N.
    pub(crate) fn state(&mut self, dof: usize) -> State {
        let joints = |limit| (0..dof).map(|_| self.number(limit)).collect();
        State {
            function: Function::InverseDynamics,
            q: joints(3.0),
            qd: joints(2.0),
            qdd: joints(5.0),
            tau: joints(20.0),
            wrench: Some(Wrench { force: self.vector(10.0), moment: self.vector(10.0) }),
            payload: Some(Payload {
                mass: self.rounded(1.5 + self.number(1.0)),
                com: self.vector(0.1),
                ..Payload::default()
            }),
            base: BaseMotion {
                omega: self.vector(1.0),
                omega_dot: self.vector(2.0),
                velocity: [0.0; 3],
                acceleration: self.vector(5.0),
                gravity: self.vector(10.0),
            },
        }
    }
}
