//! Wrench of each link on the next, from step 6.

use crate::at_tip::AtTip;
use crate::coordinates::Coordinates as _;
use crate::definition::definitions;
use crate::link_state::JointMotions;
use crate::mechanism::Mechanism;
use crate::per_joint::PerJoint;
use crate::{Arm, Constant, JointWrenches, Scalar, Wrench};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn joint_wrenches<T: Scalar>(self, q: &[T], qd: &[T], qdd: &[T]) -> J::Of<Wrench<T>> {
        let (_, loads) = self.passes(JointMotions::new(q, qd, qdd), &self.fixed_base(), AtTip::Nothing);
        self.per_joint.of(|i| {
            let joint = &loads.as_ref()[i].joint;
            Wrench::from_vectors(joint.force, joint.moment)
        })
    }
}

definitions! { JointWrenches<DOF> {
    /// As [`JointWrenches::joint_wrenches`], base to tip, for the joints that follow no other.
    fn joint_wrenches(q: joints, qd: joints, qdd: joints) -> joint_wrenches = |robot| {
        let [q, qd, qdd] = [q, qd, qdd].map(|values| robot.of_joints(values));
        robot.coordinates.only(robot.mechanism.joint_wrenches(q.as_ref(), qd.as_ref(), qdd.as_ref()))
    };
} }
