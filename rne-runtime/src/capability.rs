//! The functions of a robot: one trait per capability, implemented by generated code and by [`Arm`](crate::Arm) alike.
//!
//! A trait gets a new method only with a default, or in a breaking version.
//!
//! Joint arrays run from base to tip. Revolute joints: rad, rad/s, rad/s², N m. Prismatic joints: m, m/s, m/s², N.

mod closed_loops;
mod floating_base;

pub use closed_loops::*;
pub use floating_base::*;

use crate::jacobian_derivatives::{derivatives_of_rows, rate_of_rows};
use crate::ldlt::{factor, inverse_of, solve};
use crate::optimisation::{rows_by, still};
use crate::smooth_sign::SmoothSign;
use crate::{
    AccelerationDerivatives, BaseMotion, Dual, MomentumAndRate, Payload, Pose, Scalar, TorqueDerivatives, Wrench,
};

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

    /// M(q)⁻¹ τ: the accelerations (rad/s², prismatic: m/s²) that the torques `tau` (N m, prismatic: N) add, in fewer
    /// operations than [`inverse_mass_matrix`](Self::inverse_mass_matrix) has. `tau` may be any vector: of impulses
    /// (N m s), for example, which change the velocities.
    ///
    /// A singular mass matrix (a joint that moves nothing) gives numbers that are not finite, and never panics.
    #[must_use]
    fn inverse_mass_matrix_times_torques<T: Scalar>(&self, q: &[T; DOF], tau: &[T; DOF]) -> [T; DOF] {
        let (mut m, mut inverse, mut x) = (self.mass_matrix(q), [T::zero(); DOF], *tau);
        factor(&mut m, &mut inverse);
        solve(&m, &inverse, &mut x);
        x
    }
}

/// The matrix C(q, q̇) of τ = M(q) q̈ + C(q, q̇) q̇ + g(q), by Christoffel's symbols.
pub trait CoriolisMatrix<const DOF: usize> {
    /// C(q, q̇), row = torque. Of the matrices that give the same C q̇ it is Christoffel's, C_ij = ½ Σ_k (∂M_ij/∂q_k +
    /// ∂M_ik/∂q_j - ∂M_jk/∂q_i) q̇_k: Ṁ - 2C is skew, Ṁ = C + Cᵀ, and C is half the derivative of C q̇ with respect to q̇.
    #[must_use]
    fn coriolis_matrix<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [[T; DOF]; DOF];

    /// Coriolis and centrifugal torques C(q, q̇) q̇, N m (prismatic: N): the bias torques without gravity. Every matrix C
    /// gives the same; generated code needs none.
    #[must_use]
    fn coriolis_torques<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [T; DOF] {
        let row = |row: [T; DOF]| row.iter().zip(qd).fold(T::zero(), |sum, (c, rate)| sum + *c * *rate);
        self.coriolis_matrix(q, qd).map(row)
    }
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
    /// [`JacobianDerivatives::jacobian_rate`](crate::JacobianDerivatives::jacobian_rate). Without code of its own, by
    /// dual numbers through the Jacobian of the frame.
    #[must_use]
    fn jacobian_rate_at_frame<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [[T; DOF]; 6] {
        rate_of_rows(q, qd, |q| self.jacobian_at_frame(q))
    }

    /// ∂J/∂q of the frame, as
    /// [`JacobianDerivatives::jacobian_derivatives`](crate::JacobianDerivatives::jacobian_derivatives). Without code of
    /// its own, by dual numbers.
    #[must_use]
    fn jacobian_derivatives_at_frame<T: Scalar>(&self, q: &[T; DOF]) -> [[[T; DOF]; DOF]; 6] {
        derivatives_of_rows(q, |q| self.jacobian_at_frame(q))
    }
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

    /// The rate J̇ of the geometric Jacobian of a frame at velocities `qd`, in world axes; zero columns for joints that
    /// do not move the frame.
    #[must_use]
    fn jacobian_rate_of<const FRAME: usize, T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [[T; DOF]; 6]
    where
        Self: AtFrame<DOF, FRAME>,
    {
        self.jacobian_rate_at_frame(q, qd)
    }

    /// ∂J/∂q of the geometric Jacobian of a frame, in world axes: element (r, i, j) is that of element (r, i) by the
    /// position of joint j.
    #[must_use]
    fn jacobian_derivatives_of<const FRAME: usize, T: Scalar>(&self, q: &[T; DOF]) -> [[[T; DOF]; DOF]; 6]
    where
        Self: AtFrame<DOF, FRAME>,
    {
        self.jacobian_derivatives_at_frame(q)
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

    /// ∂τ/∂q and ∂τ/∂q̇ of `inverse_dynamics_with_wrenches`, where the wrenches do not change in axes of their tips. See
    /// [`inverse_dynamics_derivatives`](InverseDynamicsDerivatives::inverse_dynamics_derivatives).
    #[must_use]
    fn inverse_dynamics_derivatives_with_wrenches<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
    ) -> TorqueDerivatives<DOF, T> {
        let (still_q, still_qd, qdd, wrenches) = (still(q), still(qd), still(qdd), wrenches.map(Wrench::still));
        TorqueDerivatives {
            dq: rows_by(q, |q| self.inverse_dynamics_with_wrenches(q, &still_qd, &qdd, &wrenches)),
            dqd: rows_by(qd, |qd| self.inverse_dynamics_with_wrenches(&still_q, qd, &qdd, &wrenches)),
        }
    }

    /// The derivatives of `forward_dynamics_with_wrenches` by q, q̇ and τ, where the wrenches do not change in axes of
    /// their tips. See
    /// [`forward_dynamics_derivatives`](crate::ForwardDynamicsDerivatives::forward_dynamics_derivatives).
    #[must_use]
    fn forward_dynamics_derivatives_with_wrenches<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        wrenches: &[Wrench<T>; TIPS],
    ) -> AccelerationDerivatives<DOF, T> {
        let (still_q, still_qd, still_tau, wrenches) = (still(q), still(qd), still(tau), wrenches.map(Wrench::still));
        let by_tau = rows_by(tau, |tau| self.forward_dynamics_with_wrenches(&still_q, &still_qd, tau, &wrenches));
        let accelerations = |q: &_, qd: &_| self.forward_dynamics_with_wrenches(q, qd, &still_tau, &wrenches);
        AccelerationDerivatives::by_dual_numbers(q, qd, accelerations, by_tau)
    }
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

    /// The derivatives of `forward_dynamics_with_payload` by q, q̇ and τ. See
    /// [`forward_dynamics_derivatives`](crate::ForwardDynamicsDerivatives::forward_dynamics_derivatives).
    #[must_use]
    fn forward_dynamics_derivatives_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        payload: &Payload<T>,
    ) -> AccelerationDerivatives<DOF, T> {
        let inverse = inverse_of(self.mass_matrix_with_payload(q, payload), &[T::zero(); DOF]);
        let (tau, payload) = (still(tau), payload.still());
        let accelerations = |q: &_, qd: &_| self.forward_dynamics_with_payload(q, qd, &tau, &payload);
        AccelerationDerivatives::by_dual_numbers(q, qd, accelerations, inverse)
    }
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

    /// The derivatives of [`actuator_torques_smooth`](Self::actuator_torques_smooth) by q̇, by rows, N m s/rad or N s/m:
    /// what friction adds to the derivatives of the torques by velocities. The matrix is diagonal where no joint
    /// follows others. The derivative by accelerations, G² Jm, is constant.
    ///
    /// At the joint of a motor it is G² B + |G| (½ (Tc⁺ - Tc⁻) + (Tc⁺ + Tc⁻) s) ds/dq̇, with ds/dq̇ = width² / (q̇² +
    /// width²)^(3/2). `width` > 0: `actuator_torques` itself has no derivative at rest, and a `width` of zero gives
    /// numbers there that are not finite.
    #[must_use]
    fn actuator_torques_smooth_derivatives<T: Scalar>(&self, qd: &[T; DOF], width: T) -> [[T; DOF]; DOF] {
        let still_qdd = [Dual::constant(T::zero()); DOF];
        rows_by(qd, |qd| self.actuator_torques_smooth(qd, &still_qdd, Dual::constant(width)))
    }
}
