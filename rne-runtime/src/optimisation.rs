//! Derivatives for optimisers, and those of an [`Arm`] by dual numbers through the seven steps: exact up to rounding,
//! one direction at a time. Generated code has them in reverse mode and by composite bodies, from other formulas.

use core::array::from_fn;

use crate::{AccelerationDerivatives, Dual, Scalar, TorqueGradient};
#[cfg(feature = "arm")]
use crate::{
    Arm, Constant,
    at_tip::AtTip,
    coordinates::Coordinates as _,
    definition::{Definition, definitions},
    per_joint::{PerJoint, Square},
};

/// How a weighted sum of the torques changes with the motion: the product of a vector and the Jacobian of the inverse
/// dynamics, as the gradient of a Lagrangian has it.
pub trait InverseDynamicsGradient<const DOF: usize> {
    /// The derivatives of λᵀτ by q, q̇ and q̈, with τ of [`inverse_dynamics`](crate::InverseDynamics::inverse_dynamics)
    /// and the `multipliers` λ.
    ///
    /// They are λᵀ times the matrices of
    /// [`inverse_dynamics_derivatives`](crate::InverseDynamicsDerivatives::inverse_dynamics_derivatives), and M(q) λ.
    /// Code that is derived has them in reverse mode, in a few times the operations of the torques.
    #[must_use]
    fn torque_gradient<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        multipliers: &[T; DOF],
    ) -> TorqueGradient<DOF, T>;
}

/// How the accelerations change with the state and with the torques: the linear model that shooting methods and linear
/// quadratic regulators take.
pub trait ForwardDynamicsDerivatives<const DOF: usize> {
    /// The derivatives of [`forward_dynamics`](crate::ForwardDynamics::forward_dynamics) by q, q̇ and τ, at a state.
    ///
    /// With the accelerations q̈ of this state, ∂q̈/∂q = -M⁻¹ ∂τ/∂q, ∂q̈/∂q̇ = -M⁻¹ ∂τ/∂q̇ and ∂q̈/∂τ = M⁻¹. A singular mass
    /// matrix (a joint that moves nothing) gives numbers that are not finite.
    ///
    /// Source: J. Carpentier, N. Mansard, "Analytical derivatives of rigid body dynamics algorithms", 2018.
    #[must_use]
    fn forward_dynamics_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
    ) -> AccelerationDerivatives<DOF, T>;
}

impl<const DOF: usize, T: Scalar> AccelerationDerivatives<DOF, T> {
    /// Derivatives of accelerations by q and q̇, beside the inverse of the mass matrix.
    pub(crate) fn by_dual_numbers(
        q: &[T; DOF],
        qd: &[T; DOF],
        accelerations: impl Fn(&[Dual<T>; DOF], &[Dual<T>; DOF]) -> [Dual<T>; DOF],
        dtau: [[T; DOF]; DOF],
    ) -> Self {
        let (still_q, still_qd) = (still(q), still(qd));
        Self {
            dq: rows_by(q, |q| accelerations(q, &still_qd)),
            dqd: rows_by(qd, |qd| accelerations(&still_q, qd)),
            dtau,
        }
    }
}

/// Numbers that nothing changes.
pub(crate) fn still<T: Scalar, const N: usize>(x: &[T; N]) -> [Dual<T>; N] {
    x.map(Dual::constant)
}

/// The derivatives of the elements of y(x), by rows, with a column for each element of x.
pub(crate) fn rows_by<T: Scalar, const N: usize, const ROWS: usize>(
    x: &[T; N],
    y: impl Fn(&[Dual<T>; N]) -> [Dual<T>; ROWS],
) -> [[T; N]; ROWS] {
    let columns: [_; N] = from_fn(|j| y(&from_fn(|i| along(x, i, j))));
    from_fn(|row| from_fn(|column| columns[column][row].derivative))
}

/// λ times the derivative of the torques.
#[cfg(feature = "arm")]
fn weighted<T: Scalar>(torques: &[Dual<T>], multipliers: &[T]) -> T {
    torques.iter().zip(multipliers).fold(T::zero(), |sum, (torque, &weight)| sum + torque.derivative * weight)
}

/// Element i of a list, with element j on its way.
pub(crate) fn along<T: Scalar>(x: &[T], i: usize, j: usize) -> Dual<T> {
    Dual { value: x[i], derivative: if i == j { T::one() } else { T::zero() } }
}

#[cfg(feature = "arm")]
impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    /// λᵀτ by q, by q̇ and by q̈.
    pub(crate) fn torque_gradient<T: Scalar>(
        self,
        motion: [&[T]; 3],
        multipliers: &[T],
    ) -> (J::Of<T>, J::Of<T>, J::Of<T>) {
        let still = motion.map(|x| self.still(x));
        let by = |place: usize| {
            self.coordinates.each().of(|j| {
                let mut moving = still.clone();
                moving[place] = self.along(motion[place], j);
                let [q, qd, qdd] = &moving;
                weighted(self.torques([q.as_ref(), qd.as_ref(), qdd.as_ref()], AtTip::Nothing).as_ref(), multipliers)
            })
        };
        (by(0), by(1), by(2))
    }

    /// The accelerations by q, by q̇ and by τ, under a load and the same load of dual numbers.
    #[allow(clippy::type_complexity)] // three matrices
    pub(crate) fn acceleration_derivatives<T: Scalar>(
        self,
        [q, qd, tau]: [&[T]; 3],
        load: AtTip<'_, T>,
        still_load: AtTip<'_, Dual<T>>,
    ) -> (Square<J, T>, Square<J, T>, Square<J, T>) {
        let [still_q, still_qd, tau] = [q, qd, tau].map(|x| self.still(x));
        let accelerations = |q: &[_], qd: &[_]| self.forward_dynamics([q, qd, tau.as_ref()], still_load);
        let dq = self.rows_by(q, |q| accelerations(q, still_qd.as_ref()));
        (dq, self.rows_by(qd, |qd| accelerations(still_q.as_ref(), qd)), self.inverse_mass_matrix(q, load))
    }
}

#[cfg(feature = "arm")]
definitions! { InverseDynamicsGradient<DOF> {
    /// As [`InverseDynamicsGradient::torque_gradient`].
    fn torque_gradient(q: joints, qd: joints, qdd: joints, multipliers: joints) -> TorqueGradient<DOF> =
        |robot| robot.torque_gradient([q, qd, qdd], multipliers);
} }

#[cfg(feature = "arm")]
definitions! { ForwardDynamicsDerivatives<DOF> {
    /// As [`ForwardDynamicsDerivatives::forward_dynamics_derivatives`].
    fn forward_dynamics_derivatives(q: joints, qd: joints, tau: joints) -> AccelerationDerivatives<DOF> =
        |robot| robot.acceleration_derivatives([q, qd, tau], AtTip::Nothing, AtTip::Nothing);
} }
