//! The seven steps of recursive Newton-Euler.
//!
//! After A. D. Udai, NPTEL "Industrial Robotics: Theories for Implementation", lecture 38, and S. K. Saha, "Introduction to
//! Robotics", chapter 8. Each step is one function; the passes below them go from link to link.
//!
//! ```text
//! ω, ω̇         angular velocity and acceleration of a link          e     axis of the joint, (0, 0, 1)
//! ċ, c̈         velocity and acceleration of its centre of mass      d     from the joint to the centre of mass
//! g            acceleration of gravity                              r     from the centre of mass to the next joint
//! f, n         force and moment that accelerate the link            m, I  mass; inertia about the centre of mass
//! f_{i-1,i}    force and moment that link i-1 exerts on link i      R_i   turns components in the axes of link i into
//! n_{i-1,i}                                                               components in the axes of link i-1
//! τ            torque (N m) or force (N) of the actuator            R, P  revolute, prismatic
//! ```
//!
//! `prev` is link i-1, `this` is link i, `child` is link i+1. The vectors of link i stand in the axes of form P: fixed to
//! link i, z along joint i. The lecture writes the same vectors in axes fixed to link i-1: Rz(θ_i) leads there and leaves z
//! elements, so τ, as they are.
//!
//! The order of the operations is part of the contract: generated code repeats it and is compared bit for bit.

use nalgebra::Vector3;
use rne_model::JointKind::{Prismatic, Revolute};

use crate::link_frame::{Chain, LinkFrame};
use crate::link_state::{ForceMoment, Joint, JointMotions, LinkLoad, LinkMotion};
use crate::{BaseMotion, Constant, Scalar, Wrench};

/// Step 1: angular velocity.
///
/// - R: ω_i = R_iᵀ ω_{i-1} + q̇_i e_i
/// - P: ω_i = R_iᵀ ω_{i-1}
fn angular_velocity<T: Scalar>(joint: &Joint<T>, prev: &LinkMotion<T>, this: &LinkMotion<T>) -> Vector3<T> {
    match joint.link.kind {
        Revolute => this.rotation.tr_mul(&prev.omega) + e() * joint.qd,
        Prismatic => this.rotation.tr_mul(&prev.omega),
    }
}

/// Step 2: angular acceleration.
///
/// - R: ω̇_i = R_iᵀ ω̇_{i-1} + q̈_i e_i + q̇_i ω_i × e_i
/// - P: ω̇_i = R_iᵀ ω̇_{i-1}
fn angular_acceleration<T: Scalar>(joint: &Joint<T>, prev: &LinkMotion<T>, this: &LinkMotion<T>) -> Vector3<T> {
    match joint.link.kind {
        Revolute => (this.rotation.tr_mul(&prev.omega_dot) + e() * joint.qdd) + this.omega.cross(&e()) * joint.qd,
        Prismatic => this.rotation.tr_mul(&prev.omega_dot),
    }
}

/// Step 3: velocity of the centre of mass. No later step uses it.
///
/// - R: ċ_i = R_iᵀ (ċ_{i-1} + ω_{i-1} × r_{i-1}) + ω_i × d_i
/// - P: the same + q̇_i e_i
fn velocity<T: Scalar>(
    joint: &Joint<T>,
    prev: &LinkMotion<T>,
    prev_velocity: &Vector3<T>,
    this: &LinkMotion<T>,
) -> Vector3<T> {
    let joint_origin = prev_velocity + prev.omega.cross(&prev.r);
    let as_if_rigid = this.rotation.tr_mul(&joint_origin) + this.omega.cross(&this.d);
    match joint.link.kind {
        Revolute => as_if_rigid,
        Prismatic => as_if_rigid + e() * joint.qd,
    }
}

/// Step 4: acceleration of the centre of mass, gravity not included.
///
/// - R: c̈_i = R_iᵀ (c̈_{i-1} + ω̇_{i-1} × r_{i-1} + ω_{i-1} × (ω_{i-1} × r_{i-1})) + ω̇_i × d_i + ω_i × (ω_i × d_i)
/// - P: the same + q̈_i e_i + 2 q̇_i ω_i × e_i
fn acceleration<T: Scalar>(joint: &Joint<T>, prev: &LinkMotion<T>, this: &LinkMotion<T>) -> Vector3<T> {
    let joint_origin =
        (prev.acceleration + prev.omega_dot.cross(&prev.r)) + prev.omega.cross(&prev.omega.cross(&prev.r));
    let as_if_rigid = (this.rotation.tr_mul(&joint_origin) + this.omega_dot.cross(&this.d))
        + this.omega.cross(&this.omega.cross(&this.d));
    match joint.link.kind {
        Revolute => as_if_rigid,
        Prismatic => {
            let two = T::one() + T::one();
            (as_if_rigid + e() * joint.qdd) + this.omega.cross(&e()) * (two * joint.qd)
        }
    }
}

/// Step 5: gravity.
///
/// - g_i = R_iᵀ g_{i-1}
fn gravity<T: Scalar>(prev: &LinkMotion<T>, this: &LinkMotion<T>) -> Vector3<T> {
    this.rotation.tr_mul(&prev.gravity)
}

/// Step 6, the link alone: force and moment that accelerate it.
///
/// - f_i = m_i c̈_i
/// - n_i = I_i ω̇_i + ω_i × (I_i ω_i)
fn inertia_wrench<T: Scalar>(link: &LinkFrame<T>, this: &LinkMotion<T>) -> ForceMoment<T> {
    let force = this.acceleration * link.mass;
    let moment = link.inertia * this.omega_dot + this.omega.cross(&(link.inertia * this.omega));
    ForceMoment { force, moment }
}

/// Step 6, the balance: force and moment from link i-1, the moment about the joint's reference point.
///
/// - f_{i-1,i} = f_i + f_{i,i+1} - m_i g_i
/// - n_{i-1,i} = n_i + n_{i,i+1} + d_i × f_{i-1,i} + r_i × f_{i,i+1}
///
/// f_i - m_i g_i is computed as m_i (c̈_i - g_i): one product instead of two.
fn joint_wrench<T: Scalar>(
    link: &LinkFrame<T>,
    this: &LinkMotion<T>,
    inertia: &ForceMoment<T>,
    child: &ForceMoment<T>,
) -> ForceMoment<T> {
    let force = (this.acceleration - this.gravity) * link.mass + child.force;
    let moment = ((inertia.moment + child.moment) + this.d.cross(&force)) + this.r.cross(&child.force);
    ForceMoment { force, moment }
}

/// Step 7: what the actuator delivers is the element along the joint's axis.
///
/// - R: τ_i = e_i · n_{i-1,i}
/// - P: τ_i = e_i · f_{i-1,i}
fn actuator<T: Scalar>(link: &LinkFrame<T>, joint: &ForceMoment<T>) -> T {
    match link.kind {
        Revolute => joint.moment.z,
        Prismatic => joint.force.z,
    }
}

/// The forward pass, steps 1, 2, 4 and 5, from the base to the tip. Links beyond the shortest argument stay as they are.
pub(crate) fn forward<S: Constant, T: Scalar>(
    chain: Chain<'_, S>,
    base: &BaseMotion<T>,
    joints: JointMotions<'_, T>,
    motions: &mut [LinkMotion<T>],
) {
    let mut prev = LinkMotion::of_base(chain, base);
    for (joint, motion) in chain.joints(joints).zip(motions) {
        let mut this = LinkMotion::placed(&joint);
        this.omega = angular_velocity(&joint, &prev, &this);
        this.omega_dot = angular_acceleration(&joint, &prev, &this);
        this.acceleration = acceleration(&joint, &prev, &this);
        this.gravity = gravity(&prev, &this);
        *motion = this;
        prev = this;
    }
}

/// Step 3 for every link, from the base to the tip, after the forward pass. It stands apart because no torque needs it.
pub(crate) fn velocities<'a, S: Constant, T: Scalar>(
    chain: Chain<'a, S>,
    base: &BaseMotion<T>,
    joints: JointMotions<'a, T>,
    motions: &'a [LinkMotion<T>],
) -> impl Iterator<Item = Vector3<T>> + 'a {
    let start = (LinkMotion::of_base(chain, base), Vector3::from(base.velocity));
    chain.joints(joints).zip(motions).scan(start, |(prev, prev_velocity), (joint, this)| {
        *prev_velocity = velocity(&joint, prev, prev_velocity, this);
        *prev = *this;
        Some(*prev_velocity)
    })
}

/// The backward pass, steps 6 and 7, from the tip to the base. `tip` is f_{n,n+1}, n_{n,n+1}; `None` is a free tip.
pub(crate) fn backward<S: Constant, T: Scalar>(
    chain: Chain<'_, S>,
    motions: &[LinkMotion<T>],
    tip: Option<&Wrench<T>>,
    loads: &mut [LinkLoad<T>],
) {
    // R_{i+1}, and the wrench of joint i+1 in the axes of link i+1.
    let mut rotation = chain.ends.tip_rotation.map(S::to);
    let mut wrench = tip.map_or_else(ForceMoment::zero, ForceMoment::from);
    for ((link, this), load) in chain.links().zip(motions).zip(loads).rev() {
        let child = ForceMoment { force: rotation * wrench.force, moment: rotation * wrench.moment };
        let inertia = inertia_wrench(&link, this);
        let joint = joint_wrench(&link, this, &inertia, &child);
        let tau = actuator(&link, &joint);
        *load = LinkLoad { inertia, joint, tau };
        rotation = this.rotation;
        wrench = joint;
    }
}

/// e_i, the joint's axis: z in form P.
fn e<T: Scalar>() -> Vector3<T> {
    Vector3::new(T::zero(), T::zero(), T::one())
}
