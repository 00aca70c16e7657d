//! Steps of integrators and their derivatives, written once for both kinds of robots: over arrays if the number of
//! joints is known at compile time, otherwise over lists. Over arrays they allocate nothing, and no branch depends on a
//! number.

pub(crate) mod floating_integrator;
pub(crate) mod floating_runge_kutta;
pub(crate) mod runge_kutta;

use crate::Scalar;

/// A row of numbers: an array or a list.
pub trait Row<T>: AsRef<[T]> + AsMut<[T]> + Clone {}
impl<T, R: AsRef<[T]> + AsMut<[T]> + Clone> Row<T> for R {}

/// The indices of the derivatives with respect to q and q̇ in lists of derivatives with respect to q, q̇ and τ.
pub(crate) const POSITION: usize = 0;
pub(crate) const RATE: usize = 1;

/// Returns x + h · change, where each element has a step h of its own, because lists may contain the states of many
/// robots.
fn moved_by_each<T: Scalar, R: Row<T>>(x: &R, change: &R, step: impl Fn(usize) -> T) -> R {
    let mut next = x.clone();
    for (at, (x, &change)) in next.as_mut().iter_mut().zip(change.as_ref()).enumerate() {
        *x += step(at) * change;
    }
    next
}

/// Returns x + h · change.
pub fn moved<T: Scalar, R: Row<T>>(x: &R, change: &R, step: T) -> R {
    moved_by_each(x, change, |_| step)
}

/// Returns the derivatives of x + h · change with respect to q, q̇ and τ, from those of the change. x itself is q or
/// q̇, as `place` says.
pub(crate) fn moved_by<T: Scalar, R: Row<T>, M: Row<R>>(place: usize, change: &[M; 3], step: T) -> [M; 3] {
    let mut found = change.clone();
    for (kind, block) in found.iter_mut().enumerate() {
        for (joint, row) in block.as_mut().iter_mut().enumerate() {
            row.as_mut().iter_mut().for_each(|x| *x = step * *x);
            if kind == place {
                row.as_mut()[joint] += T::one();
            }
        }
    }
    found
}

/// Positions and velocities.
type State<R> = [R; 2];

/// Returns the four states at which the classical Runge-Kutta method evaluates the accelerations, and the accelerations
/// at the first three.
fn stages<T: Scalar, R: Row<T>, E>(
    accelerations: impl Fn(&R, &R) -> Result<R, E>,
    [q, qd]: [&R; 2],
    step: impl Fn(usize) -> T,
) -> Result<([State<R>; 4], [R; 3]), E> {
    let next = |[position, rate]: &State<R>, part: f64| {
        let acceleration = accelerations(position, rate)?;
        let duration = |at| step(at) * T::from_f64(part);
        Ok(([moved_by_each(q, rate, duration), moved_by_each(qd, &acceleration, duration)], acceleration))
    };
    let first = [q.clone(), qd.clone()];
    let (second, of_first) = next(&first, 0.5)?;
    let (third, of_second) = next(&second, 0.5)?;
    let (fourth, of_third) = next(&third, 1.0)?;
    Ok(([first, second, third, fourth], [of_first, of_second, of_third]))
}

/// Returns the changes of the mean velocity and of the velocity during a step, from the accelerations at the four
/// states.
fn weighted<T: Scalar, R: Row<T>>([first, second, third, fourth]: [&R; 4], step: impl Fn(usize) -> T) -> [R; 2] {
    let (mut mean, mut rates) = (first.clone(), first.clone());
    for (at, (mean, rates)) in mean.as_mut().iter_mut().zip(rates.as_mut()).enumerate() {
        let [first, second, third, fourth] = [first, second, third, fourth].map(|of_stage| of_stage.as_ref()[at]);
        let (middle, sixth) = (second + third, step(at) / T::from_f64(6.0));
        (*mean, *rates) = ((first + middle) * sixth, ((first + (middle + middle)) + fourth) * sixth);
    }
    [mean, rates]
}

/// Computes the step of [`RungeKuttaStep::runge_kutta_step`](crate::RungeKuttaStep::runge_kutta_step), with a function
/// that returns the accelerations at positions and velocities. Returns the next positions and the next velocities.
/// `step` is the duration for each element of the rows.
///
/// # Errors
/// The first error of the accelerations.
pub fn runge_kutta_step<T: Scalar, R: Row<T>, E>(
    accelerations: impl Fn(&R, &R) -> Result<R, E>,
    [q, qd]: [&R; 2],
    step: impl Fn(usize) -> T,
) -> Result<[R; 2], E> {
    let ([.., last], [first, second, third]) = stages(&accelerations, [q, qd], &step)?;
    let fourth = accelerations(&last[0], &last[1])?;
    let [mean, rates] = weighted([&first, &second, &third, &fourth], &step);
    Ok([moved_by_each(q, &moved(qd, &mean, T::one()), step), moved(qd, &rates, T::one())])
}

/// Computes the derivatives of [`RungeKuttaStepDerivatives::runge_kutta_step_derivatives`](
/// crate::RungeKuttaStepDerivatives::runge_kutta_step_derivatives), with functions that return the accelerations and
/// their derivatives with respect to q, q̇ and τ. Returns the derivatives of the next positions and of the next
/// velocities.
///
/// # Errors
/// The first error of the accelerations or of their derivatives.
pub fn runge_kutta_step_derivatives<T: Scalar, R: Row<T>, M: Row<R>, E>(
    accelerations: impl Fn(&R, &R) -> Result<R, E>,
    derivatives: impl Fn(&R, &R) -> Result<[M; 3], E>,
    state: [&R; 2],
    step: T,
) -> Result<[[M; 3]; 2], E> {
    let (states, _) = stages(accelerations, state, |_| step)?;
    let at = |stage: usize| derivatives(&states[stage][0], &states[stage][1]);
    let half = step * T::from_f64(0.5);
    let first = at(0)?;
    let second = chained(&at(1)?, half, &first, None);
    let third = chained(&at(2)?, half, &second, Some((half, &first)));
    let fourth = chained(&at(3)?, step, &third, Some((half, &second)));
    let [mut means, mut changes] = [first.clone(), first.clone()];
    for (kind, (means, changes)) in means.iter_mut().zip(&mut changes).enumerate() {
        for (row, (mean, change)) in means.as_mut().iter_mut().zip(changes.as_mut()).enumerate() {
            let of_stages = [&first, &second, &third, &fourth].map(|of_stage| &of_stage[kind].as_ref()[row]);
            [*mean, *change] = weighted(of_stages, |_| step);
        }
    }
    let [mean, rates] = [means, changes].map(|change| moved_by(RATE, &change, T::one()));
    Ok([moved_by(POSITION, &mean, step), rates])
}

/// Returns the derivatives of the accelerations at a state of the method with respect to the arguments of the step. The
/// chain rule needs the derivatives at the state before, whose accelerations moved the velocities, and at the one
/// before that, whose accelerations moved the positions.
fn chained<T: Scalar, R: Row<T>, M: Row<R>>(
    own: &[M; 3],
    duration: T,
    before: &[M; 3],
    earlier: Option<(T, &[M; 3])>,
) -> [M; 3] {
    let [by_position, by_rate, _] = own.each_ref().map(AsRef::as_ref);
    let mut found = own.clone();
    for (kind, block) in found.iter_mut().enumerate() {
        for (i, row) in block.as_mut().iter_mut().enumerate() {
            let mut change = by_position[i].clone();
            if kind != RATE {
                change.as_mut().fill(T::zero());
            }
            let mut add = |factor: T, by: &R| {
                change.as_mut().iter_mut().zip(by.as_ref()).for_each(|(sum, &by)| *sum += factor * by);
            };
            for (k, &by_rate) in by_rate[i].as_ref().iter().enumerate() {
                add(by_rate, &before[kind].as_ref()[k]);
                if let Some((duration, earlier)) = earlier {
                    add(by_position[i].as_ref()[k] * duration, &earlier[kind].as_ref()[k]);
                }
            }
            row.as_mut().iter_mut().zip(change.as_ref()).for_each(|(element, &change)| *element += duration * change);
        }
    }
    found
}
