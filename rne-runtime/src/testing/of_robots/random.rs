//! Random numbers that are the same in each run.

use core::array;
use core::cell::Cell;

use crate::{BaseMotion, Payload, Wrench};

/// The largest positions, velocities, accelerations and torques of a joint: rad or m, their rates per s and s², N m or
/// N.
pub const JOINTS: [f64; 4] = [3.0, 2.0, 5.0, 20.0];

/// Random numbers that are the same in each run and on each machine, from a linear congruential generator with Knuth's
/// constants.
#[derive(Clone, Debug)]
pub struct Random {
    state: Cell<u64>,
    rounded: fn(f64) -> f64,
}

impl Random {
    /// Creates random numbers that depend on a seed. Each is rounded by `rounded`.
    #[must_use]
    pub const fn new(seed: u64, rounded: fn(f64) -> f64) -> Self {
        Self { state: Cell::new(seed), rounded }
    }

    /// Returns a number between `-limit` and `limit`.
    #[must_use]
    pub fn number(&self, limit: f64) -> f64 {
        let next = self.state.get().wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.state.set(next);
        // the upper bits are the random ones
        let [a, b, c, d, ..] = next.to_be_bytes();
        (self.rounded)(limit * (2.0 * f64::from(u32::from_be_bytes([a, b, c, d])) / f64::from(u32::MAX) - 1.0))
    }

    /// Returns numbers between `-limit` and `limit`.
    #[must_use]
    pub fn array<const N: usize>(&self, limit: f64) -> [f64; N] {
        array::from_fn(|_| self.number(limit))
    }

    /// Returns a wrench, N and N m.
    #[must_use]
    pub fn wrench(&self) -> Wrench<f64> {
        Wrench { force: self.array(10.0), moment: self.array(10.0) }
    }

    /// Returns a point mass, kg and m.
    #[must_use]
    pub fn payload(&self) -> Payload<f64> {
        Payload { mass: (self.rounded)(1.5 + self.number(1.0)), com: self.array(0.1), ..Payload::default() }
    }

    /// Returns the motion of a base without a velocity of its origin, on which no torque depends.
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
