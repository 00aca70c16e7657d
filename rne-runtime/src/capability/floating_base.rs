//! The functions of a robot whose base nothing holds.

#[cfg(doc)]
use super::{Energy, InverseDynamics, MassMatrix, Regressor, TipWrenches};
use crate::{
    AccelerationsAndWrenches, BaseMotion, BaseTwist, FloatingAccelerations, FloatingTorques, Payload, Pose, Scalar,
    Wrench,
};

/// Dynamics of a robot whose base nothing holds: it walks, flies or rides. Its base is the link `floating_base` of the
/// robot file; without that key the derive is an error, unless its attribute has `allow_lints`: then the base has no
/// mass, and the wrench is what the mount of the robot must bear.
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

/// A robot with a floating base and a payload that is known when the program runs: every function is that of the robot
/// whose last link has the payload, too. The tips exert nothing. The base and its `NV` = `DOF` + 6 velocities are those
/// of [`FloatingBase`]; a payload of zero gives the numbers of its functions with free tips.
pub trait FloatingPayloadDynamics<const DOF: usize, const NV: usize> {
    /// Torques, and the wrench that must act on the base, when frame 0 moves as `base` says. See
    /// [`inverse_dynamics_of_floating_base`](FloatingBase::inverse_dynamics_of_floating_base).
    #[must_use]
    fn floating_inverse_dynamics_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
        payload: &Payload<T>,
    ) -> FloatingTorques<DOF, T>;

    /// The mass matrix of `NV` rows and columns. See [`floating_mass_matrix`](FloatingBase::floating_mass_matrix).
    #[must_use]
    fn floating_mass_matrix_with_payload<T: Scalar>(&self, q: &[T; DOF], payload: &Payload<T>) -> [[T; NV]; NV];

    /// The wrench on the base, force (N) above moment (N m), and the torques (N m or N) of a motion without
    /// accelerations. See [`floating_bias`](FloatingBase::floating_bias).
    #[must_use]
    fn floating_bias_torques_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        omega: &[T; 3],
        payload: &Payload<T>,
    ) -> [T; NV];

    /// The accelerations that follow from torques, where nothing but gravity acts on the robot. See
    /// [`floating_forward_dynamics`](FloatingBase::floating_forward_dynamics).
    #[must_use]
    fn floating_forward_dynamics_with_payload<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        omega: &[T; 3],
        payload: &Payload<T>,
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
