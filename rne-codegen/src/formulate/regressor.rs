//! Torques per inertial parameter: τ = Y π, π = (m, m c̄, J) of each link about the origin O of its link frame, in its
//! axes.
//!
//! ```text
//! U = [ω̇]× + [ω]×[ω]×, a acceleration of O less gravity:   F = m a + U h,   N = h × a + J ω̇ + ω × J ω
//! u, v  angular velocity of link k and velocity of O per rate of joint i:   τ_i = v · F + u · N
//!   m:  v · a          h:  Uᵀ v + a × u          J:  u · J ω̇ + (u × ω) · J ω
//! ```

use rne_model::JointKind::{Prismatic, Revolute};

use crate::formulate::arm::Arm;
use crate::formulate::kinematics::offset;
use crate::formulate::seven_steps::{JointState, Motion};
use crate::ir::Builder;
use crate::ir::ledger::Cause;
use crate::ir::name::Name;
use crate::ir::quantity::Quantity;
use crate::ir::{Matrix, Symbol, Vector};

/// Parameters of a link.
pub(crate) const PARAMETERS: usize = 10;

/// Y by torque, link and parameter; zero where a link is nearer to the base than the joint.
pub(crate) fn regressor<'s>(
    builder: &'s Builder,
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    motions: &[Motion<'s>],
) -> Vec<Vec<[Symbol<'s>; PARAMETERS]>> {
    let dof = states.len();
    let zero = builder.constant(0.0, Cause::Arithmetic);
    let (zeros, e) = (
        builder.zeros(Cause::JointAxis),
        Vector([0.0, 0.0, 1.0].map(|value| builder.constant(value, Cause::JointAxis))),
    );
    let mut rows = vec![vec![[zero; PARAMETERS]; dof]; dof];
    // acceleration of the joint's point less gravity, in the axes of the link before
    let mut point = -arm.gravity;
    // (u, v) at the joint's point of every joint so far, in the axes of the link before
    let mut twists: Vec<[Vector<'s>; 2]> = Vec::with_capacity(dof);
    for (index, ((link, state), motion)) in arm.links.iter().zip(states).zip(motions).enumerate() {
        let line = builder.joint(index + 1);
        let back = motion.rotation.transpose();
        let Motion { omega, omega_dot, .. } = *motion;
        let reach = line.within(Quantity::Partial, || offset(link.offset, link.kind, state.q));
        let gradient = line.within(Quantity::Gradient, || gradient(omega, omega_dot));
        let origin = line.within(Quantity::OriginAcceleration, || {
            let at_joint = back * point;
            let sliding = match link.kind {
                Revolute => at_joint,
                Prismatic => {
                    let twice = builder.entry(Name::scalar(Quantity::Two, 0), 2.0) * state.qd;
                    at_joint + e * state.qdd + omega.cross(e) * twice
                }
            };
            sliding + gradient * reach
        });
        point = line.within(Quantity::JointPointAcceleration, || origin + gradient * link.lever);
        for twist in &mut twists {
            *twist = line.within(Quantity::Partial, || [back * twist[0], back * twist[1]]);
        }
        twists.push(match link.kind {
            Revolute => [e, zeros],
            Prismatic => [zeros, e],
        });
        // in the axes of the link frame
        let into = link.table_axes.transpose();
        let in_frame = line.within(Quantity::Partial, || [omega, omega_dot, origin].map(|v| into * v));
        let gradient_in_frame = line.within(Quantity::Gradient, || self::gradient(in_frame[0], in_frame[1]));
        for (joint, [u, v]) in twists.iter_mut().enumerate() {
            let at_origin = line.within(Quantity::Partial, || *v + u.cross(reach));
            let (u_in_frame, v_in_frame) = line.within(Quantity::Partial, || (into * *u, into * at_origin));
            let elements =
                line.within(Quantity::Partial, || columns(in_frame, gradient_in_frame, u_in_frame, v_in_frame));
            let mut parameter = 0;
            rows[joint][index] = elements.map(|element| {
                parameter += 1;
                builder.name(
                    Name { indices: [index + 1, parameter], ..Name::scalar(Quantity::RegressorElement, joint + 1) },
                    element,
                )
            });
            *v = line.within(Quantity::Partial, || at_origin + u.cross(link.lever));
        }
    }
    rows
}

/// U = [ω̇]× + [ω]×[ω]×
fn gradient<'s>(omega: Vector<'s>, omega_dot: Vector<'s>) -> Matrix<'s> {
    let ([x, y, z], [dx, dy, dz]) = (omega.0, omega_dot.0);
    let (xx, yy, zz, xy, xz, yz) = (x * x, y * y, z * z, x * y, x * z, y * z);
    Matrix::from_rows([[-(yy + zz), xy - dz, xz + dy], [xy + dz, -(xx + zz), yz - dx], [xz - dy, yz + dx, -(xx + yy)]])
}

/// The ten elements of one joint and one link.
fn columns<'s>(
    [omega, omega_dot, a]: [Vector<'s>; 3],
    gradient: Matrix<'s>,
    u: Vector<'s>,
    v: Vector<'s>,
) -> [Symbol<'s>; PARAMETERS] {
    let mass = v.dot(a);
    let [hx, hy, hz] = (gradient.transpose() * v + a.cross(u)).0;
    let ([ux, uy, uz], [dx, dy, dz]) = (u.0, omega_dot.0);
    let ([px, py, pz], [wx, wy, wz]) = (u.cross(omega).0, omega.0);
    [
        mass,
        hx,
        hy,
        hz,
        ux * dx + px * wx,
        (ux * dy + uy * dx) + (px * wy + py * wx),
        (ux * dz + uz * dx) + (px * wz + pz * wx),
        uy * dy + py * wy,
        (uy * dz + uz * dy) + (py * wz + pz * wy),
        uz * dz + pz * wz,
    ]
}
