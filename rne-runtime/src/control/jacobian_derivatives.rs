//! Derivatives of the Jacobian of the tip. An [`Arm`] computes them by dual numbers through its Jacobian, exact up to
//! rounding.

use core::array::from_fn;

use crate::control::optimisation::along;
#[cfg(feature = "arm")]
use crate::{
    Constant,
    definition::Definition,
    definition::coordinates::Coordinates as _,
    definition::per_joint::{PerJoint, Square},
};
use crate::{Dual, Scalar};

/// Returns the rate of the rows of a Jacobian at velocities.
pub(crate) fn rate_of_rows<T: Scalar, const DOF: usize>(
    q: &[T; DOF],
    qd: &[T; DOF],
    jacobian: impl Fn(&[Dual<T>; DOF]) -> [[Dual<T>; DOF]; 6],
) -> [[T; DOF]; 6] {
    let moving = from_fn(|i| Dual { value: q[i], derivative: qd[i] });
    jacobian(&moving).map(|row| row.map(|element| element.derivative))
}

/// Returns the derivatives of the rows of a Jacobian with respect to the position of each joint.
pub(crate) fn derivatives_of_rows<T: Scalar, const DOF: usize>(
    q: &[T; DOF],
    jacobian: impl Fn(&[Dual<T>; DOF]) -> [[Dual<T>; DOF]; 6],
) -> [[[T; DOF]; DOF]; 6] {
    let by: [_; DOF] = from_fn(|j| jacobian(&from_fn(|i| along(q, i, j))));
    from_fn(|row| from_fn(|i| from_fn(|j| by[j][row][i].derivative)))
}

#[cfg(feature = "arm")]
impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    pub(crate) fn jacobian_rate<T: Scalar>(self, q: &[T], qd: &[T]) -> [J::Of<T>; 6] {
        let each = self.coordinates.each();
        let moving = each.of(|i| Dual { value: q[i], derivative: qd[i] });
        self.jacobian(moving.as_ref()).map(|row| each.of(|i| row.as_ref()[i].derivative))
    }

    pub(crate) fn jacobian_derivatives<T: Scalar>(self, q: &[T]) -> [Square<J, T>; 6] {
        let each = self.coordinates.each();
        let by = each.of(|j| self.jacobian(self.along(q, j).as_ref()));
        from_fn(|row| each.of(|i| each.of(|j| by.as_ref()[j][row].as_ref()[i].derivative)))
    }
}
