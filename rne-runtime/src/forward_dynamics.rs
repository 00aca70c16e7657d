//! Forward dynamics: the accelerations that follow from torques, M(q) q̈ = τ - bias(q, q̇).
//!
//! M is [`mass_matrix`](crate::MassMatrix::mass_matrix), the bias is
//! [`bias_torques`](crate::InverseDynamics::bias_torques), and M = L D Lᵀ without pivoting, which a positive definite
//! matrix does not need. The order of the operations is part of the contract; generated code repeats it:
//!
//! ```text
//! for j = 1 … n      D_j  = M_jj - L_j1 c_j1 - L_j2 c_j2 - …        over k < j, subtracted one by one
//!                    V_j  = 1 / D_j
//!     for i > j      c_ij = M_ij - L_i1 c_j1 - L_i2 c_j2 - …        over k < j
//!                    L_ij = c_ij V_j
//! forward            y_i  = (τ_i - bias_i) - L_i1 y_1 - L_i2 y_2 - …         over k < i
//!                    z_i  = y_i V_i
//! backward           q̈_i  = z_i - L_{i+1,i} q̈_{i+1} - L_{i+2,i} q̈_{i+2} - …   over k > i, ascending
//! ```

use crate::at_tip::AtTip;
use crate::ldlt::{factor, solve};
use crate::link_state::JointMotions;
use crate::mechanism::Mechanism;
use crate::per_joint::PerJoint;
use crate::{Arm, Constant, ForwardDynamics, Scalar};
#[cfg(feature = "std")]
use crate::{DynArm, WrongLength};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn forward_dynamics<T: Scalar>(self, q: &[T], qd: &[T], tau: &[T], tip: AtTip<'_, T>) -> J::Of<T> {
        let zeros = self.zeros();
        let bias = self.torques(JointMotions::new(q, qd, zeros.as_ref()), &self.fixed_base(), tip);
        let mut x = self.per_joint.of(|i| tau[i] - bias.as_ref()[i]);
        let (mut m, mut inverse) = (self.mass_matrix(q, tip.matter()), zeros);
        factor(m.as_mut(), inverse.as_mut());
        solve(m.as_ref(), inverse.as_ref(), x.as_mut());
        x
    }
}

impl<const DOF: usize, S: Constant> ForwardDynamics<DOF> for Arm<DOF, S> {
    fn forward_dynamics<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], tau: &[T; DOF]) -> [T; DOF] {
        self.mechanism().forward_dynamics(q, qd, tau, AtTip::Nothing)
    }
}

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
    /// As [`ForwardDynamics::forward_dynamics`]: accelerations, with a free tip.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn forward_dynamics<T: Scalar>(&self, q: &[T], qd: &[T], tau: &[T]) -> Result<Vec<T>, WrongLength> {
        self.forward_dynamics_with(q, qd, tau, AtTip::Nothing)
    }

    pub(crate) fn forward_dynamics_with<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        tau: &[T],
        tip: AtTip<'_, T>,
    ) -> Result<Vec<T>, WrongLength> {
        self.has_length("tau", tau)?;
        let at_rest = vec![T::zero(); self.dof()];
        let (q, qd, zeros) = self.of_all_joints(q, qd, &at_rest)?;
        let bias = self.mechanism().torques(JointMotions::new(&q, &qd, &zeros), &self.fixed_base(), tip);
        let mut x: Vec<T> = tau.iter().zip(self.couplings.torques(bias)).map(|(&tau, bias)| tau - bias).collect();
        let mut m = self.couplings.symmetric(self.mechanism().mass_matrix(&q, tip.matter()));
        let mut inverse = vec![T::zero(); self.dof()];
        factor(&mut m, &mut inverse);
        solve(&m, &inverse, &mut x);
        Ok(x)
    }
}
