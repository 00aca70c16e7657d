//! The functions of a robot with closed loops.

#[cfg(doc)]
use super::{FloatingBase, TipWrenches};
#[cfg(all(feature = "arm", feature = "std"))]
use crate::seven_steps::at_tip::AtTip;

capability! {
/// A robot with closed loops: an ankle that two rods drive, a four-bar linkage, a delta robot.
///
/// `q`, `qd`, `qdd` and `tau` have `DOF` elements, of the joints that move by themselves. `passive` has the positions
/// of the `PASSIVE` dependent joints, in the order of the robot file. They must close the loops: [`close`](Self::close)
/// finds them, and its residual shows how accurately. If they do not close the loops, the results of the other
/// functions are meaningless. In a singular position, where the dependent joints are not determined, the numbers are
/// not finite.
///
/// `EQUATIONS` is the number of equations of all loops: 5 of a revolute cut, 3 of a spherical one, 4 of a universal
/// one, 6 of a weld. The equations are solved in the order that the robot file determines, without a search for pivots;
/// `rne show` prints the order.
///
/// Source of the equations: W. Khalil, J.-F. Kleinfinger, "Dynamic modeling of closed-loop robots", 1987.
pub trait ClosedLoops<DOF, PASSIVE, EQUATIONS, TIPS> of loops {
    /// One step of Newton's method from the guess `passive`: the positions after the step, and the residual of the
    /// equations before it.
    fn closure_step(q: coordinates, passive: passive) -> ClosureStep<PASSIVE, EQUATIONS> =
        |robot| robot.newton(q, passive);

    /// The map G: velocities of the dependent joints are G q̇, and torques τ_p at them are equivalent to torques Gᵀ τ_p
    /// at the joints of `q`.
    fn loop_map(q: coordinates, passive: passive) -> PassiveRows = |robot| robot.map(q, passive);

    /// Ġ q̇, rad/s² or m/s²: the accelerations of the dependent joints are G q̈ + Ġ q̇.
    fn loop_map_rate_times_velocity(q: coordinates, passive: passive, qd: coordinates) -> PassiveVector =
        |robot| robot.map_rate(q, passive, qd);

    /// Torques of the joints of `q`, N m or N: the dependent joints have no actuators.
    fn inverse_dynamics_of_loops(q: coordinates, passive: passive, qd: coordinates, qdd: coordinates) -> Vector =
        |robot| robot.torques_of_loops([q, passive, qd, qdd], &robot.fixed_base(), AtTip::Nothing).tau;

    /// Torques when the robot exerts a wrench on its environment at each of its tips, in axes of the tip. The tips are
    /// those of [`TipWrenches`].
    fn inverse_dynamics_of_loops_with_wrenches(
        q: coordinates, passive: passive, qd: coordinates, qdd: coordinates, wrenches: wrenches
    ) -> Vector =
        |robot| robot.torques_of_loops([q, passive, qd, qdd], &robot.fixed_base(), AtTip::Wrenches(wrenches)).tau;

    /// Torques that hold the robot still against gravity, N m or N.
    fn gravity_torques_of_loops(q: coordinates, passive: passive) -> Vector =
        |robot| robot.gravity_of_loops(q, passive, AtTip::Nothing);

    /// Coriolis, centrifugal and gravity torques, N m or N: the torques where the joints of `q` do not accelerate.
    fn bias_torques_of_loops(q: coordinates, passive: passive, qd: coordinates) -> Vector =
        |robot| robot.bias_of_loops([q, passive, qd], AtTip::Nothing);

    /// The mass matrix of the joints of `q`, symmetric to the last bit; kg m², kg m or kg.
    fn mass_matrix_of_loops(q: coordinates, passive: passive) -> Matrix =
        |robot| robot.mass_of_loops(q, passive, AtTip::Nothing);

    /// Accelerations of the joints of `q`, rad/s² or m/s², for their torques `tau`.
    fn forward_dynamics_of_loops(q: coordinates, passive: passive, qd: coordinates, tau: coordinates) -> Vector =
        |robot| robot.accelerations_of_loops([q, passive, qd, tau], AtTip::Nothing);
} with {
    /// Closes the loops from a guess by five steps of Newton's method, without a branch. The result has the residual of
    /// the equations at its positions.
    ///
    /// The residual says whether the loops are closed: from the positions of the last control cycle it is at rounding.
    /// From a guess some tenths of a radian off, five steps may leave 1e-8 m or fail. It stays large where no position
    /// closes the loops. A loop can be closed in several ways, such as a
    /// four-bar linkage with its elbow up or down; the guess decides which of them is found.
    #[must_use]
    fn close<T: crate::Scalar>(
        &self,
        q: &[T; DOF],
        guess: &[T; PASSIVE],
    ) -> crate::ClosureStep<PASSIVE, EQUATIONS, T> {
        let mut passive = *guess;
        for _ in 0..5 {
            passive = self.closure_step(q, &passive).passive;
        }
        crate::ClosureStep { passive, residual: self.closure_step(q, &passive).residual }
    }
}
}

capability! {
/// A robot with closed loops and a payload that is known when the program runs: the payload is fixed to the tip, as in
/// [`PayloadDynamics`](crate::PayloadDynamics). The loops are those of [`ClosedLoops`], whose functions close them. A
/// payload of zero gives the numbers of the function without a payload.
pub trait ClosedLoopsPayloadDynamics<DOF, PASSIVE> of loops {
    /// Torques, N m or N. See [`inverse_dynamics_of_loops`](ClosedLoops::inverse_dynamics_of_loops).
    fn inverse_dynamics_of_loops_with_payload(
        q: coordinates, passive: passive, qd: coordinates, qdd: coordinates, payload: payload
    ) -> Vector =
        |robot| robot.torques_of_loops([q, passive, qd, qdd], &robot.fixed_base(), AtTip::Payload(payload)).tau;

    /// Torques that hold the robot and the payload still against gravity, N m or N.
    fn gravity_torques_of_loops_with_payload(q: coordinates, passive: passive, payload: payload) -> Vector =
        |robot| robot.gravity_of_loops(q, passive, AtTip::Payload(payload));

    /// Coriolis, centrifugal and gravity torques, N m or N. See
    /// [`bias_torques_of_loops`](ClosedLoops::bias_torques_of_loops).
    fn bias_torques_of_loops_with_payload(q: coordinates, passive: passive, qd: coordinates, payload: payload)
        -> Vector = |robot| robot.bias_of_loops([q, passive, qd], AtTip::Payload(payload));

    /// The mass matrix, symmetric to the last bit. See [`mass_matrix_of_loops`](ClosedLoops::mass_matrix_of_loops).
    fn mass_matrix_of_loops_with_payload(q: coordinates, passive: passive, payload: payload) -> Matrix =
        |robot| robot.mass_of_loops(q, passive, AtTip::Payload(payload));

    /// Accelerations, rad/s² or m/s². See [`forward_dynamics_of_loops`](ClosedLoops::forward_dynamics_of_loops).
    fn forward_dynamics_of_loops_with_payload(
        q: coordinates, passive: passive, qd: coordinates, tau: coordinates, payload: payload
    ) -> Vector = |robot| robot.accelerations_of_loops([q, passive, qd, tau], AtTip::Payload(payload));
}
}

capability! {
/// A robot with closed loops and a floating base: a humanoid whose ankles are driven by rods.
///
/// `q`, `passive` and the loops are those of [`ClosedLoops`], whose functions close them. The base, `NV` = `DOF` + 6
/// velocities and the tips are those of [`FloatingBase`].
pub trait FloatingClosedLoops<DOF, PASSIVE, NV, TIPS> of loops {
    /// Torques of the joints of `q`, and the wrench that must act on the base, when frame 0 moves as `base` says. See
    /// [`inverse_dynamics_of_floating_base`](crate::FloatingBase::inverse_dynamics_of_floating_base).
    fn inverse_dynamics_of_floating_loops(
        q: coordinates, passive: passive, qd: coordinates, qdd: coordinates, base: motion, wrenches: wrenches
    ) -> FloatingTorques<DOF> =
        |robot| robot.torques_of_loops([q, passive, qd, qdd], base, AtTip::Wrenches(wrenches));

    /// The mass matrix of the base and of the joints of `q`, symmetric to the last bit. See
    /// [`floating_mass_matrix`](crate::FloatingBase::floating_mass_matrix).
    fn floating_mass_matrix_of_loops(q: coordinates, passive: passive) -> FloatingMatrix =
        |robot| robot.floating_mass_of_loops(q, passive);

    /// Accelerations of the base and of the joints of `q` for torques of these joints, while the wrenches and gravity
    /// act. See [`floating_forward_dynamics`](crate::FloatingBase::floating_forward_dynamics).
    fn floating_forward_dynamics_of_loops(
        q: coordinates, passive: passive, qd: coordinates, tau: coordinates, omega: omega, wrenches: wrenches
    ) -> FloatingAccelerations<DOF> =
        |robot| robot.floating_accelerations_of_loops([q, passive, qd, tau], omega, AtTip::Wrenches(wrenches));
}
}
