//! The functions of a robot: one trait per capability, implemented by generated code and by [`Arm`](crate::Arm) alike.
//!
//! A trait gets a new method only with a default, or in a breaking version.
//!
//! Joint arrays run from base to tip. Revolute joints: rad, rad/s, rad/s², N m. Prismatic joints: m, m/s, m/s², N.

use crate::ldlt::inverse_of;
use crate::smooth_sign::SmoothSign;
use crate::{BaseMotion, BaseTwist, Payload, Pose, Scalar, Wrench};

/// Torques from motion: recursive Newton-Euler inverse dynamics, τ(q, q̇, q̈).
///
/// τ is what the actuators must deliver: τ = M(q) q̈ + C(q, q̇) q̇ + g(q). No friction, and no rotor inertia
/// unless the arm is taken with its rotors: `#[robot(rotors)]`, `with_rotors`.
#[diagnostic::on_unimplemented(
    note = "`InverseDynamics` belongs into the same `derive`, for a number of joints that the robot file decides: \
            `#[derive(InverseDynamics)]`, and with batches `#[derive(InverseDynamics, BatchInverseDynamics)]`"
)]
pub trait InverseDynamics<const DOF: usize> {
    /// Torques for positions `q`, velocities `qd` and accelerations `qdd` with a free tip.
    #[must_use]
    fn inverse_dynamics<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], qdd: &[T; DOF]) -> [T; DOF];

    /// Torques when the last link exerts `wrench` on its environment: τ = τ_free + Jᵀ w.
    #[must_use]
    fn inverse_dynamics_with_wrench<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        wrench: &Wrench<T>,
    ) -> [T; DOF];

    /// Torques when `payload` is fixed to the tip: a mass (kg), its centre (m) and the inertia about it (kg m²), all in
    /// tip-frame axes, known when the program runs. They are those of the arm whose last link has the payload too.
    #[must_use]
    fn inverse_dynamics_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        payload: &Payload<T>,
    ) -> [T; DOF];

    /// Torques for a caller who has the sines and cosines of the joint positions already, from a CORDIC or a kinematics
    /// pass: `sin[i]` and `cos[i]` are those of `q[i]` of a revolute joint, without the constant part of its angle;
    /// those of a prismatic joint are not used, as `q[i]` of a revolute joint is not.
    #[must_use]
    fn inverse_dynamics_from_sin_cos<T: Scalar>(
        &self,
        sin: &[T; DOF],
        cos: &[T; DOF],
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
    ) -> [T; DOF];

    /// Torques that hold the arm still against gravity, τ(q, 0, 0).
    #[must_use]
    fn gravity_torques<T: Scalar>(&self, q: &[T; DOF]) -> [T; DOF];

    /// Coriolis, centrifugal and gravity torques, τ(q, q̇, 0).
    #[must_use]
    fn bias_torques<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [T; DOF];
}

/// The mass matrix M(q) of τ = M(q) q̈ + C(q, q̇) q̇ + g(q).
#[diagnostic::on_unimplemented(
    note = "`MassMatrix` belongs into the same `derive`: `#[derive(MassMatrix)]`, and with batches \
            `#[derive(MassMatrix, BatchMassMatrix)]`"
)]
pub trait MassMatrix<const DOF: usize> {
    /// M(q): element (i, j) is the torque at joint i for a unit acceleration of joint j, from rest and without gravity.
    /// In kg m², kg m or kg, as the kinds of joints i and j have it.
    ///
    /// Symmetric to the last bit, positive semidefinite; definite unless links are massless. No rotor inertia,
    /// unless the arm is taken with its rotors (`#[robot(rotors)]`, `with_rotors`): then G² Jm stands on the diagonal.
    #[must_use]
    fn mass_matrix<T: Scalar>(&self, q: &[T; DOF]) -> [[T; DOF]; DOF];

    /// M(q)⁻¹: element (i, j) is the acceleration of joint i for a unit torque at joint j, from rest and without
    /// gravity.
    ///
    /// Symmetric to the last bit. A singular mass matrix (a joint that moves nothing) gives numbers that are not
    /// finite, and never panics.
    #[must_use]
    fn inverse_mass_matrix<T: Scalar>(&self, q: &[T; DOF]) -> [[T; DOF]; DOF] {
        inverse_of(self.mass_matrix(q), &[T::zero(); DOF])
    }
}

/// The matrix C(q, q̇) of τ = M(q) q̈ + C(q, q̇) q̇ + g(q), by Christoffel's symbols.
pub trait CoriolisMatrix<const DOF: usize> {
    /// C(q, q̇), row = torque. Of the matrices that give the same C q̇ it is Christoffel's, C_ij = ½ Σ_k (∂M_ij/∂q_k +
    /// ∂M_ik/∂q_j - ∂M_jk/∂q_i) q̇_k: Ṁ - 2C is skew, Ṁ = C + Cᵀ, and C is half the derivative of C q̇ with respect to q̇.
    #[must_use]
    fn coriolis_matrix<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [[T; DOF]; DOF];
}

/// Motion from torques, for simulation.
#[diagnostic::on_unimplemented(
    note = "`ForwardDynamics` belongs into the same `derive`: `#[derive(ForwardDynamics)]`, and with batches \
            `#[derive(ForwardDynamics, BatchForwardDynamics)]`"
)]
pub trait ForwardDynamics<const DOF: usize> {
    /// Accelerations q̈ = M(q)⁻¹ (τ - C(q, q̇) q̇ - g(q)) with a free tip, rad/s² or m/s².
    ///
    /// A singular mass matrix (a joint that moves nothing) gives numbers that are not finite, and never panics.
    #[must_use]
    fn forward_dynamics<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], tau: &[T; DOF]) -> [T; DOF];
}

/// Where the links and the tip are, and how they move with the joints. World axes; the robot's `base` places frame 0
/// there.
pub trait Kinematics<const DOF: usize> {
    /// The pose of the tip frame (`tool` included) in the world.
    #[must_use]
    fn forward_kinematics<T: Scalar>(&self, q: &[T; DOF]) -> Pose<T>;

    /// The poses of the link frames of the table in the world: at the far end of link i in a standard table, on joint i
    /// in a modified one. The tool is not included.
    #[must_use]
    fn link_poses<T: Scalar>(&self, q: &[T; DOF]) -> [Pose<T>; DOF];

    /// The geometric Jacobian: J q̇ is the velocity of the tip frame's origin (three rows, m/s) above the angular
    /// velocity of the last link (three rows, rad/s), in world axes.
    ///
    /// Column i of a revolute joint is z_i × (p_tip - p_i) above z_i, of a prismatic one z_i above 0.
    #[must_use]
    fn jacobian<T: Scalar>(&self, q: &[T; DOF]) -> [[T; DOF]; 6];

    /// J̇ q̇: acceleration of the tip frame's origin (m/s²) above angular acceleration of the last link (rad/s²) at q̈ =
    /// 0, in world axes. At any other q̈ they are J q̈ + J̇ q̇.
    #[must_use]
    fn jacobian_rate_times_velocity<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [T; 6];

    /// Jᵀ w: the torques (N m, prismatic: N) by which the joints make the last link exert `wrench` on its environment
    /// at the tip, in tip axes. They are the difference between `inverse_dynamics_with_wrench` and `inverse_dynamics`.
    #[must_use]
    fn wrench_torques<T: Scalar>(&self, q: &[T; DOF], wrench: &Wrench<T>) -> [T; DOF] {
        let (jacobian, Pose { rotation, .. }) = (self.jacobian(q), self.forward_kinematics(q));
        let turned = |[x, y, z]: [T; 3]| rotation.map(|[a, b, c]| a * x + b * y + c * z);
        let ([fx, fy, fz], [nx, ny, nz]) = (turned(wrench.force), turned(wrench.moment));
        let [vx, vy, vz, wx, wy, wz] = jacobian;
        core::array::from_fn(|i| vx[i] * fx + vy[i] * fy + vz[i] * fz + wx[i] * nx + wy[i] * ny + wz[i] * nz)
    }
}

/// The functions of [`Kinematics`] at one frame of the robot file, or at the link frame of a joint, instead of the tip.
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
}

/// The place of a name in a list: the function `frame` of `#[derive(FrameKinematics)]`.
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

/// Pose, Jacobian, J̇q̇ and torques of a wrench at the named frames of the robot file and at the link frames.
/// World axes, as in [`Kinematics`].
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

    /// J̇ q̇ of a frame: the acceleration of its origin (m/s²) above the angular acceleration of its link (rad/s²) at q̈
    /// = 0, in world axes.
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
}

/// The centre of mass of the links, all together, in the world; the robot's `base` places frame 0 there. Rotors are not
/// included. An arm without mass gives numbers that are not finite.
pub trait CentreOfMass<const DOF: usize> {
    /// Σ m c / Σ m, m.
    #[must_use]
    fn centre_of_mass<T: Scalar>(&self, q: &[T; DOF]) -> [T; 3];

    /// Its Jacobian: J q̇ is the velocity of the centre of mass, m/s, in world axes.
    #[must_use]
    fn centre_of_mass_jacobian<T: Scalar>(&self, q: &[T; DOF]) -> [[T; DOF]; 3];
}

/// Kinetic and potential energy of the links, J. The kinetic energy of rotors, ½ G² Jm q̇², is included where the arm is
/// taken with them: `#[robot(rotors)]`, `with_rotors`.
pub trait Energy<const DOF: usize> {
    /// ½ q̇ᵀ M(q) q̇, as ½ Σ (m ċ·ċ + ω·Iω).
    #[must_use]
    fn kinetic_energy<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> T;

    /// -Σ m g·c, with c from the origin of frame 0 to each centre of mass: zero where all masses are there. Where the
    /// base stands in the world does not matter.
    #[must_use]
    fn potential_energy<T: Scalar>(&self, q: &[T; DOF]) -> T;
}

/// The torques as a linear function of the inertial parameters, for their identification.
pub trait Regressor<const DOF: usize> {
    /// Y(q, q̇, q̈), gravity included: τ_i = Σ_j Σ_k Y\[i\]\[j\]\[k\] π_jk (torque, link, parameter), with ten parameters
    /// per link, π_j = (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz).
    ///
    /// They refer to the link frame of the table: c and J from its origin, in its axes; Jxy is the tensor's element, -∫
    /// x y dm.
    #[must_use]
    fn regressor<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], qdd: &[T; DOF]) -> [[[T; 10]; DOF]; DOF];
}

/// ∂τ/∂q and ∂τ/∂q̇ of one state. Row i is torque i, column j is joint j.
///
/// Units: of a torque (N m, or N for a prismatic joint) per rad or m, and per rad/s or m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueDerivatives<const DOF: usize, T> {
    /// ∂τ_i/∂q_j.
    pub dq: [[T; DOF]; DOF],
    /// ∂τ_i/∂q̇_j.
    pub dqd: [[T; DOF]; DOF],
}

/// How the torques change with the state.
#[diagnostic::on_unimplemented(
    note = "`InverseDynamicsDerivatives` belongs into the same `derive`: `#[derive(InverseDynamicsDerivatives)]`, and \
            with batches `#[derive(InverseDynamicsDerivatives, BatchInverseDynamicsDerivatives)]`"
)]
pub trait InverseDynamicsDerivatives<const DOF: usize> {
    /// ∂τ/∂q and ∂τ/∂q̇ of [`inverse_dynamics`](InverseDynamics::inverse_dynamics) at a state, row = torque, column =
    /// joint. ∂τ/∂q̈ is the [mass matrix](MassMatrix::mass_matrix).
    #[must_use]
    fn inverse_dynamics_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
    ) -> TorqueDerivatives<DOF, T>;
}

/// Loads of the joint bearings: the wrenches between links.
pub trait JointWrenches<const DOF: usize> {
    /// f_{i-1,i} and n_{i-1,i} with a free tip: exerted BY link i-1 ON link i, about the joint's reference point J_i,
    /// in the axes of form P (fixed to link i, z along joint i). The z element of the moment of a revolute joint, of
    /// the force of a prismatic one, is τ_i.
    ///
    /// J_i is fixed to link i-1: the origin of frame i-1 in a standard table; in a modified one the foot of the common
    /// normal on axis i. Moment in N m, force in N.
    #[must_use]
    fn joint_wrenches<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], qdd: &[T; DOF]) -> [Wrench<T>; DOF];
}

/// The momentum of the joints p = M(q) q̇ of one state, and the rate that it has without external torques. Row i is
/// joint i.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentumAndRate<const DOF: usize, T> {
    /// p = M(q) q̇, N m s or N s.
    pub momentum: [T; DOF],
    /// τ + C(q, q̇)ᵀ q̇ - g(q), which is τ + ∂T/∂q - ∂V/∂q, N m or N.
    pub rate: [T; DOF],
}

/// External torques without accelerations: what a momentum observer asks of the arm at every tick. Its state, gain and
/// update are [`ObserverState`](crate::ObserverState).
pub trait MomentumObserver<const DOF: usize> {
    /// p = M(q) q̇, and τ + C(q, q̇)ᵀ q̇ - g(q) with Christoffel's C: with external torques ṗ is this rate and they, so
    /// they are ṗ less this rate. `tau`: what the actuators deliver to the links, friction taken off.
    ///
    /// Rotors belong to p where the arm is taken with them: `#[robot(rotors)]`, `with_rotors`.
    #[must_use]
    fn momentum_and_rate<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], tau: &[T; DOF]) -> MomentumAndRate<DOF, T>;
}

/// The robot with a wrench at each of its tips: the frames of the list `tips` of the robot file, in its order. Without
/// that list the tip frame is the only tip.
///
/// A wrench is what the robot exerts on its environment at the tip, in axes of the tip, as in
/// [`inverse_dynamics_with_wrench`](InverseDynamics::inverse_dynamics_with_wrench).
pub trait TipWrenches<const DOF: usize, const TIPS: usize> {
    /// Torques, N m or N: τ = τ_free + Σ Jₖᵀ wₖ, with the Jacobian Jₖ of tip k.
    #[must_use]
    fn inverse_dynamics_with_wrenches<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
    ) -> [T; DOF];

    /// Accelerations, rad/s² or m/s². See [`forward_dynamics`](ForwardDynamics::forward_dynamics).
    #[must_use]
    fn forward_dynamics_with_wrenches<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
    ) -> [T; DOF];
}

/// The torques of a robot whose base nothing holds, and what its base needs, for one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatingTorques<const DOF: usize, T> {
    /// Force (N) and moment (N m) about the origin of frame 0, in axes of frame 0, that must act ON the base beside
    /// gravity so that it moves as told. They are zero in free flight.
    pub wrench: Wrench<T>,
    /// Torques or forces of the actuators, N m or N.
    pub tau: [T; DOF],
}

/// The acceleration of a base that nothing holds, in axes of frame 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseAcceleration<T> {
    /// Acceleration of the origin of frame 0 less gravity, m/s²: what an accelerometer reads there.
    pub linear: [T; 3],
    /// Angular acceleration ω̇, rad/s².
    pub angular: [T; 3],
}

/// The motion of a robot whose base nothing holds, from torques, for one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatingAccelerations<const DOF: usize, T> {
    /// Acceleration of the base, less gravity.
    pub base: BaseAcceleration<T>,
    /// Accelerations of the joints, rad/s² or m/s².
    pub qdd: [T; DOF],
}

/// Dynamics of a robot whose base nothing holds: it walks, flies or rides. Its base is the link `floating_base` of the
/// robot file; without that key the base has no mass, and the wrench is what the mount of the robot must bear.
///
/// The tips and their wrenches are those of [`TipWrenches`]. `NV` = `DOF` + 6 velocities: three linear ones of the
/// base, three angular ones, all in axes of frame 0, then those of the joints. Accelerations are (a - g, ω̇, q̈) with
/// the classical acceleration a of the origin of frame 0; forces are (force, moment about this origin, τ). So neither
/// gravity nor the orientation of the base enters.
#[diagnostic::on_unimplemented(
    note = "`FloatingBase` belongs into the same `derive`: `#[derive(FloatingBase)]`, and with batches \
            `#[derive(FloatingBase, BatchFloatingInverseDynamics)]`"
)]
pub trait FloatingBase<const DOF: usize, const NV: usize, const TIPS: usize> {
    /// Torques, and the wrench that must act on the base, when frame 0 moves as `base` says.
    ///
    /// `base` is what an inertial measurement unit reads: ω, ω̇, and the acceleration of the origin of frame 0 less
    /// gravity, in axes of frame 0. Only the difference `acceleration` - `gravity` counts. No orientation and no linear
    /// velocity enter.
    #[must_use]
    fn inverse_dynamics_of_floating_base<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
        wrenches: &[Wrench<T>; TIPS],
    ) -> FloatingTorques<DOF, T>;

    /// The mass matrix M of `NV` rows and columns: forces are M accelerations + [bias](Self::floating_bias).
    ///
    /// Symmetric to the last bit. The block of the joints is the [mass matrix](MassMatrix::mass_matrix) of the robot
    /// whose base is held. Elements that no state makes differ from zero are zero: those of joints on different
    /// branches, and of the base.
    #[must_use]
    fn floating_mass_matrix<T: Scalar>(&self, q: &[T; DOF]) -> [[T; NV]; NV];

    /// The wrench on the base, force (N) above moment (N m), and the torques (N m or N) that a motion without
    /// accelerations needs, a - g = 0, ω̇ = 0, q̈ = 0: velocity products, and what wrenches at the tips ask. No friction,
    /// as in [`bias_torques`](InverseDynamics::bias_torques).
    ///
    /// `omega`: angular velocity of the base, rad/s, in axes of frame 0.
    #[must_use]
    fn floating_bias<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        omega: &[T; 3],
        wrenches: &[Wrench<T>; TIPS],
    ) -> [T; NV];

    /// The accelerations that follow from torques, where nothing but gravity and the wrenches at the tips acts on the
    /// robot. `omega` as in [`floating_bias`](Self::floating_bias).
    ///
    /// A base without mass, as that of a robot file without `floating_base`, can turn against its joints while no link
    /// moves: the mass matrix is singular then, and the numbers mean nothing or are not finite. The function never
    /// panics.
    #[must_use]
    fn floating_forward_dynamics<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        omega: &[T; 3],
        wrenches: &[Wrench<T>; TIPS],
    ) -> FloatingAccelerations<DOF, T>;
}

/// Momentum of a robot whose base nothing holds, about its centre of mass. `NV` velocities and accelerations, and the
/// base, are those of [`FloatingBase`]: all vectors are in axes of frame 0. Turned by the rotation of the base, force
/// and moment are those in world axes.
pub trait CentroidalMomentum<const DOF: usize, const NV: usize> {
    /// The matrix A: A v is the momentum (N s), then the angular momentum about the centre of mass (N m s).
    ///
    /// Source: D. E. Orin, A. Goswami, S.-H. Lee, "Centroidal dynamics of a humanoid robot", 2013. A robot without mass
    /// gives numbers that are not finite.
    #[must_use]
    fn centroidal_momentum_matrix<T: Scalar>(&self, q: &[T; DOF]) -> [[T; NV]; 6];

    /// The rate of this momentum when the accelerations (a - g, ω̇, q̈) are zero: force (N), then moment about the centre
    /// of mass (N m). A times the accelerations, plus this rate, is what acts on the robot beside gravity.
    ///
    /// `omega`: angular velocity of the base, rad/s.
    #[must_use]
    fn centroidal_bias<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], omega: &[T; 3]) -> [T; 6];

    /// The momentum A v (N s), then the angular momentum about the centre of mass (N m s), without the matrix.
    ///
    /// `twist`: velocity of the origin of frame 0, m/s, and angular velocity of the base, rad/s.
    #[must_use]
    fn centroidal_momentum<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], twist: &BaseTwist<T>) -> [T; 6];
}

/// Energy of a robot whose base nothing holds.
pub trait FloatingEnergy<const DOF: usize> {
    /// Kinetic energy ½ vᵀ M v, J, with the [mass matrix](FloatingBase::floating_mass_matrix) M; rotors included in an
    /// arm with its rotors.
    ///
    /// `twist`: velocity of the origin of frame 0, m/s, and angular velocity of the base, rad/s, in axes of frame 0.
    #[must_use]
    fn floating_kinetic_energy<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], twist: &BaseTwist<T>) -> T;

    /// Potential energy -Σ m g·c, J, with c from the origin of the world to each centre of mass: zero where all masses
    /// are there.
    ///
    /// `pose` of frame 0 in the world, whose axes are those in which the robot file has gravity. Where `pose` is no
    /// rotation and no translation, this is the [potential energy](Energy::potential_energy).
    #[must_use]
    fn floating_potential_energy<T: Scalar>(&self, q: &[T; DOF], pose: &Pose<T>) -> T;
}

/// The wrench on a base that nothing holds and the torques as a linear function of the inertial parameters, for their
/// identification from the motion of the robot. `NV` = `DOF` + 6 rows are those of [`FloatingBase`], `BODIES` = `DOF` +
/// 1.
pub trait FloatingRegressor<const DOF: usize, const NV: usize, const BODIES: usize> {
    /// Y: row i of [force, moment, torques](FloatingBase::inverse_dynamics_of_floating_base), with free tips, is Σ_j
    /// Σ_k Y\[i\]\[j\]\[k\] π_jk. The base is the first body, then come the links, each with the ten parameters of
    /// [`regressor`](Regressor::regressor); those of the base refer to frame 0.
    ///
    /// `base` is that of [`inverse_dynamics_of_floating_base`](FloatingBase::inverse_dynamics_of_floating_base).
    #[must_use]
    fn floating_regressor<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
    ) -> [[[T; 10]; BODIES]; NV];
}

/// Jacobians and accelerations of the tips of a robot whose base nothing holds, for controllers of its whole body.
///
/// The tips are those of [`TipWrenches`]; the base and its `NV` = `DOF` + 6 velocities are those of [`FloatingBase`]:
/// the velocity of the origin of frame 0 and the angular velocity of the base, both in axes of frame 0, then the
/// velocities of the joints.
///
/// `base_rotation` gives the axes in which the tips are seen. Its rows and columns are those of a rotation matrix whose
/// columns are the axes of frame 0 in the world: the results are in world axes then, as `LOCAL_WORLD_ALIGNED` of other
/// libraries. The identity gives axes of the base. The transpose of the rotation of a tip in frame 0 gives axes of this
/// tip. A matrix that is no rotation gives numbers without a meaning.
pub trait FloatingKinematics<const DOF: usize, const NV: usize, const TIPS: usize> {
    /// The Jacobian of each tip: times the velocities, it is the velocity of the origin of the tip, m/s, in three rows,
    /// then the angular velocity of its link, rad/s.
    ///
    /// Elements that no state makes differ from zero are zero: those of joints that do not move the tip.
    #[must_use]
    fn tip_jacobians<T: Scalar>(&self, q: &[T; DOF], base_rotation: &[[T; 3]; 3]) -> [[[T; NV]; 6]; TIPS];

    /// J̇ v of each tip: the classical acceleration of its origin, m/s², then its angular acceleration, rad/s², where
    /// the acceleration of the origin of frame 0, the angular acceleration of the base and those of the joints are
    /// zero. At other accelerations, those of the tip are its Jacobian times them, plus this.
    ///
    /// `omega`: angular velocity of the base, rad/s, in axes of frame 0. The linear velocity of the base has no part.
    #[must_use]
    fn tip_accelerations<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        omega: &[T; 3],
        base_rotation: &[[T; 3]; 3],
    ) -> [[T; 6]; TIPS];
}

/// The accelerations of a robot on a floating base, and the wrenches of its contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AccelerationsAndWrenches<const DOF: usize, const TIPS: usize, T> {
    /// Accelerations of the base and of the joints.
    pub accelerations: FloatingAccelerations<DOF, T>,
    /// At each tip: force, N, and moment, N m, about its origin, which its contact exerts ON the robot, in world axes.
    pub wrenches_on_robot: [Wrench<T>; TIPS],
}

/// Motion of a robot whose base nothing holds while contacts hold some of its tips: a robot that stands or walks.
///
/// The contacts are those of the list `contacts` of the robot file; without it nothing is held. A `point` holds the
/// origin of its tip, a `weld` its orientation, too. The base, `NV` and the tips are those of [`FloatingBase`].
pub trait ContactDynamics<const DOF: usize, const NV: usize, const TIPS: usize> {
    /// The accelerations that follow from torques while the tips of the contacts do not accelerate in the world, and
    /// what the contacts exert ON the robot, in world axes. The moment of a point, and all of a tip without a contact,
    /// is zero.
    ///
    /// Contacts pull as well as push, and have no limit of friction: a caller looks at the forces. `omega` as in
    /// [`floating_bias`](FloatingBase::floating_bias), `base_rotation` as in [`FloatingKinematics`]. Gravity is that of
    /// the robot file, in the world.
    ///
    /// Solves M x = (0, τ) - bias + Jᵀ f and J x + J̇ v + g = 0 by M = Lᵀ D L and a factorisation of J M⁻¹ Jᵀ + μ 1,
    /// with μ = 1e-8 in 1/kg and 1/(kg m²). So contacts that hold more than the robot can move, such as four points of
    /// a foot, have finite forces in `f64`; in `f32`, μ is lost beside the other numbers, and such contacts need `f64`.
    ///
    /// Source of the equations: R. Featherstone, "Rigid Body Dynamics Algorithms", 2008, section 11.
    #[must_use]
    fn forward_dynamics_in_contact<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        omega: &[T; 3],
        base_rotation: &[[T; 3]; 3],
    ) -> AccelerationsAndWrenches<DOF, TIPS, T>;
}

/// A Newton step towards closed loops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosureStep<const PASSIVE: usize, const EQUATIONS: usize, T> {
    /// Positions of the dependent joints, rad or m.
    pub passive: [T; PASSIVE],
    /// The residual of the equations of the loops, loop by loop: p₂ - p₁ of the two places, m, in the axes of the loop,
    /// then the products of the axes that must be perpendicular.
    pub residual: [T; EQUATIONS],
}

/// A robot with closed loops: an ankle that two rods drive, a four-bar linkage, a delta robot.
///
/// `q`, `qd`, `qdd` and `tau` have `DOF` elements, of the joints that move by themselves. `passive` has the positions
/// of the `PASSIVE` dependent joints, in the order of the robot file. They must close the loops: [`close`](Self::close)
/// finds them, and its residual says how well. Where they do not close the loops, the other functions return numbers
/// that mean nothing. In a singular position, where the dependent joints are not determined, the numbers are not
/// finite.
///
/// `EQUATIONS` is the number of equations of all loops: 5 of a revolute cut, 3 of a spherical one, 4 of a universal
/// one, 6 of a weld. The equations are solved in the order that the robot file determines, without a search for pivots;
/// `rne show` prints the order.
///
/// Source of the equations: W. Khalil, J.-F. Kleinfinger, "Dynamic modeling of closed-loop robots", 1987.
pub trait ClosedLoops<const DOF: usize, const PASSIVE: usize, const EQUATIONS: usize, const TIPS: usize> {
    /// One step of Newton's method from the guess `passive`: the positions after the step, and what is left of the
    /// equations before it.
    #[must_use]
    fn closure_step<T: Scalar>(&self, q: &[T; DOF], passive: &[T; PASSIVE]) -> ClosureStep<PASSIVE, EQUATIONS, T>;

    /// Closes the loops from a guess by five steps of Newton's method, without a branch. The result has the residual of
    /// the equations at its positions.
    ///
    /// The residual says whether the loops are closed: from the positions of the last control cycle it is at rounding.
    /// From a guess some tenths of a radian off, five steps may leave 1e-8 m or fail. It stays large where no position
    /// closes the loops. A loop can be closed in several ways, such as a
    /// four-bar linkage with its elbow up or down; the guess decides which of them is found.
    #[must_use]
    fn close<T: Scalar>(&self, q: &[T; DOF], guess: &[T; PASSIVE]) -> ClosureStep<PASSIVE, EQUATIONS, T> {
        let mut passive = *guess;
        for _ in 0..5 {
            passive = self.closure_step(q, &passive).passive;
        }
        ClosureStep { passive, residual: self.closure_step(q, &passive).residual }
    }

    /// The map G: velocities of the dependent joints are G q̇, and torques at them are worth Gᵀ of them at the joints of
    /// `q`.
    #[must_use]
    fn loop_map<T: Scalar>(&self, q: &[T; DOF], passive: &[T; PASSIVE]) -> [[T; DOF]; PASSIVE];

    /// Ġ q̇, rad/s² or m/s²: the accelerations of the dependent joints are G q̈ + Ġ q̇.
    #[must_use]
    fn loop_map_rate_times_velocity<T: Scalar>(
        &self,
        q: &[T; DOF],
        passive: &[T; PASSIVE],
        qd: &[T; DOF],
    ) -> [T; PASSIVE];

    /// Torques of the joints of `q`, N m or N: the dependent joints have no actuators.
    #[must_use]
    fn inverse_dynamics_of_loops<T: Scalar>(
        &self,
        q: &[T; DOF],
        passive: &[T; PASSIVE],
        qd: &[T; DOF],
        qdd: &[T; DOF],
    ) -> [T; DOF];

    /// Torques when the robot exerts a wrench on its environment at each of its tips, in axes of the tip. The tips are
    /// those of [`TipWrenches`].
    #[must_use]
    fn inverse_dynamics_of_loops_with_wrenches<T: Scalar>(
        &self,
        q: &[T; DOF],
        passive: &[T; PASSIVE],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
    ) -> [T; DOF];

    /// The mass matrix of the joints of `q`, symmetric to the last bit; kg m², kg m or kg.
    #[must_use]
    fn mass_matrix_of_loops<T: Scalar>(&self, q: &[T; DOF], passive: &[T; PASSIVE]) -> [[T; DOF]; DOF];

    /// Accelerations of the joints of `q`, rad/s² or m/s², for their torques `tau`.
    #[must_use]
    fn forward_dynamics_of_loops<T: Scalar>(
        &self,
        q: &[T; DOF],
        passive: &[T; PASSIVE],
        qd: &[T; DOF],
        tau: &[T; DOF],
    ) -> [T; DOF];
}

/// The arm with a payload that is known when the program runs: every function is that of the arm whose last link has
/// the payload too. [`inverse_dynamics_with_payload`](InverseDynamics::inverse_dynamics_with_payload) belongs to
/// [`InverseDynamics`]. A payload of zero gives the numbers of the function without a payload.
pub trait PayloadDynamics<const DOF: usize> {
    /// Torques that hold the arm and the payload still against gravity, N m or N. See
    /// [`gravity_torques`](InverseDynamics::gravity_torques).
    #[must_use]
    fn gravity_torques_with_payload<T: Scalar>(&self, q: &[T; DOF], payload: &Payload<T>) -> [T; DOF];

    /// Coriolis, centrifugal and gravity torques, N m or N. See [`bias_torques`](InverseDynamics::bias_torques).
    #[must_use]
    fn bias_torques_with_payload<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], payload: &Payload<T>) -> [T; DOF];

    /// The mass matrix, symmetric to the last bit. See [`mass_matrix`](MassMatrix::mass_matrix).
    #[must_use]
    fn mass_matrix_with_payload<T: Scalar>(&self, q: &[T; DOF], payload: &Payload<T>) -> [[T; DOF]; DOF];

    /// Accelerations, rad/s² or m/s². See [`forward_dynamics`](ForwardDynamics::forward_dynamics).
    #[must_use]
    fn forward_dynamics_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        payload: &Payload<T>,
    ) -> [T; DOF];

    /// ∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics_with_payload`. See
    /// [`inverse_dynamics_derivatives`](InverseDynamicsDerivatives::inverse_dynamics_derivatives).
    #[must_use]
    fn inverse_dynamics_derivatives_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        payload: &Payload<T>,
    ) -> TorqueDerivatives<DOF, T>;

    /// The momentum of the joints and its rate without external torques, for an observer that does not take the payload
    /// for an external torque. See [`momentum_and_rate`](MomentumObserver::momentum_and_rate).
    #[must_use]
    fn momentum_and_rate_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        payload: &Payload<T>,
    ) -> MomentumAndRate<DOF, T>;
}

/// Torques on a vehicle, a ship or another robot.
pub trait MovingBase<const DOF: usize> {
    /// Torques with a free tip when frame 0 moves as `base` says, which replaces the robot's own gravity as well.
    #[must_use]
    fn inverse_dynamics_on_moving_base<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
    ) -> [T; DOF];
}

/// Torques of rotor inertia and motor friction, at the joints.
pub trait Actuation<const DOF: usize> {
    /// The motor terms alone, to be added to the torques of the links: G² Jm q̈ + G² B q̇ + |G| Tc(sign q̇) per joint, N m
    /// or N. A joint without a motor needs nothing, so a robot without motors gets zeros; Coulomb friction is zero at
    /// rest.
    ///
    /// The sign is [`Scalar::by_sign`], which a scalar of your own must implement for it.
    #[must_use]
    fn actuator_torques<T: Scalar>(&self, qd: &[T; DOF], qdd: &[T; DOF]) -> [T; DOF];

    /// Computes the actuator torques with friction that changes its sign gradually, for optimisers and integrators: s =
    /// q̇ / √(q̇² + width²) in place of the sign, and |G| (½ (Tc⁺ - Tc⁻) s + ½ (Tc⁺ + Tc⁻) s²) for the friction, which
    /// tends to |G| Tc⁺ and |G| Tc⁻ and is zero at rest.
    ///
    /// `width` > 0 is the velocity (rad/s or m/s) at which s is 0.7. A scalar of your own must implement
    /// [`Scalar::sqrt`].
    #[must_use]
    fn actuator_torques_smooth<T: Scalar>(&self, qd: &[T; DOF], qdd: &[T; DOF], width: T) -> [T; DOF] {
        let smooth = |value| SmoothSign { value, width };
        self.actuator_torques(&qd.map(smooth), &qdd.map(smooth)).map(|torque| torque.value)
    }
}
