//! A prismatic joint: the link slides along e by q and turns as its parent does.

use super::Joint;
use crate::formulate::joint::Wrench;
use crate::ir::{Name, Quantity, Symbol, Vector};

/// Sine and cosine of the constant θ.
pub(super) fn sine_and_cosine<'s>(joint: &Joint<'_, 's>) -> (Symbol<'s>, Symbol<'s>) {
    joint.constant_turn()
}

/// (a, 0, b + q)
pub(super) fn offset<'s>(joint: &Joint<'_, 's>, offset: Vector<'s>) -> Vector<'s> {
    offset.plus_z(joint.state.q)
}

/// The joint moves it along its axis.
pub(super) fn centre_of_mass<'s>(joint: &Joint<'_, 's>) -> Vector<'s> {
    joint.lines.vector(Quantity::D, || joint.offset(joint.link.offset) + joint.link.com)
}

pub(super) fn angular_velocity<'s>(_joint: &Joint<'_, 's>, rigid: Vector<'s>) -> Vector<'s> {
    rigid
}

pub(super) fn angular_acceleration<'s>(_joint: &Joint<'_, 's>, rigid: Vector<'s>, _omega: Vector<'s>) -> Vector<'s> {
    rigid
}

/// + q̇ e
pub(super) fn velocity<'s>(joint: &Joint<'_, 's>, rigid: Vector<'s>) -> Vector<'s> {
    rigid + joint.e * joint.state.qd
}

/// + q̈ e + 2 q̇ ω × e
pub(super) fn acceleration<'s>(joint: &Joint<'_, 's>, rigid: Vector<'s>, omega: Vector<'s>) -> Vector<'s> {
    unaccelerated(joint, rigid + joint.e * joint.state.qdd, omega)
}

/// + 2 q̇ ω × e
pub(super) fn unaccelerated<'s>(joint: &Joint<'_, 's>, rigid: Vector<'s>, omega: Vector<'s>) -> Vector<'s> {
    let two = || joint.lines.builder.entry(Name::scalar(Quantity::Two, 0), 2.0);
    let twice_rate = || joint.lines.scalar(Quantity::TwiceRate, || two() * joint.state.qd);
    rigid + omega.cross(joint.e) * twice_rate()
}

/// e · f
pub(super) fn actuator<'s>(_joint: &Joint<'_, 's>, wrench: &Wrench<'s>) -> Symbol<'s> {
    wrench.force.z()
}
