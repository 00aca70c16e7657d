//! Jacobians J of the tips of a robot with a floating base, and J̇ v, their accelerations when base and joints do not
//! accelerate.
//!
//! A tip is a frame in the place of the tip frame, relative to frame 0, in the axes that the caller gives. The columns
//! of the base are those of a free body:
//!
//! ```text
//! linear   R_k, 0                R: its columns R_k are the axes of frame 0
//! angular  R_k × p, R_k          p: from the origin of frame 0 to the tip
//! ```

use nalgebra::{Matrix3, Vector3};
use rne_model::FixedFrame;

use crate::definition::Definition;
use crate::definition::coordinates::Coordinates as _;
use crate::definition::floating_base::{BASE, turning};
use crate::definition::kinematics::Placement;
use crate::definition::per_joint::PerJoint;
use crate::seven_steps::link_state::JointMotions;
use crate::seven_steps::mechanism::Mechanism;
use crate::seven_steps::mount::Mount;
use crate::{Constant, Scalar};

/// A row of a Jacobian: the six columns of the base, then those of the joints.
type Row<J, T> = ([T; BASE], <J as PerJoint>::Of<T>);

/// Converts rows to a matrix.
pub(crate) fn matrix<T: Scalar>(rows: &[[T; 3]; 3]) -> Matrix3<T> {
    Matrix3::from(*rows).transpose()
}

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    /// Returns the rows of the Jacobian of a tip.
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

    /// Returns the acceleration of a tip, from that of the centre of mass of its link, when the base turns but has no
    /// acceleration.
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

impl<J: PerJoint, V: PerJoint, P: PerJoint, S: Constant> Definition<'_, J, V, P, S> {
    pub(crate) fn tip_jacobian<T: Scalar>(
        self,
        q: &[T],
        base_rotation: &[[T; 3]; 3],
        tip: &FixedFrame<S>,
    ) -> [V::Of<T>; 6] {
        let rows = self.mechanism.tip_jacobian(self.of_joints(q).as_ref(), matrix(base_rotation), tip);
        rows.map(|(base, joints)| {
            let joints = self.coordinates.torques(joints);
            self.velocities.of(|column| match column.checked_sub(BASE) {
                Some(joint) => joints.as_ref()[joint],
                None => base[column],
            })
        })
    }

    pub(crate) fn tip_acceleration<T: Scalar>(
        self,
        [q, qd]: [&[T]; 2],
        omega: &[T; 3],
        base_rotation: &[[T; 3]; 3],
        tip: &FixedFrame<S>,
    ) -> [T; 6] {
        let [q, qd] = [q, qd].map(|values| self.of_joints(values));
        self.mechanism.tip_acceleration((q.as_ref(), qd.as_ref()), omega, matrix(base_rotation), tip)
    }
}
