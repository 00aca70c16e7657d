//! Steps of integrators for a robot whose base nothing holds, on the manifold of its positions, and the derivatives of
//! the step of the semi-implicit Euler method.

use core::array::from_fn;

use crate::ldlt::{factor, solve};
use crate::pose_log::{cross, dot, times, transposed};
use crate::{BaseMotion, BaseTwist, FloatingBase, FloatingInverseDynamicsDerivatives, Quaternion, Scalar, Wrench};

/// The state of a robot whose base nothing holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatingState<const DOF: usize, T> {
    /// The rotation from the axes of frame 0 to those of the world.
    pub orientation: Quaternion<T>,
    /// The origin of frame 0 in the world, m.
    pub position: [T; 3],
    /// The velocity of frame 0, in its axes, m/s and rad/s.
    pub twist: BaseTwist<T>,
    /// Positions of the joints, rad or m.
    pub q: [T; DOF],
    /// Velocities of the joints, rad/s or m/s.
    pub qd: [T; DOF],
}

/// The linear model of a step of a robot whose base nothing holds: rows belong to the next state, columns to the state
/// and to the torques.
///
/// `NV` = `DOF` + 6. A change of the positions has three components of the origin of frame 0 and three of its rotation
/// vector, both in axes of frame 0, and one for each joint: position + R δp and R exp(δθ). These are the axes before
/// the step for the columns, and after it for the rows. A change of the velocities has the linear and the angular
/// velocity of frame 0 in its axes, then the joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatingStepDerivatives<const DOF: usize, const NV: usize, T> {
    /// Derivatives of the next positions by the positions.
    pub q_dq: [[T; NV]; NV],
    /// Derivatives of the next positions by the velocities.
    pub q_dv: [[T; NV]; NV],
    /// Derivatives of the next positions by the torques.
    pub q_dtau: [[T; DOF]; NV],
    /// Derivatives of the next velocities by the positions.
    pub v_dq: [[T; NV]; NV],
    /// Derivatives of the next velocities by the velocities.
    pub v_dv: [[T; NV]; NV],
    /// Derivatives of the next velocities by the torques.
    pub v_dtau: [[T; DOF]; NV],
}

/// Steps of a robot whose base nothing holds. Every type with [`FloatingBase`] has them.
pub trait FloatingIntegratorStep<const DOF: usize, const NV: usize, const TIPS: usize>:
    FloatingBase<DOF, NV, TIPS>
{
    /// A step of the semi-implicit Euler method of duration `step`, s, under torques and wrenches that do not change
    /// during the step. `gravity`: m/s², in world axes; (0, 0, -9.81) where z points up. `wrenches`: as in
    /// [`floating_bias`](FloatingBase::floating_bias). The function
    /// [`floating_euler_step`](crate::FloatingEulerStep::floating_euler_step) computes the same step of a base whose
    /// orientation is a matrix.
    ///
    /// The velocities come first, those of the origin of frame 0 in world axes. Then the position moves with the new
    /// velocity, the joints with theirs, and the base turns by the new angular velocity in its axes. The error of a
    /// motion is of order h.
    ///
    /// The base turns by the unit quaternion (1 - s, 2 u) / (1 + s) with u = h ω / 4 and s = u·u. It needs no root, no
    /// sine and no quotient by an angle, so it is smooth at ω = 0; its angle is h |ω| less (h |ω|)³ / 48, an error of
    /// higher order than that of the method. The result has the length 1 to rounding, however many steps came before.
    #[must_use]
    fn floating_quaternion_step<T: Scalar>(
        &self,
        state: &FloatingState<DOF, T>,
        tau: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
        gravity: &[T; 3],
        step: T,
    ) -> FloatingState<DOF, T> {
        let omega = &state.twist.angular;
        let found = self.floating_forward_dynamics(&state.q, &state.qd, tau, omega, wrenches);
        let rotation = state.orientation.rotation();
        let linear = moved(&state.twist.linear, &found.base.linear, step);
        // in world axes
        let linear = moved(&times(&rotation, &linear), gravity, step);
        let angular = moved(omega, &found.base.angular, step);
        let orientation = unit(&state.orientation.then(&turn(&angular, step)));
        let qd = moved(&state.qd, &found.qdd, step);
        FloatingState {
            orientation,
            position: moved(&state.position, &linear, step),
            twist: BaseTwist { linear: times(&transposed(&orientation.rotation()), &linear), angular },
            q: moved(&state.q, &qd, step),
            qd,
        }
    }

    /// A step of the classical Runge-Kutta method, with the arguments of
    /// [`floating_quaternion_step`](Self::floating_quaternion_step). The error of a motion is of order h⁴.
    ///
    /// The method integrates the turn of the base in the coordinates u of the unit quaternion (1 - s, 2 u) / (1 + s)
    /// with s = u·u, the tangent of a quarter of the angle times the axis. They begin at zero in each step, and their
    /// rate is a polynomial of u and of the angular velocity: ((1 - s) ω + 2 u × ω + 2 (u·ω) u) / 4. So the step needs
    /// no root and no sine, and it is smooth at rest. It computes the accelerations four times. The turn of a step must
    /// stay below a whole turn.
    #[must_use]
    fn floating_runge_kutta_step<T: Scalar>(
        &self,
        state: &FloatingState<DOF, T>,
        tau: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
        gravity: &[T; 3],
        step: T,
    ) -> FloatingState<DOF, T> {
        let half = step * T::from_f64(0.5);
        let start = Stage {
            u: [T::zero(); 3],
            linear: times(&state.orientation.rotation(), &state.twist.linear),
            omega: state.twist.angular,
            q: state.q,
            qd: state.qd,
        };
        let rate = |stage: &Stage<DOF, T>| {
            let found = self.floating_forward_dynamics(&stage.q, &stage.qd, tau, &stage.omega, wrenches);
            let rotation = state.orientation.then(&turned(&stage.u)).rotation();
            let linear = times(&rotation, &found.base.linear);
            Stage {
                u: rate_of_turn(&stage.u, &stage.omega),
                linear: from_fn(|axis| linear[axis] + gravity[axis]),
                omega: found.base.angular,
                q: stage.qd,
                qd: found.qdd,
            }
        };
        let first = rate(&start);
        let second = rate(&start.moved(&first, half));
        let third = rate(&start.moved(&second, half));
        let fourth = rate(&start.moved(&third, step));
        let sum = first.moved(&second.moved(&third, T::one()), T::one() + T::one()).moved(&fourth, T::one());
        let sixth = step / T::from_f64(6.0);
        let next = start.moved(&sum, sixth);
        // the position moves with the mean of the velocities at the four states
        let mean: [T; 3] = from_fn(|axis| {
            start.linear[axis] + (first.linear[axis] + second.linear[axis] + third.linear[axis]) * sixth
        });
        let orientation = unit(&state.orientation.then(&turned(&next.u)));
        FloatingState {
            orientation,
            position: moved(&state.position, &mean, step),
            twist: BaseTwist { linear: times(&transposed(&orientation.rotation()), &next.linear), angular: next.omega },
            q: next.q,
            qd: next.qd,
        }
    }
}

/// The numbers that a step integrates, or their rates: the turn of the base, the velocity of its origin in world axes,
/// its angular velocity in its axes, and the joints.
#[derive(Clone, Copy)]
struct Stage<const DOF: usize, T> {
    u: [T; 3],
    linear: [T; 3],
    omega: [T; 3],
    q: [T; DOF],
    qd: [T; DOF],
}

impl<const DOF: usize, T: Scalar> Stage<DOF, T> {
    /// These and h times other ones.
    fn moved(&self, by: &Self, step: T) -> Self {
        Self {
            u: moved(&self.u, &by.u, step),
            linear: moved(&self.linear, &by.linear, step),
            omega: moved(&self.omega, &by.omega, step),
            q: moved(&self.q, &by.q, step),
            qd: moved(&self.qd, &by.qd, step),
        }
    }
}

/// The rate of the coordinates u of a turn, by the angular velocity in the turned axes.
fn rate_of_turn<T: Scalar>(u: &[T; 3], omega: &[T; 3]) -> [T; 3] {
    let (two, quarter) = (T::one() + T::one(), T::from_f64(0.25));
    let (scale, along, across) = (T::one() - dot(u, u), two * dot(u, omega), cross(u, omega));
    from_fn(|axis| quarter * (scale * omega[axis] + two * across[axis] + along * u[axis]))
}

impl<const DOF: usize, const NV: usize, const TIPS: usize, R: FloatingBase<DOF, NV, TIPS> + ?Sized>
    FloatingIntegratorStep<DOF, NV, TIPS> for R
{
}

/// The derivatives of this step, for optimisers. Every type with [`FloatingBase`] and
/// [`FloatingInverseDynamicsDerivatives`] has them.
pub trait FloatingIntegratorStepDerivatives<const DOF: usize, const NV: usize, const TIPS: usize>:
    FloatingBase<DOF, NV, TIPS> + FloatingInverseDynamicsDerivatives<DOF, NV, TIPS>
{
    /// The derivatives of [`floating_quaternion_step`](FloatingIntegratorStep::floating_quaternion_step) by the state
    /// and by the torques, exact up to rounding: the derivatives of the accelerations are -M⁻¹ times those of the
    /// wrench on the base and of the torques.
    #[must_use]
    fn floating_euler_step_derivatives<T: Scalar>(
        &self,
        state: &FloatingState<DOF, T>,
        tau: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
        gravity: &[T; 3],
        step: T,
    ) -> FloatingStepDerivatives<DOF, NV, T> {
        let FloatingState { twist, q, qd, .. } = state;
        let found = self.floating_forward_dynamics(q, qd, tau, &twist.angular, wrenches);
        // `found` has the acceleration of the base less gravity, so the field `gravity` of the motion stays zero
        let base = BaseMotion {
            omega: twist.angular,
            omega_dot: found.base.angular,
            acceleration: found.base.linear,
            ..BaseMotion::default()
        };
        let forces = self.floating_inverse_dynamics_derivatives(q, qd, &found.qdd, &base, wrenches);
        let (mut mass, mut inverse) = (self.floating_mass_matrix(q), [T::zero(); NV]);
        factor(&mut mass, &mut inverse);
        let accelerations = |forces: &dyn Fn(usize) -> T| {
            let mut x: [T; NV] = from_fn(forces);
            solve(&mass, &inverse, &mut x);
            x
        };
        let next = self.floating_quaternion_step(state, tau, wrenches, gravity, step);
        let change = Change::new(state, &next, &found.base.linear, step);
        let still = [[T::zero(); NV]; 2];
        let column = |part: usize, at: usize| {
            let mut given = still;
            given[part][at] = T::one();
            let of_forces = match (part, at.checked_sub(BASE)) {
                (0, Some(joint)) => accelerations(&|row| -forces.dq[row][joint]),
                (_, Some(joint)) => accelerations(&|row| -forces.dqd[row][joint]),
                (1, None) if at >= 3 => accelerations(&|row| -forces.domega[row][at - 3]),
                _ => [T::zero(); NV],
            };
            change.of(&given, &of_forces)
        };
        let by_torque = |joint: usize| {
            let unit = |row: usize| if row == BASE + joint { T::one() } else { T::zero() };
            change.of(&still, &accelerations(&unit))
        };
        let mut result = FloatingStepDerivatives {
            q_dq: still_matrix(),
            q_dv: still_matrix(),
            q_dtau: still_matrix(),
            v_dq: still_matrix(),
            v_dv: still_matrix(),
            v_dtau: still_matrix(),
        };
        for at in 0..NV {
            let ([q_by_q, v_by_q], [q_by_v, v_by_v]) = (column(0, at), column(1, at));
            fill(&mut result.q_dq, at, &q_by_q);
            fill(&mut result.q_dv, at, &q_by_v);
            fill(&mut result.v_dq, at, &v_by_q);
            fill(&mut result.v_dv, at, &v_by_v);
        }
        for joint in 0..DOF {
            let [q_by_tau, v_by_tau] = by_torque(joint);
            fill(&mut result.q_dtau, joint, &q_by_tau);
            fill(&mut result.v_dtau, joint, &v_by_tau);
        }
        result
    }
}

impl<const DOF: usize, const NV: usize, const TIPS: usize, R: ?Sized> FloatingIntegratorStepDerivatives<DOF, NV, TIPS>
    for R
where
    R: FloatingBase<DOF, NV, TIPS> + FloatingInverseDynamicsDerivatives<DOF, NV, TIPS>,
{
}

/// Six velocities of the base stand before those of the joints.
const BASE: usize = 6;

fn still_matrix<const ROWS: usize, const COLUMNS: usize, T: Scalar>() -> [[T; COLUMNS]; ROWS] {
    [[T::zero(); COLUMNS]; ROWS]
}

/// Writes a column of a matrix.
fn fill<const ROWS: usize, const COLUMNS: usize, T: Scalar>(
    matrix: &mut [[T; COLUMNS]; ROWS],
    at: usize,
    column: &[T; ROWS],
) {
    for (row, &element) in matrix.iter_mut().zip(column) {
        row[at] = element;
    }
}

/// x + h times what changes it.
pub(crate) fn moved<const N: usize, T: Scalar>(x: &[T; N], change: &[T; N], step: T) -> [T; N] {
    from_fn(|i| x[i] + step * change[i])
}

/// The rotation by which a step turns the base.
fn turn<T: Scalar>(omega: &[T; 3], step: T) -> Quaternion<T> {
    let quarter = step * T::from_f64(0.25);
    turned(&omega.map(|x| x * quarter))
}

/// The unit quaternion (1 - s, 2 u) / (1 + s) with s = u·u.
fn turned<T: Scalar>(u: &[T; 3]) -> Quaternion<T> {
    let square = dot(u, u);
    let scale = T::one() / (T::one() + square);
    let [x, y, z] = u.map(|x| (x + x) * scale);
    Quaternion { w: (T::one() - square) * scale, x, y, z }
}

/// The quaternion with the length 1, if its length is nearly that: a step of Newton's method.
fn unit<T: Scalar>(near: &Quaternion<T>) -> Quaternion<T> {
    let square = near.to_wxyz().iter().fold(T::zero(), |sum, &part| sum + part * part);
    let scale = T::from_f64(1.5) - square * T::from_f64(0.5);
    Quaternion::from_wxyz(near.to_wxyz().map(|part| part * scale))
}

/// How the next state changes with the state and with the accelerations.
struct Change<T> {
    step: T,
    /// R'ᵀ R
    back: [[T; 3]; 3],
    /// v + h a, in axes of frame 0 before the step.
    linear: [T; 3],
    /// v', in axes of frame 0 after the step.
    next_linear: [T; 3],
    /// h ω / 4 of the turn, and the factor of its derivative.
    quarter: [T; 3],
    scale: T,
    /// The turn by half of it, from the axes after it to those before.
    half_back: [[T; 3]; 3],
}

impl<T: Scalar> Change<T> {
    fn new<const DOF: usize>(
        state: &FloatingState<DOF, T>,
        next: &FloatingState<DOF, T>,
        acceleration: &[T; 3],
        step: T,
    ) -> Self {
        let omega = &next.twist.angular;
        let quarter = omega.map(|x| x * step * T::from_f64(0.25));
        let square = dot(&quarter, &quarter);
        // the Cayley transform of u: a turn by half of that of the step
        let scale = (T::one() + T::one()) / (T::one() + square);
        let half_back = from_fn(|row| {
            let unit: [T; 3] = from_fn(|at| if at == row { T::one() } else { T::zero() });
            // a row of Cᵀ is C e; C x = x + 2 (u × x + u × (u × x)) / (1 + s)
            let once = cross(&quarter, &unit);
            let twice = cross(&quarter, &once);
            from_fn(|at| unit[at] + scale * (once[at] + twice[at]))
        });
        Self {
            step,
            back: transposed(&turn(omega, step).rotation()),
            linear: moved(&state.twist.linear, acceleration, step),
            next_linear: next.twist.linear,
            quarter,
            scale,
            half_back,
        }
    }

    /// The changes of positions and velocities after the step, by those before it and by what they change in the
    /// accelerations.
    fn of<const NV: usize>(&self, [q, v]: &[[T; NV]; 2], accelerations: &[T; NV]) -> [[T; NV]; 2] {
        let three = |x: &[T; NV], from: usize| -> [T; 3] { from_fn(|at| x[from + at]) };
        let mut next = [[T::zero(); NV]; 2];
        for at in 0..NV {
            next[1][at] = v[at] + self.step * accelerations[at];
            next[0][at] = q[at] + self.step * next[1][at];
        }
        // R E turns on by Eᵀ δθ and by the right Jacobian of E: (1 + Cᵀ) 2 (1 - u×) / (1 + s) of the change of u
        let angular = three(&next[1], 3).map(|x| x * self.step * T::from_f64(0.25));
        let crossed = cross(&self.quarter, &angular);
        let half: [T; 3] = from_fn(|at| self.scale * (angular[at] - crossed[at]));
        let (turned_half, before) = (times(&self.half_back, &half), times(&self.back, &three(q, 3)));
        let turned: [T; 3] = from_fn(|at| before[at] + (half[at] + turned_half[at]));
        // the velocity in world axes is R (v + h a) + h g, here in axes of frame 0 before the step, then after it
        let swung = cross(&three(q, 3), &self.linear);
        let linear: [T; 3] = from_fn(|at| next[1][at] + swung[at]);
        let linear = times(&self.back, &linear);
        let origin = times(&self.back, &three(q, 0));
        let swung = cross(&self.next_linear, &turned);
        for at in 0..3 {
            next[0][at] = origin[at] + self.step * linear[at];
            next[0][3 + at] = turned[at];
            next[1][at] = linear[at] + swung[at];
        }
        next
    }
}
