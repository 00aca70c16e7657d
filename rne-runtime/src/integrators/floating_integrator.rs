//! Steps of integrators for a robot with a floating base, whose orientation is integrated as a rotation.

use core::array::from_fn;

use crate::integrators::moved;
use crate::values::pose_log::{cross, dot, times, transposed};
use crate::{BaseAcceleration, BaseTwist, FloatingBase, Quaternion, Scalar, Wrench};

/// The state of a robot with a floating base.
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

/// Steps of a robot with a floating base. Every type with [`FloatingBase`] has them.
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
        // the new velocity of the origin, in world axes
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
        let FloatingState { orientation, position, twist, q, qd } = state;
        let (next, mean) = runge_kutta(&Stage::of(orientation, twist, *q, *qd), step, |_, stage| {
            let found = self.floating_forward_dynamics(&stage.q, &stage.qd, tau, &stage.omega, wrenches);
            stage.rates(&found.base, found.qdd, orientation, gravity)
        });
        let (orientation, twist) = next.base(orientation);
        FloatingState { orientation, position: moved(position, &mean, step), twist, q: next.q, qd: next.qd }
    }
}

/// The variables that a step integrates, their rates, or changes of either: the turn of the base during the step, the
/// velocity of its origin in world axes, its angular velocity in its axes, and the joints, as an array or a list.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub struct Stage<J, T> {
    pub u: [T; 3],
    pub linear: [T; 3],
    pub omega: [T; 3],
    pub q: J,
    pub qd: J,
}

impl<J: AsRef<[T]> + AsMut<[T]> + Clone, T: Scalar> Stage<J, T> {
    /// Returns the variables of a state at the beginning of a step, when the base has not turned yet.
    pub fn of(orientation: &Quaternion<T>, twist: &BaseTwist<T>, q: J, qd: J) -> Self {
        let linear = times(&orientation.rotation(), &twist.linear);
        Self { u: [T::zero(); 3], linear, omega: twist.angular, q, qd }
    }

    /// Returns the rates of the variables from the accelerations. `orientation` is that of the base at the beginning of
    /// the step.
    #[must_use]
    pub fn rates(&self, base: &BaseAcceleration<T>, qdd: J, orientation: &Quaternion<T>, gravity: &[T; 3]) -> Self {
        let linear = times(&orientation.then(&turned(&self.u)).rotation(), &base.linear);
        Self {
            u: rate_of_turn(&self.u, &self.omega),
            linear: from_fn(|axis| linear[axis] + gravity[axis]),
            omega: base.angular,
            q: self.qd.clone(),
            qd: qdd,
        }
    }

    /// Returns the orientation of the base after its turn from `orientation`, and its velocity in its axes.
    pub fn base(&self, orientation: &Quaternion<T>) -> (Quaternion<T>, BaseTwist<T>) {
        let orientation = unit(&orientation.then(&turned(&self.u)));
        let linear = times(&transposed(&orientation.rotation()), &self.linear);
        (orientation, BaseTwist { linear, angular: self.omega })
    }

    /// Returns these variables plus h times other ones.
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

/// Returns the variables after a step of the classical Runge-Kutta method, and the mean of the velocities with which
/// the position moves. `rates` returns the rates at one of the four states, which are numbered 0 to 3.
#[doc(hidden)]
pub fn runge_kutta<J: AsRef<[T]> + AsMut<[T]> + Clone, T: Scalar>(
    start: &Stage<J, T>,
    step: T,
    mut rates: impl FnMut(usize, &Stage<J, T>) -> Stage<J, T>,
) -> (Stage<J, T>, [T; 3]) {
    let half = step * T::from_f64(0.5);
    let first = rates(0, start);
    let second = rates(1, &start.moved(&first, half));
    let third = rates(2, &start.moved(&second, half));
    let fourth = rates(3, &start.moved(&third, step));
    let sum = first.moved(&second.moved(&third, T::one()), T::one() + T::one()).moved(&fourth, T::one());
    let sixth = step / T::from_f64(6.0);
    let mean =
        from_fn(|axis| start.linear[axis] + (first.linear[axis] + second.linear[axis] + third.linear[axis]) * sixth);
    (start.moved(&sum, sixth), mean)
}

/// Converts a change of the coordinates u of a turn to a rotation vector in the turned axes: 4 / (1 + s) times the
/// change, turned back by half of the turn.
pub(crate) fn turn_by_change<T: Scalar>(u: &[T; 3], change: &[T; 3]) -> [T; 3] {
    let half = T::one() / (T::one() + dot(u, u));
    let scale = half + half;
    let once = cross(u, change);
    let twice = cross(u, &once);
    from_fn(|axis| (scale + scale) * (change[axis] + scale * (twice[axis] - once[axis])))
}

/// Returns the rate of the coordinates u of a turn from the angular velocity in the turned axes.
fn rate_of_turn<T: Scalar>(u: &[T; 3], omega: &[T; 3]) -> [T; 3] {
    let (two, quarter) = (T::one() + T::one(), T::from_f64(0.25));
    let (scale, along, across) = (T::one() - dot(u, u), two * dot(u, omega), cross(u, omega));
    from_fn(|axis| quarter * (scale * omega[axis] + two * across[axis] + along * u[axis]))
}

impl<const DOF: usize, const NV: usize, const TIPS: usize, R: FloatingBase<DOF, NV, TIPS> + ?Sized>
    FloatingIntegratorStep<DOF, NV, TIPS> for R
{
}

/// Returns the rotation by which a step turns the base.
pub(crate) fn turn<T: Scalar>(omega: &[T; 3], step: T) -> Quaternion<T> {
    let quarter = step * T::from_f64(0.25);
    turned(&omega.map(|x| x * quarter))
}

/// Returns the unit quaternion (1 - s, 2 u) / (1 + s) with s = u·u.
pub(crate) fn turned<T: Scalar>(u: &[T; 3]) -> Quaternion<T> {
    let square = dot(u, u);
    let scale = T::one() / (T::one() + square);
    let [x, y, z] = u.map(|x| (x + x) * scale);
    Quaternion { w: (T::one() - square) * scale, x, y, z }
}

/// Normalises a quaternion whose length is nearly 1, by one step of Newton's method.
pub(crate) fn unit<T: Scalar>(near: &Quaternion<T>) -> Quaternion<T> {
    let square = near.to_wxyz().iter().fold(T::zero(), |sum, &part| sum + part * part);
    let scale = T::from_f64(1.5) - square * T::from_f64(0.5);
    Quaternion::from_wxyz(near.to_wxyz().map(|part| part * scale))
}
