//! The seven steps of recursive Newton-Euler with symbols.
//!
//! NPTEL "Industrial Robotics: Theories for Implementation", lecture 38 (A. D. Udai), after S. K. Saha.
//!
//! ```text
//! ω, ω̇         angular velocity and acceleration of a link          e     axis of the joint, (0, 0, 1)
//! ċ, c̈         velocity and acceleration of its centre of mass      d     from J_i to the centre of mass of link i
//! g            acceleration of gravity                              r_i   from the parent's centre of mass to J_i
//! f, n         force and moment that accelerate the link            m, I  mass; inertia about the centre of mass
//! f_{p,i}      force and moment that the parent link p exerts       R_i   turns components in the axes of link i into
//! n_{p,i}      on link i, the moment about J_i                            components in the axes of its parent
//! τ            torque (N m) or force (N) of the actuator
//! ```
//!
//! Link i is the one that joint i moves. Link p is the one that carries joint i: its parent, or the base. In a chain p
//! is i-1, and r_i is the lecture's r_{i-1}. f_{i,k} and n_{i,k} are f_{p,i} and n_{p,i} of a joint k that link i
//! carries, or of a tip; in a chain there is one k, and it is i+1.
//!
//! J_i is a point on the axis of joint i, fixed to link p: O_i of the lecture where the table is standard, the foot of
//! the common normal on axis i where it is modified.
//!
//! The components of a vector of link i are along axes that are fixed to link i, with z along joint i; only r_i is
//! along the axes of link p. These axes are called form P; they serve standard and modified Denavit-Hartenberg tables.
//! The lecture uses axes that are fixed to link i-1: a vector v here is Rz(θ_i) v there. The z elements are equal, so τ
//! is the same.
//!
//! `line.define(name).by(formula)` computes a formula and gives the result its name in the generated code. The names of
//! a `line` have the number of its joint (`w2_z`); numbers of joints count from 1 there, and 0 is the base. Reports
//! count the operations within `by(…)` under this name. `'s` is the lifetime of the builder on which all formulas are
//! written.
//!
//! `back` is R_iᵀ. R_i and d_i are computed in [`super::joint`], r_i in [`super::arm`]. The argument of
//! `joint.velocity(…)` and its like is the part of the step that both kinds of joint have; the method adds the term
//! that only a revolute or only a prismatic joint has.
//!
//! The lecture has a chain on a base that does not move. The terms of trees, moving bases and rotors of motors are in
//! [`super::carried`], [`super::base`] and [`super::spin`]; those of links with mass 0 that still have a first moment h
//! (kg m), a number of its own and not mass times a distance, are in [`super::first_moment`]. Identification of
//! parameters gives such links.

use crate::formulate::carried::{self, Load};
use crate::formulate::first_moment::FirstMoment;
use crate::formulate::spin::Rotors;
use crate::formulate::{Arm, AtTip, Body, Joint, JointState, Wrench};
use crate::ir::{JointLines, Matrix, Quantity, Symbol, Vector};

/// How a link turns: the results of steps 1 and 2.
#[derive(Clone, Copy)]
pub(crate) struct Turning<'s> {
    /// R_i
    pub(crate) rotation: Matrix<'s>,
    /// ω_i
    pub(crate) omega: Vector<'s>,
    /// ω̇_i
    pub(crate) omega_dot: Vector<'s>,
}

/// The results of steps 1 to 5 for a link.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'s> {
    pub(crate) turning: Turning<'s>,
    /// d_i
    pub(crate) d: Vector<'s>,
    /// ċ_i
    pub(crate) c_dot: Vector<'s>,
    /// c̈_i
    pub(crate) c_ddot: Vector<'s>,
    /// g_i
    pub(crate) gravity: Vector<'s>,
}

/// The results of steps 6 and 7 for a link.
#[derive(Clone, Copy)]
pub(crate) struct JointLoad<'s> {
    /// f_{p,i} and n_{p,i}
    pub(crate) wrench: Wrench<'s>,
    /// τ_i
    pub(crate) torque: Symbol<'s>,
}

/// The torques of all joints, base to tip.
pub(crate) fn inverse_dynamics<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    base: &Motion<'s>,
    tip: &AtTip<'s>,
) -> Vec<JointLoad<'s>> {
    inverse_dynamics_of_floating_base(arm, states, base, tip).1
}

/// The wrench that must act on a floating base, if the robot has one, and the torques of all joints.
pub(crate) fn inverse_dynamics_of_floating_base<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    base: &Motion<'s>,
    tip: &AtTip<'s>,
) -> (Option<Wrench<'s>>, Vec<JointLoad<'s>>) {
    let motions = forward(arm, states, base);
    // the wrench that the last link exerts on a payload depends on the motion of that link
    backward(arm, states, (base, &motions), &tip.wrenches(arm, &motions))
}

/// The forward pass, parents first: the motion of each link from that of its parent.
pub(crate) fn forward<'s>(arm: &Arm<'s>, states: &[JointState<'s>], base: &Motion<'s>) -> Vec<Motion<'s>> {
    let mut motions: Vec<Motion<'s>> = Vec::with_capacity(states.len());
    for joint in arm.joints(states) {
        let parent = joint.link.parent.map_or(base, |parent| &motions[parent]);
        motions.push(motion(&joint, parent));
    }
    motions
}

/// Steps 1 and 2: how link i turns.
pub(crate) fn turning<'s>(joint: &Joint<'_, 's>, parent: &Turning<'s>) -> Turning<'s> {
    let line = joint.lines;
    let rotation = joint.rotation();
    let back = rotation.transpose();

    // 1   ω_i = R_iᵀ ω_p                           revolute: + q̇_i e
    let omega = line.define(Quantity::Omega).by(joint.angular_velocity(back * parent.omega));

    // 2   ω̇_i = R_iᵀ ω̇_p                           revolute: + q̈_i e + q̇_i ω_i × e
    let omega_dot = line.define(Quantity::OmegaDot).by(joint.angular_acceleration(back * parent.omega_dot, omega));

    Turning { rotation, omega, omega_dot }
}

/// Steps 1 to 5: the motion of link i.
fn motion<'s>(joint: &Joint<'_, 's>, parent: &Motion<'s>) -> Motion<'s> {
    // ω_p × r_i has the number of link p in its name, and a second number if joint i is not the first of p
    let (line, parent_line) = (joint.lines, joint.lines_of_parent().with_second_number(joint.link.mount.label));
    let Turning { omega: omega_p, omega_dot: omega_dot_p, .. } = parent.turning;
    let turning = turning(joint, &parent.turning);
    let Turning { rotation, omega, omega_dot } = turning;
    let (back, r, d) = (rotation.transpose(), joint.link.mount.r, joint.centre());

    // 3   ċ_i = R_iᵀ (ċ_p + ω_p × r_i) + ω_i × d_i                      prismatic: + q̇_i e
    let omega_cross_r = parent_line.define(Quantity::OmegaCrossR).by(omega_p.cross(r));
    let omega_cross_d = line.define(Quantity::OmegaCrossD).by(omega.cross(d));
    // velocity of J_i, a point of link p
    let velocity_of_j = line.define(Quantity::JointPointVelocity).by(parent.c_dot + omega_cross_r);
    let c_dot = line.define(Quantity::Velocity).by(joint.velocity(back * velocity_of_j + omega_cross_d));

    // 4   c̈_i = R_iᵀ (c̈_p + ω̇_p × r_i + ω_p × (ω_p × r_i))
    //           + ω̇_i × d_i + ω_i × (ω_i × d_i)                         prismatic: + q̈_i e + 2 q̇_i ω_i × e
    let acceleration_of_j = line
        .define(Quantity::JointPointAcceleration)
        .by(parent.c_ddot + omega_dot_p.cross(r) + omega_p.cross(omega_cross_r));
    let c_ddot = line
        .define(Quantity::Acceleration)
        .by(joint.acceleration(back * acceleration_of_j + omega_dot.cross(d) + omega.cross(omega_cross_d), omega));

    // 5   g_i = R_iᵀ g_p
    let gravity = line.define(Quantity::Gravity).by(back * parent.gravity);

    Motion { turning, d, c_dot, c_ddot, gravity }
}

/// The arguments of step 6 for one link: its body and motion, what it carries and the rotors that turn on it.
struct Balance<'a, 's> {
    body: &'a Body<'s>,
    motion: &'a Motion<'s>,
    load: &'a Load<'s>,
    rotors: &'a Rotors<'a, 's>,
    /// The link, counted from 0; `None` for the base.
    link: Option<usize>,
    /// The lines of f_i and n_i, and those of f_{p,i} and n_{p,i}, whose names have the number of the parent, too.
    lines: [JointLines<'s>; 2],
    /// The names of f_{p,i} and n_{p,i}.
    names: [Quantity; 2],
}

/// Step 6: the wrench that the parent exerts on link i.
fn wrench<'s>(balance: &Balance<'_, 's>) -> Wrench<'s> {
    let Balance { body, motion, load, rotors, link, lines: [line, at_joint], names: [force_name, moment_name] } =
        *balance;
    let Motion { turning: Turning { omega, omega_dot, .. }, d, c_ddot, gravity, .. } = *motion;
    // h_i, the first moment (kg m) of a link with mass 0; of other links the methods of h return their argument
    let h = FirstMoment::of(body, line, motion);

    // 6   f_i = m_i c̈_i
    // no formula below uses this result: it is written so that `rne show` and `rne explain` can print f_i
    line.define(Quantity::InertiaForce).by(h.add_to_force(c_ddot * body.mass));

    //     n_i = I_i ω̇_i + ω_i × (I_i ω_i)
    let angular_momentum = line.define(Quantity::AngularMomentum).by(body.inertia * omega);
    let inertia_moment = line.define(Quantity::InertiaMoment).by({
        let moment = body.inertia * omega_dot + omega.cross(angular_momentum);
        rotors.add_to_moment(link, omega, h.add_to_moment(moment))
    });

    //     f_{p,i} = f_i - m_i g_i + Σ R_k f_{i,k}
    // f_i - m_i g_i is computed as m_i (c̈_i - g_i): one product instead of two
    let force = at_joint.define(force_name).by({
        let own = (c_ddot - gravity) * body.mass;
        load.with_forces(h.add_to_force(own))
    });

    //     n_{p,i} = n_i + Σ R_k n_{i,k} + d_i × f_{p,i} + Σ r_k × R_k f_{i,k}
    let moment = at_joint.define(moment_name).by({
        let moment = load.with_moments(inertia_moment) + d.cross(force);
        // - h_i × g_i, if the link has a first moment
        h.subtract_weight(load.with_levers(moment))
    });
    Wrench { force, moment }
}

/// The backward pass, parents last: each link hands its wrench on to its parent. At the end, the wrench that must act
/// on a floating base.
fn backward<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    (base, motions): (&Motion<'s>, &[Motion<'s>]),
    at_tips: &[Wrench<'s>],
) -> (Option<Wrench<'s>>, Vec<JointLoad<'s>>) {
    let rotors = Rotors::of(arm, states);
    // what each link exerts: first at its tips, then, added in the loop, on the links that its joints move
    let mut loads = carried::at_tips(arm, at_tips);
    let mut load_of_base = Load::default();
    let mut of_joints = Vec::with_capacity(motions.len());
    for (joint, motion) in arm.joints(states).zip(motions).rev() {
        let Joint { lines: line, link, index, .. } = joint;
        let wrench = wrench(&Balance {
            body: &link.body,
            motion,
            load: &loads[index],
            rotors: &rotors,
            link: Some(index),
            // names of a wrench have both numbers: `f1_2` is exerted by link 1 on link 2
            lines: [line, line.behind(link.parent)],
            names: [Quantity::JointForce, Quantity::JointMoment],
        });

        // 7 τ_i = e · n_{p,i} prismatic: e · f_{p,i} Joints are coupled if one of them follows another. τ_i of such a
        // joint is only one part of the torque of the joint that is followed, so its name is `axis_tau`, not `tau`.
        // Rotors of motors add their part, also those that other links carry.
        let torque = line.define(arm.coordinates.name_of_torque(index).quantity).by({
            let torque = joint.actuator(&wrench);
            rotors.add_to_torque(&joint, (base, motions), torque)
        });
        of_joints.push(JointLoad { wrench, torque });

        // R_i f_{p,i} and R_i n_{p,i}, in the axes of link p
        let rotation = motion.turning.rotation;
        match link.parent {
            Some(parent) => loads[parent].put(arm.builder.joint(parent + 1), rotation, &link.mount, &wrench),
            None if arm.floating_base.is_some() => {
                load_of_base.put(arm.builder.joint(0), rotation, &link.mount, &wrench);
            }
            None => {}
        }
    }
    of_joints.reverse();
    let on_base = arm.floating_base.as_ref().map(|body| {
        wrench(&Balance {
            body,
            motion: base,
            load: &load_of_base,
            rotors: &rotors,
            link: None,
            lines: [arm.builder.joint(0); 2],
            names: [Quantity::BaseForce, Quantity::BaseMoment],
        })
    });
    (on_base, of_joints)
}
