//! How the Jacobian of the tip changes; of an [`Arm`] by dual numbers through its Jacobian, exact up to rounding.

use core::array::from_fn;

use crate::optimisation::along;
#[cfg(feature = "arm")]
use crate::{
    Arm, Constant,
    coordinates::Coordinates as _,
    definition::{Definition, definitions},
    per_joint::{PerJoint, Square},
};
use crate::{Dual, Scalar};

/// How the geometric Jacobian J of the tip changes: for tasks in accelerations of the tip, and for their derivatives.
/// Rows and axes are those of [`jacobian`](crate::Kinematics::jacobian): three linear ones, then three angular ones, in
/// world axes.
pub trait JacobianDerivatives<const DOF: usize> {
    /// J̇ at velocities `qd` (rad/s, prismatic: m/s): linear rows in m/s² per rad/s or m/s, angular ones in rad/s² per
    /// rad/s or m/s. J̇ q̇ alone is [`jacobian_rate_times_velocity`](crate::Kinematics::jacobian_rate_times_velocity), in
    /// fewer operations.
    #[must_use]
    fn jacobian_rate<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [[T; DOF]; 6];

    /// ∂J/∂q: element (r, i, j) is that of element (r, i) of J by the position of joint j, per rad or m.
    ///
    /// The first three matrices, the second derivatives of the position of the tip, are symmetric. J̇ is the sum over j
    /// of element (r, i, j) times q̇_j.
    #[must_use]
    fn jacobian_derivatives<T: Scalar>(&self, q: &[T; DOF]) -> [[[T; DOF]; DOF]; 6];
}

/// The rate of the rows of a Jacobian at velocities.
pub(crate) fn rate_of_rows<T: Scalar, const DOF: usize>(
    q: &[T; DOF],
    qd: &[T; DOF],
    jacobian: impl Fn(&[Dual<T>; DOF]) -> [[Dual<T>; DOF]; 6],
) -> [[T; DOF]; 6] {
    let moving = from_fn(|i| Dual { value: q[i], derivative: qd[i] });
    jacobian(&moving).map(|row| row.map(|element| element.derivative))
}

/// The derivatives of the rows of a Jacobian by the position of each joint.
pub(crate) fn derivatives_of_rows<T: Scalar, const DOF: usize>(
    q: &[T; DOF],
    jacobian: impl Fn(&[Dual<T>; DOF]) -> [[Dual<T>; DOF]; 6],
) -> [[[T; DOF]; DOF]; 6] {
    let by: [_; DOF] = from_fn(|j| jacobian(&from_fn(|i| along(q, i, j))));
    from_fn(|row| from_fn(|i| from_fn(|j| by[j][row][i].derivative)))
}

#[cfg(feature = "arm")]
impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    fn jacobian_rate<T: Scalar>(self, q: &[T], qd: &[T]) -> [J::Of<T>; 6] {
        let each = self.coordinates.each();
        let moving = each.of(|i| Dual { value: q[i], derivative: qd[i] });
        self.jacobian(moving.as_ref()).map(|row| each.of(|i| row.as_ref()[i].derivative))
    }

    fn jacobian_derivatives<T: Scalar>(self, q: &[T]) -> [Square<J, T>; 6] {
        let each = self.coordinates.each();
        let by = each.of(|j| self.jacobian(self.along(q, j).as_ref()));
        from_fn(|row| each.of(|i| each.of(|j| by.as_ref()[j][row].as_ref()[i].derivative)))
    }
}

#[cfg(feature = "arm")]
definitions! { JacobianDerivatives<DOF> {
    /// As [`JacobianDerivatives::jacobian_rate`]: six rows.
    fn jacobian_rate(q: joints, qd: joints) -> rows6 = |robot| robot.jacobian_rate(q, qd);
    /// As [`JacobianDerivatives::jacobian_derivatives`]: six matrices.
    fn jacobian_derivatives(q: joints) -> matrices6 = |robot| robot.jacobian_derivatives(q);
} }
