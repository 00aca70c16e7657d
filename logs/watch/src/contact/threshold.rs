//! Computes the threshold of contacts from a rate of false alarms.
//!
//! Every joint gets the same share of the rate: the more joints there are, the higher is the threshold of each. Noise
//! is assumed to be normal, with the standard deviation of [`ContactNoise`](crate::ContactNoise), which changes along a
//! motion with the error of the model.
//!
//! If a signal must stay above k standard deviations for the time `hold`, the rate of false alarms is at most 2 Q(k) /
//! hold, where Q is the upper tail of the normal distribution. This bound is valid for noise of any spectrum: a signal
//! that stays above for this time is above at one of the instants of any grid with this step.

use crate::Settings;

/// Returns the threshold of one of `dof` joints, in standard deviations.
pub(super) fn threshold(settings: &Settings, dof: usize) -> f64 {
    #[allow(clippy::cast_precision_loss)] // at most 64 joints
    let share = settings.false_alarms / dof.max(1) as f64;
    quantile(0.5 * share / 3600.0 * settings.hold)
}

/// Returns the k with Q(k) = p, for p below a half: noise with standard deviation 1 is above k with this probability.
fn quantile(p: f64) -> f64 {
    bisect(|k| 0.5 * libm::erfc(k * std::f64::consts::FRAC_1_SQRT_2) > p, 0.0, 38.0)
}

/// Returns the number between `low` and `high` from which on `is_below` is false.
fn bisect(is_below: impl Fn(f64) -> bool, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::quantile;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (p, k) in [(0.5, 0.0), (0.158_655_254, 1.0), (0.022_750_132, 2.0), (2.866_515_7e-7, 5.0)] {
            assert!((quantile(p) - k).abs() < 1e-7, "{p}: {}", quantile(p));
        }
    }
}
