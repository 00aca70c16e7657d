//! Steps of integrators over lists, in the order of operations of those over arrays: of a [`DynArm`](crate::DynArm),
//! and of any other robot whose number of joints is known at run time only.

use crate::Scalar;
#[cfg(feature = "arm")]
use crate::{Constant, DynArm, WrongLength};

/// A matrix by rows.
type Matrix<T> = Vec<Vec<T>>;

/// The derivatives by q, by q̇ and by τ.
type Blocks<T> = [Matrix<T>; 3];

/// x + h times what changes it, with an h of each place: lists may have the states of many robots.
fn moved<T: Scalar>(x: &[T], change: &[T], step: impl Fn(usize) -> T) -> Vec<T> {
    x.iter().zip(change).enumerate().map(|(at, (&x, &change))| x + step(at) * change).collect()
}

/// The derivatives of x + h times what changes it, where x is the argument of this place.
fn moved_by<T: Scalar>(place: usize, change: &Blocks<T>, step: T) -> Blocks<T> {
    let times = |matrix: &Matrix<T>| matrix.iter().map(|row| row.iter().map(|&x| step * x).collect()).collect();
    let mut found: Blocks<T> = change.each_ref().map(times);
    for (joint, row) in found[place].iter_mut().enumerate() {
        if let Some(own) = row.get_mut(joint) {
            *own += T::one();
        }
    }
    found
}

/// Positions, velocities, and the accelerations at the state before, from which they follow.
type Stage<T> = [Vec<T>; 3];

/// The four states at which the classical Runge-Kutta method has the accelerations.
fn stages<T: Scalar, E>(
    accelerations: impl Fn(&[T], &[T]) -> Result<Vec<T>, E>,
    [q, qd]: [&[T]; 2],
    step: impl Fn(usize) -> T,
) -> Result<[Stage<T>; 4], E> {
    let next = |[position, rate, _]: &Stage<T>, part: f64| {
        let acceleration = accelerations(position, rate)?;
        let duration = |at| step(at) * T::from_f64(part);
        Ok([moved(q, rate, duration), moved(qd, &acceleration, duration), acceleration])
    };
    let first = [q.to_vec(), qd.to_vec(), Vec::new()];
    let second = next(&first, 0.5)?;
    let third = next(&second, 0.5)?;
    let fourth = next(&third, 1.0)?;
    Ok([first, second, third, fourth])
}

/// The changes of the mean velocity of a step, and of the velocity, by four accelerations.
fn weighted<T: Scalar>([first, second, third, fourth]: [&[T]; 4], step: impl Fn(usize) -> T) -> [Vec<T>; 2] {
    let rows = first.iter().zip(second).zip(third.iter().zip(fourth)).enumerate();
    let both = rows.map(|(at, ((&first, &second), (&third, &fourth)))| {
        let (middle, sixth) = (second + third, step(at) / T::from_f64(6.0));
        ((first + middle) * sixth, ((first + (middle + middle)) + fourth) * sixth)
    });
    let (mean, rates) = both.unzip();
    [mean, rates]
}

/// As [`RungeKuttaStep::runge_kutta_step`](crate::RungeKuttaStep::runge_kutta_step), by the accelerations of positions
/// and velocities: the next positions and the next velocities. `step` is the duration for each place of the lists.
///
/// # Errors
/// The first of the accelerations.
#[doc(hidden)]
pub fn runge_kutta_step<T: Scalar, E>(
    accelerations: impl Fn(&[T], &[T]) -> Result<Vec<T>, E>,
    q: &[T],
    qd: &[T],
    step: impl Fn(usize) -> T,
) -> Result<[Vec<T>; 2], E> {
    let [_, second, third, fourth] = stages(&accelerations, [q, qd], &step)?;
    let last = accelerations(&fourth[0], &fourth[1])?;
    let [mean, rates] = weighted([&second[2], &third[2], &fourth[2], &last], &step);
    Ok([moved(q, &moved(qd, &mean, |_| T::one()), step), moved(qd, &rates, |_| T::one())])
}

/// As [`RungeKuttaStepDerivatives::runge_kutta_step_derivatives`](
/// crate::RungeKuttaStepDerivatives::runge_kutta_step_derivatives), by the accelerations of positions and velocities
/// and by their derivatives by q, by q̇ and by τ: those of the next positions and those of the next velocities.
///
/// # Errors
/// The first of the accelerations or of their derivatives.
#[doc(hidden)]
pub fn runge_kutta_step_derivatives<T: Scalar, E>(
    accelerations: impl Fn(&[T], &[T]) -> Result<Vec<T>, E>,
    derivatives: impl Fn(&[T], &[T]) -> Result<Blocks<T>, E>,
    q: &[T],
    qd: &[T],
    step: T,
) -> Result<[Blocks<T>; 2], E> {
    let states = stages(accelerations, [q, qd], |_| step)?;
    let at = |stage: usize| derivatives(&states[stage][0], &states[stage][1]);
    let half = step * T::from_f64(0.5);
    let first = at(0)?;
    let second = chained(&at(1)?, half, &first, None);
    let third = chained(&at(2)?, half, &second, Some((half, &first)));
    let fourth = chained(&at(3)?, step, &third, Some((half, &second)));
    let found = [0, 1, 2].map(|kind: usize| {
        let row = |row: usize| {
            weighted([&first, &second, &third, &fourth].map(|of_stage| of_stage[kind][row].as_slice()), |_| step)
        };
        let rows = (0..q.len()).map(row).map(|[mean, rates]| (mean, rates));
        rows.unzip::<_, _, Matrix<T>, Matrix<T>>()
    });
    let [mean, rates] =
        [found.each_ref().map(|of| of.0.clone()), found.map(|of| of.1)].map(|change| moved_by(1, &change, T::one()));
    Ok([moved_by(0, &mean, step), rates])
}

/// The derivatives of the accelerations at a state by those of the step's arguments, as those over arrays.
fn chained<T: Scalar>(own: &Blocks<T>, duration: T, before: &Blocks<T>, earlier: Option<(T, &Blocks<T>)>) -> Blocks<T> {
    let dof = own[0].len();
    let mut found = own.clone();
    for (kind, block) in found.iter_mut().enumerate() {
        for (i, row) in block.iter_mut().enumerate() {
            let mut change = if kind == 1 { own[0][i].clone() } else { vec![T::zero(); dof] };
            let mut add = |factor: T, by: &[T]| change.iter_mut().zip(by).for_each(|(sum, &by)| *sum += factor * by);
            for k in 0..dof {
                add(own[1][i][k], &before[kind][k]);
                if let Some((duration, earlier)) = earlier {
                    add(own[0][i][k] * duration, &earlier[kind][k]);
                }
            }
            for (element, change) in row.iter_mut().zip(change) {
                *element += duration * change;
            }
        }
    }
    found
}

/// [`NextState`](crate::NextState) of a [`DynArm`].
#[cfg(feature = "arm")]
#[derive(Clone, Debug, PartialEq)]
pub struct DynNextState<T> {
    /// Positions, rad or m.
    pub q: Vec<T>,
    /// Velocities, rad/s or m/s.
    pub qd: Vec<T>,
}

/// [`StepDerivatives`](crate::StepDerivatives) of a [`DynArm`].
#[cfg(feature = "arm")]
#[derive(Clone, Debug, PartialEq)]
pub struct DynStepDerivatives<T> {
    /// By the positions.
    pub dq: Vec<Vec<T>>,
    /// By the velocities.
    pub dqd: Vec<Vec<T>>,
    /// By the torques.
    pub dtau: Vec<Vec<T>>,
}

/// [`NextStateDerivatives`](crate::NextStateDerivatives) of a [`DynArm`].
#[cfg(feature = "arm")]
#[derive(Clone, Debug, PartialEq)]
pub struct DynNextStateDerivatives<T> {
    /// Derivatives of the next positions.
    pub q: DynStepDerivatives<T>,
    /// Derivatives of the next velocities.
    pub qd: DynStepDerivatives<T>,
}

#[cfg(feature = "arm")]
impl<T> DynNextStateDerivatives<T> {
    fn of(blocks: [Blocks<T>; 2]) -> Self {
        let [q, qd] = blocks.map(|[dq, dqd, dtau]| DynStepDerivatives { dq, dqd, dtau });
        Self { q, qd }
    }
}

#[cfg(feature = "arm")]
impl<S: Constant> DynArm<S> {
    /// As [`EulerStep::euler_step`](crate::EulerStep::euler_step).
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn euler_step<T: Scalar>(&self, q: &[T], qd: &[T], tau: &[T], step: T) -> Result<DynNextState<T>, WrongLength> {
        let next = moved(qd, &self.forward_dynamics(q, qd, tau)?, |_| step);
        Ok(DynNextState { q: moved(q, &next, |_| step), qd: next })
    }

    /// As [`EulerStepDerivatives::euler_step_derivatives`](crate::EulerStepDerivatives::euler_step_derivatives).
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn euler_step_derivatives<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        step: T,
    ) -> Result<DynNextStateDerivatives<T>, WrongLength> {
        let rates = moved_by(1, &self.blocks(q, qd, tau)?, step);
        Ok(DynNextStateDerivatives::of([moved_by(0, &rates, step), rates]))
    }

    /// As [`RungeKuttaStep::runge_kutta_step`](crate::RungeKuttaStep::runge_kutta_step).
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn runge_kutta_step<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        step: T,
    ) -> Result<DynNextState<T>, WrongLength> {
        let [q, qd] = runge_kutta_step(|q, qd| self.forward_dynamics(q, qd, tau), q, qd, |_| step)?;
        Ok(DynNextState { q, qd })
    }

    /// As [`RungeKuttaStepDerivatives::runge_kutta_step_derivatives`](
    /// crate::RungeKuttaStepDerivatives::runge_kutta_step_derivatives).
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn runge_kutta_step_derivatives<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        step: T,
    ) -> Result<DynNextStateDerivatives<T>, WrongLength> {
        let accelerations = |q: &[T], qd: &[T]| self.forward_dynamics(q, qd, tau);
        let derivatives = |q: &[T], qd: &[T]| self.blocks(q, qd, tau);
        runge_kutta_step_derivatives(accelerations, derivatives, q, qd, step).map(DynNextStateDerivatives::of)
    }

    /// The derivatives of the accelerations.
    fn blocks<T: Scalar>(&self, q: &[T], qd: &[T], tau: &[T]) -> Result<Blocks<T>, WrongLength> {
        let found = self.forward_dynamics_derivatives(q, qd, tau)?;
        Ok([found.dq, found.dqd, found.dtau])
    }
}
