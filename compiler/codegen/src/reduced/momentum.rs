//! The generalized momentum of the joints and its rate, with regrouped inertial parameters (the reduced form, section
//! 14).
//!
//! ```text
//! p = M(q) q̇ = τ(q, 0, q̇) without gravity                           the recursion, with velocities for accelerations
//! ∂T/∂q_i = (ω × e) · n_i + (v × e) · f_i   (revolute),   (ω × e) · f_i   (prismatic)
//! rate    = τ + ∂T/∂q - g(q)
//! ```
//!
//! With a floating base, the recursion also gives the momentum of the robot, and its angular momentum about the origin
//! of frame 0.
//!
//! If q̇ is given to the recursion in the place of q̈, it computes ω in the place of ω̇, and the velocity v of the
//! frame's origin in the place of its acceleration. Then f_i and n_i are the momenta of the link and of all links after
//! it. Regrouping keeps the torques of the arm, so it also keeps its mass matrix and its kinetic energy.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::ir::{Moving, Name, Number, Quantity, Symbol, Vector};
use crate::reduced::backward::{Carried, inward, torques_of_floating_base};
use crate::reduced::forward::motions;
use crate::reduced::{Arm, Motion, Moved, Wrench, crba};

/// Returns p and its rate without external torques, base to tip.
pub(crate) fn momentum_and_rate<'s>(arm: &Arm<'_, 's>) -> [Vec<Symbol<'s>>; 2] {
    let builder = arm.builder;
    let gravity = crba::gravity_torques(arm);
    let joint_frames = arm.joint_frames.without_gravity();
    let weightless = Arm { joint_frames: &joint_frames, ..*arm };
    let (moved, carried) = builder.moving(Moving::RatesForAccelerations, || {
        let moved = motions(&weightless);
        let carried = inward(&weightless, &moved, arm.load(false)).0;
        (moved, carried)
    });
    let rates = carried.iter().zip(&moved).zip(gravity).enumerate().map(|(index, ((carried, link), gravity))| {
        builder.at(Quantity::MomentumRate, index + 1);
        let rate =
            arm.joint_frames.coordinates.applied(builder, index) + of_motion(arm, index, link, carried) - gravity;
        builder.name(Name::scalar(Quantity::MomentumRate, index + 1), rate)
    });
    let rates = rates.collect();
    [carried.iter().map(|carried| carried.torque).collect(), rates]
}

/// Returns the momentum of a robot with a floating base, and its angular momentum about the origin of frame 0.
pub(crate) fn of_floating_base<'s>(arm: &Arm<'_, 's>) -> Wrench<'s> {
    let joint_frames = arm.joint_frames.without_gravity();
    let weightless = Arm { joint_frames: &joint_frames, ..*arm };
    arm.builder.moving(Moving::RatesForAccelerations, || torques_of_floating_base(&weightless)).0
}

/// Returns ∂T/∂q_i.
fn of_motion<'s>(arm: &Arm<'_, 's>, index: usize, link: &Moved<'s>, carried: &Carried<'s>) -> Symbol<'s> {
    let row = &arm.rows()[index];
    // a sphere's spin about its axis does not depend on q
    if arm.is_spin(index) {
        return arm.builder.zero();
    }
    let (lambda, mu) = (arm.parameters.lambda[index], arm.parameters.mu[index]);
    let per_length = mu.inverse().unwrap_or(Number::ONE);
    let per_both = (lambda * mu).inverse().unwrap_or(Number::ONE);
    let found = match row.kind {
        // the link's frame and N share the axis and a point of it
        Revolute => {
            let about_z = |v: Vector<'s>, of: Vector<'s>| v.0[1] * of.0[0] - v.0[0] * of.0[1];
            let of_frame = |motion: &Motion<'s>, wrench: &Wrench<'s>| {
                about_z(motion.omega_dot, wrench.moment) + about_z(motion.acceleration, wrench.force).times(per_both)
            };
            of_frame(&link.own, &carried.own) + of_frame(&link.unturned, &carried.unturned)
        }
        Prismatic => {
            let turning = link.own.omega_dot.cross(arm.builder.vector(row.axis));
            turning.dot(carried.own.force).times(per_length)
        }
    };
    found.signed(row.reversed)
}
