//! The Coriolis matrix C(q, q̇) of Christoffel, by the seven steps.
//!
//! Without gravity and at q̈ = 0 the torques are a quadratic form in the velocities, b(x) = B(x, x) with B bilinear and
//! symmetric, B(x, y)_i = Σ_jk Γ_ijk x_j y_k with Christoffel's symbols Γ_ijk = ½ (∂M_ij/∂q_k + ∂M_ik/∂q_j -
//! ∂M_jk/∂q_i). Christoffel's matrix is C_ij = Σ_k Γ_ijk q̇_k. So its column j is the polar form with the unit vector
//! e_j,
//!
//! ```text
//! C e_j = B(q̇, e_j) = (b(q̇ + e_j) - b(q̇ - e_j)) / 4
//! ```
//!
//! an identity and no difference quotient: it is exact up to rounding. Half the derivative of b with respect to q̇ is
//! the same matrix.

use crate::at_tip::AtTip;
use crate::link_state::JointMotions;
use crate::mechanism::Mechanism;
use crate::per_joint::{PerJoint, Square};
use crate::{BaseMotion, Constant, Scalar};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn coriolis_matrix<T: Scalar>(self, q: &[T], qd: &[T]) -> Square<J, T> {
        let weightless = BaseMotion::fixed([T::zero(); 3]);
        let zeros = self.zeros();
        let torques =
            |qd: J::Of<T>| self.torques(JointMotions::new(q, qd.as_ref(), zeros.as_ref()), &weightless, AtTip::Nothing);
        let quarter = T::from_f64(0.25);
        let mut matrix = self.per_joint.all(&zeros);
        for j in 0..q.len() {
            let unit = self.unit::<T>(j);
            let faster = torques(self.per_joint.of(|k| qd[k] + unit.as_ref()[k]));
            let slower = torques(self.per_joint.of(|k| qd[k] - unit.as_ref()[k]));
            for (i, row) in matrix.as_mut().iter_mut().enumerate() {
                row.as_mut()[j] = (faster.as_ref()[i] - slower.as_ref()[i]) * quarter;
            }
        }
        matrix
    }
}
