//! The regressor Y of the inertial parameters: τ = Y π, with π = (m, m c̄, J) of each link about the origin O of its
//! link frame, in the axes of that frame.
//!
//! ```text
//! U = [ω̇]× + [ω]×[ω]×, a acceleration of O less gravity:   F = m a + U h,   N = h × a + J ω̇ + ω × J ω
//! u, v  angular velocity of link k and velocity of O per rate of joint i:   τ_i = v · F + u · N
//!   m:  v · a          h:  Uᵀ v + a × u          J:  u · J ω̇ + (u × ω) · J ω
//! ```
//!
//! A floating base is a link, too: its link frame is frame 0. For each of its six rows, u or v is an axis of that
//! frame.

use std::array::from_fn;

use rne_model::JointKind::{Prismatic, Revolute};
use rne_model::PER_LINK;

use crate::formulate::{Arm, JointState, Link, Motion, Turning};
use crate::function::Length;
use crate::ir::{Cause, Matrix, Name, Quantity, Symbol, Vector};

/// Number of rows of the base.
const OF_BASE: usize = Length::OF_BASE;

/// The ten elements of each link in each row.
type Rows<'s> = Vec<Vec<[Symbol<'s>; PER_LINK]>>;

/// The values that a joint gets from the link that carries it, at the joint's point and in the axes of that link: the
/// acceleration less gravity, and (u, v) of the rows of the joints that move the link.
#[derive(Clone)]
struct Carrier<'s> {
    acceleration: Vector<'s>,
    twists: Vec<(usize, [Vector<'s>; 2])>,
}

/// Returns Y by torque, link and parameter; an element is zero if the joint does not move the link.
pub(crate) fn regressor<'s>(arm: &Arm<'s>, states: &[JointState<'s>], motions: &[Motion<'s>]) -> Rows<'s> {
    let still = Carrier { acceleration: -arm.gravity, twists: Vec::new() };
    of_links(arm, states, motions, vec![still; states.len()])
}

/// Returns Y for a floating base: rows of force, moment and torques; the base comes first, then the links.
/// `acceleration` is that of the origin of frame 0, less gravity.
pub(crate) fn floating_regressor<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    motions: &[Motion<'s>],
    (base, acceleration): (&Motion<'s>, Vector<'s>),
) -> Rows<'s> {
    let (builder, line) = (arm.builder, arm.builder.joint(0));
    let [zero, one] = [0.0, 1.0].map(|x| builder.constant(x, Cause::JointAxis));
    let zeros = Vector([zero; 3]);
    let Turning { omega, omega_dot, .. } = base.turning;
    let gradient = line.within(Quantity::Gradient, || gradient(omega, omega_dot));
    let unit = |axis: usize| Vector([0, 1, 2].map(|other| if other == axis { one } else { zero }));
    let twist = |row: usize| if row < 3 { [zeros, unit(row)] } else { [unit(row - 3), zeros] };
    let twists: Vec<_> = (0..OF_BASE).map(|row| (row, twist(row))).collect();
    let carrier = |link: &Link<'s>| {
        if link.parent.is_some() {
            return Carrier { acceleration: zeros, twists: Vec::new() };
        }
        let lever = link.mount.lever;
        let acceleration = line.within(Quantity::JointPointAcceleration, || acceleration + gradient * lever);
        let at_joint = |[u, v]: [Vector<'s>; 2]| line.within(Quantity::Partial, || [u, v + u.cross(lever)]);
        Carrier { acceleration, twists: twists.iter().map(|(row, twist)| (*row, at_joint(*twist))).collect() }
    };
    let mut rows = of_links(arm, states, motions, arm.links.iter().map(carrier).collect());
    for (row, elements) in rows.iter_mut().enumerate() {
        let own = match twists.get(row) {
            Some((_, twist)) => {
                line.within(Quantity::Partial, || columns([omega, omega_dot, acceleration], gradient, *twist))
            }
            // a torque does not depend on the parameters of the base: no joint moves the base
            None => [zero; PER_LINK],
        };
        let named = |parameter: usize| builder.name(name_of_floating(row, 0, parameter), own[parameter]);
        elements.insert(0, from_fn(named));
    }
    rows
}

/// Returns the elements of the links; with a floating base, the rows of the base come before those of the joints.
/// `carriers` has an element for each joint; on entry those of joints on the base must be set, the others are computed.
fn of_links<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    motions: &[Motion<'s>],
    mut carriers: Vec<Carrier<'s>>,
) -> Rows<'s> {
    let (builder, dof) = (arm.builder, states.len());
    let floats = builder.function.is_of_floating_base();
    let of_base = if floats { OF_BASE } else { 0 };
    let mut rows = vec![vec![[builder.constant(0.0, Cause::Arithmetic); PER_LINK]; dof]; of_base + dof];
    let zeros = builder.zeros(Cause::JointAxis);
    // one element more for links at the end of the chain: it is written, but no joint reads it
    carriers.push(Carrier { acceleration: zeros, twists: Vec::new() });
    for (joint, motion) in arm.joints(states).zip(motions) {
        let (line, link) = (joint.lines, joint.link);
        let Turning { rotation, omega, omega_dot } = motion.turning;
        let back = rotation.transpose();
        let reach = line.within(Quantity::Partial, || joint.offset(link.offset));
        let gradient = line.within(Quantity::Gradient, || gradient(omega, omega_dot));
        let origin = line.within(Quantity::OriginAcceleration, || {
            joint.acceleration(back * carriers[joint.index].acceleration, omega) + gradient * reach
        });
        let mut mounted: Vec<(usize, Vector<'s>)> =
            arm.carried_joints(joint.index).map(|(index, link)| (index, link.mount.lever)).collect();
        if mounted.is_empty() {
            mounted.push((dof, arm.tip.lever));
        }
        for (index, lever) in &mounted {
            carriers[*index].acceleration =
                line.within(Quantity::JointPointAcceleration, || origin + gradient * *lever);
        }
        let mut twists = std::mem::take(&mut carriers[joint.index].twists);
        for (_, twist) in &mut twists {
            *twist = line.within(Quantity::Partial, || twist.map(|part| back * part));
        }
        twists.push(match link.kind {
            Revolute => (of_base + joint.index, [joint.e, zeros]),
            Prismatic => (of_base + joint.index, [zeros, joint.e]),
        });
        // from here on in the axes of the link frame
        let into = link.table_axes.transpose();
        let in_frame = line.within(Quantity::Partial, || [omega, omega_dot, origin].map(|v| into * v));
        let gradient_in_frame = line.within(Quantity::Gradient, || self::gradient(in_frame[0], in_frame[1]));
        for (row, [u, v]) in twists {
            let at_origin = line.within(Quantity::Partial, || v + u.cross(reach));
            let in_axes = line.within(Quantity::Partial, || [u, at_origin].map(|v| into * v));
            let elements = line.within(Quantity::Partial, || columns(in_frame, gradient_in_frame, in_axes));
            for (parameter, element) in elements.into_iter().enumerate() {
                let name = if floats {
                    name_of_floating(row, joint.index + 1, parameter)
                } else {
                    element_name(row, joint.index, parameter)
                };
                rows[row][joint.index][parameter] = builder.name(name, element);
            }
            for (index, lever) in &mounted {
                let at_joint = line.within(Quantity::Partial, || at_origin + u.cross(*lever));
                carriers[*index].twists.push((row, [u, at_joint]));
            }
        }
    }
    rows
}

/// Returns the name of an element of Y; joint, link and parameter are counted from 0.
pub(crate) fn element_name(joint: usize, link: usize, parameter: usize) -> Name {
    Name { indices: [link + 1, parameter + 1], ..Name::scalar(Quantity::RegressorElement, joint + 1) }
}

/// Returns the name of an element of Y with a floating base; the base is body 0 and has the first six rows.
pub(crate) fn name_of_floating(row: usize, body: usize, parameter: usize) -> Name {
    let name = match row.checked_sub(OF_BASE) {
        Some(joint) => Name::scalar(Quantity::RegressorElement, joint + 1),
        None => Name::of_base(Quantity::BaseForce, Quantity::BaseMoment, row),
    };
    // the names of the elements of the base have no body number
    let indices = if body == 0 { [parameter + 1, 0] } else { [body, parameter + 1] };
    Name { indices, ..name }
}

/// Returns U = [ω̇]× + [ω]×[ω]×.
fn gradient<'s>(omega: Vector<'s>, omega_dot: Vector<'s>) -> Matrix<'s> {
    let ([x, y, z], [dx, dy, dz]) = (omega.0, omega_dot.0);
    let (xx, yy, zz, xy, xz, yz) = (x * x, y * y, z * z, x * y, x * z, y * z);
    Matrix::from_rows([[-(yy + zz), xy - dz, xz + dy], [xy + dz, -(xx + zz), yz - dx], [xz - dy, yz + dx, -(xx + yy)]])
}

/// Returns the ten elements of Y for one joint and one link.
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
