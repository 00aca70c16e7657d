//! A revolute joint: the link turns about e by q, so its points take part in its turning and in nothing else.

use rne_model::QuarterTurns;

use super::Joint;
use crate::formulate::joint::Wrench;
use crate::ir::{Quantity, Symbol, Vector, by_quarters};

/// Sine and cosine of θ + q. A right angle θ permutes and negates those of q exactly; any other is added to q.
pub(super) fn sine_and_cosine<'s>(joint: &Joint<'_, 's>) -> (Symbol<'s>, Symbol<'s>) {
    let (line, theta) = (joint.lines, joint.link.theta);
    match (joint.state.turn, theta.right) {
        (Some(turn), Some(turns)) => by_quarters(turn, turns),
        // the addition theorem
        (Some((s, c)), None) => {
            let (sin, cos) = joint.constant_turn();
            (
                line.scalar(Quantity::TurnedSine, || s * cos + c * sin),
                line.scalar(Quantity::TurnedCosine, || c * cos - s * sin),
            )
        }
        (None, right) => {
            let q = joint.state.q;
            let angle = if right.is_some() {
                q
            } else {
                line.scalar(Quantity::Angle, || line.entry(Quantity::Theta, theta.radians) + q)
            };
            let (s, c) = line.builder.sine_and_cosine(angle);
            let turn = (line.name(Quantity::Sine, s), line.name(Quantity::Cosine, c));
            by_quarters(turn, right.unwrap_or(QuarterTurns::Zero))
        }
    }
}

pub(super) fn offset<'s>(_joint: &Joint<'_, 's>, offset: Vector<'s>) -> Vector<'s> {
    offset
}

/// A constant of the table.
pub(super) fn centre_of_mass<'s>(joint: &Joint<'_, 's>) -> Vector<'s> {
    joint.lines.name_vector(Quantity::D, joint.link.offset + joint.link.com)
}

/// + q̇ e
pub(super) fn angular_velocity<'s>(joint: &Joint<'_, 's>, rigid: Vector<'s>) -> Vector<'s> {
    rigid + joint.e * joint.state.qd
}

/// + q̈ e + q̇ ω × e
pub(super) fn angular_acceleration<'s>(joint: &Joint<'_, 's>, rigid: Vector<'s>, omega: Vector<'s>) -> Vector<'s> {
    rigid + joint.e * joint.state.qdd + omega.cross(joint.e) * joint.state.qd
}

pub(super) fn velocity<'s>(_joint: &Joint<'_, 's>, rigid: Vector<'s>) -> Vector<'s> {
    rigid
}

pub(super) fn acceleration<'s>(_joint: &Joint<'_, 's>, rigid: Vector<'s>, _omega: Vector<'s>) -> Vector<'s> {
    rigid
}

pub(super) fn unaccelerated<'s>(_joint: &Joint<'_, 's>, rigid: Vector<'s>, _omega: Vector<'s>) -> Vector<'s> {
    rigid
}

/// e · n
pub(super) fn actuator<'s>(_joint: &Joint<'_, 's>, wrench: &Wrench<'s>) -> Symbol<'s> {
    wrench.moment.z()
}
