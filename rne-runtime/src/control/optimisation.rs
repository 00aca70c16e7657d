//! Derivatives for optimisers, and those of an [`Arm`] by dual numbers through the seven steps: exact up to rounding,
//! one direction at a time. Generated code has them in reverse mode and by composite bodies, from other formulas.

use core::array::from_fn;

use crate::{AccelerationDerivatives, Dual, Scalar};

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

/// Element i of a list, with element j on its way.
pub(crate) fn along<T: Scalar>(x: &[T], i: usize, j: usize) -> Dual<T> {
    Dual { value: x[i], derivative: if i == j { T::one() } else { T::zero() } }
}
