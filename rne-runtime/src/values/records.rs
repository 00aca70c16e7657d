//! The records that functions return: with arrays, and with lists for `DynArm`.

use crate::values::numbers::Numbers;
use crate::{BaseTwist, Pose, Wrench};

/// The acceleration of a floating base, in axes of frame 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseAcceleration<T> {
    /// Acceleration of the origin of frame 0 less gravity, m/s², as an accelerometer measures it there.
    pub linear: [T; 3],
    /// Angular acceleration ω̇, rad/s².
    pub angular: [T; 3],
}

/// Defines records with arrays, and records with the same fields as lists.
macro_rules! records {
    ($(
        $(#[$doc:meta])*
        $name:ident<$($size:ident),*>, $counted:ident {
            $($(#[$field_doc:meta])* $field:ident: $known:ty | $lists:ty,)*
        }
    )*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct $name<$(const $size: usize,)* T> { $($(#[$field_doc])* pub $field: $known),* }

            impl<$(const $size: usize,)* T> From<($($known,)*)> for $name<$($size,)* T> {
                fn from(($($field,)*): ($($known,)*)) -> Self {
                    Self { $($field),* }
                }
            }

            impl<$(const $size: usize,)* T: Numbers<T>> Numbers<T> for $name<$($size,)* T> {
                fn each(&self, see: &mut impl FnMut(&T)) {
                    $(self.$field.each(see);)*
                }
            }

            #[doc = concat!("[`", stringify!($name), "`] of a robot with a number of joints known at run time.")]
            #[cfg(feature = "std")]
            #[derive(Clone, Debug, PartialEq)]
            pub struct $counted<T> { $($(#[$field_doc])* pub $field: $lists),* }

            #[cfg(feature = "std")]
            impl<T> From<($($lists,)*)> for $counted<T> {
                fn from(($($field,)*): ($($lists,)*)) -> Self {
                    Self { $($field),* }
                }
            }

            #[cfg(feature = "std")]
            impl<T: Numbers<T>> Numbers<T> for $counted<T> {
                fn each(&self, see: &mut impl FnMut(&T)) {
                    $(self.$field.each(see);)*
                }
            }

            #[cfg(feature = "machine")]
            impl<T: crate::values::numbers::Shaped<T>> crate::values::numbers::Shaped<T> for $counted<T> {
                fn take(layout: &rne_functions::Layout, numbers: &mut impl Iterator<Item = T>) -> Self {
                    let mut parts = layout.parts();
                    // Rust evaluates fields in the order in which they are written here
                    Self { $($field: crate::values::numbers::Shaped::take(parts.next().unwrap_or(layout), numbers)),* }
                }
            }
        )*

        /// The records with lists, under the names of those with arrays.
        #[cfg(feature = "std")]
        #[doc(hidden)]
        pub mod of_lists { $(pub use super::$counted as $name;)* }
    };
}

records! {
    /// ∂τ/∂q and ∂τ/∂q̇ of one state. Row i is torque i, column j is joint j.
    ///
    /// Units: of a torque (N m, or N for a prismatic joint) per rad or m, and per rad/s or m/s.
    TorqueDerivatives<DOF>, DynTorqueDerivatives {
        /// ∂τ_i/∂q_j.
        dq: [[T; DOF]; DOF] | Vec<Vec<T>>,
        /// ∂τ_i/∂q̇_j.
        dqd: [[T; DOF]; DOF] | Vec<Vec<T>>,
    }

    /// The momentum of the joints p = M(q) q̇ of one state, and the rate that it has without external torques. Row i is
    /// joint i.
    MomentumAndRate<DOF>, DynMomentumAndRate {
        /// p = M(q) q̇, N m s or N s.
        momentum: [T; DOF] | Vec<T>,
        /// τ + C(q, q̇)ᵀ q̇ - g(q), which is τ + ∂T/∂q - ∂V/∂q, N m or N.
        rate: [T; DOF] | Vec<T>,
    }

    /// The derivatives of λᵀτ for one state: of the torques, each times its multiplier and added up.
    ///
    /// Units: of λᵀτ per rad or m, per rad/s or m/s, and per rad/s² or m/s².
    TorqueGradient<DOF>, DynTorqueGradient {
        /// ∂(λᵀτ)/∂q_j, λᵀ ∂τ/∂q.
        dq: [T; DOF] | Vec<T>,
        /// ∂(λᵀτ)/∂q̇_j, λᵀ ∂τ/∂q̇.
        dqd: [T; DOF] | Vec<T>,
        /// ∂(λᵀτ)/∂q̈_j, M(q) λ.
        dqdd: [T; DOF] | Vec<T>,
    }

    /// The derivatives of the accelerations for one state. Row i is acceleration i, column j is joint j.
    ///
    /// Units: of an acceleration (rad/s², or m/s² for a prismatic joint) per rad or m, per rad/s or m/s, and per N m or
    /// N.
    AccelerationDerivatives<DOF>, DynAccelerationDerivatives {
        /// ∂q̈_i/∂q_j.
        dq: [[T; DOF]; DOF] | Vec<Vec<T>>,
        /// ∂q̈_i/∂q̇_j.
        dqd: [[T; DOF]; DOF] | Vec<Vec<T>>,
        /// ∂q̈_i/∂τ_j, M(q)⁻¹: symmetric.
        dtau: [[T; DOF]; DOF] | Vec<Vec<T>>,
    }

    /// The second derivatives of λᵀτ for one state: of the torques, each times its multiplier and added up. Element (i,
    /// j) is the derivative with respect to the motions of joints i and j.
    ///
    /// Those with respect to q̇ and q̈ and to q̈ twice are zero, because the torques are linear in q̈, with the matrix
    /// M(q).
    ///
    /// Units: of λᵀτ per rad or m, rad/s or m/s, rad/s² or m/s² of both joints.
    TorqueHessian<DOF>, DynTorqueHessian {
        /// ∂²(λᵀτ)/∂q_i∂q_j: symmetric.
        dq_dq: [[T; DOF]; DOF] | Vec<Vec<T>>,
        /// ∂²(λᵀτ)/∂q_i∂q̇_j.
        dq_dqd: [[T; DOF]; DOF] | Vec<Vec<T>>,
        /// ∂²(λᵀτ)/∂q̇_i∂q̇_j: symmetric.
        dqd_dqd: [[T; DOF]; DOF] | Vec<Vec<T>>,
        /// ∂²(λᵀτ)/∂q_i∂q̈_j, ∂(M(q) λ)_j/∂q_i.
        dq_dqdd: [[T; DOF]; DOF] | Vec<Vec<T>>,
    }

    /// The state of a robot after a step.
    NextState<DOF>, DynNextState {
        /// Positions, rad or m.
        q: [T; DOF] | Vec<T>,
        /// Velocities, rad/s or m/s.
        qd: [T; DOF] | Vec<T>,
    }

    /// The derivatives of `DOF` positions or velocities after a step. Row i belongs to position or velocity i of the
    /// next state, column j to joint j.
    StepDerivatives<DOF>, DynStepDerivatives {
        /// Derivatives with respect to the positions, per rad or m.
        dq: [[T; DOF]; DOF] | Vec<Vec<T>>,
        /// Derivatives with respect to the velocities, per rad/s or m/s.
        dqd: [[T; DOF]; DOF] | Vec<Vec<T>>,
        /// Derivatives with respect to the torques, per N m or N.
        dtau: [[T; DOF]; DOF] | Vec<Vec<T>>,
    }

    /// The linear model of a step: with the state x = (q, q̇), the changes δx' = A δx + B δτ. The rows of A are those
    /// of `dq` beside those of `dqd`, the rows of B are those of `dtau`. In both, the rows of the positions are above
    /// those of the velocities.
    NextStateDerivatives<DOF>, DynNextStateDerivatives {
        /// Derivatives of the next positions.
        q: StepDerivatives<DOF, T> | DynStepDerivatives<T>,
        /// Derivatives of the next velocities.
        qd: StepDerivatives<DOF, T> | DynStepDerivatives<T>,
    }

    /// The torques of a robot with a floating base, and what its base needs, for one state.
    FloatingTorques<DOF>, DynFloatingTorques {
        /// Force (N) and moment (N m) about the origin of frame 0, in axes of frame 0, that must act ON the base
        /// besides gravity so that it has the given motion. They are zero in free flight.
        wrench: Wrench<T> | Wrench<T>,
        /// Torques or forces of the actuators, N m or N.
        tau: [T; DOF] | Vec<T>,
    }

    /// The motion of a robot with a floating base, from torques, for one state.
    FloatingAccelerations<DOF>, DynFloatingAccelerations {
        /// Acceleration of the base, less gravity.
        base: BaseAcceleration<T> | BaseAcceleration<T>,
        /// Accelerations of the joints, rad/s² or m/s².
        qdd: [T; DOF] | Vec<T>,
    }

    /// The accelerations of a robot on a floating base, and the wrenches of its contacts.
    AccelerationsAndWrenches<DOF, TIPS>, DynAccelerationsAndWrenches {
        /// Accelerations of the base and of the joints.
        accelerations: FloatingAccelerations<DOF, T> | DynFloatingAccelerations<T>,
        /// At each tip: force, N, and moment, N m, about its origin, which its contact exerts ON the robot, in world
        /// axes.
        wrenches_on_robot: [Wrench<T>; TIPS] | Vec<Wrench<T>>,
    }

    /// The derivatives of the wrench on a floating base and of the torques, for one state.
    ///
    /// `NV` = `DOF` + 6 rows: the force on the base (N), the moment about the origin of frame 0 (N m), both in axes of
    /// frame 0, then the torques (N m, or N for a prismatic joint). Columns are per rad or m, and per rad/s or m/s.
    ///
    /// Elements that vanish in every state are exactly zero and need no operation: those of joints on different
    /// branches.
    FloatingTorqueDerivatives<DOF, NV>, DynFloatingTorqueDerivatives {
        /// Derivatives with respect to the positions of the joints.
        dq: [[T; DOF]; NV] | Vec<Vec<T>>,
        /// Derivatives with respect to the velocities of the joints.
        dqd: [[T; DOF]; NV] | Vec<Vec<T>>,
        /// Derivatives with respect to the angular velocity of the base, in axes of frame 0.
        domega: [[T; 3]; NV] | Vec<[T; 3]>,
    }

    /// The state of a robot with a floating base, after a step.
    FloatingNextState<DOF>, DynFloatingNextState {
        /// The pose of frame 0 in the world.
        pose: Pose<T> | Pose<T>,
        /// The velocity of frame 0, in its axes, m/s and rad/s.
        twist: BaseTwist<T> | BaseTwist<T>,
        /// Positions of the joints, rad or m.
        q: [T; DOF] | Vec<T>,
        /// Velocities of the joints, rad/s or m/s.
        qd: [T; DOF] | Vec<T>,
    }

    /// The linear model of a step of a robot with a floating base: rows belong to the next state, columns to the
    /// state and to the torques.
    ///
    /// `NV` = `DOF` + 6. A change of the positions has three components of the origin of frame 0 and three of its
    /// rotation vector, both in axes of frame 0, and one for each joint: position + R δp and R exp(δθ). These are the
    /// axes before the step for the columns, and after it for the rows. A change of the velocities has the linear and
    /// the angular velocity of frame 0 in its axes, then the joints.
    FloatingStepDerivatives<DOF, NV>, DynFloatingStepDerivatives {
        /// Derivatives of the next positions with respect to the positions.
        q_dq: [[T; NV]; NV] | Vec<Vec<T>>,
        /// Derivatives of the next positions with respect to the velocities.
        q_dv: [[T; NV]; NV] | Vec<Vec<T>>,
        /// Derivatives of the next positions with respect to the torques.
        q_dtau: [[T; DOF]; NV] | Vec<Vec<T>>,
        /// Derivatives of the next velocities with respect to the positions.
        v_dq: [[T; NV]; NV] | Vec<Vec<T>>,
        /// Derivatives of the next velocities with respect to the velocities.
        v_dv: [[T; NV]; NV] | Vec<Vec<T>>,
        /// Derivatives of the next velocities with respect to the torques.
        v_dtau: [[T; DOF]; NV] | Vec<Vec<T>>,
    }

    /// A Newton step towards closed loops.
    ClosureStep<PASSIVE, EQUATIONS>, DynClosureStep {
        /// Positions of the dependent joints, rad or m.
        passive: [T; PASSIVE] | Vec<T>,
        /// The residual of the equations of the loops, loop by loop: p₂ - p₁ of the two places, m, in the axes of the
        /// loop, then the products of the axes that must be perpendicular.
        residual: [T; EQUATIONS] | Vec<T>,
    }
}

impl<const DOF: usize, const TIPS: usize, T> From<(BaseAcceleration<T>, [T; DOF], [Wrench<T>; TIPS])>
    for AccelerationsAndWrenches<DOF, TIPS, T>
{
    fn from((base, qdd, wrenches_on_robot): (BaseAcceleration<T>, [T; DOF], [Wrench<T>; TIPS])) -> Self {
        Self { accelerations: FloatingAccelerations { base, qdd }, wrenches_on_robot }
    }
}

#[cfg(feature = "std")]
impl<T> From<(BaseAcceleration<T>, Vec<T>, Vec<Wrench<T>>)> for DynAccelerationsAndWrenches<T> {
    fn from((base, qdd, wrenches_on_robot): (BaseAcceleration<T>, Vec<T>, Vec<Wrench<T>>)) -> Self {
        Self { accelerations: DynFloatingAccelerations { base, qdd }, wrenches_on_robot }
    }
}
