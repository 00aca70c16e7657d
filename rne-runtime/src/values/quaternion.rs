//! The orientation of a base as a unit quaternion, in either order of its elements.

use num_traits::Float;

use crate::Scalar;
use crate::values::pose_log::half_turn;

/// A unit quaternion w + x i + y j + z k: the rotation that turns components in the axes of a frame into components in
/// the axes of the world. `q` and `-q` are the same rotation.
///
/// An array of four numbers does not show which element is w, so the name of each constructor tells the order.
///
/// ```
/// use rne_runtime::Quaternion;
///
/// // a quarter turn about z, as MuJoCo and Drake write it, and as Pinocchio and ROS do
/// let half = 0.5_f64.sqrt();
/// let turn = Quaternion::from_wxyz([half, 0.0, 0.0, half]);
/// assert_eq!(turn, Quaternion::from_xyzw([0.0, 0.0, half, half]));
/// // x of the frame points along y of the world
/// assert!((turn.rotation()[1][0] - 1.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion<T> {
    /// The scalar part.
    pub w: T,
    /// Component along x.
    pub x: T,
    /// Component along y.
    pub y: T,
    /// Component along z.
    pub z: T,
}

impl<T: Scalar> Quaternion<T> {
    /// No rotation.
    #[must_use]
    pub fn identity() -> Self {
        let zero = T::zero();
        Self { w: T::one(), x: zero, y: zero, z: zero }
    }

    /// Creates it from an array in the order of MuJoCo, Drake and iDynTree. It must have length 1.
    #[must_use]
    pub fn from_wxyz([w, x, y, z]: [T; 4]) -> Self {
        Self { w, x, y, z }
    }

    /// Creates it from an array in the order of Pinocchio, Eigen's storage, ROS and dynibo. It must have length 1.
    #[must_use]
    pub fn from_xyzw([x, y, z, w]: [T; 4]) -> Self {
        Self { w, x, y, z }
    }

    /// Returns it as an array in the order of MuJoCo, Drake and iDynTree.
    #[must_use]
    pub fn to_wxyz(self) -> [T; 4] {
        [self.w, self.x, self.y, self.z]
    }

    /// Returns it as an array in the order of Pinocchio, Eigen's storage, ROS and dynibo.
    #[must_use]
    pub fn to_xyzw(self) -> [T; 4] {
        [self.x, self.y, self.z, self.w]
    }

    /// The rows of the rotation matrix.
    #[must_use]
    pub fn rotation(&self) -> [[T; 3]; 3] {
        self.rotation_by(T::one() + T::one())
    }

    /// The rows of the rotation matrix of this quaternion after division by its length, computed without a root. A
    /// quaternion of zeros has no rotation: the elements are not finite then.
    #[must_use]
    pub(crate) fn rotation_of_any_length(&self) -> [[T; 3]; 3] {
        let square = self.to_wxyz().into_iter().fold(T::zero(), |sum, x| sum + x * x);
        self.rotation_by((T::one() + T::one()) / square)
    }

    /// Returns the rows of the rotation matrix, where `two` is 2 over the square of the length.
    fn rotation_by(&self, two: T) -> [[T; 3]; 3] {
        let Self { w, x, y, z } = *self;
        let one = T::one();
        [
            [one - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)],
            [two * (x * y + w * z), one - two * (x * x + z * z), two * (y * z - w * x)],
            [two * (x * z - w * y), two * (y * z + w * x), one - two * (x * x + y * y)],
        ]
    }

    /// Returns the rotation that first applies `next`, whose axes are those of this frame, then this rotation.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.to_wxyz(), next.to_wxyz());
        Self {
            w: a * e - b * f - c * g - d * h,
            x: a * f + b * e + c * h - d * g,
            y: a * g - b * h + c * e + d * f,
            z: a * h + b * g - c * f + d * e,
        }
    }
}

/// For `f32` and `f64`, with the square root and the sine of each type.
impl<T: Scalar + Float> Quaternion<T> {
    /// The quaternion of a rotation matrix, with w ≥ 0 (Shepperd 1978).
    #[must_use]
    pub fn of_rotation(rotation: &[[T; 3]; 3]) -> Self {
        let ([x, y, z], _, w) = half_turn(rotation);
        Self { w, x, y, z }
    }

    /// Returns the orientation after a further turn by the rotation vector `turn` (rad) in axes of the frame: ω dt,
    /// where a gyroscope on the frame measures ω. The result has length 1 to rounding, however many steps came before.
    ///
    /// For a constant ω the step is exact; otherwise its error is of order dt³ if ω is taken in the middle of the step.
    #[must_use]
    pub fn turned_by(&self, turn: [T; 3]) -> Self {
        let half = <T as Scalar>::from_f64(0.5);
        let [x, y, z] = turn.map(|angle| angle * half);
        let square = x * x + y * y + z * z;
        let angle = Float::sqrt(square);
        let (sine, w) = Scalar::sin_cos(angle);
        // sin(a) / a, by its series for small a, where the quotient would have few correct digits
        let ratio = if square < <T as Scalar>::from_f64(1e-8) {
            T::one() - square * <T as Scalar>::from_f64(1.0 / 6.0)
        } else {
            sine / angle
        };
        let next = self.then(&Self { w, x: x * ratio, y: y * ratio, z: z * ratio });
        let length = Float::sqrt(next.to_wxyz().iter().fold(T::zero(), |sum, &part| sum + part * part));
        let [w, x, y, z] = next.to_wxyz().map(|part| part / length);
        Self { w, x, y, z }
    }
}
