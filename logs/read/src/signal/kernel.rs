//! The filter of logs: a symmetric low-pass filter of finite length, and central differences.
//!
//! The ideal low-pass filter with a Kaiser window (A. V. Oppenheim, R. W. Schafer, "Discrete-Time Signal Processing",
//! 3rd ed., 2010, section 7.6; J. F. Kaiser, 1974): with the cut-off `f_c` and the step `T`,
//!
//! `h_k = 2 f_c T sinc(2 f_c T k) I0(β sqrt(1 − (k/M)²)) / I0(β)`, |k| ≤ M, divided by their sum.
//!
//! It passes frequencies below 2/3 f_c and stops those above 4/3 f_c, both up to a thousandth; at f_c the gain is one
//! half. It is symmetric, so its phase is zero. Derivatives are central differences of eighth order (B. Fornberg, 1988)
//! of the filtered numbers. For a sine, they are too small by less than the part (ωT)⁸/630.

use crate::limits::work;
use crate::signal::convolution::Convolution;

/// Attenuation of the stop band, dB: half a thousandth passes. The ripple of the pass band has the same size.
const ATTENUATION: f64 = 66.0;

/// Half the width of the transition band, as a part of the cut-off.
const HALF_TRANSITION: f64 = 1.0 / 3.0;

/// Weights of central differences of eighth order on the right; those on the left are their negatives.
const DIFFERENCES: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Number of weights on each side above which a filter is applied by Fourier transforms.
const WIDE: usize = 1024;

/// A symmetric filter.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    /// The weights from the middle outwards.
    weights: Vec<f64>,
    /// The convolution that applies the filter, if it is wide.
    convolution: Option<Convolution>,
    /// Step between numbers, s.
    step: f64,
}

/// The highest cut-off as a part of the sampling rate: its transition band ends at half the rate.
pub(crate) const HIGHEST: f64 = 0.5 / (1.0 + HALF_TRANSITION);

/// Ratio of the end of the pass band to the cut-off.
pub(crate) const PASSED: f64 = 1.0 - HALF_TRANSITION;

impl Kernel {
    /// Makes the low-pass filter with this cut-off, Hz, for this step, s.
    #[expect(clippy::cast_precision_loss, reason = "weights of a filter that is shorter than a run")]
    pub(crate) fn low_pass(cutoff: f64, step: f64) -> Self {
        use std::f64::consts::PI;
        let beta = 0.1102 * (ATTENUATION - 8.7);
        let half = Self::half_of(cutoff, step);
        let at = |k: usize| {
            let x = 2.0 * cutoff * step * k as f64;
            let sinc = if k == 0 { 1.0 } else { (PI * x).sin() / (PI * x) };
            let place = k as f64 / half as f64;
            sinc * bessel(beta * (1.0 - place * place).max(0.0).sqrt())
        };
        let weights: Vec<f64> = (0..=half).map(at).collect();
        let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
        let weights: Vec<f64> = weights.into_iter().map(|weight| weight / sum).collect();
        let convolution = (half > WIDE).then(|| Convolution::new(&weights));
        Self { weights, convolution, step }
    }

    /// Returns how many numbers on each side the low-pass filter with this cut-off, Hz, needs for this step, s. It is
    /// known before the filter is made, because a low cut-off may need more numbers than a run or the memory has.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it ends at the largest number")]
    pub(crate) fn half_of(cutoff: f64, step: f64) -> usize {
        let transition = 2.0 * std::f64::consts::PI * cutoff * step * 2.0 * HALF_TRANSITION;
        ((ATTENUATION - 8.0) / (2.285 * transition) / 2.0).ceil() as usize
    }

    /// Returns the lowest cut-off, Hz, whose low-pass filter needs at most `half` numbers on each side, for this step,
    /// s.
    #[expect(clippy::cast_precision_loss, reason = "states of a run")]
    pub(crate) fn lowest_of(half: usize, step: f64) -> f64 {
        (ATTENUATION - 8.0) / (2.285 * 2.0 * half as f64) / (2.0 * std::f64::consts::PI * step * 2.0 * HALF_TRANSITION)
    }

    /// Returns how many numbers on each side the low-pass filter needs.
    pub(crate) fn half(&self) -> usize {
        self.weights.len() - 1
    }

    /// Returns how many numbers on each side a difference needs.
    pub(crate) const fn of_difference() -> usize {
        DIFFERENCES.len()
    }

    /// Returns the number of which the length of a piece must be a multiple.
    pub(crate) fn block(&self) -> usize {
        self.convolution.as_ref().map_or(1, Convolution::block)
    }

    /// Returns how many numbers must follow the beginning of the last block, if the run has them, so that pieces
    /// give the same bits as the whole run.
    pub(crate) fn behind(&self) -> usize {
        self.convolution.as_ref().map_or(0, Convolution::length)
    }

    /// Returns the first `count` filtered numbers for which all neighbours are known, `half()` on each side.
    pub(crate) fn smooth(&self, numbers: &[f64], count: usize) -> Vec<f64> {
        let half = self.half();
        if let Some(convolution) = &self.convolution {
            return convolution.smooth(numbers, count);
        }
        work::add(count * half);
        // the order of additions does not depend on the beginning of a piece, so that pieces give the same bits as the
        // whole run
        let at = |window: &[f64]| {
            let pairs = (1..=half).map(|k| self.weights[k] * (window[half - k] + window[half + k]));
            self.weights[0] * window[half] + pairs.sum::<f64>()
        };
        numbers[..count + 2 * half].windows(2 * half + 1).map(at).collect()
    }

    /// Returns the derivative of the numbers for which all neighbours are known: four fewer at each end.
    pub(crate) fn differentiate(&self, numbers: &[f64]) -> Vec<f64> {
        let at = |window: &[f64]| {
            let pairs = (1..=4).map(|k| DIFFERENCES[k - 1] * (window[4 + k] - window[4 - k]));
            pairs.sum::<f64>() / self.step
        };
        numbers.windows(2 * DIFFERENCES.len() + 1).map(at).collect()
    }
}

/// Returns the modified Bessel function I0, by its series.
fn bessel(x: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 1.0;
    for k in 1..64 {
        term *= (x / 2.0 / f64::from(k)).powi(2);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Returns the gain of the filter at a frequency, Hz, which is real because the filter is symmetric.
    #[expect(clippy::cast_precision_loss, reason = "small")]
    fn gain(kernel: &Kernel, frequency: f64) -> f64 {
        let angle = 2.0 * PI * frequency * kernel.step;
        kernel.weights[0] + (1..=kernel.half()).map(|k| 2.0 * kernel.weights[k] * (angle * k as f64).cos()).sum::<f64>()
    }

    #[test]
    fn bands_are_passed_and_stopped_to_a_thousandth() {
        for (cutoff, rate) in [(10.0, 125.0), (5.0, 30.0), (6.0, 30.0), (2.0, 1000.0), (25.0, 125.0), (11.0, 30.0)] {
            let kernel = Kernel::low_pass(cutoff, 1.0 / rate);
            assert!((gain(&kernel, 0.0) - 1.0).abs() < 1e-14);
            for i in 0..=1000 {
                let passed = cutoff * PASSED * f64::from(i) / 1000.0;
                assert!((gain(&kernel, passed) - 1.0).abs() < 1e-3, "{cutoff} of {rate} at {passed}");
                let begin = cutoff * (1.0 + HALF_TRANSITION);
                let stopped = begin + (rate / 2.0 - begin) * f64::from(i) / 1000.0;
                assert!(gain(&kernel, stopped).abs() < 1e-3, "{cutoff} of {rate} at {stopped}");
            }
            assert!((gain(&kernel, cutoff) - 0.5).abs() < 0.01, "{}", gain(&kernel, cutoff));
        }
    }

    /// Fourier transforms give the same numbers as the direct sum, and the work hardly grows with the width of the
    /// filter.
    #[test]
    #[expect(clippy::cast_precision_loss, reason = "small")]
    fn wide_filters_are_applied_as_narrow_ones_are() {
        let mut random = fastrand::Rng::with_seed(5);
        for cutoff in [2.0, 0.7] {
            let wide = Kernel::low_pass(cutoff, 1e-3);
            assert!(wide.half() > WIDE, "{}", wide.half());
            let direct = Kernel { convolution: None, ..wide.clone() };
            let count = 2 * wide.block() + 77;
            let numbers: Vec<f64> =
                (0..count + 2 * wide.half()).map(|i| 3.0 + 1e-4 * i as f64 + random.f64()).collect();
            let (mut found, mut expected) = (Vec::new(), Vec::new());
            let work = work::of(|| found = wide.smooth(&numbers, count));
            let of_sums = work::of(|| expected = direct.smooth(&numbers, count));
            assert_eq!(found.len(), count);
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-13, "{found} {expected}");
            }
            assert!(work < 100 * count as u64 && of_sums == (count * wide.half()) as u64, "{work} {of_sums}");
            // a constant is unchanged to the last bit
            let still = vec![0.1; wide.behind()];
            assert!(wide.smooth(&still, 50).iter().all(|number| *number == 0.1));
        }
    }

    #[test]
    fn how_long_a_filter_is_is_known_before_it_is_made() {
        for (cutoff, step) in [(2.0, 0.01), (0.37, 0.008), (11.0, 0.04)] {
            let half = Kernel::half_of(cutoff, step);
            assert_eq!(Kernel::low_pass(cutoff, step).half(), half);
            let lowest = Kernel::lowest_of(half, step);
            assert!(lowest <= cutoff && Kernel::half_of(lowest * 1.001, step) <= half, "{lowest} {cutoff}");
            assert!(Kernel::half_of(lowest * 0.999, step) > half);
        }
        assert_eq!(Kernel::half_of(1e-300, 0.01), usize::MAX);
        assert_eq!(Kernel::lowest_of(0, 0.01), f64::INFINITY);
    }

    #[test]
    fn differences_are_the_derivative_to_their_order() {
        let kernel = Kernel::low_pass(10.0, 0.01);
        // exact for polynomials of degree 8
        let x = |i: i32| (f64::from(i) * 0.01).powi(8) - 3.0 * (f64::from(i) * 0.01).powi(5);
        let derivative = |t: f64| 8.0 * t.powi(7) - 15.0 * t.powi(4);
        let numbers: Vec<f64> = (96..=104).map(x).collect();
        let found = kernel.differentiate(&numbers);
        assert_eq!(found.len(), 1);
        assert!((found[0] - derivative(1.0)).abs() < 1e-10, "{}", found[0]);
        // the error for a sine is below the bound of the module's documentation
        for frequency in [1.0_f64, 5.0, 10.0, 15.0] {
            let w = 2.0 * PI * frequency;
            let numbers: Vec<f64> = (-4..=4).map(|i| (w * f64::from(i) * 0.01).sin()).collect();
            let relative = (kernel.differentiate(&numbers)[0] / w - 1.0).abs();
            assert!(relative <= (w * 0.01).powi(8) / 630.0 + 1e-12, "{frequency}: {relative}");
        }
    }

    #[test]
    fn bessel_is_that_of_tables() {
        // Abramowitz and Stegun, table 9.8, e^-x I0(x)
        for (x, scaled) in [(1.0_f64, 0.465_759_607_6), (5.0, 0.183_540_812_6)] {
            assert!((bessel(x) * (-x).exp() - scaled).abs() < 1e-10);
        }
    }
}
