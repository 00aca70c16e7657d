//! Jacobians of the tips of a robot whose base nothing holds, and their accelerations where nothing else accelerates.
//!
//! A tip is a frame in the place of the tip frame, seen from frame 0 with the axes that the caller gives. The columns
//! of the base are those of a free body:
//!
//! ```text
//! linear   R_k, 0                R: its columns R_k are the axes of frame 0
//! angular  R_k × p, R_k          p: from the origin of frame 0 to the tip
//! ```

use nalgebra::{Matrix3, Vector3};
use rne_model::FixedFrame;

use crate::floating_base::{BASE, turning};
use crate::kinematics::Placement;
use crate::link_state::JointMotions;
use crate::mechanism::Mechanism;
use crate::mount::Mount;
use crate::per_joint::PerJoint;
use crate::{Arm, Constant, Scalar};
#[cfg(feature = "std")]
use crate::{DynArm, WrongLength};

/// The six columns of the base in a row of a Jacobian, and those of the joints.
type Row<J, T> = ([T; BASE], <J as PerJoint>::Of<T>);

/// A matrix of its rows.
fn matrix<T: Scalar>(rows: &[[T; 3]; 3]) -> Matrix3<T> {
    Matrix3::from(*rows).transpose()
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// The rows of the Jacobian of a tip.
    fn tip_jacobian<T: Scalar>(self, q: &[T], rotation: Matrix3<T>, tip: &FixedFrame<S>) -> [Row<J, T>; 6] {
        let start = Placement { rotation, translation: Vector3::zeros() };
        let links = self.placements(start, q);
        let (mut joints, origin) = Mechanism { at: Some(tip), ..self }.jacobian_from(start, links.as_ref());
        let zeros = self.zeros();
        core::array::from_fn(|row| {
            let element = |column: usize| {
                let axis = rotation.column(column % 3);
                match (row / 3, column / 3) {
                    (0, 1) => axis.cross(&origin)[row],
                    (0, _) => axis[row],
                    (_, 0) => T::zero(),
                    _ => axis[row - 3],
                }
            };
            (core::array::from_fn(element), core::mem::replace(&mut joints[row], zeros.clone()))
        })
    }

    /// The acceleration of a tip by that of the centre of mass of its link, where the base turns and nothing else of it
    /// accelerates.
    pub(crate) fn tip_acceleration<T: Scalar>(
        self,
        (q, qd): (&[T], &[T]),
        omega: &[T; 3],
        rotation: Matrix3<T>,
        tip: &FixedFrame<S>,
    ) -> [T; 6] {
        let zeros = self.zeros();
        let motions = self.motions(JointMotions::new(q, qd, zeros.as_ref()), &turning(omega));
        let mount: Mount<T> = Mount::of_frame(self.table.convention, self.table.rows, tip).to();
        let (mut linear, mut angular) = if let Some(link) = tip.on.map(|link| &motions.as_ref()[link]) {
            let centripetal = link.omega.cross(&link.omega.cross(&mount.r));
            ((link.acceleration + link.omega_dot.cross(&mount.r)) + centripetal, link.omega_dot)
        } else {
            let omega = Vector3::from(*omega);
            (omega.cross(&omega.cross(&mount.r)), Vector3::zeros())
        };
        let mut link = tip.on;
        while let Some(index) = link {
            let turn = &motions.as_ref()[index].rotation;
            (linear, angular) = (turn * linear, turn * angular);
            link = self.chain.links[index].parent;
        }
        let (linear, angular) = (rotation * linear, rotation * angular);
        [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
    }
}

/// An arm that does not know its tips takes them.
impl<const DOF: usize, S: Constant> Arm<DOF, S> {
    /// As [`FloatingKinematics::tip_jacobians`](crate::FloatingKinematics::tip_jacobians), of these tips; `NV` is
    /// `DOF` +
    /// 6. A tip on a link that there is not is on the base.
    #[must_use]
    pub fn tip_jacobians<T: Scalar, const NV: usize, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        base_rotation: &[[T; 3]; 3],
        tips: &[FixedFrame<S>; TIPS],
    ) -> [[[T; NV]; 6]; TIPS] {
        const { assert!(NV == DOF + BASE, "the matrix has a column for each joint and six for the base") };
        core::array::from_fn(|tip| {
            let rows = self.mechanism().tip_jacobian(q, matrix(base_rotation), &on_a_link(&tips[tip], DOF));
            rows.map(|(base, joints)| {
                core::array::from_fn(|column| if column < BASE { base[column] } else { joints[column - BASE] })
            })
        })
    }

    /// As [`FloatingKinematics::tip_accelerations`](crate::FloatingKinematics::tip_accelerations), of these tips. A tip
    /// on a link that there is not is on the base.
    #[must_use]
    pub fn tip_accelerations<T: Scalar, const TIPS: usize>(
        &self,
        q: &[T; DOF],
        qd: &[T; DOF],
        omega: &[T; 3],
        base_rotation: &[[T; 3]; 3],
        tips: &[FixedFrame<S>; TIPS],
    ) -> [[T; 6]; TIPS] {
        let of_tip = |tip: &FixedFrame<S>| {
            self.mechanism().tip_acceleration((q, qd), omega, matrix(base_rotation), &on_a_link(tip, DOF))
        };
        core::array::from_fn(|tip| of_tip(&tips[tip]))
    }
}

/// The tip, on the base if its link is not there.
fn on_a_link<S: Constant>(tip: &FixedFrame<S>, links: usize) -> FixedFrame<S> {
    FixedFrame { on: tip.on.filter(|on| *on < links), ..*tip }
}

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
    /// As [`FloatingKinematics::tip_jacobians`](crate::FloatingKinematics::tip_jacobians): for each of the
    /// [tips](Self::tips) six rows of 6 + n numbers.
    ///
    /// # Errors
    /// When the argument does not have one element per joint.
    pub fn tip_jacobians<T: Scalar>(
        &self,
        q: &[T],
        base_rotation: &[[T; 3]; 3],
    ) -> Result<Vec<Vec<Vec<T>>>, WrongLength> {
        let q = &*self.of_joints("q", q)?;
        let of_tip = |tip: &FixedFrame<S>| {
            let rows = self.mechanism().tip_jacobian(q, matrix(base_rotation), tip);
            let bases = rows.each_ref().map(|(base, _)| *base);
            let joints = self.couplings.rows(rows.map(|(_, joints)| joints));
            bases.iter().zip(joints).map(|(base, joints)| [base.as_slice(), joints.as_ref()].concat()).collect()
        };
        Ok(self.tips().iter().map(of_tip).collect())
    }

    /// As [`FloatingKinematics::tip_accelerations`](crate::FloatingKinematics::tip_accelerations), of the
    /// [tips](Self::tips).
    ///
    /// # Errors
    /// When a joint argument does not have one element per joint.
    pub fn tip_accelerations<T: Scalar>(
        &self,
        q: &[T],
        qd: &[T],
        omega: &[T; 3],
        base_rotation: &[[T; 3]; 3],
    ) -> Result<Vec<[T; 6]>, WrongLength> {
        let (q, qd) = (&*self.of_joints("q", q)?, &*self.of_joints("qd", qd)?);
        let rotation = matrix(base_rotation);
        let of_tip = |tip| self.mechanism().tip_acceleration((q, qd), omega, rotation, tip);
        Ok(self.tips().iter().map(of_tip).collect())
    }
}
