//! The functions of a robot with closed loops.

#[cfg(doc)]
use super::{FloatingBase, TipWrenches};
use crate::{BaseMotion, ClosureStep, FloatingAccelerations, FloatingTorques, Scalar, Wrench};

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

    /// The map G: velocities of the dependent joints are G q̇, and torques at them are worth Gᵀ of them at the joints
    /// of `q`.
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

/// A robot with closed loops whose base nothing holds: a humanoid whose ankles are driven by rods.
///
/// `q`, `passive` and the loops are those of [`ClosedLoops`], whose functions close them. The base, `NV` = `DOF` + 6
/// velocities and the tips are those of [`FloatingBase`].
pub trait FloatingClosedLoops<const DOF: usize, const PASSIVE: usize, const NV: usize, const TIPS: usize> {
    /// Torques of the joints of `q`, and the wrench that must act on the base, when frame 0 moves as `base` says. See
    /// [`inverse_dynamics_of_floating_base`](crate::FloatingBase::inverse_dynamics_of_floating_base).
    #[must_use]
    fn inverse_dynamics_of_floating_loops<T: Scalar>(
        &self,
        q: &[T; DOF],
        passive: &[T; PASSIVE],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        base: &BaseMotion<T>,
        wrenches: &[Wrench<T>; TIPS],
    ) -> FloatingTorques<DOF, T>;

    /// The mass matrix of the base and of the joints of `q`, symmetric to the last bit. See
    /// [`floating_mass_matrix`](crate::FloatingBase::floating_mass_matrix).
    #[must_use]
    fn floating_mass_matrix_of_loops<T: Scalar>(&self, q: &[T; DOF], passive: &[T; PASSIVE]) -> [[T; NV]; NV];

    /// Accelerations of the base and of the joints of `q` for torques of these joints, while the wrenches and gravity
    /// act. See [`floating_forward_dynamics`](crate::FloatingBase::floating_forward_dynamics).
    #[must_use]
    fn floating_forward_dynamics_of_loops<T: Scalar>(
        &self,
        q: &[T; DOF],
        passive: &[T; PASSIVE],
        qd: &[T; DOF],
        tau: &[T; DOF],
        omega: &[T; 3],
        wrenches: &[Wrench<T>; TIPS],
    ) -> FloatingAccelerations<DOF, T>;
}
