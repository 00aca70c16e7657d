//! The mass matrix M(q), by the seven steps: its columns are the torques of unit accelerations.
//!
//! Column j is τ(q, 0, e_j) without gravity: q̈ = e_j is 1 at j and 0 elsewhere. The rows i ≤ j of column j are taken,
//! and mirrored, so the matrix is symmetric to the last bit. The order of the operations is that of the seven steps;
//! generated code repeats it. The inverse is L⁻ᵀ D⁻¹ L⁻¹ by the factors of
//! [forward dynamics](crate::ForwardDynamics): column j from row j on, mirrored too.

use crate::at_tip::AtTip;
use crate::coordinates::Coordinates as _;
use crate::definition::Definition;
use crate::ldlt::{factor, inverse_of, solve};
use crate::link_state::{ForceMoment, JointMotions};
use crate::mechanism::Mechanism;
use crate::per_joint::{PerJoint, Square};
use crate::{BaseMotion, Constant, Scalar};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn mass_matrix<T: Scalar>(self, q: &[T], tip: AtTip<'_, T>) -> Square<J, T> {
        self.mass_matrix_beside(q, tip, |_, _| {})
    }

    /// M(q) of the joints; `on_base` is given the wrench on a base that does not move, for each column.
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
}

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    pub(crate) fn mass_matrix<T: Scalar>(self, q: &[T], load: AtTip<'_, T>) -> Square<J, T> {
        self.coordinates.symmetric(self.mechanism.mass_matrix(self.of_joints(q).as_ref(), load.matter()))
    }

    pub(crate) fn inverse_mass_matrix<T: Scalar>(self, q: &[T], load: AtTip<'_, T>) -> Square<J, T> {
        inverse_of(self.mass_matrix(q, load), &self.zeros())
    }

    /// Solves M(q) x = b.
    pub(crate) fn accelerations<T: Scalar>(self, q: &[T], mut b: J::Of<T>, load: AtTip<'_, T>) -> J::Of<T> {
        let (mut m, mut inverse) = (self.mass_matrix(q, load), self.zeros());
        factor(m.as_mut(), inverse.as_mut());
        solve(m.as_ref(), inverse.as_ref(), b.as_mut());
        b
    }
}
