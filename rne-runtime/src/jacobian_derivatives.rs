//! How the Jacobian of the tip changes; of an [`Arm`] by dual numbers through its Jacobian, exact up to rounding.

use core::array::from_fn;

use crate::optimisation::along;
#[cfg(all(feature = "arm", feature = "std"))]
use crate::optimisation::moving;
#[cfg(feature = "arm")]
use crate::{Arm, Constant, Kinematics};
use crate::{Dual, Scalar};
#[cfg(all(feature = "arm", feature = "std"))]
use crate::{DynArm, WrongLength};

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
impl<const DOF: usize, S: Constant> JacobianDerivatives<DOF> for Arm<DOF, S> {
    fn jacobian_rate<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF]) -> [[T; DOF]; 6] {
        rate_of_rows(q, qd, |q| self.jacobian(q))
    }

    fn jacobian_derivatives<T: Scalar>(&self, q: &[T; DOF]) -> [[[T; DOF]; DOF]; 6] {
        derivatives_of_rows(q, |q| self.jacobian(q))
    }
}

#[cfg(all(feature = "arm", feature = "std"))]
impl<S: Constant> DynArm<S> {
    /// As [`JacobianDerivatives::jacobian_rate`]: six rows.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn jacobian_rate<T: Scalar>(&self, q: &[T], qd: &[T]) -> Result<[Vec<T>; 6], WrongLength> {
        for (name, list) in [("q", q), ("qd", qd)] {
            self.has_length(name, list)?;
        }
        let moving: Vec<_> = q.iter().zip(qd).map(|(&value, &derivative)| Dual { value, derivative }).collect();
        Ok(self.jacobian(&moving)?.map(|row| row.into_iter().map(|element| element.derivative).collect()))
    }

    /// As [`JacobianDerivatives::jacobian_derivatives`]: six matrices.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn jacobian_derivatives<T: Scalar>(&self, q: &[T]) -> Result<[Vec<Vec<T>>; 6], WrongLength> {
        self.has_length("q", q)?;
        let by = (0..q.len()).map(|j| self.jacobian(&moving(q, Some(j)))).collect::<Result<Vec<_>, _>>()?;
        let row = |row: usize, i: usize| by.iter().map(|jacobian| jacobian[row][i].derivative).collect();
        Ok(from_fn(|r| (0..q.len()).map(|i| row(r, i)).collect()))
    }
}
