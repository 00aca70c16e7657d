//! The derivatives of the step of the classical Runge-Kutta method of a robot whose base nothing holds: the chain rule
//! over its four states, for every robot that has the derivatives of the forces.

use core::array::from_fn;

use crate::floating_integrator::{Stage, runge_kutta, turn_by_change, turned, unit};
use crate::ldlt::{factor, solve};
use crate::pose_log::{cross, dot, times, transposed};
use crate::{
    BaseMotion, FloatingBase, FloatingInverseDynamicsDerivatives, FloatingState, FloatingStepDerivatives,
    FloatingTorqueDerivatives, Scalar, Wrench,
};

/// Six velocities of the base stand before those of the joints.
const BASE: usize = 6;

/// Derivatives of the step of
/// [`floating_runge_kutta_step`](crate::FloatingIntegratorStep::floating_runge_kutta_step), for optimisers. Every type
/// with [`FloatingBase`] and [`FloatingInverseDynamicsDerivatives`] has them.
pub trait FloatingRungeKuttaStepDerivatives<const DOF: usize, const NV: usize, const TIPS: usize>:
    FloatingBase<DOF, NV, TIPS> + FloatingInverseDynamicsDerivatives<DOF, NV, TIPS>
{
    /// The derivatives of this step by the state and by the torques, exact up to rounding: the chain rule over its four
    /// states. The changes of the accelerations there are -M⁻¹ times those of the wrench on the base and of the
    /// torques.
    #[must_use]
    fn floating_runge_kutta_step_derivatives<T: Scalar>(
        &self,
        state: &FloatingState<DOF, T>,
        tau: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
        gravity: &[T; 3],
        step: T,
    ) -> FloatingStepDerivatives<DOF, NV, T> {
        let start = Stage::of(state);
        let mut states: [Option<Linear<DOF, NV, T>>; 4] = [None; 4];
        let (next, _) = runge_kutta(&start, step, |number, stage| {
            let Stage { u, omega, q, qd, .. } = stage;
            let found = self.floating_forward_dynamics(q, qd, tau, omega, wrenches);
            // the acceleration of the base is less gravity, so the field `gravity` of the motion stays zero
            let base = BaseMotion {
                omega: *omega,
                omega_dot: found.base.angular,
                acceleration: found.base.linear,
                ..BaseMotion::default()
            };
            let (mut mass, mut inverse) = (self.floating_mass_matrix(q), [T::zero(); NV]);
            factor(&mut mass, &mut inverse);
            states[number] = Some(Linear {
                u: *u,
                omega: *omega,
                rotation: state.orientation.then(&turned(u)).rotation(),
                acceleration: found.base.linear,
                forces: self.floating_inverse_dynamics_derivatives(q, qd, &found.qdd, &base, wrenches),
                mass,
                inverse,
            });
            stage.rates(&found, &state.orientation, gravity)
        });
        let [before, turn] = [state.orientation, turned(&next.u)].map(|of| of.rotation());
        let back = transposed(&unit(&state.orientation.then(&turned(&next.u))).rotation());
        let velocity = times(&back, &next.linear);
        // the changes after the step, by one position, velocity or torque
        let column = |kind: usize, at: usize| -> [[T; NV]; 2] {
            let unit = |of: usize, place: usize| if of == kind && place == at { T::one() } else { T::zero() };
            let three = |of: usize, from: usize| -> [T; 3] { from_fn(|axis| unit(of, from + axis)) };
            let turned_before = three(0, 3);
            let (swung, driven) = (cross(&turned_before, &state.twist.linear), three(1, 0));
            let changed = Stage {
                u: [T::zero(); 3],
                linear: times(&before, &from_fn(|axis| swung[axis] + driven[axis])),
                omega: three(1, 3),
                q: from_fn(|joint| unit(0, BASE + joint)),
                qd: from_fn(|joint| unit(1, BASE + joint)),
            };
            let in_world = times(&before, &turned_before);
            let (change, mean) = runge_kutta(&changed, step, |number, stage| match &states[number] {
                Some(linear) => linear.rates(stage, &in_world, |joint| unit(2, joint)),
                None => *stage,
            });
            let shift = times(&before, &three(0, 0));
            let origin = times(&back, &from_fn(|axis| shift[axis] + step * mean[axis]));
            let (by_turn, by_u) = (times(&transposed(&turn), &turned_before), turn_by_change(&next.u, &change.u));
            let turned: [T; 3] = from_fn(|axis| by_turn[axis] + by_u[axis]);
            let (linear, swung) = (times(&back, &change.linear), cross(&velocity, &turned));
            let linear: [T; 3] = from_fn(|axis| linear[axis] + swung[axis]);
            [joined(&origin, &turned, &change.q), joined(&linear, &change.omega, &change.qd)]
        };
        let (zeros, of_torques) = ([[T::zero(); NV]; NV], [[T::zero(); DOF]; NV]);
        let [[mut q_dq, mut q_dv], [mut v_dq, mut v_dv]] = [[zeros; 2]; 2];
        let [mut q_dtau, mut v_dtau] = [of_torques; 2];
        for at in 0..NV {
            for (kind, matrices) in [[&mut q_dq, &mut v_dq], [&mut q_dv, &mut v_dv]].into_iter().enumerate() {
                fill(matrices, at, &column(kind, at));
            }
        }
        for joint in 0..DOF {
            fill([&mut q_dtau, &mut v_dtau], joint, &column(2, joint));
        }
        FloatingStepDerivatives { q_dq, q_dv, q_dtau, v_dq, v_dv, v_dtau }
    }
}

impl<const DOF: usize, const NV: usize, const TIPS: usize, R: ?Sized> FloatingRungeKuttaStepDerivatives<DOF, NV, TIPS>
    for R
where
    R: FloatingBase<DOF, NV, TIPS> + FloatingInverseDynamicsDerivatives<DOF, NV, TIPS>,
{
}

/// How the rates at a state change.
#[derive(Clone, Copy)]
struct Linear<const DOF: usize, const NV: usize, T> {
    u: [T; 3],
    omega: [T; 3],
    /// From the axes of frame 0 to those of the world.
    rotation: [[T; 3]; 3],
    /// Acceleration of the base less gravity, in its axes.
    acceleration: [T; 3],
    forces: FloatingTorqueDerivatives<DOF, NV, T>,
    /// The factors of M.
    mass: [[T; NV]; NV],
    inverse: [T; NV],
}

impl<const DOF: usize, const NV: usize, T: Scalar> Linear<DOF, NV, T> {
    /// The changes of the rates, by those of the state, by the turn of the base before the step, in world axes, and by
    /// the torques.
    fn rates(&self, change: &Stage<DOF, T>, turned_before: &[T; 3], torque: impl Fn(usize) -> T) -> Stage<DOF, T> {
        let FloatingTorqueDerivatives { dq, dqd, domega } = &self.forces;
        let mut x: [T; NV] = from_fn(|row| {
            let own = row.checked_sub(BASE).map_or(T::zero(), &torque);
            let joints = (0..DOF).map(|joint| dq[row][joint] * change.q[joint] + dqd[row][joint] * change.qd[joint]);
            joints.fold(own - dot(&domega[row], &change.omega), |sum, force| sum - force)
        });
        solve(&self.mass, &self.inverse, &mut x);
        let swung = cross(&turn_by_change(&self.u, &change.u), &self.acceleration);
        let linear = times(&self.rotation, &from_fn(|axis| x[axis] + swung[axis]));
        let carried = cross(turned_before, &times(&self.rotation, &self.acceleration));
        Stage {
            u: change_of_rate(&self.u, &self.omega, change),
            linear: from_fn(|axis| linear[axis] + carried[axis]),
            omega: from_fn(|axis| x[3 + axis]),
            q: change.qd,
            qd: from_fn(|joint| x[BASE + joint]),
        }
    }
}

/// The change of the rate ((1 - s) ω + 2 u × ω + 2 (u·ω) u) / 4 of the coordinates u of a turn.
fn change_of_rate<const DOF: usize, T: Scalar>(u: &[T; 3], omega: &[T; 3], change: &Stage<DOF, T>) -> [T; 3] {
    let half = T::from_f64(0.5);
    let (scale, along) = (half * (T::one() - dot(u, u)), dot(u, omega));
    let (less, more) = (dot(u, &change.u), dot(&change.u, omega) + dot(u, &change.omega));
    let (by_u, by_omega) = (cross(&change.u, omega), cross(u, &change.omega));
    from_fn(|axis| {
        let turned = scale * change.omega[axis] - less * omega[axis];
        half * (turned + by_u[axis] + by_omega[axis] + more * u[axis] + along * change.u[axis])
    })
}

/// Six numbers of the base, then those of the joints.
fn joined<const DOF: usize, const NV: usize, T: Scalar>(
    linear: &[T; 3],
    angular: &[T; 3],
    joints: &[T; DOF],
) -> [T; NV] {
    from_fn(|row| match row {
        0..3 => linear[row],
        3..BASE => angular[row - 3],
        _ => joints[row - BASE],
    })
}

/// Writes a column of two matrices.
fn fill<const ROWS: usize, const COLUMNS: usize, T: Scalar>(
    matrices: [&mut [[T; COLUMNS]; ROWS]; 2],
    at: usize,
    columns: &[[T; ROWS]; 2],
) {
    for (matrix, column) in matrices.into_iter().zip(columns) {
        for (row, &element) in matrix.iter_mut().zip(column) {
            row[at] = element;
        }
    }
}
