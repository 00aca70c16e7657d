//! The step of the classical Runge-Kutta method, and its derivatives by the state and by the torques, for every robot
//! that has the accelerations and their derivatives. They allocate nothing, and no branch depends on a number.

use core::array::from_fn;

use crate::integrator::{Blocks, POSITION, RATE, moved, moved_by, named};
use crate::{
    AccelerationDerivatives, ForwardDynamics, ForwardDynamicsDerivatives, NextState, NextStateDerivatives, Scalar,
};

/// A step of the classical Runge-Kutta method under torques that do not change during the step. Every type with
/// [`ForwardDynamics`] has it.
///
/// `step` is the duration h, s. The tip is free, and joints have no friction and no limits. A singular mass matrix (a
/// joint that moves nothing) gives numbers that are not finite.
///
/// ```
/// use rne_runtime::{ForwardDynamics, RungeKuttaStep, Scalar};
///
/// /// A mass of 2 kg on a slide.
/// struct Slide;
/// impl ForwardDynamics<1> for Slide {
///     fn forward_dynamics<T: Scalar>(&self, _: &[T; 1], _: &[T; 1], &[force]: &[T; 1]) -> [T; 1] {
///         [force / T::from_f64(2.0)]
///     }
/// }
///
/// // from rest under 4 N for 0.5 s: x = ½ a t² = 0.25 m
/// let next = Slide.runge_kutta_step(&[0.0], &[0.0], &[4.0], 0.5);
/// assert_eq!((next.q, next.qd), ([0.25], [1.0]));
/// ```
pub trait RungeKuttaStep<const DOF: usize>: ForwardDynamics<DOF> {
    /// A step of the classical Runge-Kutta method, with the accelerations at four states. The error of a motion is of
    /// order h⁴.
    ///
    /// The velocities at the four states are known by the accelerations before, so with q̈₁ to q̈₄ at these states q̇' =
    /// q̇ + h (q̈₁ + 2 q̈₂ + 2 q̈₃ + q̈₄) / 6 and q' = q + h (q̇ + h (q̈₁ + q̈₂ + q̈₃) / 6).
    #[must_use]
    fn runge_kutta_step<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], tau: &[T; DOF], step: T) -> NextState<DOF, T> {
        let states = stages(self, [q, qd, tau], step);
        let last = self.forward_dynamics(&states[3].0, &states[3].1, tau);
        // the accelerations at the first three states are those of the next ones
        let [first, second, third] = [1, 2, 3].map(|stage: usize| states[stage].2);
        let [mean, rates] = weighted([&first, &second, &third, &last], step);
        let mean: [T; DOF] = from_fn(|i| qd[i] + mean[i]);
        NextState { q: moved(q, &mean, step), qd: from_fn(|i| qd[i] + rates[i]) }
    }
}

impl<const DOF: usize, R: ForwardDynamics<DOF>> RungeKuttaStep<DOF> for R {}

/// Derivatives of the step of [`RungeKuttaStep`], for optimisers. Every type with [`ForwardDynamics`] and
/// [`ForwardDynamicsDerivatives`] has them.
///
/// They are exact up to rounding: the chain rule over the four states at which the step has the accelerations.
pub trait RungeKuttaStepDerivatives<const DOF: usize>: ForwardDynamics<DOF> + ForwardDynamicsDerivatives<DOF> {
    /// The derivatives of [`runge_kutta_step`](RungeKuttaStep::runge_kutta_step) by q, q̇ and τ, from those of the
    /// accelerations at its four states, and five products of matrices of `DOF` rows and 3 `DOF` columns.
    #[must_use]
    fn runge_kutta_step_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        step: T,
    ) -> NextStateDerivatives<DOF, T> {
        let states = stages(self, [q, qd, tau], step);
        let at = |stage: usize| self.forward_dynamics_derivatives(&states[stage].0, &states[stage].1, tau);
        let half = step * T::from_f64(0.5);
        let first = blocks(at(0));
        let second = chained(&at(1), half, &first, None);
        let third = chained(&at(2), half, &second, Some((half, &first)));
        let fourth = chained(&at(3), step, &third, Some((half, &second)));
        let mut of_means = [[[[T::zero(); DOF]; DOF]; 3]; 2];
        for kind in 0..3 {
            for row in 0..DOF {
                let found = weighted([&first, &second, &third, &fourth].map(|of_stage| &of_stage[kind][row]), step);
                [of_means[0][kind][row], of_means[1][kind][row]] = found;
            }
        }
        let [mean, rates] = of_means.map(|change| moved_by(RATE, &change, T::one()));
        NextStateDerivatives { q: named(moved_by(POSITION, &mean, step)), qd: named(rates) }
    }
}

impl<const DOF: usize, R> RungeKuttaStepDerivatives<DOF> for R where
    R: ForwardDynamics<DOF> + ForwardDynamicsDerivatives<DOF>
{
}

/// The four states at which the classical Runge-Kutta method has the accelerations: positions, velocities, and the
/// accelerations at the state before, from which they follow.
fn stages<const DOF: usize, T: Scalar, R: ForwardDynamics<DOF> + ?Sized>(
    robot: &R,
    [q, qd, tau]: [&[T; DOF]; 3],
    step: T,
) -> [([T; DOF], [T; DOF], [T; DOF]); 4] {
    let half = step * T::from_f64(0.5);
    let mut states = [(*q, *qd, [T::zero(); DOF]); 4];
    for (before, duration) in [half, half, step].into_iter().enumerate() {
        let (position, rate, _) = states[before];
        let acceleration = robot.forward_dynamics(&position, &rate, tau);
        states[before + 1] = (moved(q, &rate, duration), moved(qd, &acceleration, duration), acceleration);
    }
    states
}

/// The changes of the mean velocity of a step, and of the velocity, by four accelerations.
fn weighted<const DOF: usize, T: Scalar>(of_stages: [&[T; DOF]; 4], step: T) -> [[T; DOF]; 2] {
    let [first, second, third, fourth] = of_stages;
    let sixth = step / T::from_f64(6.0);
    let middle: [T; DOF] = from_fn(|i| second[i] + third[i]);
    [
        from_fn(|i| (first[i] + middle[i]) * sixth),
        from_fn(|i| ((first[i] + (middle[i] + middle[i])) + fourth[i]) * sixth),
    ]
}

fn blocks<const DOF: usize, T>(found: AccelerationDerivatives<DOF, T>) -> Blocks<DOF, T> {
    [found.dq, found.dqd, found.dtau]
}

/// The derivatives of the accelerations at a state by those of the step's arguments. The velocities of this state are
/// q̇ + `duration` times the accelerations `before`. Its positions are q + `duration` times the velocities of the state
/// before, which are q̇, or q̇ + a duration times the accelerations at the state `earlier`.
fn chained<const DOF: usize, T: Scalar>(
    own: &AccelerationDerivatives<DOF, T>,
    duration: T,
    before: &Blocks<DOF, T>,
    earlier: Option<(T, &Blocks<DOF, T>)>,
) -> Blocks<DOF, T> {
    let mut found = [own.dq, own.dqd, own.dtau];
    for (kind, block) in found.iter_mut().enumerate() {
        for (i, row) in block.iter_mut().enumerate() {
            let mut change = if kind == RATE { own.dq[i] } else { [T::zero(); DOF] };
            for k in 0..DOF {
                let by_position = earlier.map(|(duration, earlier)| (own.dq[i][k] * duration, &earlier[kind][k]));
                for (j, change) in change.iter_mut().enumerate() {
                    *change += own.dqd[i][k] * before[kind][k][j];
                    if let Some((factor, earlier)) = by_position {
                        *change += factor * earlier[j];
                    }
                }
            }
            for (element, change) in row.iter_mut().zip(change) {
                *element += duration * change;
            }
        }
    }
    found
}
