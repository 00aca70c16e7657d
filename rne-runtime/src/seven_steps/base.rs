//! The base in the seven steps: its motion before the forward pass, and the wrench on it after the backward pass. The
//! lecture has a base that does not move.

use nalgebra::Vector3;

use crate::seven_steps::link_frame::{Chain, LinkFrame};
use crate::seven_steps::link_state::{ForceMoment, JointMotions, LinkLoad, LinkMotion};
use crate::seven_steps::{inertia_wrench, joint_wrench};
use crate::{BaseMotion, Constant, Scalar};

/// The motion of the base, where the forward pass starts.
pub(crate) fn motion<S: Constant, T: Scalar>(chain: Chain<'_, S>, motion: &BaseMotion<T>) -> LinkMotion<T> {
    LinkMotion::of_base(motion, chain.floating_base.map(|_| chain.base().com))
}

/// Step 3 of the base: the velocity of its centre of mass, or of the origin of frame 0 if the base has no mass.
pub(crate) fn velocity<S: Constant, T: Scalar>(chain: Chain<'_, S>, motion: &BaseMotion<T>) -> Vector3<T> {
    let (origin, base) = (Vector3::from(motion.velocity), self::motion(chain, motion));
    if chain.floating_base.is_some() { origin + base.omega.cross(&base.d) } else { origin }
}

/// Step 6 of the base: the force and moment that must act on it, the moment about the origin of frame 0, after the
/// backward pass has left `load` on it.
pub(crate) fn wrench<S: Constant, T: Scalar>(
    chain: Chain<'_, S>,
    joints: JointMotions<'_, T>,
    this: &LinkMotion<T>,
    load: &LinkLoad<T>,
) -> ForceMoment<T> {
    let base = LinkFrame::of_base(chain.base());
    let inertia = chain.spins.with_moments(None, joints, this, inertia_wrench(&base, this));
    joint_wrench(&base, this, &inertia, load.carried.as_ref())
}
