//! Derivatives for optimisers. An [`Arm`] computes them by dual numbers through the seven steps, exact up to rounding,
//! one direction at a time. Generated code computes them by other formulas, in reverse mode and by composite bodies.

use core::array::from_fn;

use crate::{AccelerationDerivatives, Dual, Scalar};

impl<const DOF: usize, T: Scalar> AccelerationDerivatives<DOF, T> {
    /// Returns the derivatives of the accelerations with respect to q and q̇ by dual numbers, together with `dtau`, the
    /// inverse of the mass matrix.
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

/// Returns numbers whose derivatives are zero.
pub(crate) fn still<T: Scalar, const N: usize>(x: &[T; N]) -> [Dual<T>; N] {
    x.map(Dual::constant)
}

/// Returns the derivatives of the elements of y(x): one row per element of y, one column per element of x.
pub(crate) fn rows_by<T: Scalar, const N: usize, const ROWS: usize>(
    x: &[T; N],
    y: impl Fn(&[Dual<T>; N]) -> [Dual<T>; ROWS],
) -> [[T; N]; ROWS] {
    let columns: [_; N] = from_fn(|j| y(&from_fn(|i| along(x, i, j))));
    from_fn(|row| from_fn(|column| columns[column][row].derivative))
}

/// Returns element i of a list with its derivative with respect to element j, which is 1 for i = j and otherwise 0.
pub(crate) fn along<T: Scalar>(x: &[T], i: usize, j: usize) -> Dual<T> {
    Dual { value: x[i], derivative: if i == j { T::one() } else { T::zero() } }
}
