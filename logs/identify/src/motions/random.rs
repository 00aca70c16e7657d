//! Random numbers from a seed, the same on every machine.

use fastrand::Rng;

pub(crate) struct Random(Rng);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Rng::with_seed(seed))
    }

    /// Returns a number between -1 and 1.
    pub(crate) fn number(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }

    /// Returns a nearly standard normal number, without its tails: half the sum of twelve numbers between -1 and 1.
    pub(crate) fn bell(&mut self) -> f64 {
        0.5 * (0..12).map(|_| self.number()).sum::<f64>()
    }

    /// Returns a whole number from 0 to below `end`.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        self.0.usize(..end.max(1))
    }
}
