//! Wrench of each link on the next, from step 6.

use crate::at_tip::AtTip;
use crate::link_state::JointMotions;
use crate::mechanism::Mechanism;
use crate::per_joint::PerJoint;
use crate::{Arm, Constant, JointWrenches, Scalar, Wrench};
#[cfg(feature = "std")]
use crate::{DynArm, WrongLength};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn joint_wrenches<T: Scalar>(self, q: &[T], qd: &[T], qdd: &[T]) -> J::Of<Wrench<T>> {
        let (_, loads) = self.passes(JointMotions::new(q, qd, qdd), &self.fixed_base(), AtTip::Nothing);
        self.per_joint.of(|i| {
            let joint = &loads.as_ref()[i].joint;
            Wrench::from_vectors(joint.force, joint.moment)
        })
    }
}

impl<const DOF: usize, S: Constant> JointWrenches<DOF> for Arm<DOF, S> {
    fn joint_wrenches<T: Scalar>(&self, q: &[T; DOF], qd: &[T; DOF], qdd: &[T; DOF]) -> [Wrench<T>; DOF] {
        self.mechanism().joint_wrenches(q, qd, qdd)
    }
}

#[cfg(feature = "std")]
impl<S: Constant> DynArm<S> {
    /// As [`JointWrenches::joint_wrenches`], base to tip, for the joints that follow no other.
    ///
    /// # Errors
    /// When an argument does not have one element per joint.
    pub fn joint_wrenches<T: Scalar>(&self, q: &[T], qd: &[T], qdd: &[T]) -> Result<Vec<Wrench<T>>, WrongLength> {
        let (q, qd, qdd) = self.of_all_joints(q, qd, qdd)?;
        Ok(self.couplings.of_coordinates(self.mechanism().joint_wrenches(&q, &qd, &qdd)))
    }
}
