//! Derivatives for optimisers, and those of an [`Arm`] by dual numbers through the seven steps: exact up to rounding,
//! one direction at a time. Generated code has them in reverse mode and by composite bodies, from other formulas.

use core::array::from_fn;

use crate::{AccelerationDerivatives, Dual, Scalar};
#[cfg(feature = "arm")]
use crate::{
    Constant,
    definition::Definition,
    definition::coordinates::Coordinates as _,
    definition::per_joint::{PerJoint, Square},
    seven_steps::at_tip::AtTip,
};

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
    pub(crate) fn gradient<T: Scalar>(self, motion: [&[T]; 3], multipliers: &[T]) -> (J::Of<T>, J::Of<T>, J::Of<T>) {
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

    /// λᵀτ by q and q, by q and q̇, by q̇ and q̇, and by q and q̈.
    #[allow(clippy::type_complexity)] // four matrices
    pub(crate) fn hessian<T: Scalar>(
        self,
        [q, qd, qdd]: [&[T]; 3],
        multipliers: &[T],
    ) -> (Square<J, T>, Square<J, T>, Square<J, T>, Square<J, T>) {
        let each = self.coordinates.each();
        let [still_q, still_qd, qdd, multipliers] = [q, qd, qdd, multipliers].map(|x| self.still(x));
        let gradient = |q: &J::Of<Dual<T>>, qd: &J::Of<Dual<T>>| {
            let (by_q, by_qd, by_qdd) = self.gradient([q.as_ref(), qd.as_ref(), qdd.as_ref()], multipliers.as_ref());
            [by_q, by_qd, by_qdd].map(|row| each.of(|j| row.as_ref()[j].derivative))
        };
        let by_q = each.of(|i| gradient(&self.along(q, i), &still_qd));
        let by_qd = each.of(|i| gradient(&still_q, &self.along(qd, i)));
        let rows = |by: &J::Of<[J::Of<T>; 3]>, place: usize| each.of(|i| by.as_ref()[i][place].clone());
        (rows(&by_q, 0), rows(&by_q, 1), rows(&by_qd, 1), rows(&by_q, 2))
    }
}
