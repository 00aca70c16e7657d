//! A wide symmetric filter by Fourier transforms: the cost for each number grows with the logarithm of the width only.
//!
//! Overlap and save (A. V. Oppenheim, R. W. Schafer, "Discrete-Time Signal Processing", 3rd ed., 2010, section 8.7.3).

use std::fmt;
use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use crate::limits::work;

/// A filter whose sum is one, by blocks that begin at the first number.
#[derive(Clone)]
pub(crate) struct Convolution {
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    /// The transform of the filter; it is real, for the filter is symmetric.
    gains: Vec<f64>,
    /// How many numbers on each side the filter has.
    half: usize,
}

impl Convolution {
    /// Makes a convolution of a filter's weights, from the middle outwards.
    pub(crate) fn new(weights: &[f64]) -> Self {
        let half = weights.len() - 1;
        let length = (3 * half).next_power_of_two();
        let mut planner = FftPlanner::new();
        let forward = planner.plan_fft_forward(length);
        let mut values = vec![Complex::default(); length];
        for (k, weight) in weights.iter().enumerate() {
            values[k] = Complex::new(*weight, 0.0);
            values[(length - k) % length] = values[k];
        }
        forward.process(&mut values);
        #[expect(clippy::cast_precision_loss, reason = "a power of two")]
        let gains = values.iter().map(|value| value.re / length as f64).collect();
        Self { forward, inverse: planner.plan_fft_inverse(length), gains, half }
    }

    /// Numbers that a block makes of [`Convolution::length`] numbers.
    pub(crate) fn block(&self) -> usize {
        self.length() - 2 * self.half
    }

    /// Numbers that a block is made of.
    pub(crate) fn length(&self) -> usize {
        self.gains.len()
    }

    /// The first `count` numbers that have all their neighbours, filtered. What a block makes depends on all that it is
    /// made of, in the last bits: pieces are the whole where each begins with a block, and has what its last block is
    /// made of, or all that there is.
    pub(crate) fn smooth(&self, numbers: &[f64], count: usize) -> Vec<f64> {
        let mut filtered = Vec::with_capacity(count.next_multiple_of(self.block()));
        let mut values = vec![Complex::default(); self.length()];
        while filtered.len() < count {
            let numbers = &numbers[filtered.len()..];
            // what stands still stays as it is
            let level = numbers[0];
            values.fill(Complex::default());
            for (value, number) in values.iter_mut().zip(numbers) {
                value.re = number - level;
            }
            work::add(self.length() * self.length().ilog2() as usize);
            self.forward.process(&mut values);
            for (value, gain) in values.iter_mut().zip(&self.gains) {
                *value *= gain;
            }
            self.inverse.process(&mut values);
            // the first number that has all its neighbours is the middle of the first of them
            filtered.extend(values[self.half..][..self.block()].iter().map(|value| value.re + level));
        }
        filtered.truncate(count);
        filtered
    }
}

impl fmt::Debug for Convolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Convolution").field("half", &self.half).field("length", &self.length()).finish_non_exhaustive()
    }
}
