//! The pose of a frame: its origin and its orientation.

use crate::Scalar;

/// The pose of a frame in another: `rotation` turns components in the axes of the frame into components in the axes of
/// the other one, where `translation` is the frame's origin. A point p of the frame is at rotation p + translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T> {
    /// Rows of the rotation matrix.
    pub rotation: [[T; 3]; 3],
    /// Origin of the frame, m.
    pub translation: [T; 3],
}

impl<T: Scalar> Pose<T> {
    /// The frame itself: no rotation, no translation.
    #[must_use]
    pub fn identity() -> Self {
        let (zero, one) = (T::zero(), T::one());
        Self { rotation: [[one, zero, zero], [zero, one, zero], [zero, zero, one]], translation: [zero; 3] }
    }
}

impl Pose<f64> {
    /// Whether this is the pose of a rigid body, within single precision: the rows of its rotation are unit vectors at
    /// right angles, right-handed, to 1e-4. A pose with a NaN counts as rigid, because its results are NaN.
    #[must_use]
    pub fn is_rigid(&self) -> bool {
        const MOST_ROUNDED: f64 = 1e-4;
        let [x, y, z] = self.rotation;
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let cross = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
        let errors = [dot(x, x) - 1.0, dot(y, y) - 1.0, dot(x, y), z[0] - cross[0], z[1] - cross[1], z[2] - cross[2]];
        !errors.iter().any(|error| *error > MOST_ROUNDED || *error < -MOST_ROUNDED)
    }
}

/// Conversions from and to nalgebra.
#[cfg(feature = "nalgebra")]
mod conversion {
    use nalgebra::{Matrix3, Matrix4, Vector3};

    use super::Pose;
    use crate::Scalar;

    impl<T: Scalar> Pose<T> {
        /// Creates a pose from an nalgebra matrix and vector. `rotation` is used unchanged: the caller must ensure that
        /// it is orthonormal.
        #[must_use]
        pub fn from_matrix(rotation: Matrix3<T>, translation: Vector3<T>) -> Self {
            Self { rotation: rotation.transpose().into(), translation: translation.into() }
        }

        /// The rotation as an nalgebra matrix.
        #[must_use]
        pub fn rotation_matrix(&self) -> Matrix3<T> {
            Matrix3::from(self.rotation).transpose()
        }

        /// The translation as an nalgebra vector.
        #[must_use]
        pub fn translation_vector(&self) -> Vector3<T> {
            self.translation.into()
        }

        /// The homogeneous transform: rotation and translation above a row (0, 0, 0, 1).
        #[must_use]
        pub fn to_homogeneous(&self) -> Matrix4<T> {
            let (zero, one) = (T::zero(), T::one());
            let ([[a, b, c], [d, e, f], [g, h, i]], [x, y, z]) = (self.rotation, self.translation);
            #[rustfmt::skip]
        let matrix = Matrix4::new(
            a,    b,    c,    x,
            d,    e,    f,    y,
            g,    h,    i,    z,
            zero, zero, zero, one,
        );
            matrix
        }
    }

    #[cfg(feature = "simba")]
    mod isometry {
        use nalgebra::{IsometryMatrix3, Rotation3, SimdRealField, Translation3};

        use super::{Pose, Scalar};

        impl<T: Scalar + SimdRealField<Element: SimdRealField>> From<Pose<T>> for IsometryMatrix3<T> {
            fn from(pose: Pose<T>) -> Self {
                let rotation = Rotation3::from_matrix_unchecked(pose.rotation_matrix());
                Self::from_parts(Translation3::from(pose.translation_vector()), rotation)
            }
        }

        impl<T: Scalar + SimdRealField> From<IsometryMatrix3<T>> for Pose<T> {
            fn from(isometry: IsometryMatrix3<T>) -> Self {
                Self::from_matrix(isometry.rotation.into_inner(), isometry.translation.vector)
            }
        }
    }
}
