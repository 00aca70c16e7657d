//! Periodic motions from rest to rest: a finite Fourier series for each joint.
//!
//! ```text
//! q(t) = c + Σ (a_k sin kωt - b_k cos kωt) / kω      q̇(t) = Σ a_k cos kωt + b_k sin kωt
//! ```
//!
//! J. Swevers, C. Ganseman, D. Bilgin Tükel, J. De Schutter, H. Van Brussel, Optimal robot excitation and
//! identification, IEEE Transactions on Robotics and Automation 13(5), 1997, 730-740.
//!
//! A period starts and ends at rest, without acceleration, if Σ a_k = 0 and Σ k b_k = 0: coefficients are projected
//! onto these conditions.

use std::f64::consts::{PI, TAU};

use rne_runtime::Scalar;

/// Number of points in a period, for each harmonic, at which extremes are searched.
const DENSE: usize = 64;

/// A periodic motion of all joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Fourier {
    /// Period, s.
    period: f64,
    joints: Vec<Series>,
}

/// The Fourier series of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The centre c, rad or m.
    pub centre: f64,
    /// The coefficients a_k from k = 1 on, rad/s or m/s.
    pub a: Vec<f64>,
    /// The coefficients b_k from k = 1 on, rad/s or m/s.
    pub b: Vec<f64>,
}

/// Bounds of a joint's motion at any time, not only at samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionBounds {
    /// Lower bound of the position, rad or m.
    pub lower: f64,
    /// Upper bound of the position, rad or m.
    pub upper: f64,
    /// Upper bound of the speed, rad/s or m/s.
    pub velocity: f64,
    /// Upper bound of the magnitude of the acceleration, rad/s² or m/s².
    pub acceleration: f64,
}

/// Sines and cosines of the angles that divide a turn into equal parts.
#[derive(Clone, Debug)]
pub(crate) struct Grid(Vec<(f64, f64)>);

impl Grid {
    pub(crate) fn new(points: usize) -> Self {
        #[allow(clippy::cast_precision_loss)] // some hundreds
        let angle = |point: usize| TAU * point as f64 / points as f64;
        Self((0..points).map(|point| Scalar::sin_cos(angle(point))).collect())
    }

    /// Makes a grid whose points have the extremes of a series with this number of harmonics, up to the factor
    /// [`beyond`].
    pub(crate) fn dense(harmonics: usize) -> Self {
        Self::new(DENSE * harmonics)
    }

    pub(crate) fn points(&self) -> usize {
        self.0.len()
    }

    /// Returns sine and cosine of a multiple of a point's angle.
    fn at(&self, point: usize, multiple: usize) -> (f64, f64) {
        self.0[point * multiple % self.0.len()]
    }
}

/// Returns the factor by which the largest magnitude of a series may exceed that at the points of the dense grid.
///
/// Near the point t* where a trigonometric polynomial p of degree N has its largest magnitude, its magnitude is at
/// least ‖p‖ cos N(t - t*) up to a quarter of that wave (M. Riesz, Jahresber. DMV 23, 1914). One of M points is within
/// π / M of t*, so ‖p‖ is at most the largest magnitude at a point over cos(πN / M).
pub(crate) fn beyond() -> f64 {
    #[allow(clippy::cast_precision_loss)]
    let half_step = PI / DENSE as f64;
    1.0 / half_step.cos()
}

impl Series {
    /// Returns the series nearest to these coefficients that is at rest, without acceleration, at the start of the
    /// period. The longer of the two lists determines the number of harmonics.
    #[must_use]
    pub fn at_rest(centre: f64, mut a: Vec<f64>, mut b: Vec<f64>) -> Self {
        let harmonics = a.len().max(b.len());
        a.resize(harmonics, 0.0);
        b.resize(harmonics, 0.0);
        #[allow(clippy::cast_precision_loss)] // some dozens
        let count = harmonics.max(1) as f64;
        let mean = a.iter().sum::<f64>() / count;
        for a in &mut a {
            *a -= mean;
        }
        let squares: f64 = numbers().take(harmonics).map(|k| k * k).sum();
        let along = b.iter().zip(numbers()).map(|(b, k)| k * b).sum::<f64>() / squares.max(1.0);
        for (b, k) in b.iter_mut().zip(numbers()) {
            *b -= k * along;
        }
        Self { centre, a, b }
    }

    /// Scales the motion about its centre.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let scaled = |list: &[f64]| list.iter().map(|x| x * factor).collect();
        Self { centre: self.centre, a: scaled(&self.a), b: scaled(&self.b) }
    }

    /// Returns position without the centre, velocity and acceleration. `wave` returns sine and cosine of kωt for each
    /// k.
    fn state(&self, frequency: f64, wave: impl Fn(usize) -> (f64, f64)) -> [f64; 3] {
        let mut state = [0.0; 3];
        for (index, ((a, b), k)) in self.a.iter().zip(&self.b).zip(numbers()).enumerate() {
            let (sin, cos) = wave(index + 1);
            let omega = k * frequency;
            state[0] += (a * sin - b * cos) / omega;
            state[1] += a * cos + b * sin;
            state[2] += omega * (b * cos - a * sin);
        }
        state
    }

    /// Returns positions without the centre, velocities and accelerations at the points of a grid.
    pub(crate) fn on(&self, grid: &Grid, period: f64) -> Vec<[f64; 3]> {
        let frequency = TAU / period;
        (0..grid.points()).map(|point| self.state(frequency, |k| grid.at(point, k))).collect()
    }
}

/// Returns the numbers 1, 2, 3 and so on.
fn numbers() -> impl Iterator<Item = f64> {
    std::iter::successors(Some(1.0), |k| Some(k + 1.0))
}

impl Fourier {
    /// Makes a motion from its period, s, and the series of each joint, base to tip.
    #[must_use]
    pub fn new(period: f64, joints: Vec<Series>) -> Self {
        Self { period, joints }
    }

    /// The period, s.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.period
    }

    /// The series of each joint.
    #[must_use]
    pub fn joints(&self) -> &[Series] {
        &self.joints
    }

    /// Returns positions, velocities and accelerations of all joints after a number of periods, which need not be
    /// whole.
    #[must_use]
    pub fn after(&self, periods: f64) -> [Vec<f64>; 3] {
        let frequency = TAU / self.period;
        let part = periods - periods.floor();
        let wave = |k: usize| {
            #[allow(clippy::cast_precision_loss)] // some dozens
            let turns = part * k as f64;
            Scalar::sin_cos(TAU * (turns - turns.floor()))
        };
        let mut state = [const { Vec::new() }; 3];
        for series in &self.joints {
            let [q, qd, qdd] = series.state(frequency, wave);
            // the coefficients are projected so that these are 0, except for rounding
            let (qd, qdd) = if part == 0.0 { (0.0, 0.0) } else { (qd, qdd) };
            for (list, value) in state.iter_mut().zip([series.centre + q, qd, qdd]) {
                list.push(value);
            }
        }
        state
    }

    /// Returns bounds of the position, speed and acceleration of each joint over the whole motion. They exceed the true
    /// extremes by a thousandth at most.
    #[must_use]
    pub fn bounds(&self) -> Vec<MotionBounds> {
        let harmonics = self.joints.iter().map(|series| series.a.len()).max().unwrap_or(0).max(1);
        let grid = Grid::dense(harmonics);
        let state = |series: &Series| {
            let states = series.on(&grid, self.period);
            let (lowest, highest) = range(&states);
            let (middle, half) = (f64::midpoint(lowest, highest), 0.5 * (highest - lowest) * beyond());
            MotionBounds {
                lower: series.centre + middle - half,
                upper: series.centre + middle + half,
                velocity: largest(&states, 1) * beyond(),
                acceleration: largest(&states, 2) * beyond(),
            }
        };
        self.joints.iter().map(state).collect()
    }
}

/// Returns the lowest and highest position of states.
pub(crate) fn range(states: &[[f64; 3]]) -> (f64, f64) {
    let positions = states.iter().map(|state| state[0]);
    (positions.clone().fold(f64::INFINITY, f64::min), positions.fold(f64::NEG_INFINITY, f64::max))
}

/// Returns the largest magnitude of a derivative of states.
pub(crate) fn largest(states: &[[f64; 3]], derivative: usize) -> f64 {
    states.iter().fold(0.0, |most, state| state[derivative].abs().max(most))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motions::random::Random;

    fn random(random: &mut Random, harmonics: usize) -> Series {
        let mut list = || (0..harmonics).map(|_| random.number()).collect::<Vec<f64>>();
        let (a, b) = (list(), list());
        Series::at_rest(random.number(), a, b)
    }

    #[test]
    fn a_period_starts_and_ends_at_rest() {
        let mut numbers = Random::new(1);
        for harmonics in 2..12 {
            let motion = Fourier::new(3.7, vec![random(&mut numbers, harmonics)]);
            let series = &motion.joints()[0];
            let [_, qd, qdd] = series.state(TAU / 3.7, |_| (0.0, 1.0));
            assert!(qd.abs() < 1e-14 && qdd.abs() < 1e-12, "{qd} {qdd}");
            let [start, end] = [0.0, 1.0].map(|periods| motion.after(periods));
            assert_eq!(start, end);
            assert_eq!([&start[1], &start[2]], [&vec![0.0], &vec![0.0]]);
            // the velocity is continuous at the end of a period
            let [_, near, _] = motion.after(1e-9);
            assert!(near[0].abs() < 1e-12, "{near:?}");
        }
        // one harmonic gives no motion
        let still = random(&mut numbers, 1);
        assert_eq!((still.a[0], still.b[0]), (0.0, 0.0));
    }

    /// Compares derivatives with finite differences of the positions.
    #[test]
    fn rates_are_rates() {
        let mut numbers = Random::new(2);
        let motion = Fourier::new(5.0, vec![random(&mut numbers, 6), random(&mut numbers, 6)]);
        let step = 1e-5;
        for at in [0.1, 1.3, 2.2, 3.9, 4.7] {
            let [before, here, after] = [at - step, at, at + step].map(|time| motion.after(time / 5.0));
            for joint in 0..2 {
                for derivative in 0..2 {
                    let slope = (after[derivative][joint] - before[derivative][joint]) / (2.0 * step);
                    assert!((slope - here[derivative + 1][joint]).abs() < 1e-7, "{slope} {here:?}");
                }
            }
        }
    }

    #[test]
    fn bounds_hold_between_samples_and_are_no_wider_than_they_must_be() {
        let mut numbers = Random::new(3);
        for harmonics in 2..9 {
            let motion = Fourier::new(2.0, vec![random(&mut numbers, harmonics)]);
            let bounds = motion.bounds()[0];
            let fine = motion.joints()[0].on(&Grid::new(50 * DENSE * harmonics), 2.0);
            let (lowest, highest) = range(&fine);
            let centre = motion.joints()[0].centre;
            let [velocity, acceleration] = [1, 2].map(|derivative| largest(&fine, derivative));
            assert!(bounds.lower <= centre + lowest && bounds.upper >= centre + highest, "{bounds:?}");
            assert!(bounds.velocity >= velocity && bounds.acceleration >= acceleration, "{bounds:?}");
            assert!(bounds.upper - bounds.lower <= 1.002 * (highest - lowest));
            assert!(bounds.velocity <= 1.002 * velocity && bounds.acceleration <= 1.002 * acceleration);
        }
    }
}
