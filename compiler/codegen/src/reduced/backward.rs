//! The inward pass of the Newton-Euler recursion, tip to base: forces, moments and torques (the reduced form, sections
//! 3 and 5).
//!
//! ```text
//! F = m a + U h        N = antisym(U S) + h × a
//! f_i = F_i + R_{i+1} f_{i+1}        n_i = N_i + R_{i+1} n_{i+1} + p_{i+1} × R_{i+1} f_{i+1}
//! τ_i = z · n_i (revolute), z · f_i (prismatic)
//! ```

use rne_model::JointKind::{Prismatic, Revolute};

use crate::ir::{Axis, Builder, Name, Number, Quantity, Symbol, Vector};
use crate::reduced::forward::{motion_of_base, motions, plus};
use crate::reduced::gyrostats::{of_other_joints, resistance};
use crate::reduced::inward::full;
use crate::reduced::joint_frames::Tip;
use crate::reduced::regrouping::is_parallel;
use crate::reduced::siblings::gathered;
use crate::reduced::{
    Arm, Gradient, JointFrame, JointPlan, Load, Moment, Motion, Moved, PseudoInertia, ScaledTwist, Side, SymbolicTurn,
    Wrench,
};

/// The wrench that a link exerts on its parent.
#[derive(Clone, Copy)]
pub(crate) struct Child<'s> {
    /// The link that exerts the wrench.
    of: usize,
    wrench: Wrench<'s>,
    /// Whether the wrench is in frame N of a group of parallel axes; otherwise it is in the axes of the parent.
    unturned: bool,
    /// Vector from the origin of the parent's frame to the point about which the moment is.
    arm: [Number; 3],
}

/// Returns the torques, base to tip; the last link may carry a payload.
pub(crate) fn torques<'s>(arm: &Arm<'_, 's>, moved: &[Moved<'s>], payload: Option<Load<'s>>) -> Vec<Symbol<'s>> {
    inward(arm, moved, payload).0.into_iter().map(|carried| carried.torque).collect()
}

/// Returns the wrench that must act on a floating base, about the origin of frame 0, and the torques, base to tip.
pub(crate) fn torques_of_floating_base<'s>(arm: &Arm<'_, 's>) -> (Wrench<'s>, Vec<Symbol<'s>>) {
    let builder = arm.builder;
    let (carried, children) = inward(arm, &motions(arm), arm.load(false));
    let (motion, matter) = (motion_of_base(arm), &arm.parameters.base);
    let scale = |scales: &[Number]| scales.first().copied().unwrap_or(Number::ONE);
    let (lambda, mu) = (scale(&arm.parameters.lambda), scale(&arm.parameters.mu));
    builder.at(Quantity::BaseForce, 0);
    name_matter(builder, 0, matter);
    let mut wrench = first_moment(builder, matter, (lambda, mu), &motion, builder.vector(matter.h));
    wrench.moment = wrench.moment + second_moment(builder, matter, &motion, arm.plan.base_moment);
    let gyrostats = arm.joint_frames.base.iter().flat_map(|base| &base.gyrostats);
    let wrench = gyrostats.fold(wrench, |wrench, gyrostat| {
        let moment = wrench.moment + gyrostat.moment(arm, motion.omega);
        Wrench { moment, ..wrench }
    });
    let wrench = wrench.plus(gathered(builder, children.iter().map(|child| (child.wrench, child.arm)).collect()));
    let per_force = mu.inverse().unwrap_or(Number::ONE);
    (Wrench { force: wrench.force.times(per_force), ..wrench }, carried.into_iter().map(|it| it.torque).collect())
}

/// A joint's torque, and the wrench there: that on the link and all that it carries, about the origin of the link's
/// frame. The wrench is the sum of two parts, one in the link's frame and one in frame N; both are zero for a spinning
/// sphere.
pub(crate) struct Carried<'s> {
    pub(crate) torque: Symbol<'s>,
    pub(crate) own: Wrench<'s>,
    pub(crate) unturned: Wrench<'s>,
}

/// The inward pass: returns the torques and wrenches, base to tip, and the wrenches that the joints on the base exert
/// on it.
pub(crate) fn inward<'s>(
    arm: &Arm<'_, 's>,
    moved: &[Moved<'s>],
    payload: Option<Load<'s>>,
) -> (Vec<Carried<'s>>, Vec<Child<'s>>) {
    let (builder, rows) = (arm.builder, arm.rows());
    let tips = tip_wrenches(arm, |link| arm.parameters.mu[link]);
    let mut found = Vec::with_capacity(rows.len());
    let mut children: Vec<Child<'s>> = Vec::new();
    for index in (0..rows.len()).rev() {
        let link = &moved[index];
        builder.at(Quantity::ReducedForce, index + 1);
        let carries_tip = index == arm.joint_frames.tip().on;
        let at_tips = tips.iter().filter(|(on, _)| *on == index).map(|(_, wrench)| *wrench);
        let tip = at_tips.reduce(Wrench::plus);
        let nothing = Wrench::zero(builder);
        let ((torque, next), own, unturned) = if arm.is_spin(index) {
            (spin(arm, index, link, tip), nothing, nothing)
        } else {
            let payload = payload.filter(|_| carries_tip);
            let (own, unturned) = own_wrench(arm, index, link, payload);
            let own = tip.map_or(own, |tip| own.plus(tip));
            let own = rows[index]
                .gyrostats
                .iter()
                .fold(own, |own, gyrostat| Wrench { moment: own.moment + gyrostat.moment(arm, link.own.omega), ..own });
            let carried = children.iter().filter(|child| rows[child.of].parent == Some(index)).copied();
            let (own, unturned) = together(builder, carried.collect())
                .into_iter()
                .fold((own, unturned), |(own, unturned), child| with_child(arm, index, link, child, own, unturned));
            match rows[index].kind {
                Prismatic => {
                    let own = own.plus(unturned);
                    (origin_shift(arm, index, link, own), own, nothing)
                }
                Revolute => (turn(arm, index, link, own, unturned), own, unturned),
            }
        };
        builder.at(Quantity::Torque, index + 1);
        let torque = torque + arm.rate_dot(index).times(arm.joint_frames.rotors[index]);
        let of_rotors = resistance(arm, index, |link| match link {
            Some(link) => moved[link].own.omega_dot,
            None => motion_of_base(arm).omega_dot,
        });
        let more = [of_other_joints(arm, index), of_rotors].into_iter().flatten();
        let torque = more.fold(torque, |torque, more| torque + more);
        let torque = if rows[index].reversed { -torque } else { torque };
        builder.name(arm.joint_frames.coordinates.name_of_torque(index), torque);
        found.push(Carried { torque, own, unturned });
        children.extend(next);
    }
    found.reverse();
    children.retain(|child| rows[child.of].parent.is_none());
    (found, children)
}

/// Returns the wrench that the link of each tip exerts there, about the origin of the link's frame and in its axes,
/// with the index of the link. Forces are multiplied by the scale of the link.
pub(crate) fn tip_wrenches<'s>(arm: &Arm<'_, 's>, scale: impl Fn(usize) -> Number) -> Vec<(usize, Wrench<'s>)> {
    let builder = arm.builder;
    let at_origin = |(tip, [force, moment]): (&Tip, [Vector<'s>; 2])| {
        let turned = |v: Vector<'s>| Vector([0, 1, 2].map(|row| builder.vector(tip.rotation[row]).dot(v)));
        let origin_shift = arm.parameters.origin_shifts[tip.on];
        let [x, y, z] = tip.translation;
        let wrench =
            Wrench { force: turned(force), moment: turned(moment) }.about(builder.vector([x, y, z - origin_shift]));
        (tip.on, Wrench { force: wrench.force.times(scale(tip.on)), ..wrench })
    };
    arm.wrenches().into_iter().map(at_origin).collect()
}

/// Returns the torque and the wrench of a last link that is a sphere without mass: only its spin about the joint's axis
/// acts, and q is not needed (section 5.6).
fn spin<'s>(
    arm: &Arm<'_, 's>,
    index: usize,
    link: &Moved<'s>,
    tip: Option<Wrench<'s>>,
) -> (Symbol<'s>, Option<Child<'s>>) {
    let (builder, rows) = (arm.builder, arm.rows());
    let c = arm.parameters.sphere.unwrap_or_default();
    let (momentum, rate_dot) = (arm.rate(index).times(c), arm.rate_dot(index).times(c));
    let ([wx, wy, _], [_, _, dz]) = (link.own.omega.0, link.own.omega_dot.0);
    let torque = dz.times(c) + rate_dot;
    let (offset, d) = arm.lengths(index, length_inward(arm, index));
    let spin = Wrench {
        force: builder.no_vector(),
        moment: link.twist.of(Vector([wy * momentum, -(wx * momentum), rate_dot])),
    };
    let Some(tip) = tip else {
        return (torque, Some(Child { of: index, wrench: spin, unturned: false, arm: [Number::ZERO; 3] }));
    };
    let torque = torque + tip.moment.0[2];
    let back = tip.map(|v| link.twist.of(link.turn.about_z(v)));
    let arm = plus(offset, rows[index].along_axis(d));
    (torque, Some(Child { of: index, wrench: back.plus(spin), unturned: false, arm }))
}

/// Returns 1/μ, the factor of lengths in the inward pass.
fn length_inward(arm: &Arm<'_, '_>, index: usize) -> Number {
    arm.parameters.mu[index].inverse().unwrap_or(Number::ONE)
}

/// Returns F and N of the link itself: the part in its frame, and the part in frame N (not turned by the joint).
fn own_wrench<'s>(
    arm: &Arm<'_, 's>,
    index: usize,
    link: &Moved<'s>,
    payload: Option<Load<'s>>,
) -> (Wrench<'s>, Wrench<'s>) {
    let builder = arm.builder;
    let JointPlan { moment, switches: on, .. } = arm.plan.joints[index];
    let matter = &arm.parameters.links[index];
    let is_revolute = arm.rows()[index].kind != Prismatic;
    name_matter(builder, index + 1, matter);
    let (mut own, mut unturned) = (Wrench::zero(builder), Wrench::zero(builder));
    let h = builder.vector(matter.h);
    let scales = (arm.parameters.lambda[index], arm.parameters.mu[index]);
    if on.first_moment_unturned && is_revolute {
        unturned = first_moment(builder, matter, scales, &link.unturned, link.group_turn.about_z(h));
    } else {
        own = first_moment(builder, matter, scales, &link.own, h);
    }
    if let Some(load) = payload {
        // second moments of link and payload together
        let to_unturned = load.unturned && is_revolute;
        let both = load.with_link(arm, link, matter, to_unturned);
        if to_unturned { unturned = unturned.plus(both) } else { own = own.plus(both) }
    } else if on.second_moment_unturned && is_revolute {
        let s = turned_second_moment(builder, matter, link.group_turn);
        unturned.moment = unturned.moment + antisymmetric_of(&link.unturned.gradient, &s);
    } else {
        own.moment = own.moment + second_moment(builder, matter, &link.own, moment);
    }
    (own, unturned)
}

/// Returns the force F = m a + U h and the moment h × a.
fn first_moment<'s>(
    builder: &'s Builder,
    matter: &PseudoInertia,
    (lambda, mu): (Number, Number),
    motion: &Motion<'s>,
    h: Vector<'s>,
) -> Wrench<'s> {
    let per_length = lambda.inverse().unwrap_or(Number::ONE);
    let mass = builder.number(matter.mass * mu * per_length);
    Wrench {
        force: motion.acceleration * mass + motion.gradient.of(h.times(mu)),
        moment: h.times(per_length).cross(motion.acceleration),
    }
}

/// Returns the moment antisym(U S) in one of three equal forms (section 3.3).
fn second_moment<'s>(builder: &'s Builder, matter: &PseudoInertia, motion: &Motion<'s>, form: Moment) -> Vector<'s> {
    let s = matter.s;
    match form {
        Moment::Second => antisymmetric_of(&motion.gradient, &s.map(|row| row.map(|x| builder.number(x)))),
        Moment::Diagonal => {
            let ([x, y, z], [dx, dy, dz]) = (motion.omega.0, motion.omega_dot.0);
            let diagonal = |rate_dot: Symbol<'s>, product: Symbol<'s>, a: Number, b: Number| {
                rate_dot.times(a + b) + product.times(a - b)
            };
            let u = &motion.gradient.u;
            let [zy, xz, yx] = motion.gradient.differences;
            let [s12, s13, s23] = [s[0][1], s[0][2], s[1][2]];
            Vector([
                u[2][0].times(s12) - u[1][0].times(s13) + diagonal(dx, y * z, s[1][1], s[2][2]) + zy.times(s23),
                u[0][1].times(s23) - u[2][1].times(s12) + diagonal(dy, x * z, s[2][2], s[0][0]) + xz.times(s13),
                u[1][2].times(s13) - u[0][2].times(s23) + diagonal(dz, x * y, s[0][0], s[1][1]) + yx.times(s12),
            ])
        }
        Moment::Inertia => {
            // the inertia J = tr(S) 1 - S, from the second moments S
            let trace = s[0][0] + s[1][1] + s[2][2];
            let j = [0, 1, 2]
                .map(|row| builder.vector([0, 1, 2].map(|k| if row == k { trace - s[row][k] } else { -s[row][k] })));
            let apply = |v: Vector<'s>| Vector(j.map(|row| row.dot(v)));
            apply(motion.omega_dot) + motion.omega.cross(apply(motion.omega))
        }
    }
}

/// Returns antisym(U S): N_x = U31 S12 + U32 S22 - U23 S33 - U21 S13 + (U33 - U22) S23, and N_y, N_z by cyclic
/// permutation.
pub(crate) fn antisymmetric_of<'s>(gradient: &Gradient<'s>, s: &[[Symbol<'s>; 3]; 3]) -> Vector<'s> {
    let u = &gradient.u;
    let [zy, xz, yx] = gradient.differences;
    Vector([
        u[2][0] * s[0][1] + u[2][1] * s[1][1] - u[1][2] * s[2][2] - u[1][0] * s[0][2] + zy * s[1][2],
        u[0][2] * s[2][2] - u[2][0] * s[0][0] + u[0][1] * s[1][2] - u[2][1] * s[0][1] + xz * s[0][2],
        u[1][0] * s[0][0] - u[0][1] * s[1][1] + u[1][2] * s[0][2] - u[0][2] * s[1][2] + yx * s[0][1],
    ])
}

/// Returns Rz S Rzᵀ (section 5.7).
fn turned_second_moment<'s>(
    builder: &'s Builder,
    matter: &PseudoInertia,
    turn: SymbolicTurn<'s>,
) -> [[Symbol<'s>; 3]; 3] {
    let SymbolicTurn { s: sine, c: cosine } = turn;
    let [xx, yy, zz, xy, xz, yz] = matter.second_moments();
    let number = |x| builder.number(x);
    let (difference, twice) = (xx - yy, xy + xy);
    let (both, square) = (cosine * sine, cosine * cosine);
    let u = square.times(difference) - both.times(twice);
    let turned_xy = both.times(difference) + (square.times(twice) - number(xy));
    let turned_xz = cosine.times(xz) - sine.times(yz);
    let turned_yz = sine.times(xz) + cosine.times(yz);
    full([u + number(yy), number(xx) - u, number(zz), turned_xy, turned_xz, turned_yz])
}

/// Combines the wrenches that several links exert on one parent, in the axes of the parent, to one wrench.
fn together<'s>(builder: &'s Builder, carried: Vec<Child<'s>>) -> Vec<Child<'s>> {
    let (mut unturned, own): (Vec<_>, Vec<_>) = carried.into_iter().partition(|child| child.unturned);
    if own.len() < 2 {
        return own.into_iter().chain(unturned).collect();
    }
    let wrench = gathered(builder, own.iter().map(|child| (child.wrench, child.arm)).collect());
    unturned.push(Child { wrench, arm: [Number::ZERO; 3], ..own[0] });
    unturned
}

/// Adds the wrench of a child link to the two parts of a link's wrench.
fn with_child<'s>(
    arm: &Arm<'_, 's>,
    index: usize,
    link: &Moved<'s>,
    child: Child<'s>,
    own: Wrench<'s>,
    unturned: Wrench<'s>,
) -> (Wrench<'s>, Wrench<'s>) {
    let p = arm.builder.vector(child.arm);
    let Wrench { force, moment } = child.wrench;
    let to_unturned = arm.plan.joints[index].switches.wrench_unturned && arm.rows()[index].kind != Prismatic;
    match (child.unturned, to_unturned) {
        (false, false) => (own.plus(child.wrench.about(p)), unturned),
        (false, true) => {
            let force = link.group_turn.about_z(force);
            let moved = Wrench { force, moment: link.group_turn.about_z(p).cross(force) };
            (Wrench { moment: own.moment + moment, ..own }, unturned.plus(moved))
        }
        (true, true) => (own, unturned.plus(child.wrench.about(link.group_turn.about_z(p)))),
        (true, false) => {
            let turned = link.group_turn.back_about_z(force);
            (Wrench { moment: own.moment + p.cross(turned), ..own }, unturned.plus(child.wrench))
        }
    }
}

/// Returns the torque of a revolute joint, and the wrench that its link exerts on the parent.
fn turn<'s>(
    arm: &Arm<'_, 's>,
    index: usize,
    link: &Moved<'s>,
    own: Wrench<'s>,
    unturned: Wrench<'s>,
) -> (Symbol<'s>, Option<Child<'s>>) {
    let builder = arm.builder;
    let (rows, joint) = (arm.rows(), index + 1);
    let row = &rows[index];
    let JointPlan { inward_offset, switches: on, .. } = arm.plan.joints[index];
    let (offset, d) = arm.lengths(index, length_inward(arm, index));
    let parallel = is_parallel(rows, index);
    builder.name_vector(Quantity::ReducedForce, joint, own.force);
    builder.name_vector(Quantity::ReducedMoment, joint, own.moment);
    let torque = own.moment.0[2] + unturned.moment.0[2];
    if arm.joint_frames.carrier(index).is_none() {
        return (torque, None);
    }
    let in_unturned = !unturned.is_zero() || (parallel && on.group_wrench);
    let mut wrench = if in_unturned { own.map(|v| link.group_turn.about_z(v)).plus(unturned) } else { own };
    let mut p = offset;
    if inward_offset == Side::Parent {
        p = plus(p, row.along_axis(d));
    } else {
        // d z × f; the axis z is the same vector in the link's frame and in N
        let [fx, fy, _] = wrench.force.0;
        let [nx, ny, nz] = wrench.moment.0;
        wrench.moment = Vector([nx - fy.times(d), ny + fx.times(d), nz]);
    }
    let (wrench, unturned) = if in_unturned && parallel {
        (wrench, true)
    } else if in_unturned {
        (wrench.map(|v| link.twist.of(v)), false)
    } else if parallel {
        (wrench.map(|v| link.turn.about_z(v)), false)
    } else {
        (wrench.map(|v| rotated_inward(row, link, on.scaled_twist_inward, v)), false)
    };
    name_turned(arm, index, wrench);
    (torque, Some(Child { of: index, wrench, unturned, arm: p }))
}

/// Returns the force of a prismatic joint, and the wrench that its link exerts on the parent.
fn origin_shift<'s>(
    arm: &Arm<'_, 's>,
    index: usize,
    link: &Moved<'s>,
    wrench: Wrench<'s>,
) -> (Symbol<'s>, Option<Child<'s>>) {
    let builder = arm.builder;
    let (rows, joint) = (arm.rows(), index + 1);
    let row = &rows[index];
    let per_force = length_inward(arm, index);
    let (offset, d) = arm.lengths(index, per_force);
    builder.name_vector(Quantity::ReducedForce, joint, wrench.force);
    builder.name_vector(Quantity::ReducedMoment, joint, wrench.moment);
    let q = arm.position(index).times(per_force) + builder.number(d);
    let u = builder.vector(row.axis);
    let torque = u.dot(wrench.force).times(per_force);
    if row.carried {
        let wrench = wrench.about(builder.vector(offset) + u * q);
        return (torque, Some(Child { of: index, wrench, unturned: false, arm: [Number::ZERO; 3] }));
    }
    let back = wrench.about(u * q).map(|v| link.twist.of(link.turn.about_z(v)));
    name_turned(arm, index, back);
    (torque, Some(Child { of: index, wrench: back, unturned: false, arm: offset }))
}

/// Names the wrench that a link exerts, in the axes of its parent. For the first joint on the parent the names have no
/// number of a joint.
fn name_turned<'s>(arm: &Arm<'_, 's>, index: usize, wrench: Wrench<'s>) {
    let rows = arm.rows();
    let parent = rows[index].parent;
    let is_first = rows[..index].iter().all(|row| row.parent != parent);
    let line = arm.builder.joint(parent.map_or(0, |parent| parent + 1)).with_second_number(if is_first {
        0
    } else {
        index + 1
    });
    line.name_vector(Quantity::TurnedForce, wrench.force);
    line.name_vector(Quantity::TurnedMoment, wrench.moment);
}

/// Returns Rz(γ) Rx(α) Rz(θ) v; if the twist is no right angle, this can take seven products instead of eight (section
/// 5.1).
fn rotated_inward<'s>(row: &JointFrame, link: &Moved<'s>, scaled: bool, v: Vector<'s>) -> Vector<'s> {
    let SymbolicTurn { s, c } = link.turn;
    let (true, Some(ScaledTwist { ratio, larger, on_sine })) = (scaled, ScaledTwist::new(row)) else {
        return link.twist.of(link.turn.about_z(v));
    };
    let [x, y, z] = v.0;
    let u = s.times(larger) * x + c.times(larger) * y;
    let (sine, cosine) = (z * link.twist.alpha.s, z * link.twist.alpha.c);
    link.twist.about_parent(if on_sine {
        Vector([c * x - s * y, u.times(ratio) - sine, u + cosine])
    } else {
        Vector([c * x - s * y, u - sine, u.times(ratio) + cosine])
    })
}

fn name_matter(builder: &Builder, joint: usize, matter: &PseudoInertia) {
    if !builder.is_traced() {
        return;
    }
    builder.name(Name::scalar(Quantity::Mass, joint), builder.number(matter.mass));
    builder.name_vector(Quantity::FirstMoment, joint, builder.vector(matter.h));
    for (row, values) in Axis::ALL.into_iter().zip(matter.s) {
        for (column, s) in Axis::ALL.into_iter().zip(values).filter(|(column, _)| *column >= row) {
            builder.name(Name::matrix(Quantity::SecondMoment, joint, row, column), builder.number(s));
        }
    }
}
