//! The derivatives of a step of a robot with a floating base, on the manifold of its positions.

use crate::{BaseTwist, FloatingStepDerivatives, Pose, Scalar, Wrench};

/// Derivatives of a step of the semi-implicit Euler method of a robot with a floating base, for optimisers. The
/// base, the tips and the wrenches are those of [`FloatingBase`](crate::FloatingBase).
pub trait FloatingEulerStepDerivatives<const DOF: usize, const NV: usize, const TIPS: usize> {
    /// The derivatives of [`floating_euler_step`](crate::FloatingEulerStep::floating_euler_step) by the state and by
    /// the torques. The arguments are those of this step.
    ///
    /// They are exact up to rounding where `pose` is a rotation. The origin of frame 0 in `pose` has no part, and its
    /// rotation turns gravity alone.
    #[must_use]
    #[allow(clippy::too_many_arguments)] // a state and what acts on it
    fn floating_euler_step_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
        pose: &Pose<T>,
        twist: &BaseTwist<T>,
        step: T,
        wrenches: &[Wrench<T>; TIPS],
    ) -> FloatingStepDerivatives<DOF, NV, T>;
}
