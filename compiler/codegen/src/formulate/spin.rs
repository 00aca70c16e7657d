//! Rotors of the list `motors`: each turns on a link, about an axis that is fixed to that link.
//!
//! ```text
//! s = Σ n q̇, ṡ = Σ n q̈       spin relative to the link c that carries the rotor, about the axis a; Jm its inertia
//! n_c  + Jm ṡ a + ω_c × Jm s a     moment that accelerates the carrier with its rotor
//! τ_j  + n (Jm ṡ + Jm a · ω̇_c)     torque of each joint with which it turns
//! T    + ½ Jm s (s + 2 a · ω_c)    kinetic energy
//! ```
//!
//! The mass and inertia of the carrier include the rotor, as if it did not turn.

use rne_model::{Convention, Robot};

use crate::coordinates::{Ratio, scaled};
use crate::formulate::{Arm, Joint, JointState, Motion};
use crate::ir::{Builder, Cause, Matrix, Name, Quantity, Symbol, Vector};

/// A rotor of the list `motors`, which turns on a link.
pub(crate) struct Spin<'s> {
    /// The link that carries the rotor, counted from 0; `None` for the base.
    pub(crate) on: Option<usize>,
    /// Rotor axis a in the carrier's axes of form P.
    axis: Vector<'s>,
    inertia: Symbol<'s>,
    /// The joints with which the rotor turns, counted from 0, each with its ratio n.
    turns: Vec<(usize, f64)>,
    /// Number of the rotor, from 1.
    number: usize,
}

impl<'s> Spin<'s> {
    /// Returns the rotors of a robot. `twists` are the rotations Rx(α) of the rows of the table.
    pub(crate) fn all(builder: &'s Builder, robot: &Robot, twists: &[Matrix<'s>]) -> Vec<Self> {
        let mut spins = Vec::new();
        for (rotor, turns) in robot.spinning_rotors() {
            let number = spins.len() + 1;
            let axis = Vector(rotor.axis.map(|x| builder.constant(x, Cause::Arithmetic)));
            let axis = match (robot.convention, rotor.on) {
                (Convention::Standard, Some(link)) => twists[link] * axis,
                _ => axis,
            };
            let name = name(Quantity::SpinInertia, turns, number);
            let inertia = builder.name(name, builder.constant(rotor.inertia, Cause::Arithmetic));
            spins.push(Self { on: rotor.on, axis, inertia, turns: turns.to_vec(), number });
        }
        spins
    }

    /// Returns Σ n x, where x is the rate or the acceleration of each joint, as a named `quantity`.
    pub(crate) fn of_joints(
        &self,
        quantity: Quantity,
        states: &[JointState<'s>],
        of_joint: fn(&JointState<'s>) -> Symbol<'s>,
    ) -> Symbol<'s> {
        let builder = self.inertia.builder;
        let line = builder.joint(self.turns.first().map_or(0, |(joint, _)| joint + 1));
        line.within(quantity, || {
            let terms = self.turns.iter().map(|&(joint, n)| scaled(of_joint(&states[joint]), Ratio::constant(n)));
            let sum = terms.reduce(|sum, term| sum + term).unwrap_or_else(|| builder.zero());
            builder.name(name(quantity, &self.turns, self.number), sum)
        })
    }

    /// Returns Jm x a, where x is the spin or its acceleration.
    pub(crate) fn momentum(&self, spin: Symbol<'s>) -> Vector<'s> {
        self.axis * (self.inertia * spin)
    }

    /// Returns n (Jm x + Jm a · y) if the rotor turns with the joint. x is its spin and y the angular velocity of its
    /// carrier, or both are the accelerations.
    pub(crate) fn resistance(&self, joint: usize, spin: Symbol<'s>, carrier: Vector<'s>) -> Option<Symbol<'s>> {
        let (_, n) = *self.turns.iter().find(|(other, _)| *other == joint)?;
        Some(scaled(self.inertia * spin + self.inertia * self.axis.dot(carrier), Ratio::constant(n)))
    }

    /// Returns Jm s (s + 2 a · ω), twice the kinetic energy of the rotor.
    pub(crate) fn twice_energy(&self, spin: Symbol<'s>, carrier: Option<Vector<'s>>) -> Symbol<'s> {
        let whole = carrier.map_or(spin, |omega| {
            let along = self.axis.dot(omega);
            (spin + along) + along
        });
        (self.inertia * spin) * whole
    }
}

/// The rotors of a robot with their spins, as steps 6 and 7 need them.
pub(crate) struct Rotors<'a, 's> {
    /// Each rotor with its spin s and the spin's acceleration ṡ.
    spins: Vec<(&'a Spin<'s>, [Symbol<'s>; 2])>,
}

impl<'a, 's> Rotors<'a, 's> {
    pub(crate) fn of(arm: &'a Arm<'s>, states: &[JointState<'s>]) -> Self {
        let spinning = |spin: &Spin<'s>| {
            let rate = spin.of_joints(Quantity::Spin, states, |state| state.qd);
            [rate, spin.of_joints(Quantity::SpinDot, states, |state| state.qdd)]
        };
        Self { spins: arm.spins.iter().map(|spin| (spin, spinning(spin))).collect() }
    }

    /// Returns the moment n_c of a link with the angular velocity ω_c, or of the base (`None`), plus the moment of the
    /// rotors on it.
    pub(crate) fn add_to_moment(&self, carrier: Option<usize>, omega: Vector<'s>, moment: Vector<'s>) -> Vector<'s> {
        let on_carrier = self.spins.iter().filter(|(spin, _)| spin.on == carrier);
        on_carrier.fold(moment, |moment, (spin, [rate, rate_dot])| {
            moment + (spin.momentum(*rate_dot) + omega.cross(spin.momentum(*rate)))
        })
    }

    /// Returns the torque of a joint plus that of the rotors: G² Jm q̈ of its own motor, if its rotor belongs to the
    /// arm, and the torques of the rotors of the list `motors`.
    pub(crate) fn add_to_torque(
        &self,
        joint: &Joint<'_, 's>,
        (base, motions): (&Motion<'s>, &[Motion<'s>]),
        torque: Symbol<'s>,
    ) -> Symbol<'s> {
        let torque = joint.link.rotor.map_or(torque, |rotor| torque + rotor * joint.state.qdd);
        let resistances = self.spins.iter().filter_map(|(spin, [_, rate_dot])| {
            let carrier = spin.on.map_or(base, |link| &motions[link]);
            spin.resistance(joint.index, *rate_dot, carrier.turning.omega_dot)
        });
        resistances.fold(torque, |torque, resistance| torque + resistance)
    }
}

/// Returns the name of a quantity of a rotor: it has the first joint with which the rotor turns, and the number of the
/// rotor.
fn name(quantity: Quantity, turns: &[(usize, f64)], number: usize) -> Name {
    Name::indexed(quantity, turns.first().map_or(0, |(joint, _)| joint + 1), number)
}
