//! The seven steps of recursive Newton-Euler.
//!
//! After A. D. Udai, NPTEL "Industrial Robotics: Theories for Implementation", lecture 38, and S. K. Saha,
//! "Introduction to Robotics", chapter 8. Each step is one function; the passes below them go from link to link.
//!
//! ```text
//! ω, ω̇         angular velocity and acceleration of a link          e     axis of the joint, (0, 0, 1)
//! ċ, c̈         velocity and acceleration of its centre of mass      d     from J_i to the centre of mass of link i
//! g            acceleration of gravity                              r_i   from the parent's centre of mass to J_i
//! f, n         force and moment that accelerate the link            m, I  mass; inertia about the centre of mass
//! f_{p,i}      force and moment that the parent link p exerts       R_i   turns components in the axes of link i into
//! n_{p,i}      on link i                                                  components in the axes of its parent
//! τ            torque (N m) or force (N) of the actuator
//! ```
//!
//! Link i is the one that joint i moves. Link p is the one that carries joint i: its `parent`, or the base. In a chain
//! p is i-1, and r_i is the lecture's r_{i-1} ([`mount`]). f_{i,k} is f_{p,i} of a joint k that link i carries.
//!
//! J_i is a point on the axis of joint i, fixed to link p: O_i of the lecture where the table is standard, the foot of
//! the common normal on axis i where it is modified.
//!
//! The components of a vector of link i are along axes that are fixed to link i, with z along joint i; only r_i is
//! along the axes of link p. These axes are called form P. The lecture uses axes that are fixed to link i-1: a
//! vector v here is Rz(θ_i) v there. The z elements are equal, so τ is the same.
//!
//! R_i and d_i are computed in [`link_frame`]. `common` is the part of a step that both kinds of joint have:
//! `kind.velocity(common, …)` and its like add the term that only a revolute or only a prismatic joint has ([`joint`]).
//!
//! The lecture has a chain on a base that does not move. The terms of moving bases and of rotors of motors are in
//! [`base`] and [`spin`]. [`first_moment`] has those of links with mass 0 that still have a first moment h (kg m):
//! their h is a number of its own, not mass times a distance. Identification of parameters gives such links. `S` is the
//! type of the robot's numbers, `T` that of q, q̇, q̈ and the results: `f64`, or a number that carries its derivative (a
//! dual number).
//!
//! The order of the operations is part of the contract: generated code repeats it and is compared bit for bit.

pub(crate) mod at_tip;
pub(crate) mod base;
mod first_moment;
pub(crate) mod joint;
pub(crate) mod link_frame;
pub(crate) mod link_state;
pub(crate) mod mechanism;
pub(crate) mod mount;
pub(crate) mod spin;
pub(crate) mod trace;

use nalgebra::Vector3;

use crate::seven_steps::at_tip::AtTip;
use crate::seven_steps::first_moment::{add_force_of_h, add_moment_of_h, subtract_weight_of_h};
use crate::seven_steps::joint::JointLaws;
use crate::seven_steps::link_frame::{Chain, LinkFrame};
use crate::seven_steps::link_state::{Carried, ForceMoment, Joint, JointMotions, LinkLoad, LinkMotion};
use crate::{BaseMotion, Constant, Scalar};

/// Step 1: angular velocity.
///
/// - revolute: ω_i = R_iᵀ ω_p + q̇_i e_i
/// - prismatic: ω_i = R_iᵀ ω_p
fn angular_velocity<T: Scalar>(joint: &Joint<T>, parent: &LinkMotion<T>, this: &LinkMotion<T>) -> Vector3<T> {
    joint.link.kind.angular_velocity(this.rotation.tr_mul(&parent.omega), joint.qd)
}

/// Step 2: angular acceleration.
///
/// - revolute: ω̇_i = R_iᵀ ω̇_p + q̈_i e_i + q̇_i ω_i × e_i
/// - prismatic: ω̇_i = R_iᵀ ω̇_p
fn angular_acceleration<T: Scalar>(joint: &Joint<T>, parent: &LinkMotion<T>, this: &LinkMotion<T>) -> Vector3<T> {
    let common = this.rotation.tr_mul(&parent.omega_dot);
    joint.link.kind.angular_acceleration(common, &this.omega, joint.qd, joint.qdd)
}

/// Step 3: velocity of the centre of mass. No later step uses it.
///
/// - revolute: ċ_i = R_iᵀ (ċ_p + ω_p × r_i) + ω_i × d_i
/// - prismatic: the same + q̇_i e_i
fn velocity<T: Scalar>(
    joint: &Joint<T>,
    parent: &LinkMotion<T>,
    parent_velocity: &Vector3<T>,
    this: &LinkMotion<T>,
) -> Vector3<T> {
    let velocity_of_j = parent_velocity + parent.omega.cross(&joint.link.mount.r);
    let common = this.rotation.tr_mul(&velocity_of_j) + this.omega.cross(&this.d);
    joint.link.kind.velocity(common, joint.qd)
}

/// Step 4: acceleration of the centre of mass, gravity not included.
///
/// - revolute: c̈_i = R_iᵀ (c̈_p + ω̇_p × r_i + ω_p × (ω_p × r_i)) + ω̇_i × d_i + ω_i × (ω_i × d_i)
/// - prismatic: the same + q̈_i e_i + 2 q̇_i ω_i × e_i
fn acceleration<T: Scalar>(joint: &Joint<T>, parent: &LinkMotion<T>, this: &LinkMotion<T>) -> Vector3<T> {
    let r = &joint.link.mount.r;
    let acceleration_of_j =
        (parent.acceleration + parent.omega_dot.cross(r)) + parent.omega.cross(&parent.omega.cross(r));
    let common = (this.rotation.tr_mul(&acceleration_of_j) + this.omega_dot.cross(&this.d))
        + this.omega.cross(&this.omega.cross(&this.d));
    joint.link.kind.acceleration(common, &this.omega, joint.qd, joint.qdd)
}

/// Step 5: gravity.
///
/// - g_i = R_iᵀ g_p
fn gravity<T: Scalar>(parent: &LinkMotion<T>, this: &LinkMotion<T>) -> Vector3<T> {
    this.rotation.tr_mul(&parent.gravity)
}

/// Step 6, the link alone: force and moment that accelerate it.
///
/// - f_i = m_i c̈_i
/// - n_i = I_i ω̇_i + ω_i × (I_i ω_i)
fn inertia_wrench<T: Scalar>(link: &LinkFrame<T>, this: &LinkMotion<T>) -> ForceMoment<T> {
    let force = this.acceleration * link.mass;
    let moment = link.inertia * this.omega_dot + this.omega.cross(&(link.inertia * this.omega));
    // both return their last argument, unless the link has a first moment h, which the lecture does not have
    ForceMoment { force: add_force_of_h(link, this, force), moment: add_moment_of_h(link, this, moment) }
}

/// Step 6, the balance: force and moment from the parent link, the moment about J_i. The sums run over the joints k
/// that link i carries, and the tip; in a chain there is one of them.
///
/// - f_{p,i} = f_i + Σ R_k f_{i,k} - m_i g_i
/// - n_{p,i} = n_i + Σ R_k n_{i,k} + d_i × f_{p,i} + Σ r_k × R_k f_{i,k}
///
/// f_i - m_i g_i is computed as m_i (c̈_i - g_i): one product instead of two.
fn joint_wrench<T: Scalar>(
    link: &LinkFrame<T>,
    this: &LinkMotion<T>,
    inertia: &ForceMoment<T>,
    carried: Option<&Carried<T>>,
) -> ForceMoment<T> {
    let own = add_force_of_h(link, this, (this.acceleration - this.gravity) * link.mass);
    let (force, moment) = match carried {
        // the link carries neither a joint nor a tip
        None => (own, inertia.moment + this.d.cross(&own)),
        // Σ R_k f_{i,k} and Σ R_k n_{i,k}, and Σ r_k × R_k f_{i,k}
        Some(Carried { wrench, of_levers }) => {
            let force = own + wrench.force;
            (force, ((inertia.moment + wrench.moment) + this.d.cross(&force)) + of_levers)
        }
    };
    // - h_i × g_i, if the link has a first moment; otherwise the moment as it is
    ForceMoment { force, moment: subtract_weight_of_h(link, this, moment) }
}

/// Step 7: what the actuator delivers is the element along the joint's axis.
///
/// - revolute: τ_i = e_i · n_{p,i}
/// - prismatic: τ_i = e_i · f_{p,i}
fn actuator<T: Scalar>(link: &LinkFrame<T>, wrench: &ForceMoment<T>) -> T {
    link.kind.actuator(wrench)
}

/// The forward pass, steps 1, 2, 4 and 5, from the base to the tip: parents before what they carry. If an argument
/// has fewer elements than the robot has joints, the pass ends there.
pub(crate) fn forward<S: Constant, T: Scalar>(
    chain: Chain<'_, S>,
    base: &BaseMotion<T>,
    joints: JointMotions<'_, T>,
    motions: &mut [LinkMotion<T>],
) {
    let base = base::motion(chain, base);
    for (index, joint) in chain.joints(joints).enumerate().take(motions.len()) {
        let parent = joint.link.parent.map_or(base, |parent| motions[parent]);
        // R_i and d_i; each step fills in one more vector
        let mut this = LinkMotion::placed(&joint);
        this.omega = angular_velocity(&joint, &parent, &this);
        this.omega_dot = angular_acceleration(&joint, &parent, &this);
        this.acceleration = acceleration(&joint, &parent, &this);
        this.gravity = gravity(&parent, &this);
        motions[index] = this;
    }
}

/// Step 3 for every link, from the base to the tip, after the forward pass. It stands apart because no torque needs it.
pub(crate) fn velocities<S: Constant, T: Scalar>(
    chain: Chain<'_, S>,
    base: &BaseMotion<T>,
    joints: JointMotions<'_, T>,
    motions: &[LinkMotion<T>],
    velocities: &mut [Vector3<T>],
) {
    let (base_velocity, base) = (base::velocity(chain, base), base::motion(chain, base));
    for (index, (joint, this)) in chain.joints(joints).zip(motions).enumerate() {
        let (parent, parent_velocity) = match joint.link.parent {
            None => (&base, base_velocity),
            Some(parent) => (&motions[parent], velocities[parent]),
        };
        velocities[index] = velocity(&joint, parent, &parent_velocity, this);
    }
}

/// The backward pass, steps 6 and 7, from the ends to the base: each link hands its wrench on to its parent. `tip` is
/// the wrench that the last link exerts at the tip, f_{n,n+1} and n_{n,n+1} of the lecture, or one for each named tip.
///
/// Returns the load of the base: `carried` is the sum of what the base exerts on the links that it carries; the other
/// fields are zero.
pub(crate) fn backward<S: Constant, T: Scalar>(
    chain: Chain<'_, S>,
    joints: JointMotions<'_, T>,
    motions: &[LinkMotion<T>],
    tip: AtTip<'_, T>,
    loads: &mut [LinkLoad<T>],
) -> LinkLoad<T> {
    // first the wrench at each tip: zero at a free tip; that of a payload depends on the motion of its link
    tip.put(chain, motions, loads);
    let mut base = LinkLoad::empty();
    for (index, (link, this)) in chain.links().zip(motions).enumerate().rev() {
        let inertia = chain.spins.with_moments(Some(index), joints, this, inertia_wrench(&link, this));
        let joint = joint_wrench(&link, this, &inertia, loads[index].carried.as_ref());
        // rotors on links add their part to τ after this pass: `Mechanism::all_passes`
        let tau = actuator(&link, &joint);
        // `carried` stays as it is
        loads[index] = LinkLoad { inertia, joint, tau, ..loads[index] };
        let parent = link.parent.map_or(&mut base, |parent| &mut loads[parent]);
        // R_i f_{p,i}, R_i n_{p,i} and r_i × R_i f_{p,i}
        parent.carry(&this.rotation, &link.mount.r, &joint);
    }
    base
}

#[cfg(test)]
mod tests {
    use rne_model::{Angle, Convention, Dh, Inertia, JointKind, Link, Row, Transform};

    use super::*;
    use crate::seven_steps::link_frame::Table;
    use crate::seven_steps::mount::Mount;
    use crate::seven_steps::spin::Spins;

    fn row(kind: JointKind, [a, d, alpha, mass]: [f64; 4]) -> Row {
        let inertia = Inertia { xx: 0.2, yy: 0.3, zz: 0.25, xy: 0.01, xz: -0.02, yz: 0.03 };
        let dh = Dh { theta: Angle::new(0.3), d, a, alpha: Angle::new(alpha) };
        Row { kind, dh, link: Link { mass, com: [0.1, -0.2, 0.3], inertia, first_moment: [0.0; 3] } }
    }

    /// τ of a robot with these links, each of which names its parent. All joints have the same q, q̇ and q̈.
    fn torques(links: &[LinkFrame<f64>], tip: &Mount<f64>) -> Vec<f64> {
        let (tip_link, spins) = (links.len().checked_sub(1), Spins::NONE);
        let chain = Chain { links, tip, tip_link, tips: &[], spins, floating_base: None };
        let all = |value: f64| vec![value; links.len()];
        let (q, qd, qdd) = (all(0.4), all(-1.3), all(2.1));
        let base = BaseMotion { omega: [0.1, -0.4, 0.2], ..BaseMotion::fixed([0.3, 1.0, -9.81]) };
        let mut motions = vec![LinkMotion::empty(); links.len()];
        let mut loads = vec![LinkLoad::empty(); links.len()];
        let joints = JointMotions::new(&q, &qd, &qdd);
        forward(chain, &base, joints, &mut motions);
        backward(chain, joints, &motions, AtTip::Nothing, &mut loads);
        loads.iter().map(|load| load.tau).collect()
    }

    /// A link that carries two equal branches: its τ is twice that of the chain with one branch, minus that of the link
    /// alone.
    #[test]
    fn a_link_may_carry_two_joints() {
        for convention in [Convention::Standard, Convention::Modified] {
            for kind in [JointKind::Revolute, JointKind::Prismatic] {
                let rows = [row(JointKind::Revolute, [0.5, 0.2, 0.7, 3.0]), row(kind, [0.3, 0.1, -1.1, 2.0])];
                let tool = &Transform::IDENTITY;
                let table = Table { convention, rows: &rows, branches: &[], tool, tip_on: None, floating_base: None };
                let tip = Mount::of_tip(table);
                let [first, second] = [0, 1].map(|index| LinkFrame::new(table, index));
                let (alone, chain) = (torques(&[first], &tip), torques(&[first, second], &tip));
                // the third link is the second once more, on the same parent
                let tree = torques(&[first, second, second], &tip);
                assert_eq!(second.parent, Some(0));
                assert_eq!(tree[1..], [chain[1], chain[1]], "{convention:?}, {kind:?}");
                let expected = 2.0 * chain[0] - alone[0];
                assert!((tree[0] - expected).abs() < 1e-13 * expected.abs(), "{} is not {expected}", tree[0]);
            }
        }
    }
}
