//! The functions of a robot with a floating base.

#[cfg(doc)]
use super::{Energy, InverseDynamics, MassMatrix, Regressor, TipWrenches};
use crate::{BaseMotion, Scalar};
#[cfg(feature = "arm")]
use crate::{definition::still_wrenches::AllStill as _, seven_steps::at_tip::AtTip};

/// The regressor of a robot with a floating base. The wrench on the base and the torques are linear in the inertial
/// parameters, and the regressor is the matrix of this relation. Identification from the motion of the robot needs it.
/// `NV` = `DOF` + 6 rows are those of [`FloatingBase`], `BODIES` = `DOF` + 1.
pub trait FloatingRegressor<const DOF: usize, const NV: usize, const BODIES: usize> {
    /// Y: row i of [force, moment, torques](crate::FloatingBase::inverse_dynamics_of_floating_base), with free tips, is
    /// Σ_j Σ_k Y\[i\]\[j\]\[k\] π_jk. The base is the first body, then come the links, each with the ten parameters of
    /// [`regressor`](crate::Regressor::regressor); those of the base refer to frame 0.
    ///
    /// `base` is that of [`inverse_dynamics_of_floating_base`](crate::FloatingBase::inverse_dynamics_of_floating_base).
    #[must_use]
    fn floating_regressor<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
    ) -> [[[T; 10]; BODIES]; NV];
}

capability! {
/// Dynamics of a robot with a floating base: it walks, flies or rides. Its base is the link `floating_base` of the
/// robot file; without that key the derive is an error, unless its attribute has `allow_lints`: then the base has no
/// mass, and the wrench is what the mount of the robot must bear.
///
/// The tips and their wrenches are those of [`TipWrenches`]. `NV` = `DOF` + 6 velocities: three linear ones of the
/// base, three angular ones, all in axes of frame 0, then those of the joints. Accelerations are (a - g, ω̇, q̈) with
/// the classical acceleration a of the origin of frame 0; forces are (force, moment about this origin, τ). So they
/// depend neither on gravity nor on the orientation of the base.
#[diagnostic::on_unimplemented(
    note = "`FloatingBase` belongs into the same `derive`: `#[derive(FloatingBase)]`, and with batches \
            `#[derive(FloatingBase, BatchFloatingInverseDynamics)]`"
)]
pub trait FloatingBase<DOF, NV, TIPS> {
    /// Torques, and the wrench that must act on the base, when frame 0 moves as `base` says.
    ///
    /// `base` is what an inertial measurement unit reads: ω, ω̇, and the acceleration of the origin of frame 0 less
    /// gravity, in axes of frame 0. Only the difference `acceleration` - `gravity` counts. Orientation and linear
    /// velocity of the base have no effect.
    fn inverse_dynamics_of_floating_base(q: joints, qd: joints, qdd: joints, base: motion, wrenches: wrenches)
        -> FloatingTorques<DOF> = |robot| robot.torques_and_wrench([q, qd, qdd], base, AtTip::Wrenches(wrenches));

    /// The mass matrix M of `NV` rows and columns: forces are M accelerations + [bias](Self::floating_bias).
    ///
    /// Symmetric to the last bit. The block of the joints is the [mass matrix](crate::MassMatrix::mass_matrix) of the
    /// robot whose base is held. Elements that vanish in every state are exactly zero: those of joints on different
    /// branches, and some of the base.
    fn floating_mass_matrix(q: joints) -> FloatingMatrix = |robot| robot.floating_mass_matrix(q, AtTip::Nothing);

    /// The wrench on the base, force (N) above moment (N m), and the torques (N m or N) that a motion without
    /// accelerations needs, a - g = 0, ω̇ = 0, q̈ = 0: velocity products, and the wrenches at the tips. No friction, as
    /// in [`bias_torques`](crate::InverseDynamics::bias_torques).
    ///
    /// `omega`: angular velocity of the base, rad/s, in axes of frame 0.
    fn floating_bias(q: joints, qd: joints, omega: omega, wrenches: wrenches) -> FloatingVector =
        |robot| robot.floating_bias([q, qd], omega, AtTip::Wrenches(wrenches));

    /// The wrench on the base, force (N) above moment (N m), and the torques (N m or N) that hold the robot still
    /// against gravity, which the robot file has in the axes of the world.
    ///
    /// `base_rotation`: its columns are the axes of frame 0 in the world.
    fn floating_gravity_torques(q: joints, base_rotation: rotation) -> FloatingVector =
        |robot| robot.floating_gravity(q, base_rotation);

    /// The accelerations that follow from torques, where nothing but gravity and the wrenches at the tips acts on the
    /// robot. `omega` as in [`floating_bias`](Self::floating_bias).
    ///
    /// A base without mass, as that of a robot file without `floating_base`, can turn against its joints while no link
    /// moves: the mass matrix is singular then, and the numbers mean nothing or are not finite. The function never
    /// panics.
    fn floating_forward_dynamics(q: joints, qd: joints, tau: joints, omega: omega, wrenches: wrenches)
        -> FloatingAccelerations<DOF> =
        |robot| robot.floating_forward_dynamics([q, qd, tau], omega, AtTip::Wrenches(wrenches));
}
}

capability! {
/// A robot with a floating base and a payload that is known when the program runs: every function is that of the robot
/// whose last link has the payload, too. The tips exert nothing. The base and its `NV` = `DOF` + 6 velocities are those
/// of [`FloatingBase`]; a payload of zero gives the numbers of its functions with free tips.
pub trait FloatingPayloadDynamics<DOF, NV> {
    /// Torques, and the wrench that must act on the base, when frame 0 moves as `base` says. See
    /// [`inverse_dynamics_of_floating_base`](crate::FloatingBase::inverse_dynamics_of_floating_base).
    fn floating_inverse_dynamics_with_payload(q: joints, qd: joints, qdd: joints, base: motion, payload: payload)
        -> FloatingTorques<DOF> = |robot| robot.torques_and_wrench([q, qd, qdd], base, AtTip::Payload(payload));

    /// The mass matrix of `NV` rows and columns. See
    /// [`floating_mass_matrix`](crate::FloatingBase::floating_mass_matrix).
    fn floating_mass_matrix_with_payload(q: joints, payload: payload) -> FloatingMatrix =
        |robot| robot.floating_mass_matrix(q, AtTip::Payload(payload));

    /// The wrench on the base, force (N) above moment (N m), and the torques (N m or N) of a motion without
    /// accelerations. See [`floating_bias`](crate::FloatingBase::floating_bias).
    fn floating_bias_torques_with_payload(q: joints, qd: joints, omega: omega, payload: payload) -> FloatingVector =
        |robot| robot.floating_bias([q, qd], omega, AtTip::Payload(payload));

    /// The accelerations that follow from torques, where nothing but gravity acts on the robot. See
    /// [`floating_forward_dynamics`](crate::FloatingBase::floating_forward_dynamics).
    fn floating_forward_dynamics_with_payload(q: joints, qd: joints, tau: joints, omega: omega, payload: payload)
        -> FloatingAccelerations<DOF> =
        |robot| robot.floating_forward_dynamics([q, qd, tau], omega, AtTip::Payload(payload));
}
}

capability! {
/// Momentum of a robot with a floating base, about its centre of mass. `NV` velocities and accelerations, and the base,
/// are those of [`FloatingBase`]: all vectors are in axes of frame 0. Multiplied by the rotation of the base, force and
/// moment are in world axes.
pub trait CentroidalMomentum<DOF, NV> {
    /// The matrix A: A v is the momentum (N s), then the angular momentum about the centre of mass (N m s).
    ///
    /// Source: D. E. Orin, A. Goswami, S.-H. Lee, "Centroidal dynamics of a humanoid robot", 2013. A robot without mass
    /// gives numbers that are not finite.
    #[doc(alias = "CCRBA")]
    #[doc(alias = "CMM")]
    fn centroidal_momentum_matrix(q: joints) -> FloatingRows = |robot| robot.centroidal_momentum_matrix(q);

    /// The rate of this momentum when the accelerations (a - g, ω̇, q̈) are zero: force (N), then moment about the
    /// centre of mass (N m). A times the accelerations, plus this rate, is the wrench that acts on the robot besides
    /// gravity.
    ///
    /// `omega`: angular velocity of the base, rad/s.
    #[doc(alias = "dccrba")]
    fn centroidal_bias(q: joints, qd: joints, omega: omega) -> Spatial = |robot| robot.centroidal_bias(q, qd, omega);

    /// The momentum A v (N s), then the angular momentum about the centre of mass (N m s), without the matrix.
    ///
    /// `twist`: velocity of the origin of frame 0, m/s, and angular velocity of the base, rad/s.
    #[doc(alias = "computeCentroidalMomentum")]
    fn centroidal_momentum(q: joints, qd: joints, twist: twist) -> Spatial = |robot| {
        let [q, qd] = [q, qd].map(|values| robot.of_joints(values));
        robot.mechanism.centroidal_momentum(q.as_ref(), qd.as_ref(), twist)
    };
}
}

capability! {
/// Jacobians and accelerations of the tips of a robot with a floating base, for controllers of its whole body.
///
/// The tips are those of [`TipWrenches`]; the base and its `NV` = `DOF` + 6 velocities are those of [`FloatingBase`]:
/// the velocity of the origin of frame 0 and the angular velocity of the base, both in axes of frame 0, then the
/// velocities of the joints.
///
/// `base_rotation` gives the axes in which the tips are seen. Its rows and columns are those of a rotation matrix whose
/// columns are the axes of frame 0 in the world: the results are in world axes then, as `LOCAL_WORLD_ALIGNED` of other
/// libraries. The identity gives axes of the base. The transpose of the rotation of a tip in frame 0 gives axes of this
/// tip. A matrix that is no rotation gives numbers without a meaning.
pub trait FloatingKinematics<DOF, NV, TIPS> {
    /// The Jacobian of each tip: times the velocities, it is the velocity of the origin of the tip, m/s, in three rows,
    /// then the angular velocity of its link, rad/s.
    ///
    /// Elements that vanish in every state are exactly zero: those of joints that do not move the tip.
    fn tip_jacobians(q: joints, base_rotation: rotation) -> TipRows =
        |robot| robot.each_tip(|tip| robot.tip_jacobian(q, base_rotation, tip));

    /// J̇ v of each tip: the classical acceleration of its origin, m/s², then its angular acceleration, rad/s², where
    /// the acceleration of the origin of frame 0, the angular acceleration of the base and those of the joints are
    /// zero. With other accelerations, the tip has its Jacobian times these accelerations, plus J̇ v.
    ///
    /// `omega`: angular velocity of the base, rad/s, in axes of frame 0. The linear velocity of the base has no effect.
    fn tip_accelerations(q: joints, qd: joints, omega: omega, base_rotation: rotation) -> TipVectors =
        |robot| robot.each_tip(|tip| robot.tip_acceleration([q, qd], omega, base_rotation, tip));
}
}

capability! {
/// Motion of a robot with a floating base while contacts hold some of its tips: a robot that stands or walks.
///
/// The contacts are those of the list `contacts` of the robot file; without it nothing is held. A `point` holds the
/// origin of its tip, a `weld` its orientation, too. The base, `NV` and the tips are those of [`FloatingBase`].
pub trait ContactDynamics<DOF, NV, TIPS> {
    /// The accelerations that follow from torques while the tips of the contacts do not accelerate in the world, and
    /// what the contacts exert ON the robot, in world axes. The moment of a point, and all of a tip without a contact,
    /// is zero.
    ///
    /// Contacts pull as well as push, and have no limit of friction, so the caller must check the forces. `omega` as in
    /// [`floating_bias`](crate::FloatingBase::floating_bias), `base_rotation` as in [`FloatingKinematics`]. Gravity is
    /// that of the robot file, in the world.
    ///
    /// Solves M x = (0, τ) - bias + Jᵀ f and J x + J̇ v + g = 0 by M = Lᵀ D L and a factorisation of J M⁻¹ Jᵀ + μ 1,
    /// with μ = 1e-8 in 1/kg and 1/(kg m²). So contacts that hold more than the robot can move, such as four points of
    /// a foot, have finite forces in `f64`; in `f32`, μ is lost beside the other numbers, and such contacts need `f64`.
    ///
    /// Source of the equations: R. Featherstone, "Rigid Body Dynamics Algorithms", 2008, section 11.
    #[doc(alias = "constraintDynamics")]
    fn forward_dynamics_in_contact(q: joints, qd: joints, tau: joints, omega: omega, base_rotation: rotation)
        -> AccelerationsAndWrenches<DOF, TIPS> =
        |robot| robot.forward_dynamics_in_contact([q, qd, tau], omega, base_rotation);
}
}

capability! {
/// The derivatives of the torques of a robot with a floating base with respect to its state. The base, `NV` and the
/// tips are those of [`FloatingBase`](crate::FloatingBase).
pub trait FloatingInverseDynamicsDerivatives<DOF, NV, TIPS> {
    /// The derivatives of [`inverse_dynamics_of_floating_base`](crate::FloatingBase::inverse_dynamics_of_floating_base)
    /// with respect to q, q̇ and the angular velocity ω of the base, at a state.
    ///
    /// For each derivative, the other arguments are constant. For the base these are ω̇ and a - g, the classical
    /// acceleration of the origin of frame 0 less gravity, in axes of frame 0: its orientation, position and linear
    /// velocity have no effect. The wrenches stay the same in axes of their tips, so they turn with the joints.
    ///
    /// The derivative with respect to the accelerations (a - g, ω̇, q̈) is the [mass
    /// matrix](crate::FloatingBase::floating_mass_matrix).
    /// [`to_pinocchio`](crate::FloatingTorqueDerivatives::to_pinocchio) has the derivatives with respect to position,
    /// orientation and velocity of the base.
    ///
    /// Source: J. Carpentier, N. Mansard, "Analytical derivatives of rigid body dynamics algorithms", 2018.
    fn floating_inverse_dynamics_derivatives(q: joints, qd: joints, qdd: joints, base: motion, wrenches: wrenches)
        -> FloatingTorqueDerivatives<DOF, NV> =
        |robot| robot.floating_derivatives([q, qd, qdd], base, wrenches.all_still().as_ref());
}
}
