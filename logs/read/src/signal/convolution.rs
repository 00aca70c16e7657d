//! Applies a wide symmetric filter by Fourier transforms: the cost for each number grows only with the logarithm of the
//! width.
//!
//! Overlap and save (A. V. Oppenheim, R. W. Schafer, "Discrete-Time Signal Processing", 3rd ed., 2010, section 8.7.3).

use std::fmt;
use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use crate::limits::work;

/// A filter with unit sum, which is applied in blocks from the first number on.
#[derive(Clone)]
pub(crate) struct Convolution {
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    /// The Fourier transform of the filter, which is real because the filter is symmetric.
    gains: Vec<f64>,
    /// Number of weights of the filter on each side of the middle.
    half: usize,
}

impl Convolution {
    /// Makes a convolution from the weights of a filter, from the middle outwards.
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

    /// Returns how many filtered numbers a block gives from [`Convolution::length`] numbers.
    pub(crate) fn block(&self) -> usize {
        self.length() - 2 * self.half
    }

    /// Returns how many input numbers a block needs.
    pub(crate) fn length(&self) -> usize {
        self.gains.len()
    }

    /// Returns the first `count` filtered numbers for which all neighbours are known. The last bits of a block's
    /// results depend on all its input. So pieces give the same bits as the whole only if each piece begins with a
    /// block, and has all input of its last block, or all numbers that exist.
    pub(crate) fn smooth(&self, numbers: &[f64], count: usize) -> Vec<f64> {
        let mut filtered = Vec::with_capacity(count.next_multiple_of(self.block()));
        let mut values = vec![Complex::default(); self.length()];
        while filtered.len() < count {
            let numbers = &numbers[filtered.len()..];
            // subtracts the first number, so that a constant is unchanged
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
            // the first result that has all neighbours is `half` numbers after the block's start
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
