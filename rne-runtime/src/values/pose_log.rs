//! The logarithm of a pose: the rotation vector and the twist that lead to it. Errors of orientation are computed with
//! it.

use num_traits::Float;

use crate::{Pose, Scalar};

impl<T: Scalar> Pose<T> {
    /// Returns the pose of the world in this frame: Rᵀ, -Rᵀ p.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = transposed(&self.rotation);
        let translation = times(&rotation, &self.translation).map(|x| T::zero() - x);
        Self { rotation, translation }
    }

    /// Returns the pose of a frame that is at `next` in this frame: R R', R p' + p.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let columns = transposed(&next.rotation).map(|column| times(&self.rotation, &column));
        let [x, y, z] = times(&self.rotation, &next.translation);
        let [a, b, c] = self.translation;
        Self { rotation: transposed(&columns), translation: [x + a, y + b, z + c] }
    }
}

/// For `f32` and `f64`; each uses its own square root and arc tangent, so that `f32` needs no double precision.
impl<T: Scalar + Float> Pose<T> {
    /// The logarithm of the rotation, so(3): the axis times the angle, rad; the angle is from 0 to π. At π the axis may
    /// have either sign.
    ///
    /// By the unit quaternion of the rotation, of which the largest element is computed first (Shepperd 1978); so the
    /// vector is accurate near 0 and near π, too.
    #[must_use]
    pub fn rotation_log(&self) -> [T; 3] {
        let (vector, scale, _) = half_turn(&self.rotation);
        vector.map(|x| x * scale)
    }

    /// The logarithm of the pose, se(3): linear (m), then angular (rad). The constant twist that leads from the world
    /// to this frame in one unit of time, in the axes of this frame or of the world: its components are the same in
    /// both.
    ///
    /// linear = t - ½ φ × t + c φ × (φ × t) with c = (1 - (θ/2) cot(θ/2)) / θ² (Lynch and Park, Modern Robotics,
    /// 3.3.3).
    #[must_use]
    pub fn log(&self) -> [T; 6] {
        let (vector, scale, cos) = half_turn(&self.rotation);
        let phi = vector.map(|x| x * scale);
        let square = dot(&phi, &phi);
        let number = <T as Scalar>::from_f64;
        let c = if square < number(0.1) {
            // Taylor series, because the closed form would subtract nearly equal numbers here
            [1_209_600.0, 30_240.0, 720.0, 12.0]
                .iter()
                .fold(number(1.0 / 47_900_160.0) + square * number(691.0 / 1_307_674_368_000.0), |sum, &next| {
                    sum * square + number(1.0 / next)
                })
        } else {
            // `cos` is that of θ/2, and θ/2 cot(θ/2) = (θ / sin(θ/2)) cos / 2
            (T::one() - scale * cos * number(0.5)) / square
        };
        let once = cross(&phi, &self.translation);
        let twice = cross(&phi, &once);
        let linear: [T; 3] = core::array::from_fn(|i| self.translation[i] - once[i] * number(0.5) + twice[i] * c);
        [linear[0], linear[1], linear[2], phi[0], phi[1], phi[2]]
    }

    /// Returns the error of this pose from `target`, in world axes, in the order of the rows of a Jacobian: p_target -
    /// p (m), then the logarithm of R_target Rᵀ (rad). A motion with J q̇ = k · error leads to the target.
    #[must_use]
    pub fn error_to(&self, target: &Self) -> [T; 6] {
        let back = Self { translation: [T::zero(); 3], rotation: transposed(&self.rotation) };
        let turn = Self { translation: [T::zero(); 3], ..*target }.then(&back).rotation_log();
        let way: [T; 3] = core::array::from_fn(|i| target.translation[i] - self.translation[i]);
        [way[0], way[1], way[2], turn[0], turn[1], turn[2]]
    }
}

/// Returns the vector part of the unit quaternion, the factor that turns it into the rotation vector, and the scalar
/// part, which is not negative.
pub(crate) fn half_turn<T: Scalar + Float>(rotation: &[[T; 3]; 3]) -> ([T; 3], T, T) {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = *rotation;
    let (one, zero): (T, T) = (T::one(), T::zero());
    // four times the product of elements i and j of the quaternion (w, x, y, z)
    let products = [
        [one + xx + yy + zz, zy - yz, xz - zx, yx - xy],
        [zy - yz, one + xx - yy - zz, xy + yx, xz + zx],
        [xz - zx, xy + yx, one - xx + yy - zz, yz + zy],
        [yx - xy, xz + zx, yz + zy, one - xx - yy + zz],
    ];
    let largest = (1..4).fold(0, |best, i| if products[i][i] > products[best][best] { i } else { best });
    let row = products[largest];
    let length = Float::sqrt(row.iter().fold(zero, |sum, &x| sum + x * x));
    let sign = if row[0] < zero { zero - one } else { one };
    let [w, x, y, z] = row.map(|element| element * sign / length);
    let vector = [x, y, z];
    let sin = Float::sqrt(dot(&vector, &vector));
    let two = one + one;
    // θ / sin(θ/2), or its limit if the sine is zero
    let scale = if sin == zero { two } else { two * sin.atan2(w) / sin };
    (vector, scale, w)
}

pub(crate) fn transposed<T: Copy>([[a, b, c], [d, e, f], [g, h, i]]: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    [[*a, *d, *g], [*b, *e, *h], [*c, *f, *i]]
}

pub(crate) fn times<T: Scalar>(matrix: &[[T; 3]; 3], vector: &[T; 3]) -> [T; 3] {
    matrix.map(|row| dot(&row, vector))
}

pub(crate) fn dot<T: Scalar>([a, b, c]: &[T; 3], [x, y, z]: &[T; 3]) -> T {
    *a * *x + *b * *y + *c * *z
}

pub(crate) fn cross<T: Scalar>([a, b, c]: &[T; 3], [x, y, z]: &[T; 3]) -> [T; 3] {
    [*b * *z - *c * *y, *c * *x - *a * *z, *a * *y - *b * *x]
}
