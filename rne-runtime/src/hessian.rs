//! Second derivatives of weighted torques for optimisers, and those of an [`Arm`] by dual numbers of dual numbers.

#[cfg(feature = "arm")]
use crate::{
    Arm, Constant, Dual,
    coordinates::Coordinates as _,
    definition::{Definition, definitions},
    per_joint::{PerJoint, Square},
};
use crate::{Scalar, TorqueHessian};

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

#[cfg(feature = "arm")]
impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    #[allow(clippy::type_complexity)] // four matrices
    fn torque_hessian<T: Scalar>(
        self,
        [q, qd, qdd]: [&[T]; 3],
        multipliers: &[T],
    ) -> (Square<J, T>, Square<J, T>, Square<J, T>, Square<J, T>) {
        let each = self.coordinates.each();
        let [still_q, still_qd, qdd, multipliers] = [q, qd, qdd, multipliers].map(|x| self.still(x));
        let gradient = |q: &J::Of<Dual<T>>, qd: &J::Of<Dual<T>>| {
            let (by_q, by_qd, by_qdd) =
                self.torque_gradient([q.as_ref(), qd.as_ref(), qdd.as_ref()], multipliers.as_ref());
            [by_q, by_qd, by_qdd].map(|row| each.of(|j| row.as_ref()[j].derivative))
        };
        let by_q = each.of(|i| gradient(&self.along(q, i), &still_qd));
        let by_qd = each.of(|i| gradient(&still_q, &self.along(qd, i)));
        let rows = |by: &J::Of<[J::Of<T>; 3]>, place: usize| each.of(|i| by.as_ref()[i][place].clone());
        (rows(&by_q, 0), rows(&by_q, 1), rows(&by_qd, 1), rows(&by_q, 2))
    }
}

#[cfg(feature = "arm")]
definitions! { InverseDynamicsHessian<DOF> {
    /// As [`InverseDynamicsHessian::torque_hessian`].
    fn torque_hessian(q: joints, qd: joints, qdd: joints, multipliers: joints) -> TorqueHessian<DOF> =
        |robot| robot.torque_hessian([q, qd, qdd], multipliers);
} }
