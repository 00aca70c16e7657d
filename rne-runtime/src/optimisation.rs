//! Derivatives for optimisers, and those of an [`Arm`] by dual numbers through the seven steps: exact up to rounding,
//! one direction at a time. Generated code has them in reverse mode and by composite bodies, from other formulas.

use core::array::from_fn;

#[cfg(all(feature = "arm", feature = "std"))]
use crate::ldlt::inverse_of;
#[cfg(feature = "arm")]
use crate::{Arm, Constant, ForwardDynamics, InverseDynamics, MassMatrix};
use crate::{Dual, Scalar};
#[cfg(all(feature = "arm", feature = "std"))]
use crate::{DynArm, DynTorqueDerivatives, Payload, Wrench, WrongLength};
#[cfg(doc)]
use crate::{PayloadDynamics, TipWrenches};

/// The derivatives of λᵀτ for one state: of the torques, each times its multiplier and added up.
///
/// Units: of λᵀτ per rad or m, per rad/s or m/s, and per rad/s² or m/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueGradient<const DOF: usize, T> {
    /// ∂(λᵀτ)/∂q_j, λᵀ ∂τ/∂q.
    pub dq: [T; DOF],
    /// ∂(λᵀτ)/∂q̇_j, λᵀ ∂τ/∂q̇.
    pub dqd: [T; DOF],
    /// ∂(λᵀτ)/∂q̈_j, M(q) λ.
    pub dqdd: [T; DOF],
}

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

/// The derivatives of the accelerations for one state. Row i is acceleration i, column j is joint j.
///
/// Units: of an acceleration (rad/s², or m/s² for a prismatic joint) per rad or m, per rad/s or m/s, and per N m or N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AccelerationDerivatives<const DOF: usize, T> {
    /// ∂q̈_i/∂q_j.
    pub dq: [[T; DOF]; DOF],
    /// ∂q̈_i/∂q̇_j.
    pub dqd: [[T; DOF]; DOF],
    /// ∂q̈_i/∂τ_j, M(q)⁻¹: symmetric.
    pub dtau: [[T; DOF]; DOF],
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
    pub(crate) fn of(
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
impl<const DOF: usize, S: Constant> InverseDynamicsGradient<DOF> for Arm<DOF, S> {
    fn torque_gradient<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        qdd: &[T; DOF],
        multipliers: &[T; DOF],
    ) -> TorqueGradient<DOF, T> {
        let still = [q, qd, qdd].map(|x| x.map(Dual::constant));
        let by = |place: usize| {
            from_fn(|j| {
                let mut moving = still;
                moving[place] = from_fn(|i| along([q, qd, qdd][place], i, j));
                let [q, qd, qdd] = &moving;
                weighted(&self.inverse_dynamics(q, qd, qdd), multipliers)
            })
        };
        TorqueGradient { dq: by(0), dqd: by(1), dqdd: by(2) }
    }
}

#[cfg(feature = "arm")]
impl<const DOF: usize, S: Constant> ForwardDynamicsDerivatives<DOF> for Arm<DOF, S> {
    fn forward_dynamics_derivatives<T: Scalar>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        tau: &[T; DOF],
    ) -> AccelerationDerivatives<DOF, T> {
        let tau = still(tau);
        AccelerationDerivatives::of(q, qd, |q, qd| self.forward_dynamics(q, qd, &tau), self.inverse_mass_matrix(q))
    }
}

/// [`TorqueGradient`] of a [`DynArm`].
#[cfg(all(feature = "arm", feature = "std"))]
#[derive(Clone, Debug, PartialEq)]
pub struct DynTorqueGradient<T> {
    /// ∂(λᵀτ)/∂q_j.
    pub dq: Vec<T>,
    /// ∂(λᵀτ)/∂q̇_j.
    pub dqd: Vec<T>,
    /// ∂(λᵀτ)/∂q̈_j.
    pub dqdd: Vec<T>,
}

/// [`AccelerationDerivatives`] of a [`DynArm`].
#[cfg(all(feature = "arm", feature = "std"))]
#[derive(Clone, Debug, PartialEq)]
pub struct DynAccelerationDerivatives<T> {
    /// ∂q̈_i/∂q_j.
    pub dq: Vec<Vec<T>>,
    /// ∂q̈_i/∂q̇_j.
    pub dqd: Vec<Vec<T>>,
    /// ∂q̈_i/∂τ_j.
    pub dtau: Vec<Vec<T>>,
}

#[cfg(all(feature = "arm", feature = "std"))]
impl<S: Constant> DynArm<S> {
    /// As [`InverseDynamicsGradient::torque_gradient`].
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn torque_gradient<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        multipliers: &[T],
    ) -> Result<DynTorqueGradient<T>, WrongLength> {
        for (name, list) in [("q", q), ("qd", qd), ("qdd", qdd), ("multipliers", multipliers)] {
            self.has_length(name, list)?;
        }
        let by = |place: usize| {
            let column = |j: usize| {
                let [q, qd, qdd] = [(0, q), (1, qd), (2, qdd)].map(|(at, x)| moving(x, (at == place).then_some(j)));
                Ok::<_, WrongLength>(weighted(&self.inverse_dynamics(&q, &qd, &qdd)?, multipliers))
            };
            (0..self.dof()).map(column).collect::<Result<Vec<T>, _>>()
        };
        Ok(DynTorqueGradient { dq: by(0)?, dqd: by(1)?, dqdd: by(2)? })
    }

    /// As [`ForwardDynamicsDerivatives::forward_dynamics_derivatives`].
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn forward_dynamics_derivatives<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
    ) -> Result<DynAccelerationDerivatives<T>, WrongLength> {
        let (tau, dtau) = (moving(tau, None), self.inverse_mass_matrix(q)?);
        DynAccelerationDerivatives::of(q, qd, |q, qd| self.forward_dynamics(q, qd, &tau), dtau)
    }

    /// As [`PayloadDynamics::forward_dynamics_derivatives_with_payload`].
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn forward_dynamics_derivatives_with_payload<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        payload: &Payload<T>,
    ) -> Result<DynAccelerationDerivatives<T>, WrongLength> {
        let dtau = inverse_of(self.mass_matrix_with_payload(q, payload)?, &vec![T::zero(); q.len()]);
        let (tau, payload) = (moving(tau, None), payload.still());
        let accelerations = |q: &[_], qd: &[_]| self.forward_dynamics_with_payload(q, qd, &tau, &payload);
        DynAccelerationDerivatives::of(q, qd, accelerations, dtau)
    }

    /// As [`TipWrenches::inverse_dynamics_derivatives_with_wrenches`], with one of `wrenches` for each of the
    /// [tips](Self::tips).
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint, or `wrenches` not one element per tip.
    pub fn inverse_dynamics_derivatives_with_wrenches<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        qdd: &[T],
        wrenches: &[Wrench<T>],
    ) -> Result<DynTorqueDerivatives<T>, WrongLength> {
        for (name, list) in [("q", q), ("qd", qd), ("qdd", qdd)] {
            self.has_length(name, list)?;
        }
        let wrenches: Vec<_> = wrenches.iter().copied().map(Wrench::still).collect();
        let (still_q, still_qd, qdd) = (moving(q, None), moving(qd, None), moving(qdd, None));
        Ok(DynTorqueDerivatives {
            dq: dyn_rows_by(q, |q| self.inverse_dynamics_with_wrenches(q, &still_qd, &qdd, &wrenches))?,
            dqd: dyn_rows_by(qd, |qd| self.inverse_dynamics_with_wrenches(&still_q, qd, &qdd, &wrenches))?,
        })
    }

    /// As [`TipWrenches::forward_dynamics_derivatives_with_wrenches`], with one of `wrenches` for each of the
    /// [tips](Self::tips).
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint, or `wrenches` not one element per tip.
    pub fn forward_dynamics_derivatives_with_wrenches<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        wrenches: &[Wrench<T>],
    ) -> Result<DynAccelerationDerivatives<T>, WrongLength> {
        let wrenches: Vec<_> = wrenches.iter().copied().map(Wrench::still).collect();
        let (tau, dtau) = (moving(tau, None), self.inverse_mass_matrix(q)?);
        let accelerations = |q: &[_], qd: &[_]| self.forward_dynamics_with_wrenches(q, qd, &tau, &wrenches);
        DynAccelerationDerivatives::of(q, qd, accelerations, dtau)
    }
}

#[cfg(all(feature = "arm", feature = "std"))]
impl<T: Scalar> DynAccelerationDerivatives<T> {
    /// Derivatives of accelerations by q and q̇, beside the inverse of the mass matrix.
    fn of(
        q: &[T],
        qd: &[T],
        accelerations: impl Fn(&[Dual<T>], &[Dual<T>]) -> Result<Vec<Dual<T>>, WrongLength>,
        dtau: Vec<Vec<T>>,
    ) -> Result<Self, WrongLength> {
        let (still_q, still_qd) = (moving(q, None), moving(qd, None));
        accelerations(&still_q, &still_qd)?;
        let dq = dyn_rows_by(q, |q| accelerations(q, &still_qd))?;
        Ok(Self { dq, dqd: dyn_rows_by(qd, |qd| accelerations(&still_q, qd))?, dtau })
    }
}

/// As [`rows_by`].
#[cfg(all(feature = "arm", feature = "std"))]
pub(crate) fn dyn_rows_by<T: Scalar>(
    x: &[T],
    y: impl Fn(&[Dual<T>]) -> Result<Vec<Dual<T>>, WrongLength>,
) -> Result<Vec<Vec<T>>, WrongLength> {
    let columns = (0..x.len()).map(|j| y(&moving(x, Some(j)))).collect::<Result<Vec<_>, _>>()?;
    let row = |row: usize| columns.iter().map(|column| column[row].derivative).collect();
    Ok((0..columns.first().map_or(0, Vec::len)).map(row).collect())
}

/// Numbers of which one is on its way.
#[cfg(all(feature = "arm", feature = "std"))]
pub(crate) fn moving<T: Scalar>(x: &[T], j: Option<usize>) -> Vec<Dual<T>> {
    (0..x.len()).map(|i| along(x, i, j.unwrap_or(x.len()))).collect()
}
