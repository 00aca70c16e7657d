//! Mass, motion and energy.

use crate::number::ldlt::{factor, inverse_of, solve};
#[cfg(feature = "arm")]
use crate::{BaseMotion, definition::coordinates::Coordinates as _, seven_steps::at_tip::AtTip};

capability! {
/// The mass matrix M(q) of τ = M(q) q̈ + C(q, q̇) q̇ + g(q).
#[diagnostic::on_unimplemented(
    note = "`MassMatrix` belongs into the same `derive`: `#[derive(MassMatrix)]`, and with batches \
            `#[derive(MassMatrix, BatchMassMatrix)]`"
)]
pub trait MassMatrix<DOF> {
    /// M(q): element (i, j) is the torque at joint i for a unit acceleration of joint j, from rest and without gravity.
    /// In kg m², kg m or kg, as the kinds of joints i and j have it.
    ///
    /// Symmetric to the last bit, positive semidefinite; definite unless links are massless. No rotor inertia, unless
    /// the arm is taken with its rotors (`#[robot(rotors)]`, `with_rotors`): then G² Jm is added to the diagonal.
    #[doc(alias = "crba")]
    #[doc(alias = "mj_fullM")]
    #[doc(alias = "qM")]
    #[doc(alias = "inertia matrix")]
    fn mass_matrix(q: joints) -> Matrix = |robot| robot.mass_matrix(q, AtTip::Nothing);

    /// M(q)⁻¹: element (i, j) is the acceleration of joint i for a unit torque at joint j, from rest and without
    /// gravity.
    ///
    /// Symmetric to the last bit. A singular mass matrix (a joint that moves nothing) gives numbers that are not
    /// finite, and never panics.
    #[doc(alias = "computeMinverse")]
    fn inverse_mass_matrix(q: joints) -> Matrix or |this| {
        inverse_of(this.mass_matrix(q), &[T::zero(); DOF])
    } = |robot| robot.inverse_mass_matrix(q, AtTip::Nothing);

    /// M(q)⁻¹ τ: the accelerations (rad/s², prismatic: m/s²) that the torques `tau` (N m, prismatic: N) cause in
    /// addition, in fewer operations than [`inverse_mass_matrix`](Self::inverse_mass_matrix) needs. `tau` may be any
    /// vector: of impulses (N m s), for example, which change the velocities.
    ///
    /// A singular mass matrix (a joint that moves nothing) gives numbers that are not finite, and never panics.
    #[doc(alias = "mj_solveM")]
    fn inverse_mass_matrix_times_torques(q: joints, tau: joints) -> Vector or |this| {
        let (mut m, mut inverse, mut x) = (this.mass_matrix(q), [T::zero(); DOF], *tau);
        factor(&mut m, &mut inverse);
        solve(&m, &inverse, &mut x);
        x
    } = |robot| robot.accelerations(q, robot.list(tau), AtTip::Nothing);
}
}

capability! {
/// The matrix C(q, q̇) of τ = M(q) q̈ + C(q, q̇) q̇ + g(q), by Christoffel's symbols.
pub trait CoriolisMatrix<DOF> {
    /// C(q, q̇), row = torque. Of all matrices with the same C q̇ this is Christoffel's, C_ij = ½ Σ_k (∂M_ij/∂q_k +
    /// ∂M_ik/∂q_j - ∂M_jk/∂q_i) q̇_k: Ṁ - 2C is skew, Ṁ = C + Cᵀ, and C is half the derivative of C q̇ with respect to
    /// q̇.
    #[doc(alias = "computeCoriolisMatrix")]
    fn coriolis_matrix(q: joints, qd: joints) -> Matrix = |robot| {
        let [q, qd] = [q, qd].map(|values| robot.of_joints(values));
        robot.coordinates.matrix(robot.mechanism.coriolis_matrix(q.as_ref(), qd.as_ref()))
    };

    /// Coriolis and centrifugal torques C(q, q̇) q̇, N m (prismatic: N): the bias torques without gravity. They do not
    /// depend on the choice of the matrix C, and generated code computes them without it.
    #[doc(alias = "Coriolis")]
    fn coriolis_torques(q: joints, qd: joints) -> Vector or |this| {
        let row = |row: [T; DOF]| row.iter().zip(qd).fold(T::zero(), |sum, (c, rate)| sum + *c * *rate);
        this.coriolis_matrix(q, qd).map(row)
    } = |robot| {
        let weightless = BaseMotion::fixed([T::zero(); 3]);
        robot.torques_on([q, qd, robot.zeros().as_ref()], &weightless, AtTip::Nothing)
    };
}
}

capability! {
/// Motion from torques, for simulation.
#[diagnostic::on_unimplemented(
    note = "`ForwardDynamics` belongs into the same `derive`: `#[derive(ForwardDynamics)]`, and with batches \
            `#[derive(ForwardDynamics, BatchForwardDynamics)]`"
)]
pub trait ForwardDynamics<DOF> {
    /// Accelerations q̈ = M(q)⁻¹ (τ - C(q, q̇) q̇ - g(q)) with a free tip, rad/s² or m/s².
    ///
    /// A singular mass matrix (a joint that moves nothing) gives numbers that are not finite, and never panics.
    #[doc(alias = "aba")]
    #[doc(alias = "mj_forward")]
    fn forward_dynamics(q: joints, qd: joints, tau: joints) -> Vector =
        |robot| robot.forward_dynamics([q, qd, tau], AtTip::Nothing);
}
}

capability! {
/// Kinetic and potential energy of the links, J. The kinetic energy of rotors, ½ G² Jm q̇², is included where the arm
/// is taken with them: `#[robot(rotors)]`, `with_rotors`.
pub trait Energy<DOF> {
    /// ½ q̇ᵀ M(q) q̇, as ½ Σ (m ċ·ċ + ω·Iω).
    #[doc(alias = "computeKineticEnergy")]
    fn kinetic_energy(q: joints, qd: joints) -> Number = |robot| robot.kinetic(q, qd, None);

    /// -Σ m g·c, with c from the origin of frame 0 to each centre of mass: zero if all masses are at this origin. The
    /// placement of the base in the world does not matter.
    #[doc(alias = "computePotentialEnergy")]
    fn potential_energy(q: joints) -> Number = |robot| robot.mechanism.potential(robot.of_joints(q).as_ref());
}
}

capability! {
/// Energy of a robot with a floating base.
pub trait FloatingEnergy<DOF> {
    /// Kinetic energy ½ vᵀ M v, J, with the [mass matrix](crate::FloatingBase::floating_mass_matrix) M; rotors included
    /// in an arm with its rotors.
    ///
    /// `twist`: velocity of the origin of frame 0, m/s, and angular velocity of the base, rad/s, in axes of frame 0.
    fn floating_kinetic_energy(q: joints, qd: joints, twist: twist) -> Number =
        |robot| robot.kinetic(q, qd, Some(twist));

    /// Potential energy -Σ m g·c, J, with c from the origin of the world to each centre of mass: zero if all masses are
    /// at this origin.
    ///
    /// `pose` of frame 0 in the world, whose axes are those in which the robot file has gravity. Where `pose` is no
    /// rotation and no translation, this is the [potential energy](crate::Energy::potential_energy).
    fn floating_potential_energy(q: joints, pose: pose) -> Number =
        |robot| robot.mechanism.floating_potential(robot.of_joints(q).as_ref(), pose);
}
}

capability! {
/// The centre of mass of the links, all together, in the world; the robot's `base` places frame 0 there. Rotors are not
/// included. An arm without mass gives numbers that are not finite.
pub trait CentreOfMass<DOF> {
    /// Σ m c / Σ m, m.
    #[doc(alias = "center of mass")]
    #[doc(alias = "com")]
    fn centre_of_mass(q: joints) -> Point = |robot| robot.mechanism.mass_centre(robot.of_joints(q).as_ref());

    /// The Jacobian of the centre of mass: J q̇ is its velocity, m/s, in world axes.
    #[doc(alias = "jacobianCenterOfMass")]
    #[doc(alias = "mj_jacSubtreeCom")]
    fn centre_of_mass_jacobian(q: joints) -> PointRows =
        |robot| robot.coordinates.rows(robot.mechanism.mass_centre_jacobian(robot.of_joints(q).as_ref()));
}
}

capability! {
/// The torques as a linear function of the inertial parameters, for their identification.
pub trait Regressor<DOF> {
    /// Y(q, q̇, q̈), gravity included: τ_i = Σ_j Σ_k Y\[i\]\[j\]\[k\] π_jk (torque, link, parameter), with ten
    /// parameters per link, π_j = (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz).
    ///
    /// They refer to the link frame of the table: c and J from its origin, in its axes; Jxy is the tensor's element, -∫
    /// x y dm.
    #[doc(alias = "computeJointTorqueRegressor")]
    fn regressor(q: joints, qd: joints, qdd: joints) -> Regressor =
        |robot| robot.regressor([q, qd, qdd], &robot.fixed_base()).1;
}
}
