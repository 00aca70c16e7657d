//! The generalized momentum of the joints, and its rate, which an observer of external torques needs.
//!
//! ```text
//! p = M(q) q̇                ṗ = τ + τ_ext + ∂T/∂q - ∂V/∂q           no acceleration in it; τ_ext is not known
//! ```
//!
//! The quantities of link i and all that it carries, taken as one body, in the axes of form P: mass M, first moment s
//! and angular momentum L about J_i, linear momentum P. p is the parent of i, k runs over the joints that link i
//! carries.
//!
//! ```text
//! M_i = m_i + Σ M_k
//! s_i = M_i d_i + Σ (M_k r_k + R_k s_k)
//! P_i = m_i ċ_i + Σ R_k P_k
//! L_i = I_i ω_i + Σ R_k L_k + d_i × P_i + Σ r_k × R_k P_k
//!                       revolute                          prismatic
//! p_i                   e · L_i                           e · P_i               with a rotor + G² Jm q̇_i
//! ∂T/∂q_i               (ω_i × e) · L_i + (j̇_i × e) · P_i (ω_i × e) · P_i
//! -∂V/∂q_i              e · (s_i × g_i)                   M_i e · g_i
//! ```
//!
//! A floating base is link 0, about the origin of frame 0: P_0 is the momentum of the robot, and the angular
//! momentum about the centre of mass c = s_0 / M_0 is L_0 - c × P_0.
//!
//! ∂T/∂q_i is (V_i × S_i) · h_i: q_i changes T only because it turns the velocity that comes from the parent. j̇_i =
//! R_iᵀ (ċ_p + ω_p × r_i) is the velocity of the joint's point. A first moment h in addition to the mass adds h_i to
//! s_i, ω_i × h_i to P_i and h_i × ċ_i to L_i. A rotor of the list `motors` adds Jm s a to L of its carrier c, and n
//! (Jm s + Jm a · ω_c) to p of each joint with which it turns.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::formulate::carried::plus_sum;
use crate::formulate::floating::centroid;
use crate::formulate::{Arm, AtTip, Body, Joint, JointState, Motion, Outputs, Payload};
use crate::ir::{Cause, JointLines, Quantity, Symbol, Vector};

/// A link and all links after it as one body, about the link's joint, in the axes of the link or of its parent.
#[derive(Clone, Copy)]
struct Carried<'s> {
    mass: Symbol<'s>,
    first_moment: Vector<'s>,
    linear: Vector<'s>,
    angular: Vector<'s>,
    /// Vector from the parent's centre of mass to the joint, in the axes of the parent.
    r: Vector<'s>,
}

/// Returns p and τ + ∂T/∂q - ∂V/∂q of every joint. A payload is one more body, which the last link carries. `motions`
/// are those of an arm on a fixed base.
pub(crate) fn momentum_and_rate<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    motions: &[Motion<'s>],
    base: &Motion<'s>,
    tip: &AtTip<'s>,
) -> [Vec<Symbol<'s>>; 2] {
    let mut carried: Vec<Vec<Carried<'s>>> = vec![Vec::new(); motions.len()];
    if let (AtTip::Payload(payload), Some(link), Some(motion)) = (tip, arm.tip_link, arm.at_tip(motions)) {
        carried[link].push(of_payload(arm, payload, link, motion));
    }
    let spins: Vec<_> =
        arm.spins.iter().map(|spin| (spin, spin.of_joints(Quantity::Spin, states, |state| state.qd))).collect();
    let (mut momenta, mut rates) = (Vec::with_capacity(motions.len()), Vec::with_capacity(motions.len()));
    for (joint, motion) in arm.joints(states).zip(motions).rev() {
        let Joint { lines: line, link, .. } = joint;
        let on_link = spins.iter().filter(|(spin, _)| spin.on == Some(joint.index));
        let of_spins: Vec<_> = on_link.map(|(spin, rate)| spin.momentum(*rate)).collect();
        let body = body(line, (&link.body, link.mount.r), motion, &of_spins, &carried[joint.index]);
        let parent = link.parent.map_or(base, |parent| &motions[parent]);

        let momentum = line.define(Quantity::Momentum).by({
            let momentum = match link.kind {
                Revolute => body.angular.z(),
                Prismatic => body.linear.z(),
            };
            let momentum = link.rotor.map_or(momentum, |rotor| momentum + rotor * joint.state.qd);
            let resistances = spins.iter().filter_map(|(spin, rate)| {
                let carrier = spin.on.map_or(base, |link| &motions[link]);
                spin.resistance(joint.index, *rate, carrier.turning.omega)
            });
            resistances.fold(momentum, |momentum, resistance| momentum + resistance)
        });
        let rate = line.define(Quantity::MomentumRate).by({
            let applied = arm.coordinates.applied(line.builder, joint.index);
            applied + of_motion(&joint, &body, motion, parent) + of_gravity(&joint, &body, motion)
        });
        momenta.push(momentum);
        rates.push(rate);
        if let Some(parent) = link.parent {
            carried[parent].push(body.turned(line.named(parent + 1).with_second_number(link.mount.label), motion));
        }
    }
    momenta.reverse();
    rates.reverse();
    [momenta, rates]
}

/// Returns the linear momentum of a robot with a floating base, and its angular momentum about the centre of mass.
pub(crate) fn centroidal_momentum<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    motions: &[Motion<'s>],
    base: &Motion<'s>,
) -> Outputs<'s> {
    let builder = arm.builder;
    let of_spins = |carrier: Option<usize>| -> Vec<_> {
        let spins = arm.spins.iter().filter(|spin| spin.on == carrier);
        spins.map(|spin| spin.momentum(spin.of_joints(Quantity::Spin, states, |state| state.qd))).collect()
    };
    let mut carried: Vec<Vec<Carried<'s>>> = vec![Vec::new(); motions.len()];
    let mut on_base = Vec::new();
    for (joint, motion) in arm.joints(states).zip(motions).rev() {
        let (line, link) = (joint.lines, joint.link);
        let matter = (&link.body, link.mount.r);
        let body = body(line, matter, motion, &of_spins(Some(joint.index)), &carried[joint.index]);
        let (number, place) = match link.parent {
            Some(parent) => (parent + 1, &mut carried[parent]),
            None => (0, &mut on_base),
        };
        place.push(body.turned(line.named(number).with_second_number(link.mount.label), motion));
    }
    let Some(matter) = &arm.floating_base else { return Vec::new() };
    let nowhere = builder.zeros(Cause::FirstFrame);
    let whole = body(builder.joint(0), (matter, nowhere), base, &of_spins(None), &on_base);
    let centre = (whole.mass, whole.first_moment);
    centroid::about_centre(builder, centre, Quantity::LinearMomentum, [whole.linear, whole.angular])
}

impl<'s> Carried<'s> {
    /// Turns the vectors into the axes of the parent; `line` is that of the parent.
    fn turned(self, line: JointLines<'s>, motion: &Motion<'s>) -> Self {
        let turned = |quantity, vector| line.define(quantity).by(motion.turning.rotation * vector);
        Self {
            first_moment: turned(Quantity::TurnedMomentBehind, self.first_moment),
            linear: turned(Quantity::TurnedLinearMomentum, self.linear),
            angular: turned(Quantity::TurnedAngularMomentum, self.angular),
            ..self
        }
    }
}

/// Returns the payload as a body that the link of the tip carries.
fn of_payload<'s>(arm: &Arm<'s>, payload: &Payload<'s>, link: usize, motion: &Motion<'s>) -> Carried<'s> {
    let (dof, rotation) = (arm.links.len(), arm.tip.rotation);
    let [linear, angular] = payload.momenta(arm, motion);
    let moment = arm.builder.joint(dof + 1).define(Quantity::MomentBehind).by(payload.com * payload.mass);
    let line = arm.builder.joint(link + 1).with_second_number(arm.tip.label);
    let turned = |quantity, vector| line.define(quantity).by(rotation * vector);
    Carried {
        mass: payload.mass,
        first_moment: turned(Quantity::TurnedMomentBehind, moment),
        linear: turned(Quantity::TurnedLinearMomentum, linear),
        angular: turned(Quantity::TurnedAngularMomentum, angular),
        r: arm.tip.r,
    }
}

/// Returns link i and all that it carries as one body. `r` is the vector from the parent's centre of mass to the joint.
fn body<'s>(
    line: JointLines<'s>,
    (link, r): (&Body<'s>, Vector<'s>),
    motion: &Motion<'s>,
    of_spins: &[Vector<'s>],
    carries: &[Carried<'s>],
) -> Carried<'s> {
    let Motion { d, c_dot, .. } = *motion;
    let omega = motion.turning.omega;
    let mass = line.within(Quantity::MomentBehind, || {
        carries.iter().map(|k| k.mass).reduce(|sum, mass| sum + mass).map_or(link.mass, |sum| link.mass + sum)
    });
    let all = |of: fn(&Carried<'s>) -> Vector<'s>| carries.iter().map(of);
    let first_moment = line.define(Quantity::MomentBehind).by({
        let own = d * mass;
        let own = link.first_moment.map_or(own, |h| own + h);
        plus_sum(plus_sum(own, all(|k| k.r * k.mass)), all(|k| k.first_moment))
    });
    let linear = line.define(Quantity::LinearMomentum).by({
        let own = c_dot * link.mass;
        let own = link.first_moment.map_or(own, |h| own + omega.cross(h));
        plus_sum(own, all(|k| k.linear))
    });
    let angular = line.define(Quantity::AngularMomentumBehind).by({
        let own = link.inertia * omega;
        let own = link.first_moment.map_or(own, |h| own + h.cross(c_dot));
        let own = of_spins.iter().fold(own, |own, momentum| own + *momentum);
        plus_sum(plus_sum(own, all(|k| k.angular)) + d.cross(linear), all(|k| k.r.cross(k.linear)))
    });
    Carried { mass, first_moment, linear, angular, r }
}

/// Returns ∂T/∂q_i.
fn of_motion<'s>(joint: &Joint<'_, 's>, body: &Carried<'s>, motion: &Motion<'s>, parent: &Motion<'s>) -> Symbol<'s> {
    let turning = motion.turning.omega.cross(joint.e);
    match joint.link.kind {
        Revolute => {
            let point = parent.c_dot + parent.turning.omega.cross(joint.link.mount.r);
            let point = motion.turning.rotation.transpose() * point;
            turning.dot(body.angular) + point.cross(joint.e).dot(body.linear)
        }
        Prismatic => turning.dot(body.linear),
    }
}

/// Returns -∂V/∂q_i.
fn of_gravity<'s>(joint: &Joint<'_, 's>, body: &Carried<'s>, motion: &Motion<'s>) -> Symbol<'s> {
    match joint.link.kind {
        Revolute => body.first_moment.cross(motion.gravity).z(),
        Prismatic => motion.gravity.z() * body.mass,
    }
}
