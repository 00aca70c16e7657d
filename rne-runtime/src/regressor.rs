//! The torques as a linear function of the inertial parameters, τ = Σ Y π.
//!
//! Link j has ten parameters in the axes of its link frame, π = (m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz), J
//! being the tensor about the link frame's origin O_j. With a = Ö_j - g, force and moment about O_j that move the link
//! and carry its weight are linear in them:
//!
//! ```text
//! f = m a + ω̇ × m c + ω × (ω × m c)
//! n = m c × a + J ω̇ + ω × J ω
//! ```
//!
//! Each parameter set to one, the others to zero, gives a wrench; its way to the joints i ≤ j is that of step 6, and
//! the element along joint i is Y_{i,j}. The motion comes from the forward pass of the same table with every centre of
//! mass put at its link frame's origin: no inertial parameter of the robot enters Y.

use core::array;

use nalgebra::{Matrix3, Vector3};
use rne_model::{Convention, Link, PER_LINK, Row};

use crate::joint::JointLaws;
use crate::link_frame::{Chain, LinkFrame, Table, rotation_x};
use crate::link_state::{ForceMoment, JointMotions, LinkMotion};
use crate::mechanism::Mechanism;
use crate::mount::Mount;
use crate::per_joint::{PerJoint, Square};
use crate::{Arm, Constant, Regressor, Scalar};
#[cfg(feature = "std")]
use crate::{DynArm, WrongLength};

/// Row and column of Jxx, Jxy, Jxz, Jyy, Jyz, Jzz.
const TENSOR: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn regressor<T: Scalar>(self, q: &[T], qd: &[T], qdd: &[T]) -> Square<J, [T; PER_LINK]> {
        let rows = self.per_joint.of(|i| empty(&self.table.rows[i]));
        let table = Table { rows: rows.as_ref(), ..self.table };
        let links = self.per_joint.of(|i| LinkFrame::new(table, i));
        let chain = Chain { links: links.as_ref(), tip: &Mount::of_tip(table), ..self.chain };
        let bare = Mechanism { chain, table, ..self };
        let motions = bare.motions(JointMotions::new(q, qd, qdd), &self.fixed_base());
        let motions = motions.as_ref();

        let mut matrix = self.per_joint.all(&self.per_joint.all(&[T::zero(); PER_LINK]));
        for (j, motion) in motions.iter().enumerate() {
            let mut wrenches = unit_wrenches(motion, &self.link_axes(j));
            // The link itself: from its link frame's origin to its joint.
            let mut lever = motion.d;
            let mut joint = Some(j);
            while let Some(i) = joint {
                for (parameter, wrench) in wrenches.iter_mut().enumerate() {
                    wrench.moment += lever.cross(&wrench.force);
                    matrix.as_mut()[i].as_mut()[j][parameter] = self.table.rows[i].kind.actuator(wrench);
                    // In the axes of the parent.
                    let rotation = motions[i].rotation;
                    *wrench = ForceMoment { force: rotation * wrench.force, moment: rotation * wrench.moment };
                }
                // That link carries the wrench from there to its own joint.
                let link = &chain.links[i];
                joint = link.parent;
                if let Some(parent) = joint {
                    lever = motions[parent].d + link.mount.r.map(S::to);
                }
            }
        }
        matrix
    }

    /// Turns components in the axes of link frame `index` into those of form P.
    fn link_axes<T: Scalar>(self, index: usize) -> Matrix3<T> {
        match self.table.convention {
            Convention::Standard => rotation_x(&self.table.rows[index].dh.alpha).map(S::to),
            Convention::Modified => Matrix3::identity(),
        }
    }
}

/// The row of a link without mass.
fn empty<S: Constant>(row: &Row<S>) -> Row<S> {
    let zero = S::zero();
    let inertia = rne_model::Inertia { xx: zero, yy: zero, zz: zero, xy: zero, xz: zero, yz: zero };
    Row { link: Link { mass: zero, com: [zero; 3], inertia, first_moment: [zero; 3] }, ..*row }
}

/// Force and moment of each parameter set to one, about the origin of the link frame, in the axes of form P.
fn unit_wrenches<T: Scalar>(motion: &LinkMotion<T>, axes: &Matrix3<T>) -> [ForceMoment<T>; PER_LINK] {
    let omega = axes.tr_mul(&motion.omega);
    let omega_dot = axes.tr_mul(&motion.omega_dot);
    let acceleration = axes.tr_mul(&(motion.acceleration - motion.gravity));
    let unit = |k: usize| Vector3::from_fn(|row, _| if row == k { T::one() } else { T::zero() });
    array::from_fn(|parameter| {
        let (force, moment) = match parameter {
            0 => (acceleration, Vector3::zeros()),
            1..=3 => {
                let com = unit(parameter - 1);
                (omega_dot.cross(&com) + omega.cross(&omega.cross(&com)), com.cross(&acceleration))
            }
            _ => {
                let (row, column) = TENSOR[parameter - 4];
                let mut tensor = Matrix3::zeros();
                tensor[(row, column)] = T::one();
                tensor[(column, row)] = T::one();
                (Vector3::zeros(), tensor * omega_dot + omega.cross(&(tensor * omega)))
            }
        };
        ForceMoment { force: axes * force, moment: axes * moment }
    })
}

impl<const DOF: usize, S: Constant> Regressor<DOF> for Arm<DOF, S> {
    fn regressor<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], qdd: &[T; DOF]) -> [[[T; PER_LINK]; DOF]; DOF] {
        self.mechanism().regressor(q, qd, qdd)
    }
}

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
    /// As [`Regressor::regressor`]: torque, link, parameter.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn regressor<T: Scalar>(&self, q: &[T], qd: &[T], qdd: &[T]) -> Result<Vec<Vec<[T; PER_LINK]>>, WrongLength> {
        let (q, qd, qdd) = self.of_all_joints(q, qd, qdd)?;
        let rows = self.mechanism().regressor(&q, &qd, &qdd);
        Ok(self.couplings.gathered(rows, |sum: Vec<[T; PER_LINK]>, row, ratio| {
            let links = sum.into_iter().zip(row);
            links.map(|(a, b)| array::from_fn(|i| a[i] + b[i] * ratio.to())).collect()
        }))
    }
}
