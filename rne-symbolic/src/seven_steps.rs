//! The seven steps of recursive Newton-Euler over polynomials.
//!
//! After A. D. Udai, NPTEL "Industrial Robotics: Theories for Implementation", lecture 38, and S. K. Saha. The vectors
//! of link i stand in frame i, at joint i and fixed to link i; step 3, the velocity, is needed by no torque. The base
//! stands still, nothing touches the tip.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::arm::Link;
use crate::polynomial::Polynomial;
use crate::rational::fraction;
use crate::symbol::Symbol;
use crate::vector::Vector;

/// A polynomial of the derivation has more terms than any page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TooLong;

/// The motion of a link and gravity, in its frame.
#[derive(Debug)]
pub(crate) struct Motion {
    pub(crate) omega: Vector,
    pub(crate) omega_dot: Vector,
    pub(crate) c_ddot: Vector,
    pub(crate) gravity: Vector,
}

/// What moves a link and what its joint carries, in the link's frame: a closed form takes the torque, tests hold each
/// beside the lecture's.
#[derive(Debug)]
#[cfg_attr(not(test), allow(dead_code))]
pub(crate) struct Load {
    /// n_i
    pub(crate) inertia_moment: Vector,
    /// f_{i-1,i}
    pub(crate) force: Vector,
    /// n_{i-1,i}
    pub(crate) moment: Vector,
    /// τ_i
    pub(crate) torque: Polynomial,
}

/// What the actuators of all joints deliver, base to tip; `gravity` is that of frame 0.
pub(crate) fn inverse_dynamics(links: &[Link], gravity: &Vector) -> Result<Vec<Polynomial>, TooLong> {
    let loads = backward(links, &forward(links, gravity)?)?;
    Ok(loads.into_iter().map(|load| load.torque).collect())
}

/// Steps 1 to 5, base to tip.
pub(crate) fn forward(links: &[Link], gravity: &Vector) -> Result<Vec<Motion>, TooLong> {
    let mut motions: Vec<Motion> = Vec::with_capacity(links.len());
    for (i, link) in links.iter().enumerate() {
        let back = link.rotation.transpose();
        let base = Motion {
            omega: Vector::zero(),
            omega_dot: Vector::zero(),
            c_ddot: Vector::zero(),
            gravity: gravity.clone(),
        };
        let parent = motions.last().unwrap_or(&base);
        let r = i.checked_sub(1).and_then(|p| links.get(p)).map_or_else(Vector::zero, |link| link.r.clone());
        let qd = Polynomial::symbol(Symbol::Rate(i));
        let qdd = Polynomial::symbol(Symbol::Acceleration(i));
        let e = Vector::along_z(Polynomial::integer(1));
        let d = &link.d;

        // 1   ω_i = R_iᵀ ω_{i-1} (+ q̇_i e: revolute)
        // 2   ω̇_i = R_iᵀ ω̇_{i-1} (+ q̈_i e + q̇_i ω_i × e: revolute)
        let mut omega = &back * &parent.omega;
        let mut omega_dot = &back * &parent.omega_dot;
        if link.kind == Revolute {
            omega = omega + &e * &qd;
            omega_dot = omega_dot + &e * &qdd + &omega.cross(&e) * &qd;
        }

        // 4   c̈_i = R_iᵀ (c̈_{i-1} + ω̇_{i-1} × r_{i-1} + ω_{i-1} × (ω_{i-1} × r_{i-1}))
        //           + ω̇_i × d_i + ω_i × (ω_i × d_i) (+ q̈_i e + 2 q̇_i ω_i × e: prismatic)
        let joint = &parent.c_ddot + &(parent.omega_dot.cross(&r) + parent.omega.cross(&parent.omega.cross(&r)));
        let mut c_ddot = &back * &joint + omega_dot.cross(d) + omega.cross(&omega.cross(d));
        if link.kind == Prismatic {
            c_ddot = c_ddot + &e * &qdd + &omega.cross(&e) * &qd.scaled(&fraction(2, 1));
        }

        // 5   g_i = R_iᵀ g_{i-1}
        let gravity = &back * &parent.gravity;

        let motion = Motion { omega, omega_dot, c_ddot, gravity };
        if [&motion.omega, &motion.omega_dot, &motion.c_ddot, &motion.gravity].iter().any(|x| x.is_too_long()) {
            return Err(TooLong);
        }
        motions.push(motion);
    }
    Ok(motions)
}

/// Steps 6 and 7, tip to base.
pub(crate) fn backward(links: &[Link], motions: &[Motion]) -> Result<Vec<Load>, TooLong> {
    let mut loads = Vec::with_capacity(links.len());
    // f_{i,i+1} and n_{i,i+1} in frame i
    let (mut child_force, mut child_moment) = (Vector::zero(), Vector::zero());
    for (i, (link, motion)) in links.iter().zip(motions).enumerate().rev() {
        let Motion { omega, omega_dot, c_ddot, gravity } = motion;

        // 6   f_{i-1,i} = m_i (c̈_i - g_i) + f_{i,i+1}
        //     n_{i-1,i} = I_i ω̇_i + ω_i × (I_i ω_i) + n_{i,i+1} + d_i × f_{i-1,i} + r_i × f_{i,i+1}
        // of a first moment h_i beside the mass + ω̇_i × h_i + ω_i × (ω_i × h_i) and + h_i × (c̈_i - g_i)
        let mut force = &(c_ddot - gravity) * &link.mass + child_force.clone();
        let mut inertia_moment = &link.inertia * omega_dot + omega.cross(&(&link.inertia * omega));
        if !link.first_moment.is_zero() {
            let h = &link.first_moment;
            force = force + omega_dot.cross(h) + omega.cross(&omega.cross(h));
            inertia_moment = inertia_moment + h.cross(&(c_ddot - gravity));
        }
        let moment = inertia_moment.clone() + child_moment + link.d.cross(&force) + link.r.cross(&child_force);

        // 7 τ_i = e · n_{i-1,i} (prismatic: e · f_{i-1,i}) with the rotor, if that belongs to the arm: + G² Jm q̈_i
        let [.., along_axis] = match link.kind {
            Revolute => &moment.0,
            Prismatic => &force.0,
        };
        let torque = along_axis + &(&link.rotor * &Polynomial::symbol(Symbol::Acceleration(i)));
        if torque.is_too_long() || force.is_too_long() || moment.is_too_long() {
            return Err(TooLong);
        }
        child_force = &link.rotation * &force;
        child_moment = &link.rotation * &moment;
        loads.push(Load { inertia_moment, force, moment, torque });
    }
    loads.reverse();
    Ok(loads)
}
