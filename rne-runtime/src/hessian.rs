//! Second derivatives of weighted torques for optimisers, and those of an [`Arm`] by dual numbers of dual numbers.

#[cfg(feature = "arm")]
use core::array::from_fn;

use crate::Scalar;
#[cfg(feature = "arm")]
use crate::{Arm, Constant, Dual, InverseDynamicsGradient};
#[cfg(all(feature = "arm", feature = "std"))]
use crate::{DynArm, WrongLength};

/// The second derivatives of λᵀτ for one state: of the torques, each times its multiplier and added up. Element (i, j)
/// is by the motion of joint i and by that of joint j.
///
/// Those by q̇ and q̈ and by q̈ twice are zero: the torques are linear in q̈, with M(q).
///
/// Units: of λᵀτ per rad or m, rad/s or m/s, rad/s² or m/s² of both joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueHessian<const DOF: usize, T> {
    /// ∂²(λᵀτ)/∂q_i∂q_j: symmetric.
    pub dq_dq: [[T; DOF]; DOF],
    /// ∂²(λᵀτ)/∂q_i∂q̇_j.
    pub dq_dqd: [[T; DOF]; DOF],
    /// ∂²(λᵀτ)/∂q̇_i∂q̇_j: symmetric.
    pub dqd_dqd: [[T; DOF]; DOF],
    /// ∂²(λᵀτ)/∂q_i∂q̈_j, ∂(M(q) λ)_j/∂q_i.
    pub dq_dqdd: [[T; DOF]; DOF],
}

/// How the gradient of a weighted sum of the torques changes with the motion: what a Lagrangian with the equations of
/// motion has in its Hessian.
pub trait InverseDynamicsHessian<const DOF: usize> {
    /// The second derivatives of λᵀτ by q, q̇ and q̈, with τ of
    /// [`inverse_dynamics`](crate::InverseDynamics::inverse_dynamics) and the `multipliers` λ.
    ///
    /// They are the derivatives of [`torque_gradient`](crate::InverseDynamicsGradient::torque_gradient). Derived code
    /// in the reduced form has them by composite bodies. A robot with joints that follow others has rows and columns of
    /// those that follow no other.
    #[must_use]
    fn torque_hessian<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        multipliers: &[T; DOF],
    ) -> TorqueHessian<DOF, T>;
}

/// Element i of a list, with element j on its way.
#[cfg(feature = "arm")]
fn along<T: Scalar>(x: &[T], i: usize, j: usize) -> Dual<T> {
    Dual { value: x[i], derivative: if i == j { T::one() } else { T::zero() } }
}

#[cfg(feature = "arm")]
impl<const DOF: usize, S: Constant> InverseDynamicsHessian<DOF> for Arm<DOF, S> {
    fn torque_hessian<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        multipliers: &[T; DOF],
    ) -> TorqueHessian<DOF, T> {
        let [still_q, still_qd, qdd, multipliers] = [q, qd, qdd, multipliers].map(|x| x.map(Dual::constant));
        let by_q: [_; DOF] =
            from_fn(|i| self.torque_gradient(&from_fn(|at| along(q, at, i)), &still_qd, &qdd, &multipliers));
        let by_qd: [_; DOF] =
            from_fn(|i| self.torque_gradient(&still_q, &from_fn(|at| along(qd, at, i)), &qdd, &multipliers));
        let rates = |row: [Dual<T>; DOF]| row.map(|x| x.derivative);
        TorqueHessian {
            dq_dq: by_q.map(|row| rates(row.dq)),
            dq_dqd: by_q.map(|row| rates(row.dqd)),
            dqd_dqd: by_qd.map(|row| rates(row.dqd)),
            dq_dqdd: by_q.map(|row| rates(row.dqdd)),
        }
    }
}

/// [`TorqueHessian`] of a [`DynArm`].
#[cfg(all(feature = "arm", feature = "std"))]
#[derive(Clone, Debug, PartialEq)]
pub struct DynTorqueHessian<T> {
    /// ∂²(λᵀτ)/∂q_i∂q_j.
    pub dq_dq: Vec<Vec<T>>,
    /// ∂²(λᵀτ)/∂q_i∂q̇_j.
    pub dq_dqd: Vec<Vec<T>>,
    /// ∂²(λᵀτ)/∂q̇_i∂q̇_j.
    pub dqd_dqd: Vec<Vec<T>>,
    /// ∂²(λᵀτ)/∂q_i∂q̈_j.
    pub dq_dqdd: Vec<Vec<T>>,
}

#[cfg(all(feature = "arm", feature = "std"))]
impl<S: Constant> DynArm<S> {
    /// As [`InverseDynamicsHessian::torque_hessian`].
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn torque_hessian<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        multipliers: &[T],
    ) -> Result<DynTorqueHessian<T>, WrongLength> {
        let still = |x: &[T]| x.iter().copied().map(Dual::constant).collect::<Vec<_>>();
        let moving = |x: &[T], i: usize| (0..x.len()).map(|at| along(x, at, i)).collect::<Vec<_>>();
        let (still_qd, qdd, multipliers) = (still(qd), still(qdd), still(multipliers));
        let rates = |row: Vec<Dual<T>>| row.into_iter().map(|x| x.derivative).collect::<Vec<T>>();
        let [mut dq_dq, mut dq_dqd, mut dqd_dqd, mut dq_dqdd] = [const { Vec::new() }; 4];
        for i in 0..self.dof() {
            let row = self.torque_gradient(&moving(q, i), &still_qd, &qdd, &multipliers)?;
            dq_dq.push(rates(row.dq));
            dq_dqd.push(rates(row.dqd));
            dq_dqdd.push(rates(row.dqdd));
            dqd_dqd.push(rates(self.torque_gradient(&still(q), &moving(qd, i), &qdd, &multipliers)?.dqd));
        }
        Ok(DynTorqueHessian { dq_dq, dq_dqd, dqd_dqd, dq_dqdd })
    }
}
