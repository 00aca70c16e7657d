//! Steps of integrators for a robot whose base nothing holds, on the manifold of its positions.

use core::array::from_fn;

use crate::pose_log::{cross, dot, times, transposed};
use crate::{BaseTwist, FloatingBase, Quaternion, Scalar, Wrench};

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

/// x + h times what changes it.
pub(crate) fn moved<const N: usize, T: Scalar>(x: &[T; N], change: &[T; N], step: T) -> [T; N] {
    from_fn(|i| x[i] + step * change[i])
}

/// The rotation by which a step turns the base.
pub(crate) fn turn<T: Scalar>(omega: &[T; 3], step: T) -> Quaternion<T> {
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
