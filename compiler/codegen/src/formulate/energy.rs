//! Kinetic energy from steps 1 and 3, potential energy from the positions of the centres of mass.
//!
//! T = ½ Σ (m_i ċ_i · ċ_i + ω_i · I_i ω_i); rotors of joints add ½ Σ G² Jm q̇² to it, those of the list `motors` ½ Σ Jm
//! s (s + 2 a · ω). V = -Σ m_i g · c_i, with c_i from the origin of frame 0. A first moment h that a link has in
//! addition to its mass adds ċ_i · (ω_i × h_i) to T, and - g · R_i h_i to V.
//!
//! A floating base is link 0. If its frame 0 has the origin p and the rotation R in the world:
//! V = - Σ m_i (Rᵀ g · c_i + g · p).

use crate::formulate::derivation::Derivation;
use crate::formulate::{Arm, Frame, Frames, JointState, Motion, Outputs, pose_of_base};
use crate::ir::{Cause, Name, Quantity, Symbol, Vector};

impl<'s> Derivation<'s, '_> {
    pub(super) fn kinetic_energy(&self) -> Outputs<'s> {
        let base = self.builder.function.is_of_floating_base().then_some(&self.base);
        let energy = kinetic(&self.arm, &self.states, (base, &self.motions()));
        vec![(Name::scalar(Quantity::Kinetic, 0), energy)]
    }

    pub(super) fn potential_energy(&self) -> Outputs<'s> {
        let pose = self.is_floating().then(|| pose_of_base(self.builder));
        let (frames, centres) = (self.frames_in_frame_0(), self.centres());
        let energy = match &pose {
            Some(pose) => floating_potential(&self.arm, pose, &frames, &centres),
            None => potential(&self.arm, &frames, &centres),
        };
        vec![(Name::scalar(Quantity::Potential, 0), energy)]
    }
}

/// Returns the kinetic energy of the links, plus that of a floating `base`, if there is one.
fn kinetic<'s>(
    arm: &Arm<'s>,
    states: &[JointState<'s>],
    (base, motions): (Option<&Motion<'s>>, &[Motion<'s>]),
) -> Symbol<'s> {
    let builder = arm.builder;
    let of_base = base.zip(arm.floating_base.as_ref()).map(|(motion, body)| {
        builder.joint(0).within(Quantity::Kinetic, || {
            let momentum = body.inertia * motion.turning.omega;
            motion.c_dot.dot(motion.c_dot) * body.mass + motion.turning.omega.dot(momentum)
        })
    });
    let mut twice = of_base.unwrap_or_else(|| builder.constant(0.0, Cause::Arithmetic));
    for (index, (link, motion)) in arm.links.iter().zip(motions).enumerate() {
        let omega = motion.turning.omega;
        twice = builder.joint(index + 1).within(Quantity::Kinetic, || {
            let momentum = link.body.inertia * omega;
            let of_link = motion.c_dot.dot(motion.c_dot) * link.body.mass + omega.dot(momentum);
            let twice = twice + of_link;
            link.body.first_moment.map_or(twice, |h| {
                let half = motion.c_dot.dot(omega.cross(h));
                twice + (half + half)
            })
        });
    }
    for (index, (link, state)) in arm.links.iter().zip(states).enumerate() {
        if let Some(rotor) = link.rotor {
            twice = builder.joint(index + 1).within(Quantity::Kinetic, || twice + rotor * (state.qd * state.qd));
        }
    }
    for spin in &arm.spins {
        let rate = spin.of_joints(Quantity::Spin, states, |state| state.qd);
        let carrier = spin.on.map_or(base, |link| Some(&motions[link]));
        let omega = carrier.map(|motion| motion.turning.omega);
        let line = builder.joint(spin.on.map_or(1, |link| link + 1));
        twice = line.within(Quantity::Kinetic, || twice + spin.twice_energy(rate, omega));
    }
    let half = builder.entry(Name::scalar(Quantity::Half, 0), 0.5);
    let energy = builder.joint(motions.len()).within(Quantity::Kinetic, || twice * half);
    builder.name(Name::scalar(Quantity::Kinetic, 0), energy)
}

/// Returns the potential energy of a robot on a fixed base; `frames` and gravity are in frame 0.
fn potential<'s>(arm: &Arm<'s>, frames: &Frames<'s>, centres: &[Vector<'s>]) -> Symbol<'s> {
    let lost = lost(arm, arm.gravity, frames, centres);
    arm.builder.name(Name::scalar(Quantity::Potential, 0), -lost)
}

/// Returns the potential energy for a floating base with the given `pose` in the world; gravity is in world axes,
/// `frames` are in frame 0.
fn floating_potential<'s>(arm: &Arm<'s>, pose: &Frame<'s>, frames: &Frames<'s>, centres: &[Vector<'s>]) -> Symbol<'s> {
    let line = arm.builder.joint(0);
    let gravity = line.within(Quantity::Potential, || pose.rotation.transpose() * arm.gravity);
    let lost = lost(arm, gravity, frames, centres);
    let energy = line.within(Quantity::Potential, || {
        let of_base = arm.floating_base.as_ref().map(|base| base.mass);
        let masses = of_base.into_iter().chain(arm.links.iter().map(|link| link.body.mass));
        let mass = masses.reduce(|sum, mass| sum + mass).unwrap_or_else(|| arm.builder.zero());
        -(lost + arm.gravity.dot(pose.origin) * mass)
    });
    arm.builder.name(Name::scalar(Quantity::Potential, 0), energy)
}

/// Returns Σ m g · c, the negative of the potential energy, in frame 0.
fn lost<'s>(arm: &Arm<'s>, gravity: Vector<'s>, frames: &Frames<'s>, centres: &[Vector<'s>]) -> Symbol<'s> {
    let builder = arm.builder;
    let of_base = arm.floating_base.as_ref().map(|base| gravity.dot(base.com) * base.mass);
    let mut lost = of_base.unwrap_or_else(|| builder.constant(0.0, Cause::Arithmetic));
    for (index, ((link, frame), d)) in arm.links.iter().zip(&frames.joints).zip(centres).enumerate() {
        let line = builder.joint(index + 1);
        let centre = line.define(Quantity::ComPosition).by(frame.rotation * *d + frame.origin);
        lost = line.within(Quantity::Potential, || {
            let lost = lost + gravity.dot(centre) * link.body.mass;
            link.body.first_moment.map_or(lost, |h| lost + gravity.dot(frame.rotation * h))
        });
    }
    lost
}
