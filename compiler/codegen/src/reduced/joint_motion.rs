//! The motion of the links with the velocities of their points, as derivatives and articulated bodies need it.

use rne_model::JointKind::{Prismatic, Revolute};

use crate::ir::{Number, Quantity, Vector};
use crate::reduced::forward::{acceleration_of_base, motion_of_base};
use crate::reduced::{Arm, Gradient, Outward, SymbolicTurn};

/// The motion of a link, in one frame. The fields `twice_...` are velocities times a factor, 2 or 1.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'s> {
    pub(crate) omega: Vector<'s>,
    pub(crate) omega_dot: Vector<'s>,
    pub(crate) acceleration: Vector<'s>,
    pub(crate) twice_omega: Vector<'s>,
    pub(crate) twice_velocity: Vector<'s>,
}

/// The motion of a link and of its parent, both at the joint between them.
pub(crate) struct JointMotion<'s> {
    /// Motion of the parent at this joint's origin, in frame N, which the joint does not turn; for a prismatic joint in
    /// the axes of the link.
    pub(crate) before: Motion<'s>,
    /// Motion of the link in frame N (not turned by the joint).
    pub(crate) unturned: Motion<'s>,
    /// Motion of the link in its axes.
    pub(crate) own: Motion<'s>,
    /// Rotation from the axes of the link to N.
    pub(crate) turn: SymbolicTurn<'s>,
}

impl<'s> Outward<'s> for Motion<'s> {
    fn turned_back(self, f: impl Fn(Vector<'s>) -> Vector<'s>) -> Self {
        Self {
            omega: f(self.omega),
            omega_dot: f(self.omega_dot),
            acceleration: f(self.acceleration),
            twice_omega: f(self.twice_omega),
            twice_velocity: f(self.twice_velocity),
        }
    }

    fn at(self, p: Vector<'s>) -> Self {
        let gradient = Gradient::new(self.omega, self.omega_dot);
        Self {
            acceleration: self.acceleration + gradient.of(p),
            twice_velocity: self.twice_velocity + self.twice_omega.cross(p),
            ..self
        }
    }
}

/// Returns the motion of a floating base; its linear velocity does not change the results and is zero.
pub(crate) fn of_floating_base<'s>(arm: &Arm<'_, 's>, factor: Number) -> Motion<'s> {
    let base = motion_of_base(arm);
    Motion {
        omega: base.omega,
        omega_dot: base.omega_dot,
        acceleration: acceleration_of_base(arm),
        twice_omega: base.omega.times(factor),
        twice_velocity: arm.builder.no_vector(),
    }
}

/// Returns the motion of all links; velocities are multiplied by `factor`.
pub(crate) fn stations<'s>(arm: &Arm<'_, 's>, factor: Number) -> Vec<JointMotion<'s>> {
    let (builder, rows) = (arm.builder, arm.rows());
    let (zeros, zero) = (builder.no_vector(), builder.zero());
    let still = SymbolicTurn { s: zero, c: builder.number(Number::ONE) };
    let floating = arm.joint_frames.base.as_ref().map(|_| of_floating_base(arm, factor));
    let mut stations: Vec<JointMotion<'s>> = Vec::with_capacity(rows.len());
    for (index, row) in rows.iter().enumerate() {
        builder.at(Quantity::Omega, index + 1);
        let (rate, rate_dot) = (arm.rate(index), arm.rate_dot(index));
        let (last, last_unturned, last_turn) = if let Some(parent) = row.parent {
            let parent = &stations[parent];
            (parent.own, parent.unturned, parent.turn)
        } else {
            let base = floating.unwrap_or_else(|| Motion {
                omega: zeros,
                omega_dot: zeros,
                acceleration: builder.vector(arm.joint_frames.gravity[index].map(|g| -g)),
                twice_omega: zeros,
                twice_velocity: zeros,
            });
            (base, base, still)
        };
        let before = arm.outward(index, last, last_unturned, last_turn);
        let (own, unturned, turn) = match row.kind {
            Revolute => {
                let turn = if arm.is_spin(index) { still } else { arm.turn_of_group(index) };
                let ([wx, wy, _], [dx, dy, dz]) = (before.omega.0, before.omega_dot.0);
                let omega = before.omega.plus_z(rate);
                let unturned = Motion {
                    omega,
                    omega_dot: Vector([dx + rate * wy, dy - rate * wx, dz + rate_dot]),
                    twice_omega: omega.times(factor),
                    ..before
                };
                (unturned.turned_back(|v| turn.back_about_z(v)), unturned, turn)
            }
            Prismatic => {
                let (u, twice_rate) = (builder.vector(row.axis), rate.times(Number::integer(2)));
                let own = Motion {
                    acceleration: before.acceleration + before.omega.cross(u * twice_rate) + u * rate_dot,
                    twice_velocity: before.twice_velocity + u * rate.times(factor),
                    ..before
                };
                (own, own, still)
            }
        };
        stations.push(JointMotion { before, unturned, own, turn });
    }
    stations
}
