//! Rotors of the list `motors`: each turns on a link, about an axis that is fixed to that link.
//!
//! ```text
//! s = Σ n q̇, ṡ = Σ n q̈       spin relative to the link c that carries the rotor, about the axis a; Jm its inertia
//! n_c  + Jm ṡ a + ω_c × Jm s a     moment that accelerates the carrier with its rotor
//! τ_j  + n (Jm ṡ + Jm a · ω̇_c)     torque of each joint with which it turns
//! T    + ½ Jm s (s + 2 a · ω_c)    kinetic energy
//! ```
//!
//! The mass and inertia of the carrier include the rotor held still. The order of the operations is part of the
//! contract; generated code repeats it: joints in the order of the rows, rotors in the order of the list.

use nalgebra::Vector3;

use crate::seven_steps::link_state::{ForceMoment, JointMotions, LinkMotion};
use crate::{Constant, Scalar};

/// The constants of a rotor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spin<S> {
    /// The link that carries it, counted from 0; `None` for the base.
    pub(crate) on: Option<usize>,
    /// a, in the axes of form P of the carrier.
    pub(crate) axis: Vector3<S>,
    /// Jm
    pub(crate) inertia: S,
    /// Where the joints with which it turns begin and end, among those of all rotors.
    pub(crate) turns: [usize; 2],
}

/// The rotors of a robot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spins<'a, S> {
    pub(crate) spins: &'a [Spin<S>],
    /// Joints with which rotors turn, counted from 0, and n.
    pub(crate) turns: &'a [(usize, S)],
}

impl<'a, S: Constant> Spins<'a, S> {
    pub(crate) const NONE: Self = Self { spins: &[], turns: &[] };

    pub(crate) fn all(self) -> impl Iterator<Item = &'a Spin<S>> {
        self.spins.iter()
    }

    /// The rotors that a link carries, or the base.
    pub(crate) fn on(self, link: Option<usize>) -> impl Iterator<Item = &'a Spin<S>> {
        self.spins.iter().filter(move |spin| spin.on == link)
    }

    fn turns(self, spin: &Spin<S>) -> impl Iterator<Item = &'a (usize, S)> {
        self.turns.iter().take(spin.turns[1]).skip(spin.turns[0])
    }

    /// Σ n x, of rates or accelerations x of the joints.
    pub(crate) fn of_joints<T: Scalar>(self, spin: &Spin<S>, values: &[T]) -> T {
        let terms = self.turns(spin).map(|&(joint, n)| values[joint] * n.to());
        terms.reduce(|sum, term| sum + term).unwrap_or_else(T::zero)
    }

    /// Jm Σ n x a, of rates or accelerations x.
    pub(crate) fn momentum<T: Scalar>(self, spin: &Spin<S>, values: &[T]) -> Vector3<T> {
        spin.axis.map(S::to) * (spin.inertia.to::<T>() * self.of_joints(spin, values))
    }

    /// n_c of a link, or of the base (`None`), with Jm ṡ a + ω × Jm s a of each rotor on it.
    pub(crate) fn with_moments<T: Scalar>(
        self,
        carrier: Option<usize>,
        joints: JointMotions<'_, T>,
        motion: &LinkMotion<T>,
        mut inertia: ForceMoment<T>,
    ) -> ForceMoment<T> {
        for spin in self.on(carrier) {
            inertia.moment += self.momentum(spin, joints.qdd) + motion.omega.cross(&self.momentum(spin, joints.qd));
        }
        inertia
    }

    /// Adds n (Jm Σ n x + Jm a · y) to the element of each joint with which a rotor turns, with x and y rates or
    /// accelerations of the joints and of the links.
    pub(crate) fn resist<T: Scalar>(
        self,
        values: &[T],
        carrier: impl Fn(Option<usize>) -> Vector3<T>,
        mut add: impl FnMut(usize, T),
    ) {
        for spin in self.spins {
            let inertia = spin.inertia.to::<T>();
            let along = spin.axis.map(S::to::<T>).dot(&carrier(spin.on));
            let resistance = inertia * self.of_joints(spin, values) + inertia * along;
            for &(joint, n) in self.turns(spin) {
                add(joint, resistance * n.to());
            }
        }
    }
}
