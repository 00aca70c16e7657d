//! Random numbers from a seed, the same on every machine.

use fastrand::Rng;

pub(crate) struct Random(Rng);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Rng::with_seed(seed))
    }

    /// Between -1 and 1.
    pub(crate) fn number(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }

    /// A nearly standard normal number, without its tails: the sum of twelve numbers of variance 1/12.
    pub(crate) fn bell(&mut self) -> f64 {
        0.5 * (0..12).map(|_| self.number()).sum::<f64>()
    }

    /// Below a number.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        self.0.usize(..end.max(1))
    }
}
