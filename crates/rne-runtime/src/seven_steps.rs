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

use nalgebra::{Matrix3, Vector3};
use rne_model::JointKind::{Prismatic, Revolute};

use crate::link_frame::{Chain, LinkFrame};
use crate::{BaseMotion, Constant, Scalar, Wrench};

/// Link i with the motion of its joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joint<T> {
    pub(crate) link: LinkFrame<T>,
    /// θ_i or b_i without its constant part, rad or m.
    pub(crate) q: T,
    /// θ̇_i or ḃ_i.
    pub(crate) qd: T,
    /// θ̈_i or b̈_i.
    pub(crate) qdd: T,
}

/// What the forward pass finds for link i.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkMotion<T> {
    /// R_i
    pub(crate) rotation: Matrix3<T>,
    /// d_i
    pub(crate) d: Vector3<T>,
    /// r_i
    pub(crate) r: Vector3<T>,
    /// ω_i
    pub(crate) omega: Vector3<T>,
    /// ω̇_i
    pub(crate) omega_dot: Vector3<T>,
    /// c̈_i
    pub(crate) acceleration: Vector3<T>,
    /// g_i
    pub(crate) gravity: Vector3<T>,
}

/// What the backward pass finds for link i.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkLoad<T> {
    /// f_i
    pub(crate) inertia_force: Vector3<T>,
    /// n_i
    pub(crate) inertia_moment: Vector3<T>,
    /// f_{i-1,i}
    pub(crate) joint_force: Vector3<T>,
    /// n_{i-1,i}
    pub(crate) joint_moment: Vector3<T>,
    /// τ_i
    pub(crate) tau: T,
}

/// What link i+1 takes from link i, in the axes of link i.
struct Child<T> {
    /// f_{i,i+1}
    force: Vector3<T>,
    /// n_{i,i+1}
    moment: Vector3<T>,
}

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
fn inertia_wrench<T: Scalar>(link: &LinkFrame<T>, this: &LinkMotion<T>) -> (Vector3<T>, Vector3<T>) {
    let f = this.acceleration * link.mass;
    let n = link.inertia * this.omega_dot + this.omega.cross(&(link.inertia * this.omega));
    (f, n)
}

/// Step 6, the balance: force and moment from link i-1, the moment about the joint's reference point.
///
/// - f_{i-1,i} = f_i + f_{i,i+1} - m_i g_i
/// - n_{i-1,i} = n_i + n_{i,i+1} + d_i × f_{i-1,i} + r_i × f_{i,i+1}
fn joint_wrench<T: Scalar>(
    link: &LinkFrame<T>,
    this: &LinkMotion<T>,
    (f, n): &(Vector3<T>, Vector3<T>),
    child: &Child<T>,
) -> (Vector3<T>, Vector3<T>) {
    let force = (f + child.force) - this.gravity * link.mass;
    let moment = ((n + child.moment) + this.d.cross(&force)) + this.r.cross(&child.force);
    (force, moment)
}

/// Step 7: what the actuator delivers is the element along the joint's axis.
///
/// - R: τ_i = e_i · n_{i-1,i}
/// - P: τ_i = e_i · f_{i-1,i}
fn actuator<T: Scalar>(link: &LinkFrame<T>, (force, moment): &(Vector3<T>, Vector3<T>)) -> T {
    match link.kind {
        Revolute => moment.z,
        Prismatic => force.z,
    }
}

/// The forward pass, steps 1, 2, 4 and 5, from the base to the tip. Links beyond the shortest argument stay as they are.
pub(crate) fn forward<S: Constant, T: Scalar>(
    chain: Chain<'_, S>,
    base: &BaseMotion<T>,
    (q, qd, qdd): (&[T], &[T], &[T]),
    motions: &mut [LinkMotion<T>],
) {
    let mut prev = LinkMotion::of_base(chain, base);
    for (joint, motion) in chain.joints(q, qd, qdd).zip(motions) {
        let mut this = LinkMotion::at_rest(joint.link.rotation(joint.q), joint.link.d(joint.q), joint.link.r);
        this.omega = angular_velocity(&joint, &prev, &this);
        this.omega_dot = angular_acceleration(&joint, &prev, &this);
        this.acceleration = acceleration(&joint, &prev, &this);
        this.gravity = gravity(&prev, &this);
        *motion = this;
        prev = this;
    }
}

/// Step 3 for every link, from the base to the tip, after the forward pass.
#[cfg_attr(not(feature = "std"), allow(dead_code))]
pub(crate) fn velocities<S: Constant, T: Scalar>(
    chain: Chain<'_, S>,
    base: &BaseMotion<T>,
    (q, qd, qdd): (&[T], &[T], &[T]),
    motions: &[LinkMotion<T>],
    velocities: &mut [Vector3<T>],
) {
    let mut prev = LinkMotion::of_base(chain, base);
    let mut prev_velocity = Vector3::from(base.velocity);
    for ((joint, this), found) in chain.joints(q, qd, qdd).zip(motions).zip(velocities) {
        *found = velocity(&joint, &prev, &prev_velocity, this);
        prev = *this;
        prev_velocity = *found;
    }
}

/// The backward pass, steps 6 and 7, from the tip to the base. `tip` is f_{n,n+1}, n_{n,n+1}.
pub(crate) fn backward<S: Constant, T: Scalar>(
    chain: Chain<'_, S>,
    motions: &[LinkMotion<T>],
    tip: &Wrench<T>,
    loads: &mut [LinkLoad<T>],
) {
    // R_{i+1} and the wrench of joint i+1 in the axes of link i+1.
    let mut rotation = chain.ends.tip_rotation.map(S::to);
    let mut wrench = tip.vectors();
    for ((link, this), load) in chain.links().zip(motions).zip(loads).rev() {
        let child = Child { force: rotation * wrench.0, moment: rotation * wrench.1 };
        let inertia = inertia_wrench(&link, this);
        wrench = joint_wrench(&link, this, &inertia, &child);
        let tau = actuator(&link, &wrench);
        *load = LinkLoad {
            inertia_force: inertia.0,
            inertia_moment: inertia.1,
            joint_force: wrench.0,
            joint_moment: wrench.1,
            tau,
        };
        rotation = this.rotation;
    }
}

/// e_i, the joint's axis: z in form P.
fn e<T: Scalar>() -> Vector3<T> {
    Vector3::new(T::zero(), T::zero(), T::one())
}

impl<S: Constant> Chain<'_, S> {
    /// The links from base to tip, each with the motion of its joint.
    fn joints<T: Scalar>(&self, q: &[T], qd: &[T], qdd: &[T]) -> impl Iterator<Item = Joint<T>> {
        let motions = q.iter().zip(qd).zip(qdd);
        self.links().zip(motions).map(|(link, ((&q, &qd), &qdd))| Joint { link, q, qd, qdd })
    }
}

impl<T: Scalar> LinkMotion<T> {
    /// "Link 0": the moving frame that carries the arm, with r_0 from its origin to the first joint.
    fn of_base<S: Constant>(chain: Chain<'_, S>, base: &BaseMotion<T>) -> Self {
        Self {
            omega: base.omega.into(),
            omega_dot: base.omega_dot.into(),
            acceleration: base.acceleration.into(),
            gravity: base.gravity.into(),
            ..Self::at_rest(Matrix3::identity(), Vector3::zeros(), chain.ends.base_lever.map(S::to))
        }
    }

    fn at_rest(rotation: Matrix3<T>, d: Vector3<T>, r: Vector3<T>) -> Self {
        let zero = Vector3::zeros();
        Self { rotation, d, r, omega: zero, omega_dot: zero, acceleration: zero, gravity: zero }
    }

    /// A place for a result.
    pub(crate) fn empty() -> Self {
        Self::at_rest(Matrix3::identity(), Vector3::zeros(), Vector3::zeros())
    }
}

impl<T: Scalar> LinkLoad<T> {
    /// A place for a result.
    pub(crate) fn empty() -> Self {
        let zero = Vector3::zeros();
        Self { inertia_force: zero, inertia_moment: zero, joint_force: zero, joint_moment: zero, tau: T::zero() }
    }
}
