//! The centre of mass of the whole arm, and its Jacobian.
//!
//! ```text
//! μ_i = m_i (1 / Σ m)                                     sums of masses from the base to the tip
//! c = Σ μ_i c_i + p_b                                  c_i from the base's origin, in world axes, which stands at p_b
//! s_j = Σ s_k + μ_j c_j,   w_j = Σ w_k + μ_j              from the ends to the base; k: joints that link j carries
//! column j                                                z_j × (s_j - w_j p_j)   (revolute),   w_j z_j   (prismatic)
//! ```
//!
//! A floating base is a link, too: link 0, whose frame is frame 0.
//!
//! A link with a first moment h beside its mass adds h_i (1 / Σ m) to c and to s_j.

use nalgebra::Vector3;
use rne_model::JointKind;

use crate::definition::kinematics::Placement;
use crate::definition::per_joint::PerJoint;
use crate::seven_steps::mechanism::Mechanism;
use crate::{Constant, Scalar};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// Returns one over the mass of all links.
    fn inverse_of_mass<T: Scalar>(self) -> T {
        let mut total = self.chain.base::<T>().mass;
        for row in self.table.rows {
            total += row.link.mass.to();
        }
        T::one() / total
    }

    /// Returns μ_i c_i, plus h_i (1 / Σ m) if link i has a first moment beside its mass; and μ_i, the fraction of the
    /// whole mass that link i has.
    fn part<T: Scalar>(self, i: usize, links: &[Placement<T>], inverse: T) -> (Vector3<T>, T) {
        let part = self.table.rows[i].link.mass.to::<T>() * inverse;
        let moment = self.centre(i, links) * part;
        (self.first_moment(i, links).map_or(moment, |beside| moment + beside * inverse), part)
    }

    /// Returns the placement of the base with its axes in the world and its own origin.
    fn turned_base<T: Scalar>(self) -> Placement<T> {
        Placement { translation: Vector3::zeros(), ..Placement::constant(self.base) }
    }

    pub(crate) fn mass_centre<T: Scalar>(self, q: &[T]) -> [T; 3] {
        let links = self.placements(self.turned_base(), q);
        let (base, inverse) = (self.chain.base::<T>(), self.inverse_of_mass::<T>());
        let mut centre = base.com * (base.mass * inverse);
        for i in 0..self.table.rows.len() {
            centre += self.part(i, links.as_ref(), inverse).0;
        }
        // an arm without joints has no mass, so its centre of mass is not finite either
        if self.table.rows.is_empty() && self.chain.floating_base.is_none() {
            centre = centre.map(|zero: T| zero / T::zero());
        }
        (centre + Vector3::from(self.base.xyz).map(S::to)).into()
    }

    pub(crate) fn mass_centre_jacobian<T: Scalar>(self, q: &[T]) -> [J::Of<T>; 3] {
        let base = self.turned_base();
        let (links, inverse) = (self.placements(base, q), self.inverse_of_mass());
        // for each link, the sums s and w of the links that it carries
        let mut carried = self.per_joint.all(&(Vector3::zeros(), T::zero()));
        let mut columns = self.per_joint.all(&Vector3::zeros());
        for (i, column) in columns.as_mut().iter_mut().enumerate().rev() {
            let (mut moment, mut part) = carried.as_ref()[i];
            let of_link = self.part(i, links.as_ref(), inverse);
            moment += of_link.0;
            part += of_link.1;
            if let Some(parent) = self.chain.links[i].parent {
                let of_parent = &mut carried.as_mut()[parent];
                of_parent.0 += moment;
                of_parent.1 += part;
            }
            let frame = self.joint_frame(i, base, links.as_ref());
            let axis = frame.rotation.column(2).into_owned();
            *column = match self.table.rows[i].kind {
                JointKind::Revolute => axis.cross(&(moment - frame.translation * part)),
                JointKind::Prismatic => axis * part,
            };
        }
        core::array::from_fn(|row| self.per_joint.of(|i| columns.as_ref()[i][row]))
    }
}
