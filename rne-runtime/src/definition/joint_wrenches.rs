//! The wrench of each link on the next one, from step 6.

use crate::definition::per_joint::PerJoint;
use crate::seven_steps::at_tip::AtTip;
use crate::seven_steps::link_state::JointMotions;
use crate::seven_steps::mechanism::Mechanism;
use crate::{Constant, Scalar, Wrench};

impl<J: PerJoint, S: Constant> Mechanism<'_, J, S> {
    pub(crate) fn joint_wrenches<T: Scalar>(self, q: &[T], qd: &[T], qdd: &[T]) -> J::Of<Wrench<T>> {
        let (_, loads) = self.passes(JointMotions::new(q, qd, qdd), &self.fixed_base(), AtTip::Nothing);
        self.per_joint.of(|i| {
            let joint = &loads.as_ref()[i].joint;
            Wrench::from_vectors(joint.force, joint.moment)
        })
    }
}
