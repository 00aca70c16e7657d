//! The mass matrix M(q), by the seven steps: its columns are the torques of unit accelerations.
//!
//! Column j is τ(q, 0, e_j) without gravity: q̈ = e_j is 1 at j and 0 elsewhere. The rows i ≤ j of column j are taken,
//! and mirrored, so the matrix is symmetric to the last bit. The order of the operations is that of the seven steps;
//! generated code repeats it. The inverse is L⁻ᵀ D⁻¹ L⁻¹ by the factors of
//! [forward dynamics](crate::ForwardDynamics): column j from row j on, mirrored too.

use crate::definition::Definition;
use crate::definition::coordinates::Coordinates as _;
use crate::definition::per_joint::{PerJoint, Square};
use crate::number::ldlt::{factor, inverse_of, solve};
use crate::seven_steps::at_tip::AtTip;
use crate::seven_steps::link_state::{ForceMoment, JointMotions};
use crate::seven_steps::mechanism::Mechanism;
use crate::{BaseMotion, Constant, Scalar};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn mass_matrix<T: Scalar>(self, q: &[T], tip: AtTip<'_, T>) -> Square<J, T> {
        self.mass_matrix_beside(q, tip, |_, _| {})
    }

    /// Returns M(q) of the joints. For each column, `on_base` gets the wrench on a base that does not move.
    pub(crate) fn mass_matrix_beside<T: Scalar>(
        self,
        q: &[T],
        tip: AtTip<'_, T>,
        mut on_base: impl FnMut(usize, ForceMoment<T>),
    ) -> Square<J, T> {
        let weightless = BaseMotion::fixed([T::zero(); 3]);
        let at_rest = self.zeros();
        let mut matrix = self.per_joint.all(&at_rest);
        for j in 0..q.len() {
            let unit = self.unit(j);
            let joints = JointMotions::new(q, at_rest.as_ref(), unit.as_ref());
            let (wrench, column) = self.of_floating_base(joints, &weightless, tip);
            on_base(j, wrench);
            for (i, &element) in column.as_ref().iter().enumerate().take(j + 1) {
                matrix.as_mut()[i].as_mut()[j] = element;
                matrix.as_mut()[j].as_mut()[i] = element;
            }
        }
        matrix
    }

    /// Returns the Coriolis matrix C(q, q̇) of Christoffel, by the seven steps.
    ///
    /// Without gravity and at q̈ = 0 the torques are a quadratic form in the velocities, b(x) = B(x, x) with B bilinear
    /// and symmetric, B(x, y)_i = Σ_jk Γ_ijk x_j y_k with Christoffel's symbols Γ_ijk = ½ (∂M_ij/∂q_k + ∂M_ik/∂q_j -
    /// ∂M_jk/∂q_i). Christoffel's matrix is C_ij = Σ_k Γ_ijk q̇_k. So its column j is the polar form with the unit
    /// vector e_j,
    ///
    /// ```text
    /// C e_j = B(q̇, e_j) = (b(q̇ + e_j) - b(q̇ - e_j)) / 4
    /// ```
    ///
    /// an identity and no difference quotient: it is exact up to rounding. Half the derivative of b with respect to q̇
    /// is the same matrix.
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

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    pub(crate) fn mass_matrix<T: Scalar>(self, q: &[T], load: AtTip<'_, T>) -> Square<J, T> {
        self.coordinates.symmetric(self.mechanism.mass_matrix(self.of_joints(q).as_ref(), load.matter()))
    }

    pub(crate) fn inverse_mass_matrix<T: Scalar>(self, q: &[T], load: AtTip<'_, T>) -> Square<J, T> {
        inverse_of(self.mass_matrix(q, load), &self.zeros())
    }

    /// Solves M(q) x = b and returns x.
    pub(crate) fn accelerations<T: Scalar>(self, q: &[T], mut b: J::Of<T>, load: AtTip<'_, T>) -> J::Of<T> {
        let (mut m, mut inverse) = (self.mass_matrix(q, load), self.zeros());
        factor(m.as_mut(), inverse.as_mut());
        solve(m.as_ref(), inverse.as_ref(), b.as_mut());
        b
    }
}
