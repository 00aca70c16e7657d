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

use crate::definition::Definition;
use crate::definition::coordinates::Coordinates as _;
use crate::definition::per_joint::PerJoint;
use crate::seven_steps::at_tip::AtTip;
use crate::{Constant, Scalar};

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    pub(crate) fn forward_dynamics<T: Scalar>(self, [q, qd, tau]: [&[T]; 3], load: AtTip<'_, T>) -> J::Of<T> {
        let bias = self.bias(q, qd, load);
        self.accelerations(q, self.coordinates.each().of(|i| tau[i] - bias.as_ref()[i]), load)
    }
}
