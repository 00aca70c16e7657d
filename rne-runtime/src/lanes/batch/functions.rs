//! The functions that are computed for many states at once.
//!
//! One slice per joint and quantity, or per element of a matrix, and in it one number per state. All slices have the
//! same length. Units are those of the single call of the same name.

use super::{BatchScalar, LengthMismatch, VectorUnit};
use crate::{
    BaseMotion, FloatingBase, ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, MassMatrix, Wrench,
};

/// Torques from motion for many states at once.
///
/// One slice per joint, base to tip, and in it one number per state: rad, rad/s, rad/s² and N m for revolute joints, m,
/// m/s, m/s² and N for prismatic ones. All slices have the same length.
pub trait BatchInverseDynamics<const DOF: usize>: InverseDynamics<DOF> {
    /// Writes to `tau` the torques for positions `q`, velocities `qd` and accelerations `qdd` with a free tip, on the
    /// widest vector unit that the processor has.
    ///
    /// # Errors
    ///
    /// When two slices differ in length. No torque is written then.
    fn inverse_dynamics_batch<T: BatchScalar>(
        &self,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        tau: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch> {
        self.inverse_dynamics_batch_on(VectorUnit::widest(), q, qd, qdd, tau)
    }

    /// Computes the batch on a given vector unit: for comparisons, or for the same bits on every processor.
    ///
    /// # Errors
    ///
    /// When two slices differ in length. No torque is written then.
    fn inverse_dynamics_batch_on<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        tau: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch>;
}

/// The mass matrix of many states at once.
///
/// One slice per joint or element of the matrix, and in it one number per state: `mass[i][j][state]`.
///
/// An element whose slice is empty is not written. Writing a large matrix takes as long as computing it. So give slices
/// for one half only, because it is symmetric, and none for joints on different branches, where it is zero. Zeros that
/// do not depend on the state are written if they have a slice.
pub trait BatchMassMatrix<const DOF: usize>: MassMatrix<DOF> {
    /// Writes to `mass` the mass matrices for positions `q`, row i in `mass[i]`: kg m² between revolute joints, kg
    /// between prismatic ones, kg m between the two. On the widest vector unit that the processor has.
    ///
    /// # Errors
    ///
    /// When two slices differ in length, but for elements that are empty. Nothing is written then.
    fn mass_matrix_batch<T: BatchScalar>(
        &self,
        q: [&[T]; DOF],
        mass: [[&mut [T]; DOF]; DOF],
    ) -> Result<(), LengthMismatch> {
        self.mass_matrix_batch_on(VectorUnit::widest(), q, mass)
    }

    /// Computes the batch on a given vector unit: for comparisons, or for the same bits on every processor.
    ///
    /// # Errors
    ///
    /// When two slices differ in length, but for elements that are empty. Nothing is written then.
    fn mass_matrix_batch_on<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        q: [&[T]; DOF],
        mass: [[&mut [T]; DOF]; DOF],
    ) -> Result<(), LengthMismatch>;
}

/// Motion from torques for many states at once.
///
/// One slice per joint, base to tip, and in it one number per state: rad, rad/s, N m and rad/s² for revolute joints, m,
/// m/s, N and m/s² for prismatic ones. All slices have the same length.
pub trait BatchForwardDynamics<const DOF: usize>: ForwardDynamics<DOF> {
    /// Writes to `qdd` the accelerations for positions `q`, velocities `qd` and torques `tau` with a free tip, on the
    /// widest vector unit that the processor has. A singular mass matrix gives numbers that are not finite.
    ///
    /// # Errors
    ///
    /// When two slices differ in length. Nothing is written then.
    fn forward_dynamics_batch<T: BatchScalar>(
        &self,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        tau: [&[T]; DOF],
        qdd: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch> {
        self.forward_dynamics_batch_on(VectorUnit::widest(), q, qd, tau, qdd)
    }

    /// Computes the batch on a given vector unit: for comparisons, or for the same bits on every processor.
    ///
    /// # Errors
    ///
    /// When two slices differ in length. Nothing is written then.
    fn forward_dynamics_batch_on<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        tau: [&[T]; DOF],
        qdd: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch>;
}

/// ∂τ/∂q and ∂τ/∂q̇ of many states at once.
///
/// One slice per joint or element of a matrix, and in it one number per state: `dq[i][j][state]` is ∂τᵢ/∂qⱼ.
///
/// An element whose slice is empty is not written, as in [`BatchMassMatrix`]: a torque does not depend on joints of
/// other branches. Zeros that do not depend on the state are written if they have a slice.
pub trait BatchInverseDynamicsDerivatives<const DOF: usize>: InverseDynamicsDerivatives<DOF> {
    /// Writes to `dq` and `dqd` the derivatives of the torques with respect to positions and to velocities, for
    /// positions `q`, velocities `qd` and accelerations `qdd` with a free tip: torque i in row i, N m or N per rad or
    /// m, and per rad/s or m/s. On the widest vector unit that the processor has.
    ///
    /// # Errors
    ///
    /// When two slices differ in length, but for elements that are empty. Nothing is written then.
    fn inverse_dynamics_derivatives_batch<T: BatchScalar>(
        &self,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        dq: [[&mut [T]; DOF]; DOF],
        dqd: [[&mut [T]; DOF]; DOF],
    ) -> Result<(), LengthMismatch> {
        self.inverse_dynamics_derivatives_batch_on(VectorUnit::widest(), q, qd, qdd, dq, dqd)
    }

    /// Computes the batch on a given vector unit: for comparisons, or for the same bits on every processor.
    ///
    /// # Errors
    ///
    /// When two slices differ in length, but for elements that are empty. Nothing is written then.
    fn inverse_dynamics_derivatives_batch_on<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        dq: [[&mut [T]; DOF]; DOF],
        dqd: [[&mut [T]; DOF]; DOF],
    ) -> Result<(), LengthMismatch>;
}

/// Torques, and the wrench that must act on the base, of many states of a robot with a floating base.
///
/// One slice per joint or component of a vector, and in it one number per state. All slices have the same length.
#[allow(clippy::too_many_arguments)] // each is a quantity
pub trait BatchFloatingInverseDynamics<const DOF: usize, const VELOCITIES: usize, const TIPS: usize>:
    FloatingBase<DOF, VELOCITIES, TIPS>
{
    /// Writes to `tau` the torques (N m or N), and to `wrench` the force (N) and then the moment (N m) that must act ON
    /// the base beside gravity, about the origin of frame 0 and in its axes, as
    /// [`inverse_dynamics_of_floating_base`](FloatingBase::inverse_dynamics_of_floating_base) does. The vectors of
    /// `base` are slices of their components; its velocity is not read. The robot exerts `wrenches` at its tips; an
    /// empty slice in one is zero. On the widest vector unit that the processor has.
    ///
    /// # Errors
    ///
    /// When two slices differ in length, but for wrenches that are empty. Nothing is written then.
    fn inverse_dynamics_of_floating_base_batch<T: BatchScalar>(
        &self,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        base: &BaseMotion<&[T]>,
        wrenches: &[Wrench<&[T]>; TIPS],
        wrench: [&mut [T]; 6],
        tau: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch> {
        self.inverse_dynamics_of_floating_base_batch_on(VectorUnit::widest(), q, qd, qdd, base, wrenches, wrench, tau)
    }

    /// Computes the batch on a given vector unit: for comparisons, or for the same bits on every processor.
    ///
    /// # Errors
    ///
    /// When two slices differ in length, but for wrenches that are empty. Nothing is written then.
    fn inverse_dynamics_of_floating_base_batch_on<T: BatchScalar>(
        &self,
        unit: VectorUnit,
        q: [&[T]; DOF],
        qd: [&[T]; DOF],
        qdd: [&[T]; DOF],
        base: &BaseMotion<&[T]>,
        wrenches: &[Wrench<&[T]>; TIPS],
        wrench: [&mut [T]; 6],
        tau: [&mut [T]; DOF],
    ) -> Result<(), LengthMismatch>;
}
