//! The state of a floating base in the vectors of other tools: docs/reference/conventions.md has the table of these
//! conventions.

use num_traits::Float;

use crate::values::pose_log::{cross, times, transposed};
use crate::{BaseMotion, Pose, Quaternion, Scalar, Wrench};

/// The velocity of a floating base, in axes of frame 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseTwist<T> {
    /// Velocity of the origin of frame 0, m/s.
    pub linear: [T; 3],
    /// Angular velocity, rad/s.
    pub angular: [T; 3],
}

impl<T: Scalar> Default for BaseTwist<T> {
    /// A base at rest.
    fn default() -> Self {
        Self { linear: [T::zero(); 3], angular: [T::zero(); 3] }
    }
}

impl<T: Scalar> BaseTwist<T> {
    /// Creates it from the first six elements of Pinocchio's `v` with a free flyer: linear, angular, in axes of the
    /// base.
    #[must_use]
    pub fn from_pinocchio(v: &[T; 6]) -> Self {
        let [linear, angular] = halves(v);
        Self { linear, angular }
    }

    /// Returns the first six elements of Pinocchio's `v`.
    #[must_use]
    pub fn to_pinocchio(&self) -> [T; 6] {
        joined(self.linear, self.angular)
    }

    /// Creates it from the first six elements of MuJoCo's `qvel` with a free joint: linear in world axes, angular in
    /// axes of the base.
    #[must_use]
    pub fn from_mujoco(base: &Pose<T>, qvel: &[T; 6]) -> Self {
        let [linear, angular] = halves(qvel);
        Self { linear: times(&transposed(&base.rotation), &linear), angular }
    }

    /// Returns the first six elements of MuJoCo's `qvel`.
    #[must_use]
    pub fn to_mujoco(&self, base: &Pose<T>) -> [T; 6] {
        joined(times(&base.rotation, &self.linear), self.angular)
    }
}

#[cfg(feature = "arm")]
impl<T: Scalar> BaseTwist<T> {
    /// Returns the motion of a base with this velocity, without acceleration and gravity.
    pub(crate) fn motion(&self) -> BaseMotion<T> {
        BaseMotion { omega: self.angular, velocity: self.linear, ..BaseMotion::default() }
    }
}

impl<T: Scalar> BaseMotion<T> {
    /// The motion that an inertial measurement unit in frame 0 measures: ω (rad/s), its rate ω̇ (rad/s²), which is a
    /// difference of readings or zero, and the specific force a - g (m/s²). At rest the accelerometer measures -g,
    /// which points up.
    #[must_use]
    pub fn from_imu(gyroscope: [T; 3], gyroscope_rate: [T; 3], accelerometer: [T; 3]) -> Self {
        let zero = [T::zero(); 3];
        Self { omega: gyroscope, omega_dot: gyroscope_rate, velocity: zero, acceleration: accelerometer, gravity: zero }
    }

    /// The motion that a unit at `imu` in frame 0 measures, as in [`from_imu`](Self::from_imu). Its readings are in its
    /// own axes.
    #[must_use]
    pub fn from_imu_at(imu: &Pose<T>, gyroscope: [T; 3], gyroscope_rate: [T; 3], accelerometer: [T; 3]) -> Self {
        let [omega, omega_dot, there] =
            [gyroscope, gyroscope_rate, accelerometer].map(|reading| times(&imu.rotation, &reading));
        // a_imu = a_0 + ω̇ × p + ω × (ω × p)
        let (turning, inwards) = (cross(&omega_dot, &imu.translation), cross(&omega, &cross(&omega, &imu.translation)));
        let here = core::array::from_fn(|i| there[i] - turning[i] - inwards[i]);
        Self::from_imu(omega, omega_dot, here)
    }

    /// Creates it from the first elements of Pinocchio's `q` (7), `v` (6) and `a` (6) with a free flyer, and gravity in
    /// the axes in which `q` has the orientation: those of the placement of the free flyer, which are the world's in
    /// most models.
    ///
    /// Pinocchio's acceleration is spatial: the classical one of frame 0's origin is a + ω × v.
    #[must_use]
    pub fn from_pinocchio(q: &[T; 7], v: &[T; 6], a: &[T; 6], gravity: [T; 3]) -> Self {
        let base = Pose::from_pinocchio(q);
        let ([velocity, omega], [spatial, omega_dot]) = (halves(v), halves(a));
        let turning = cross(&omega, &velocity);
        let acceleration = core::array::from_fn(|i| spatial[i] + turning[i]);
        let gravity = times(&transposed(&base.rotation), &gravity);
        Self { omega, omega_dot, velocity, acceleration, gravity }
    }

    /// Returns the first six elements of Pinocchio's `a`: the spatial acceleration. It depends on the velocity and not
    /// on gravity.
    #[must_use]
    pub fn to_pinocchio(&self) -> [T; 6] {
        let turning = cross(&self.omega, &self.velocity);
        joined(core::array::from_fn(|i| self.acceleration[i] - turning[i]), self.omega_dot)
    }

    /// Creates it from the first elements of MuJoCo's `qpos` (7), `qvel` (6) and `qacc` (6) with a free joint, and
    /// gravity in world axes.
    #[must_use]
    pub fn from_mujoco(qpos: &[T; 7], qvel: &[T; 6], qacc: &[T; 6], gravity: [T; 3]) -> Self {
        let base = Pose::from_mujoco(qpos);
        let ([velocity, omega], [acceleration, omega_dot]) = (halves(qvel), halves(qacc));
        let in_base = |vector: [T; 3]| times(&transposed(&base.rotation), &vector);
        Self {
            omega,
            omega_dot,
            velocity: in_base(velocity),
            acceleration: in_base(acceleration),
            gravity: in_base(gravity),
        }
    }

    /// Returns the first six elements of MuJoCo's `qacc`.
    #[must_use]
    pub fn to_mujoco(&self, base: &Pose<T>) -> [T; 6] {
        joined(times(&base.rotation, &self.acceleration), self.omega_dot)
    }
}

impl<T: Scalar> Pose<T> {
    /// Creates it from the first seven elements of Pinocchio's `q` with a free flyer: the position, then the quaternion
    /// x y z w, of any length. It is the pose in the placement of the free flyer, which is the world in most models.
    #[must_use]
    pub fn from_pinocchio(&[a, b, c, x, y, z, w]: &[T; 7]) -> Self {
        Self { rotation: Quaternion { w, x, y, z }.rotation_of_any_length(), translation: [a, b, c] }
    }

    /// Creates it from the first seven elements of MuJoCo's `qpos` with a free joint: the position, then the quaternion
    /// w x y z, of any length.
    #[must_use]
    pub fn from_mujoco(&[a, b, c, w, x, y, z]: &[T; 7]) -> Self {
        Self { rotation: Quaternion { w, x, y, z }.rotation_of_any_length(), translation: [a, b, c] }
    }
}

/// For `f32` and `f64`, because the quaternion needs a square root.
impl<T: Scalar + Float> Pose<T> {
    /// Returns the first seven elements of Pinocchio's `q`.
    #[must_use]
    pub fn to_pinocchio(&self) -> [T; 7] {
        let ([a, b, c], [x, y, z, w]) = (self.translation, Quaternion::of_rotation(&self.rotation).to_xyzw());
        [a, b, c, x, y, z, w]
    }

    /// Returns the first seven elements of MuJoCo's `qpos`.
    #[must_use]
    pub fn to_mujoco(&self) -> [T; 7] {
        let ([a, b, c], [w, x, y, z]) = (self.translation, Quaternion::of_rotation(&self.rotation).to_wxyz());
        [a, b, c, w, x, y, z]
    }
}

/// The wrench on a floating base ([`FloatingTorques::wrench`](crate::FloatingTorques::wrench)) as the first six
/// elements of a generalised force.
impl<T: Scalar> Wrench<T> {
    /// Returns it as in Pinocchio's `tau`: force, moment, in axes of the base.
    #[must_use]
    pub fn to_pinocchio(&self) -> [T; 6] {
        joined(self.force, self.moment)
    }

    /// Returns it as in MuJoCo's `qfrc_inverse`: the force in world axes, the moment about the base's origin in axes of
    /// the base.
    #[must_use]
    pub fn to_mujoco(&self, base: &Pose<T>) -> [T; 6] {
        joined(times(&base.rotation, &self.force), self.moment)
    }
}

fn halves<T: Copy>(&[a, b, c, d, e, f]: &[T; 6]) -> [[T; 3]; 2] {
    [[a, b, c], [d, e, f]]
}

fn joined<T>([a, b, c]: [T; 3], [d, e, f]: [T; 3]) -> [T; 6] {
    [a, b, c, d, e, f]
}
