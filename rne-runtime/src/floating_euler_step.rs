//! The step of the semi-implicit Euler method of a robot with a floating base, with the rotation of the base as a
//! matrix.

#[cfg(feature = "arm")]
use core::array::from_fn;

#[cfg(feature = "arm")]
use crate::pose_log::{dot, times, transposed};
#[cfg(feature = "arm")]
use crate::steps::moved;
#[cfg(feature = "arm")]
use crate::{ArmWithTips, BaseAcceleration, Constant, at_tip::AtTip, definition::definitions};
use crate::{BaseTwist, FloatingNextState, Pose, Scalar, Wrench};

/// A step of the semi-implicit Euler method of a robot with a floating base, under torques and wrenches that do not
/// change during the step. The base, the tips and the wrenches are those of [`FloatingBase`](crate::FloatingBase).
pub trait FloatingEulerStep<const DOF: usize, const TIPS: usize> {
    /// The state after a step of the duration `step`, s. `pose` is that of frame 0 in the world, `twist` its velocity
    /// in its axes. Gravity is that of the robot file, in axes of the world.
    ///
    /// The velocities come first, by the accelerations of [`floating_forward_dynamics`](
    /// crate::FloatingBase::floating_forward_dynamics), those of the origin of frame 0 in world axes. Then this origin
    /// and the joints move with the new velocities, and the base turns by the new angular velocity in its axes. The
    /// error of a motion is of order h.
    ///
    /// The base turns by the unit quaternion (1 - s, 2 u) / (1 + s) with u = h ω / 4 and s = u·u. It needs no root, no
    /// sine and no quotient by an angle, so it is smooth at ω = 0; its angle is h |ω| less (h |ω|)³ / 48, an error of
    /// higher order than that of the method. The rotation after the step is orthogonal to rounding, however many steps
    /// came before. A `pose` that is no rotation, or a base without mass, gives numbers without a meaning.
    #[must_use]
    #[allow(clippy::too_many_arguments)] // a state and what acts on it
    fn floating_euler_step<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        pose: &Pose<T>,
        twist: &BaseTwist<T>,
        step: T,
        wrenches: &[Wrench<T>; TIPS],
    ) -> FloatingNextState<DOF, T>;
}

/// The pose and the velocity of the base after a step; `gravity` is in world axes.
#[cfg(feature = "arm")]
pub(crate) fn next_of_base<T: Scalar>(
    (pose, twist): (&Pose<T>, &BaseTwist<T>),
    acceleration: &BaseAcceleration<T>,
    gravity: &[T; 3],
    step: T,
) -> (Pose<T>, BaseTwist<T>) {
    let angular = moved(&twist.angular, &acceleration.angular, step);
    let linear = moved(&twist.linear, &acceleration.linear, step);
    let in_world = moved(&times(&pose.rotation, &linear), gravity, step);
    let turned = product(&pose.rotation, &turn(&angular.map(|x| x * step)));
    let rotation = next_rotation(&turned);
    let linear = times(&transposed(&rotation), &in_world);
    let translation = moved(&pose.translation, &in_world, step);
    (Pose { rotation, translation }, BaseTwist { linear, angular })
}

#[cfg(feature = "arm")]
fn product<T: Scalar>(a: &[[T; 3]; 3], b: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    transposed(&transposed(b).map(|column| times(a, &column)))
}

/// The rotation by the unit quaternion (1 - s, 2 u) / (1 + s) with s = u·u and 4 u = `angle`.
#[cfg(feature = "arm")]
fn turn<T: Scalar>(angle: &[T; 3]) -> [[T; 3]; 3] {
    let one = T::one();
    let u = angle.map(|x| x * T::from_f64(0.25));
    let inverse = one / (one + dot(&u, &u));
    let factor = inverse + inverse;
    let (w, [x, y, z]) = (factor - one, u.map(|x| x * factor));
    let [x2, y2, z2] = [x + x, y + y, z + z];
    let ([xx, yy, zz], [xy, xz, yz], [wx, wy, wz]) =
        ([x2 * x, y2 * y, z2 * z], [x2 * y, x2 * z, y2 * z], [x2 * w, y2 * w, z2 * w]);
    [[one - (yy + zz), xy - wz, xz + wy], [xy + wz, one - (xx + zz), yz - wx], [xz - wy, yz + wx, one - (xx + yy)]]
}

/// B (3 - Bᵀ B) / 2: a step of Newton's method towards the rotation next to B.
#[cfg(feature = "arm")]
fn next_rotation<T: Scalar>(near: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    let (half, columns) = (T::from_f64(0.5), transposed(near));
    let element = |row: usize, column: usize| {
        let product = dot(&columns[row.min(column)], &columns[row.max(column)]) * half;
        if row == column { T::from_f64(1.5) - product } else { -product }
    };
    product(near, &from_fn(|row| from_fn(|column| element(row, column))))
}

#[cfg(feature = "arm")]
definitions! { FloatingEulerStep<DOF, TIPS> {
    /// As [`FloatingEulerStep::floating_euler_step`], with one of `wrenches` for each of the [tips](Self::tips).
    fn floating_euler_step(
        q: joints, qd: joints, tau: joints, pose: pose, twist: twist, step: number, wrenches: wrenches
    ) -> FloatingNextState<DOF> = |robot| {
        let (base, qdd) = robot.floating_forward_dynamics([q, qd, tau], &twist.angular, AtTip::Wrenches(wrenches));
        let (pose, twist) = next_of_base((pose, twist), &base, &robot.mechanism.gravity.map(S::to), step);
        let [q, qd] = [q, qd].map(|x| robot.list(x));
        let qd = moved(&qd, &qdd, step);
        (pose, twist, moved(&q, &qd, step), qd)
    };
} }
