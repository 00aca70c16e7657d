//! The derivatives of a step of a robot with a floating base, on the manifold of its positions.

use crate::shapes::records;
use crate::{BaseTwist, Pose, Scalar, Wrench};

records! {
    /// The linear model of a step of a robot with a floating base: rows belong to the next state, columns to the
    /// state and to the torques.
    ///
    /// `NV` = `DOF` + 6. A change of the positions has three components of the origin of frame 0 and three of its
    /// rotation vector, both in axes of frame 0, and one for each joint: position + R δp and R exp(δθ). These are the
    /// axes before the step for the columns, and after it for the rows. A change of the velocities has the linear and
    /// the angular velocity of frame 0 in its axes, then the joints.
    FloatingStepDerivatives<DOF, NV>, DynFloatingStepDerivatives {
        /// Derivatives of the next positions by the positions.
        q_dq: [[T; NV]; NV] | Vec<Vec<T>>,
        /// Derivatives of the next positions by the velocities.
        q_dv: [[T; NV]; NV] | Vec<Vec<T>>,
        /// Derivatives of the next positions by the torques.
        q_dtau: [[T; DOF]; NV] | Vec<Vec<T>>,
        /// Derivatives of the next velocities by the positions.
        v_dq: [[T; NV]; NV] | Vec<Vec<T>>,
        /// Derivatives of the next velocities by the velocities.
        v_dv: [[T; NV]; NV] | Vec<Vec<T>>,
        /// Derivatives of the next velocities by the torques.
        v_dtau: [[T; DOF]; NV] | Vec<Vec<T>>,
    }
}

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
