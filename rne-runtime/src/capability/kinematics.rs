//! Poses, Jacobians and torques of wrenches.

use crate::control::jacobian_derivatives::{derivatives_of_rows, rate_of_rows};
#[cfg(feature = "arm")]
use crate::definition::coordinates::Coordinates as _;
use crate::{Pose, Scalar, Wrench};

capability! {
/// Where the links and the tip are, and how they move with the joints. World axes; the robot's `base` places frame 0
/// there.
pub trait Kinematics<DOF> {
    /// The pose of the tip frame (`tool` included) in the world.
    #[doc(alias = "pose")]
    #[doc(alias = "fk")]
    #[doc(alias = "fkine")]
    fn forward_kinematics(q: joints) -> Pose =
        |robot| robot.mechanism.tip_pose(robot.of_joints(q).as_ref());

    /// The poses of the link frames of the table in the world: at the far end of link i in a standard table, on joint i
    /// in a modified one. The tool is not included.
    fn link_poses(q: joints) -> Poses =
        |robot| robot.coordinates.only(robot.mechanism.link_poses(robot.of_joints(q).as_ref()));

    /// The geometric Jacobian: J q̇ is the velocity of the tip frame's origin (three rows, m/s) above the angular
    /// velocity of the last link (three rows, rad/s), in world axes.
    ///
    /// Column i of a revolute joint is z_i × (p_tip - p_i) above z_i, of a prismatic one z_i above 0.
    #[doc(alias = "computeJointJacobian")]
    #[doc(alias = "mj_jac")]
    fn jacobian(q: joints) -> SpatialRows = |robot| robot.jacobian(q);

    /// J̇ q̇: acceleration of the tip frame's origin (m/s²) above angular acceleration of the last link (rad/s²) at q̈
    /// = 0, in world axes. At any other q̈ they are J q̈ + J̇ q̇.
    fn jacobian_rate_times_velocity(q: joints, qd: joints) -> Spatial = |robot| {
        let [q, qd] = [q, qd].map(|values| robot.of_joints(values));
        robot.mechanism.jacobian_rate_times_velocity(q.as_ref(), qd.as_ref())
    };

    /// Jᵀ w: the torques (N m, prismatic: N) by which the joints make the last link exert `wrench` on its environment
    /// at the tip, in tip axes. They are the difference between `inverse_dynamics_with_wrench` and `inverse_dynamics`.
    fn wrench_torques(q: joints, wrench: wrench) -> Vector or |this| {
        let (jacobian, Pose { rotation, .. }) = (this.jacobian(q), this.forward_kinematics(q));
        let turned = |[x, y, z]: [T; 3]| rotation.map(|[a, b, c]| a * x + b * y + c * z);
        let ([fx, fy, fz], [nx, ny, nz]) = (turned(wrench.force), turned(wrench.moment));
        let [vx, vy, vz, wx, wy, wz] = jacobian;
        core::array::from_fn(|i| vx[i] * fx + vy[i] * fy + vz[i] * fz + wx[i] * nx + wy[i] * ny + wz[i] * nz)
    } = |robot| robot.coordinates.torques(robot.mechanism.wrench_torques(robot.of_joints(q).as_ref(), wrench));
}
}

/// The functions of [`Kinematics`] and [`JacobianDerivatives`](crate::JacobianDerivatives) at one frame of the robot
/// file, or at the link frame of a joint, instead of the tip.
///
/// `#[derive(FrameKinematics)]` implements this trait for every frame. `FRAME` is the place of the frame: first the
/// list `frames` in the order of the file, then the link frames from base to tip. [`FrameKinematics`] has methods that
/// take the frame as a constant.
pub trait AtFrame<const DOF: usize, const FRAME: usize> {
    /// The pose of the frame in the world.
    #[must_use]
    fn pose_at_frame<T: Scalar>(&self, q: &[T; DOF]) -> Pose<T>;

    /// The geometric Jacobian of the frame, as [`Kinematics::jacobian`]. Columns of joints that do not move the frame
    /// are zero.
    #[must_use]
    fn jacobian_at_frame<T: Scalar>(&self, q: &[T; DOF]) -> [[T; DOF]; 6];

    /// J̇ q̇ of the frame, as [`Kinematics::jacobian_rate_times_velocity`].
    #[must_use]
    fn jacobian_rate_times_velocity_at_frame<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [T; 6];

    /// Jᵀ w of a wrench at the frame, as [`Kinematics::wrench_torques`].
    #[must_use]
    fn wrench_torques_at_frame<T: Scalar>(&self, q: &[T; DOF], wrench: &Wrench<T>) -> [T; DOF];

    /// The rate J̇ of the Jacobian of the frame, as
    /// [`JacobianDerivatives::jacobian_rate`](crate::JacobianDerivatives::jacobian_rate). The default implementation
    /// uses dual numbers through the Jacobian of the frame.
    #[must_use]
    fn jacobian_rate_at_frame<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [[T; DOF]; 6] {
        rate_of_rows(q, qd, |q| self.jacobian_at_frame(q))
    }

    /// ∂J/∂q of the frame, as
    /// [`JacobianDerivatives::jacobian_derivatives`](crate::JacobianDerivatives::jacobian_derivatives). The default
    /// implementation uses dual numbers.
    #[must_use]
    fn jacobian_derivatives_at_frame<T: Scalar>(&self, q: &[T; DOF]) -> [[[T; DOF]; DOF]; 6] {
        derivatives_of_rows(q, |q| self.jacobian_at_frame(q))
    }
}

/// Returns the index of a name in a list: the function `frame` of `#[derive(FrameKinematics)]` calls it.
#[doc(hidden)]
#[must_use]
pub const fn frame_index(names: &[&str], name: &str) -> Option<usize> {
    let mut index = 0;
    while index < names.len() {
        let (known, asked) = (names[index].as_bytes(), name.as_bytes());
        let mut at = 0;
        while at < known.len() && at < asked.len() && known[at] == asked[at] {
            at += 1;
        }
        if at == known.len() && at == asked.len() {
            return Some(index);
        }
        index += 1;
    }
    None
}

/// Pose, Jacobian, its rate and derivatives, J̇q̇ and torques of a wrench at the named frames of the robot file and at
/// the link frames. World axes, as in [`Kinematics`].
///
/// The frame is a constant, so that each call is straight-line code of this frame. `#[derive(FrameKinematics)]` also
/// gives the function `frame`, which turns a name into this constant while the program is compiled; a name that the
/// file does not have is a compile error: `arm.jacobian_of::<{ MyArm::frame("camera") }, _>(&q)`.
pub trait FrameKinematics<const DOF: usize, const FRAMES: usize> {
    /// The poses of the frames of the list `frames`, in the order of the file.
    #[must_use]
    fn frame_poses<T: Scalar>(&self, q: &[T; DOF]) -> [Pose<T>; FRAMES];

    /// The pose of a frame in the world.
    #[must_use]
    fn pose_of<const FRAME: usize, T: Scalar>(&self, q: &[T; DOF]) -> Pose<T>
    where
        Self: AtFrame<DOF, FRAME>,
    {
        self.pose_at_frame(q)
    }

    /// The geometric Jacobian of a frame: J q̇ is the velocity of its origin (three rows, m/s) above the angular
    /// velocity of its link (three rows, rad/s), in world axes.
    ///
    /// The frame is a constant of the call and not an argument: `arm.jacobian_of::<{ MyArm::frame("camera") }, _>(&q)`.
    #[doc(alias = "frame_jacobian")]
    #[doc(alias = "getFrameJacobian")]
    #[must_use]
    fn jacobian_of<const FRAME: usize, T: Scalar>(&self, q: &[T; DOF]) -> [[T; DOF]; 6]
    where
        Self: AtFrame<DOF, FRAME>,
    {
        self.jacobian_at_frame(q)
    }

    /// J̇ q̇ of a frame: the acceleration of its origin (m/s²) above the angular acceleration of its link (rad/s²) at
    /// q̈ = 0, in world axes.
    #[must_use]
    fn jacobian_rate_times_velocity_of<const FRAME: usize, T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [T; 6]
    where
        Self: AtFrame<DOF, FRAME>,
    {
        self.jacobian_rate_times_velocity_at_frame(q, qd)
    }

    /// Jᵀ w: the torques (N m, prismatic: N) by which the joints make the link of a frame exert `wrench` on its
    /// environment, about the origin of the frame and in its axes.
    #[must_use]
    fn wrench_torques_of<const FRAME: usize, T: Scalar>(&self, q: &[T; DOF], wrench: &Wrench<T>) -> [T; DOF]
    where
        Self: AtFrame<DOF, FRAME>,
    {
        self.wrench_torques_at_frame(q, wrench)
    }

    /// The rate J̇ of the geometric Jacobian of a frame at velocities `qd`, in world axes; zero columns for joints that
    /// do not move the frame.
    #[must_use]
    fn jacobian_rate_of<const FRAME: usize, T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [[T; DOF]; 6]
    where
        Self: AtFrame<DOF, FRAME>,
    {
        self.jacobian_rate_at_frame(q, qd)
    }

    /// ∂J/∂q of the geometric Jacobian of a frame, in world axes: element (r, i, j) is the derivative of element (r, i)
    /// with respect to the position of joint j.
    #[must_use]
    fn jacobian_derivatives_of<const FRAME: usize, T: Scalar>(&self, q: &[T; DOF]) -> [[[T; DOF]; DOF]; 6]
    where
        Self: AtFrame<DOF, FRAME>,
    {
        self.jacobian_derivatives_at_frame(q)
    }
}
