//! From a rate of false alarms to thresholds.
//!
//! Every test of every joint gets the same share of the rate: the more joints there are, the higher are the thresholds
//! of each. Noise is taken to be normal, as large as the baseline says; what a baseline says changes along a motion,
//! with what the model leaves open: [`ModelError`](crate::ModelError).
//!
//! ```text
//! k deviations for a time of hold      the rate of alarms is at most 2 Q(k) / hold
//! cumulative sum above h               the mean time between alarms is (e^(2 K H) - 1 - 2 K H) / (4 K²) blocks,
//!                                      K = 1/2, H = h + 1.166
//! ```
//!
//! The first is a bound whatever the spectrum of the noise: who stays above for a time of hold is above at one of any
//! instants that are a hold apart. The second is D. Siegmund's approximation (1985) for independent numbers of
//! deviation 1, halved for both signs; the numbers are means of blocks that are longer than the noise remembers.

use crate::Settings;

/// The allowance of a cumulative sum: half of the offset that it finds soonest, in deviations.
pub(crate) const ALLOWANCE: f64 = 0.5;

/// Tests of a joint.
const TESTS: f64 = 3.0;

/// Thresholds in deviations of the baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Thresholds {
    /// The threshold of the observer, in deviations, for the time of hold.
    pub external: f64,
    /// The thresholds of the cumulative sums, in deviations of a block: [of the offset, of the friction].
    pub sums: [f64; 2],
}

impl Thresholds {
    /// The thresholds of one of `dof` joints, by the duration of its blocks, s: [of the offset, of the friction].
    pub(crate) fn new(settings: &Settings, dof: usize, blocks: [f64; 2]) -> Self {
        #[allow(clippy::cast_precision_loss)] // at most 64 joints
        let share = settings.false_alarms / (TESTS * dof.max(1) as f64);
        let per_second = share / 3600.0;
        let external = quantile(0.5 * per_second * settings.hold);
        Self { external, sums: blocks.map(|block| of_sum(1.0 / (per_second * block))) }
    }
}

/// The threshold h at which a number of blocks pass between two alarms, in the mean.
fn of_sum(blocks: f64) -> f64 {
    let between = |h: f64| {
        let twice = 2.0 * ALLOWANCE * (h + 1.166);
        (twice.exp() - 1.0 - twice) / (4.0 * ALLOWANCE * ALLOWANCE)
    };
    bisect(|h| between(h) < blocks, 0.0, 200.0)
}

/// The k with Q(k) = p, for p below a half: noise of deviation 1 is above it with this probability.
fn quantile(p: f64) -> f64 {
    bisect(|k| 0.5 * libm::erfc(k * std::f64::consts::FRAC_1_SQRT_2) > p, 0.0, 38.0)
}

/// Where `is_below` turns false.
fn bisect(is_below: impl Fn(f64) -> bool, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::{of_sum, quantile};

    #[test]
    fn quantiles_are_those_of_tables() {
        for (p, k) in [(0.5, 0.0), (0.158_655_254, 1.0), (0.022_750_132, 2.0), (2.866_515_7e-7, 5.0)] {
            assert!((quantile(p) - k).abs() < 1e-7, "{p}: {}", quantile(p));
        }
    }

    /// For two sides with K = 1/2: h = 4 has 168, h = 5 has 465 in the mean, as in tables of control charts.
    #[test]
    fn sums_are_those_of_tables() {
        for (blocks, h) in [(168.0, 4.0), (465.0, 5.0)] {
            assert!((of_sum(blocks) - h).abs() < 0.02, "{blocks}: {}", of_sum(blocks));
        }
    }
}
