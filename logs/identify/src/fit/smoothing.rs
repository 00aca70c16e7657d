//! A low-pass filter of finite length and without delay. Filtering both sides of an equation keeps it valid.
//!
//! Measured torques are noisy, and robots smooth them before anybody logs them; friction that changes its sign is
//! sharp. So the torque and every column of the regressor pass the same filter: its kernel is Gaussian in time,
//! symmetrical, and has unit sum at every instant, also where samples are not evenly spaced. The parameters do not
//! change.
//!
//! M. Gautier, Dynamic identification of robots with power model, IEEE ICRA 1997 ("parallel filtering").

/// Number of standard deviations after which the kernel ends; 6e-5 of it is left out.
const REACH: f64 = 4.0;

/// A Gaussian kernel in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Kernel {
    /// Standard deviation, s.
    width: f64,
}

/// A kernel around one instant: the index of the first sample in reach, the weights of the samples, and their weights
/// for the slope.
#[derive(Clone, Debug, Default)]
pub(crate) struct Weights {
    pub(crate) start: usize,
    pub(crate) values: Vec<f64>,
    pub(crate) slopes: Vec<f64>,
}

impl Kernel {
    /// Makes the kernel that passes half the power at this frequency, Hz: |H(f)|² = exp(-4π² width² f²) = 1/2.
    pub(crate) fn of_cutoff(cutoff: f64) -> Self {
        Self { width: std::f64::consts::LN_2.sqrt() / (std::f64::consts::TAU * cutoff) }
    }

    /// Returns the width, s: instants that are closer than this give no new information.
    pub(crate) fn width(self) -> f64 {
        self.width
    }

    /// Returns the time before and after an instant that the kernel covers, s.
    pub(crate) fn reach(self) -> f64 {
        REACH * self.width
    }

    /// Returns the weights around an instant. The kernel is cut off at the first and last time.
    pub(crate) fn about(self, time: &[f64], instant: f64) -> Weights {
        let start = time.partition_point(|time| *time < instant - self.reach());
        let end = time.partition_point(|time| *time <= instant + self.reach());
        let taken = time.get(start..end).unwrap_or_default();
        let weigh = |time: &f64| (-0.5 * ((time - instant) / self.width).powi(2)).exp();
        let mut values: Vec<f64> = taken.iter().map(weigh).collect();
        let sum: f64 = values.iter().sum();
        if sum == 0.0 {
            return Weights::default();
        }
        for value in &mut values {
            *value /= sum;
        }
        // the derivative of the weights with respect to the instant, scaled so that a straight line gets its exact
        // slope, also where the kernel is cut off
        let mean: f64 = taken.iter().zip(&values).map(|(time, value)| (time - instant) * value).sum();
        let mut slopes: Vec<f64> =
            taken.iter().zip(&values).map(|(time, value)| (time - instant - mean) * value).collect();
        let spread: f64 = taken.iter().zip(&slopes).map(|(time, slope)| (time - instant) * slope).sum();
        if spread > 0.0 {
            for slope in &mut slopes {
                *slope /= spread;
            }
        }
        Weights { start, values, slopes }
    }
}

impl Weights {
    pub(crate) fn of(&self, values: &[f64]) -> f64 {
        weighted(&self.values, values.get(self.start..).unwrap_or_default())
    }

    pub(crate) fn slope_of(&self, values: &[f64]) -> f64 {
        weighted(&self.slopes, values.get(self.start..).unwrap_or_default())
    }
}

fn weighted(weights: &[f64], values: &[f64]) -> f64 {
    weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_the_power_passes_at_the_cutoff_and_slopes_are_slopes() {
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 0.002).collect();
        let wave = |frequency: f64| -> Vec<f64> {
            time.iter().map(|t| (std::f64::consts::TAU * frequency * (t - 4.0)).cos()).collect()
        };
        let kernel = Kernel::of_cutoff(3.0);
        let middle = kernel.about(&time, 4.0);
        assert!((middle.of(&wave(3.0)) - 0.5_f64.sqrt()).abs() < 1e-3);
        assert!((middle.of(&wave(0.0)) - 1.0).abs() < 1e-14);
        let line: Vec<f64> = time.iter().map(|t| 0.3 + 2.0 * t).collect();
        assert!((middle.slope_of(&line) - 2.0).abs() < 1e-11);
        assert!((middle.of(&line) - 8.3).abs() < 1e-12);
    }
}
