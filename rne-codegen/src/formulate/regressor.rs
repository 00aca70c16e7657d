//! Torques per inertial parameter: τ = Y π, π = (m, m c̄, J) of each link about the origin O of its link frame, in its
//! axes.
//!
//! ```text
//! U = [ω̇]× + [ω]×[ω]×, a acceleration of O less gravity:   F = m a + U h,   N = h × a + J ω̇ + ω × J ω
//! u, v  angular velocity of link k and velocity of O per rate of joint i:   τ_i = v · F + u · N
//!   m:  v · a          h:  Uᵀ v + a × u          J:  u · J ω̇ + (u × ω) · J ω
//! ```

use rne_model::JointKind::{Prismatic, Revolute};
use rne_model::PER_LINK;

use crate::formulate::{Arm, JointState, Motion, Turning};
use crate::ir::{Cause, Matrix, Name, Quantity, Symbol, Vector};

/// Y by torque, link and parameter; zero where the joint does not move the link.
pub(crate) fn regressor<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    motions: &[Motion<'s>],
) -> Vec<Vec<[Symbol<'s>; PER_LINK]>> {
    let (builder, dof) = (arm.builder, states.len());
    let mut rows = vec![vec![[builder.constant(0.0, Cause::Arithmetic); PER_LINK]; dof]; dof];
    let zeros = builder.zeros(Cause::JointAxis);
    // of every joint, in the axes of its parent, at the joint's point: its acceleration less gravity, and (u, v) of the
    // joints that move the parent; behind them those of what stands at an end, which nothing takes
    let mut points = vec![-arm.gravity; dof + 1];
    let mut carriers: Vec<Vec<(usize, [Vector<'s>; 2])>> = vec![Vec::new(); dof + 1];
    for (joint, motion) in arm.joints(states).zip(motions) {
        let (line, link) = (joint.lines, joint.link);
        let Turning { rotation, omega, omega_dot } = motion.turning;
        let back = rotation.transpose();
        let reach = line.within(Quantity::Partial, || joint.offset(link.offset));
        let gradient = line.within(Quantity::Gradient, || gradient(omega, omega_dot));
        let origin = line.within(Quantity::OriginAcceleration, || {
            joint.acceleration(back * points[joint.index], omega) + gradient * reach
        });
        let mut mounted: Vec<(usize, Vector<'s>)> =
            arm.carried_joints(joint.index).map(|(index, link)| (index, link.mount.lever)).collect();
        if mounted.is_empty() {
            mounted.push((dof, arm.tip.lever));
        }
        for (index, lever) in &mounted {
            points[*index] = line.within(Quantity::JointPointAcceleration, || origin + gradient * *lever);
        }
        let mut twists = std::mem::take(&mut carriers[joint.index]);
        for (_, twist) in &mut twists {
            *twist = line.within(Quantity::Partial, || twist.map(|part| back * part));
        }
        twists.push(match link.kind {
            Revolute => (joint.index, [joint.e, zeros]),
            Prismatic => (joint.index, [zeros, joint.e]),
        });
        // in the axes of the link frame
        let into = link.table_axes.transpose();
        let in_frame = line.within(Quantity::Partial, || [omega, omega_dot, origin].map(|v| into * v));
        let gradient_in_frame = line.within(Quantity::Gradient, || self::gradient(in_frame[0], in_frame[1]));
        for (row, [u, v]) in twists {
            let at_origin = line.within(Quantity::Partial, || v + u.cross(reach));
            let in_axes = line.within(Quantity::Partial, || [u, at_origin].map(|v| into * v));
            let elements = line.within(Quantity::Partial, || columns(in_frame, gradient_in_frame, in_axes));
            for (parameter, element) in elements.into_iter().enumerate() {
                let name = element_name(row, joint.index, parameter);
                rows[row][joint.index][parameter] = builder.name(name, element);
            }
            for (index, lever) in &mounted {
                let at_joint = line.within(Quantity::Partial, || at_origin + u.cross(*lever));
                carriers[*index].push((row, [u, at_joint]));
            }
        }
    }
    rows
}

/// The name of an element of Y; joint, link and parameter are counted from 0.
pub(crate) fn element_name(joint: usize, link: usize, parameter: usize) -> Name {
    Name { indices: [link + 1, parameter + 1], ..Name::scalar(Quantity::RegressorElement, joint + 1) }
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
    [u, v]: [Vector<'s>; 2],
) -> [Symbol<'s>; PER_LINK] {
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
