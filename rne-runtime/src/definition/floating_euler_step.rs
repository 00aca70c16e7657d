//! The step of the semi-implicit Euler method of a robot with a floating base, with the rotation of the base as a
//! matrix.

use core::array::from_fn;

use crate::integrators::moved;
use crate::values::pose_log::{dot, times, transposed};
use crate::{BaseAcceleration, BaseTwist, Pose, Scalar};

/// Returns the pose and the velocity of the base after a step; `gravity` is in world axes.
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

fn product<T: Scalar>(a: &[[T; 3]; 3], b: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    transposed(&transposed(b).map(|column| times(a, &column)))
}

/// Returns the rotation matrix of the unit quaternion (1 - s, 2 u) / (1 + s) with s = u·u and 4 u = `angle`.
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

/// Returns B (3 - Bᵀ B) / 2: one step of Newton's method from a matrix B that is nearly a rotation to the nearest
/// rotation.
fn next_rotation<T: Scalar>(near: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    let (half, columns) = (T::from_f64(0.5), transposed(near));
    let element = |row: usize, column: usize| {
        let product = dot(&columns[row.min(column)], &columns[row.max(column)]) * half;
        if row == column { T::from_f64(1.5) - product } else { -product }
    };
    product(near, &from_fn(|row| from_fn(|column| element(row, column))))
}
