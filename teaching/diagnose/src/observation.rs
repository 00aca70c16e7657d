//! The printed torques of another computation.

use rne_runtime::Wrench;

/// A state of an arm, and the torques of another tool, or of a calculation by hand, for it.
///
/// Lists run from base to tip. Revolute joints: rad, rad/s, rad/s², N m; prismatic joints: m, m/s, m/s², N.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Joint positions.
    pub q: Vec<f64>,
    /// Joint velocities.
    pub qd: Vec<f64>,
    /// Joint accelerations.
    pub qdd: Vec<f64>,
    /// The wrench that the last link exerts on its environment, at the tip, in tip axes; `None` for a free tip.
    pub wrench: Option<Wrench<f64>>,
    /// The torques in question.
    pub tau: Vec<f64>,
    /// Tolerance of each torque: at least half a unit of its last digit. In addition, rounding errors up to 1e-9 of the
    /// largest torque are allowed.
    pub resolution: Vec<f64>,
}

/// The largest tolerance for a pair of slips, as a part of the largest torque.
pub const COARSEST: f64 = 1e-3;

impl Observation {
    /// Returns a copy in which no tolerance exceeds [`COARSEST`] times the largest torque. Without this limit, some
    /// pairs of slips would agree by chance with torques of few digits.
    pub(crate) fn to_enough_digits(&self) -> Self {
        let most = COARSEST * largest(&self.tau);
        Self { resolution: self.resolution.iter().map(|half| half.min(most)).collect(), ..self.clone() }
    }

    /// Returns the number of decimal digits of all torques together, by the largest torque.
    pub(crate) fn digits(&self) -> f64 {
        let size = largest(&self.tau);
        self.resolution.iter().map(|half| (size / half.max(ROUNDING * size)).log10().max(0.0)).sum()
    }

    /// Whether torques agree with those of the observation within its tolerances.
    pub(crate) fn shows(&self, tau: &[f64]) -> bool {
        if tau.len() != self.tau.len() || tau.iter().any(|tau| !tau.is_finite()) {
            return false;
        }
        let rounding = ROUNDING * largest(&self.tau).max(largest(tau));
        let pairs = self.tau.iter().zip(tau).zip(&self.resolution);
        pairs.map(|((a, b), own)| (a - b).abs() - own).all(|excess| excess <= rounding)
    }

    /// Returns the largest difference from the torques, relative to the largest torque; infinite if a torque is not a
    /// number.
    pub(crate) fn error(&self, tau: &[f64]) -> f64 {
        if tau.iter().any(|tau| !tau.is_finite()) {
            return f64::INFINITY;
        }
        let size = largest(&self.tau).max(largest(tau));
        let differences: Vec<f64> = self.tau.iter().zip(tau).map(|(a, b)| a - b).collect();
        if size == 0.0 { 0.0 } else { largest(&differences) / size }
    }
}

/// The largest difference between two right computations, as a part of the largest torque.
const ROUNDING: f64 = 1e-9;

pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
}
