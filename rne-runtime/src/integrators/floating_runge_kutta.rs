//! The derivatives of the step of the classical Runge-Kutta method of a robot with a floating base: the chain rule
//! over its four states, for every robot that has the derivatives of the forces.

use core::array::from_fn;

use crate::integrators::floating_integrator::{Stage, runge_kutta, turn_by_change, turned};
use crate::number::ldlt::{factor, solve};
use crate::values::pose_log::{cross, dot, times, transposed};
use crate::{
    BaseAcceleration, BaseMotion, BaseTwist, FloatingBase, FloatingInverseDynamicsDerivatives, FloatingState,
    FloatingStepDerivatives, FloatingTorqueDerivatives, Quaternion, Scalar, Wrench,
};

/// The six velocities of the base come before those of the joints.
const BASE: usize = 6;

/// Derivatives of the step of
/// [`floating_runge_kutta_step`](crate::FloatingIntegratorStep::floating_runge_kutta_step), for optimisers. Every type
/// with [`FloatingBase`] and [`FloatingInverseDynamicsDerivatives`] has them.
pub trait FloatingRungeKuttaStepDerivatives<const DOF: usize, const NV: usize, const TIPS: usize>:
    FloatingBase<DOF, NV, TIPS> + FloatingInverseDynamicsDerivatives<DOF, NV, TIPS>
{
    /// The derivatives of this step with respect to the state and the torques, exact up to rounding: the chain rule
    /// over its four states. The changes of the accelerations there are -M⁻¹ times those of the wrench on the base and
    /// of the torques.
    #[must_use]
    fn floating_runge_kutta_step_derivatives<T: Scalar>(
        &self,
        state: &FloatingState<DOF, T>,
        tau: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
        gravity: &[T; 3],
        step: T,
    ) -> FloatingStepDerivatives<DOF, NV, T> {
        let FloatingState { orientation, twist, q, qd, .. } = state;
        let mut found = [None; 4];
        let (next, _) = runge_kutta(&Stage::of(orientation, twist, *q, *qd), step, |number, stage| {
            let Stage { omega, q, qd, .. } = stage;
            let accelerations = self.floating_forward_dynamics(q, qd, tau, omega, wrenches);
            // the computed acceleration of the base already contains -g, so the field `gravity` of the motion stays
            // zero
            let base = BaseMotion {
                omega: *omega,
                omega_dot: accelerations.base.angular,
                acceleration: accelerations.base.linear,
                ..BaseMotion::default()
            };
            let (mut mass, mut inverse) = (self.floating_mass_matrix(q), [T::zero(); NV]);
            factor(&mut mass, &mut inverse);
            let forces = self.floating_inverse_dynamics_derivatives(q, qd, &accelerations.qdd, &base, wrenches);
            found[number] = Some((Turning::of(stage, &accelerations.base, orientation), forces, mass, inverse));
            stage.rates(&accelerations.base, accelerations.qdd, orientation, gravity)
        });
        let (zeros, of_torques) = ([[T::zero(); NV]; NV], [[T::zero(); DOF]; NV]);
        let [[mut q_dq, mut q_dv], [mut v_dq, mut v_dv]] = [[zeros; 2]; 2];
        let [mut q_dtau, mut v_dtau] = [of_torques; 2];
        let linear = |number: usize| {
            found[number].as_ref().map(|(turning, forces, mass, inverse)| {
                let FloatingTorqueDerivatives { dq, dqd, domega } = forces;
                Linear { turning: *turning, dq, dqd, domega, mass, inverse }
            })
        };
        let mut put = |[half, kind]: [usize; 2], row: usize, at: usize, element: T| match (half, kind) {
            (0, 0) => q_dq[row][at] = element,
            (0, 1) => q_dv[row][at] = element,
            (0, _) => q_dtau[row][at] = element,
            (_, 0) => v_dq[row][at] = element,
            (_, 1) => v_dv[row][at] = element,
            _ => v_dtau[row][at] = element,
        };
        derivatives(
            [orientation, &next.base(orientation).0],
            twist,
            &next,
            step,
            linear,
            &mut [T::zero(); NV],
            &mut put,
        );
        FloatingStepDerivatives { q_dq, q_dv, q_dtau, v_dq, v_dv, v_dtau }
    }
}

impl<const DOF: usize, const NV: usize, const TIPS: usize, R: ?Sized> FloatingRungeKuttaStepDerivatives<DOF, NV, TIPS>
    for R
where
    R: FloatingBase<DOF, NV, TIPS> + FloatingInverseDynamicsDerivatives<DOF, NV, TIPS>,
{
}

/// Passes every derivative of a step to `put`: [0 for a position or 1 for a velocity, kind of the argument (0
/// positions, 1 velocities, 2 torques)], row, column and value. `orientations` are those before and after the step, and
/// `next` has the variables after it. `linear` returns how the rates change at each of the four states. `x` is scratch
/// memory for as many numbers as the mass matrix has rows.
#[doc(hidden)]
pub fn derivatives<'a, T: Scalar + 'a, R: AsRef<[T]> + 'a, J: AsRef<[T]> + AsMut<[T]> + Clone + 'a>(
    orientations: [&Quaternion<T>; 2],
    twist: &BaseTwist<T>,
    next: &Stage<J, T>,
    step: T,
    linear: impl Fn(usize) -> Option<Linear<'a, T, R, J>>,
    x: &mut [T],
    put: &mut impl FnMut([usize; 2], usize, usize, T),
) {
    let [before, after] = orientations.map(Quaternion::rotation);
    let (back, turn_back) = (transposed(&after), transposed(&turned(&next.u).rotation()));
    let velocity = times(&back, &next.linear);
    let size = x.len();
    for (kind, columns) in [size, size, size - BASE].into_iter().enumerate() {
        for at in 0..columns {
            let unit = |of: usize, place: usize| if of == kind && place == at { T::one() } else { T::zero() };
            let three = |of: usize, from: usize| -> [T; 3] { from_fn(|axis| unit(of, from + axis)) };
            let joints = |of: usize| {
                let mut units = next.q.clone();
                units.as_mut().iter_mut().enumerate().for_each(|(joint, own)| *own = unit(of, BASE + joint));
                units
            };
            let turned_before = three(0, 3);
            let (swung, driven) = (cross(&turned_before, &twist.linear), three(1, 0));
            let changed = Stage {
                u: [T::zero(); 3],
                linear: times(&before, &from_fn(|axis| swung[axis] + driven[axis])),
                omega: three(1, 3),
                q: joints(0),
                qd: joints(1),
            };
            let in_world = times(&before, &turned_before);
            let (change, mean) = runge_kutta(&changed, step, |number, stage| match linear(number) {
                Some(linear) => linear.rates(stage, &in_world, |joint| unit(2, joint), x),
                None => stage.clone(),
            });
            let shift = times(&before, &three(0, 0));
            let origin = times(&back, &from_fn(|axis| shift[axis] + step * mean[axis]));
            let (by_turn, by_u) = (times(&turn_back, &turned_before), turn_by_change(&next.u, &change.u));
            let turned: [T; 3] = from_fn(|axis| by_turn[axis] + by_u[axis]);
            let (linear, swung) = (times(&back, &change.linear), cross(&velocity, &turned));
            let linear: [T; 3] = from_fn(|axis| linear[axis] + swung[axis]);
            for (half, base, joints) in [(0, [origin, turned], &change.q), (1, [linear, change.omega], &change.qd)] {
                let rows = base.as_flattened().iter().chain(joints.as_ref()).enumerate();
                rows.for_each(|(row, &element)| put([half, kind], row, at, element));
            }
        }
    }
}

/// Turn, angular velocity, orientation and acceleration of the base at a state.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Turning<T> {
    u: [T; 3],
    omega: [T; 3],
    /// The rotation from the axes of frame 0 to those of the world.
    rotation: [[T; 3]; 3],
    /// Acceleration of the base less gravity, in axes of the base.
    acceleration: [T; 3],
}

impl<T: Scalar> Turning<T> {
    pub fn of<J>(stage: &Stage<J, T>, base: &BaseAcceleration<T>, orientation: &Quaternion<T>) -> Self {
        let rotation = orientation.then(&turned(&stage.u)).rotation();
        Self { u: stage.u, omega: stage.omega, rotation, acceleration: base.linear }
    }
}

/// The linear model of the rates at a state: derivatives of the forces, and factors of M.
#[doc(hidden)]
#[derive(Debug)]
pub struct Linear<'a, T, R, J> {
    pub turning: Turning<T>,
    pub dq: &'a [J],
    pub dqd: &'a [J],
    pub domega: &'a [[T; 3]],
    pub mass: &'a [R],
    pub inverse: &'a [T],
}

impl<T: Scalar, R: AsRef<[T]>, J: AsRef<[T]> + AsMut<[T]> + Clone> Linear<'_, T, R, J> {
    /// Returns the changes of the rates, caused by changes of the state, by a turn of the base before the step (in
    /// world axes) and by changes of the torques. `x` is scratch memory for the accelerations.
    fn rates(
        &self,
        change: &Stage<J, T>,
        turned_before: &[T; 3],
        torque: impl Fn(usize) -> T,
        x: &mut [T],
    ) -> Stage<J, T> {
        let Turning { u, omega, rotation, acceleration } = &self.turning;
        for (row, x) in x.iter_mut().enumerate() {
            let own = row.checked_sub(BASE).map_or(T::zero(), &torque);
            let by_joints = self.dq[row].as_ref().iter().zip(self.dqd[row].as_ref());
            let changes = change.q.as_ref().iter().zip(change.qd.as_ref());
            let joints = by_joints.zip(changes).map(|((&dq, &dqd), (&q, &qd))| dq * q + dqd * qd);
            *x = joints.fold(own - dot(&self.domega[row], &change.omega), |sum, force| sum - force);
        }
        solve(self.mass, self.inverse, x);
        let swung = cross(&turn_by_change(u, &change.u), acceleration);
        let linear = times(rotation, &from_fn(|axis| x[axis] + swung[axis]));
        let carried = cross(turned_before, &times(rotation, acceleration));
        let mut qd = change.qd.clone();
        qd.as_mut().copy_from_slice(&x[BASE..]);
        Stage {
            u: change_of_rate(u, omega, change),
            linear: from_fn(|axis| linear[axis] + carried[axis]),
            omega: from_fn(|axis| x[3 + axis]),
            q: change.qd.clone(),
            qd,
        }
    }
}

/// Returns the change of ((1 - s) ω + 2 u × ω + 2 (u·ω) u) / 4, which is the rate of the coordinates u of a turn.
fn change_of_rate<J, T: Scalar>(u: &[T; 3], omega: &[T; 3], change: &Stage<J, T>) -> [T; 3] {
    let half = T::from_f64(0.5);
    let (scale, along) = (half * (T::one() - dot(u, u)), dot(u, omega));
    let (less, more) = (dot(u, &change.u), dot(&change.u, omega) + dot(u, &change.omega));
    let (by_u, by_omega) = (cross(&change.u, omega), cross(u, &change.omega));
    from_fn(|axis| {
        let turned = scale * change.omega[axis] - less * omega[axis];
        half * (turned + by_u[axis] + by_omega[axis] + more * u[axis] + along * change.u[axis])
    })
}
