//! The state of a momentum observer, from tick to tick.
//!
//! ```text
//! ṙ = K (τ_ext - r),   K = 2π gain                r is the external torque through a low-pass of the first order
//! τ_ext = ṗ - rate(q, q̇, τ),   p = M(q) q̇
//!
//! over a tick of length h, in the mean:
//! t   = (p - p₋) / h - ½ (rate + rate₋)           the trapezoidal rule; ₋ is the tick before
//! r   = r₋ + w (t - r₋),   w = 1 - e^(-K h)       exact where τ_ext is the same throughout the tick
//! ```
//!
//! After A. De Luca, R. Mattone (2003, 2005). Their integral of the rates grows without bound, so it is not formed.
//! Only its increments are used, so that old rounding errors decay like old torques, in `f32` too.

use core::array;

#[cfg(all(feature = "arm", feature = "std"))]
use crate::{Constant, DynArm, WrongLength};
use crate::{MomentumObserver, Scalar};

/// The shortest period of an observer, s.
const SHORTEST_PERIOD: f64 = 1e-30;

/// External torques without accelerations: what an observer knows from one tick of a controller to the next.
///
/// The torques are those of the environment on the arm, positive along the joint: a person who pushes joint i towards
/// larger q_i causes a positive number, and a wrench w that the environment exerts on the tip causes Jᵀ w. Everything
/// that the model lacks also appears in them: friction, unless it is subtracted from `tau`, and a payload.
///
/// ```
/// # struct Link;
/// # impl rne_runtime::MomentumObserver<1> for Link {
/// #     fn momentum_and_rate<T: rne_runtime::Scalar>(&self, _: &[T; 1], qd: &[T; 1], tau: &[T; 1])
/// #         -> rne_runtime::MomentumAndRate<1, T> {
/// #         rne_runtime::MomentumAndRate { momentum: [qd[0] + qd[0]], rate: *tau }
/// #     }
/// # }
/// # let robot = Link;
/// use rne_runtime::ObserverState;
///
/// let mut observer = ObserverState::new(20.0, 0.001); // 20 Hz, 1 kHz
/// let (q, qd, tau) = ([0.0], [0.0], [0.0]); // measured, every tick
/// let external = observer.update(&robot, &q, &qd, &tau); // N m
/// assert_eq!(external, [0.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObserverState<const DOF: usize, T> {
    momentum: [T; DOF],
    rate: [T; DOF],
    external: [T; DOF],
    /// The weight w at the next update; 0 at the first one, because no tick precedes it.
    next: T,
    weight: T,
    /// 1/h, Hz.
    frequency: T,
}

impl<const DOF: usize, T: Scalar> ObserverState<DOF, T> {
    /// An observer with a low-pass of `gain` Hz (its time constant is 1/(2π gain) s), updated every `period` s.
    ///
    /// It is stable and does not overshoot for every `gain` and `period` above zero: the larger the product of both,
    /// the nearer is what an update returns to the mean external torque of its tick. With a `gain` or a `period` that
    /// is not above zero, and with a `period` below 1e-30 s, the observer returns zeros. In single precision noise of
    /// rounding asks for a gain below a tenth of the rate of the ticks.
    #[must_use]
    pub fn new(gain: f64, period: f64) -> Self {
        let zeros = [T::zero(); DOF];
        let (weight, frequency) = tick(gain, period);
        Self { momentum: zeros, rate: zeros, external: zeros, next: T::zero(), weight, frequency }
    }

    /// One tick: positions, rates and torques of the actuators as they are measured at its end. Returns the external
    /// torques, N m or N. The first update after [`new`](Self::new) or [`reset`](Self::reset) only starts the observer,
    /// and returns zeros.
    ///
    /// If torques are commanded and then kept constant, `tau` has those that acted until now, and not the next ones.
    ///
    /// An update has no branch that looks at its numbers. After a sample that is not finite the external torques are
    /// not finite until [`reset`](Self::reset); a program whose sensors can give such samples skips the update then.
    #[inline]
    pub fn update<R: MomentumObserver<DOF>>(
        &mut self,
        robot: &R,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
    ) -> [T; DOF] {
        let now = robot.momentum_and_rate(q, qd, tau);
        let (frequency, weight) = (self.frequency, self.next);
        let external = array::from_fn(|i| {
            let [momentum, rate] = [[self.momentum[i], now.momentum[i]], [self.rate[i], now.rate[i]]];
            low_pass(self.external[i], momentum, rate, frequency, weight)
        });
        (self.momentum, self.rate, self.external, self.next) = (now.momentum, now.rate, external, self.weight);
        external
    }

    /// Forgets all earlier ticks: the next update is the first one again.
    pub fn reset(&mut self) {
        let zeros = [T::zero(); DOF];
        // momentum, rate and external torques too, because a number that is not finite remains so when it is multiplied
        // by zero
        (self.momentum, self.rate, self.external, self.next) = (zeros, zeros, zeros, T::zero());
    }

    /// The external torques of the last update, N m or N.
    #[must_use]
    pub const fn external_torques(&self) -> &[T; DOF] {
        &self.external
    }

    /// The momenta M(q) q̇ of the last update, N m s or N s.
    #[must_use]
    pub const fn momentum(&self) -> &[T; DOF] {
        &self.momentum
    }
}

/// Returns r of a joint from r at the tick before, and from momentum and rate, each as [before, now].
#[inline]
fn low_pass<T: Scalar>(before: T, momentum: [T; 2], rate: [T; 2], frequency: T, weight: T) -> T {
    let change = (momentum[1] - momentum[0]) * frequency;
    let mean = change - (rate[1] + rate[0]) * T::from_f64(0.5);
    before + (mean - before) * weight
}

/// Returns the weight w and the frequency 1/h of a tick of length h.
fn tick<T: Scalar>(gain: f64, period: f64) -> (T, T) {
    // for a shorter tick the frequency may not be finite, at least in single precision
    let (weight, frequency) = if period >= SHORTEST_PERIOD {
        (weight(core::f64::consts::TAU * gain * period), 1.0 / period)
    } else {
        (0.0, 0.0)
    };
    (T::from_f64(weight), T::from_f64(frequency))
}

/// [`ObserverState`] for a [`DynArm`], whose number of joints is known when the program runs.
#[cfg(all(feature = "arm", feature = "std"))]
#[derive(Clone, Debug, PartialEq)]
pub struct DynObserverState<T> {
    momentum: Vec<T>,
    rate: Vec<T>,
    external: Vec<T>,
    has_begun: bool,
    /// The gain, Hz, and the period, s, of [`Self::update`].
    gain: f64,
    period: f64,
}

#[cfg(all(feature = "arm", feature = "std"))]
impl<T: Scalar> DynObserverState<T> {
    /// Creates an observer as [`ObserverState::new`] does, for a number of joints.
    #[must_use]
    pub fn new(dof: usize, gain: f64, period: f64) -> Self {
        let zeros = vec![T::zero(); dof];
        Self { momentum: zeros.clone(), rate: zeros.clone(), external: zeros, has_begun: false, gain, period }
    }

    /// As [`ObserverState::update`].
    ///
    /// # Errors
    /// When an argument, or the arm, does not have one element per joint of the observer.
    pub fn update<S: Constant>(
        &mut self,
        arm: &DynArm<S>,
        q: &[T],
        qd: &[T],
        tau: &[T],
    ) -> Result<Vec<T>, WrongLength> {
        let now = arm.momentum_and_rate(q, qd, tau)?;
        self.advance(self.period, now.momentum, now.rate)
    }

    /// One tick of any length, `period` s after the tick before: as [`update`](Self::update), with the results of
    /// `momentum_and_rate` of an arm, of any implementation. The first tick begins and returns zeros; a `period` below
    /// 1e-30 s does not change the external torques.
    ///
    /// `momentum` is M(q) q̇, N m s or N s, and `rate` is τ + C(q, q̇)ᵀ q̇ - g(q), N m or N, base to tip. Returns the
    /// external torques, N m or N.
    ///
    /// # Errors
    /// When an argument does not have one element per joint of the observer.
    pub fn advance(&mut self, period: f64, momentum: Vec<T>, rate: Vec<T>) -> Result<Vec<T>, WrongLength> {
        let expected = self.external.len();
        if momentum.len() != expected {
            return Err(WrongLength { argument: "momentum", expected, found: momentum.len() });
        }
        if rate.len() != expected {
            return Err(WrongLength { argument: "rate", expected, found: rate.len() });
        }
        let (weight, frequency) = if self.has_begun { tick(self.gain, period) } else { (T::zero(), T::zero()) };
        for (i, external) in self.external.iter_mut().enumerate() {
            let both = [[self.momentum[i], momentum[i]], [self.rate[i], rate[i]]];
            *external = low_pass(*external, both[0], both[1], frequency, weight);
        }
        (self.momentum, self.rate, self.has_begun) = (momentum, rate, true);
        Ok(self.external.clone())
    }

    /// As [`ObserverState::reset`].
    pub fn reset(&mut self) {
        for list in [&mut self.momentum, &mut self.rate, &mut self.external] {
            list.fill(T::zero());
        }
        self.has_begun = false;
    }

    /// The external torques of the last update, base to tip.
    #[must_use]
    pub fn external_torques(&self) -> &[T] {
        &self.external
    }
}

/// 1 - e^(-x) for x ≥ 0, as s / (1 + s) with the series of s = e^x - 1 after a division of x by 2^n: `core` has no
/// exponential.
fn weight(x: f64) -> f64 {
    // without a gain, or for NaN
    if x.is_nan() || x <= 0.0 {
        return 0.0;
    }
    // for larger x, e^(-x) is below rounding
    if x >= 40.0 {
        return 1.0;
    }
    let (mut x, mut halved) = (x, 0);
    while x > 0.5 {
        x *= 0.5;
        halved += 1;
    }
    // e^x - 1 = x (1 + x/2 (1 + x/3 (…)))
    let mut s = 1.0;
    for k in (2..=18).rev() {
        s = 1.0 + s * x / f64::from(k);
    }
    s *= x;
    for _ in 0..halved {
        // (1 + s)² - 1
        s *= s + 2.0;
    }
    s / (1.0 + s)
}

#[cfg(test)]
mod tests {
    use super::weight;

    #[test]
    #[cfg(feature = "std")]
    fn the_weight_is_one_minus_an_exponential() {
        for x in [0.0_f64, 1e-12, 1e-3, 0.3, 0.5, 0.51, 1.0, 2.5, 7.0, 20.0, 39.9, 40.0, 1e9, f64::INFINITY] {
            let expected = -(-x).exp_m1();
            assert!((weight(x) - expected).abs() <= 4e-15 * expected, "{x}: {} is not {expected}", weight(x));
        }
    }
}
