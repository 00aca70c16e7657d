//! Finds values that follow from wrong earlier values, and values that are zero in every state.

use std::collections::BTreeSet;

use rne_model::Robot;
use rne_runtime::{LinkTrace, WrongLength};

use super::comparison::Place;
use super::formulas::Formulas;
use super::{Line, Quantity, ROUNDING, Situation, Worksheet};

/// Number of additional states in which a value must be zero to count as zero in every state.
const STATES: usize = 3;

impl Worksheet {
    /// Returns the components that are zero in every state of the arm, such as ω_x of a planar arm: each by the index
    /// of its line in [`Worksheet::lines`] and its own index. This worksheet must be that of `robot` at `at`. A
    /// component that is zero at this state and at three others counts as zero in every state.
    ///
    /// # Errors
    /// When a list of the situation does not have one number per joint.
    pub fn always_zero(&self, robot: &Robot, at: &Situation) -> Result<BTreeSet<(usize, usize)>, WrongLength> {
        let mut zero = self.zeros();
        for state in 0..STATES {
            // numbers without relations by which a sum of terms could vanish by chance
            let list = |from: usize| {
                let number = |joint: usize| u32::try_from(7 * state + from + 3 * joint).map_or(0.0, f64::from);
                let angle = |joint: usize| (1.0 + 3.7 * number(joint)).sin();
                (0..robot.dof()).map(|joint| 0.3_f64.copysign(angle(joint)) + angle(joint)).collect::<Vec<f64>>()
            };
            let there = Situation { q: list(0), qd: list(1), qdd: list(2), ..at.clone() };
            let zeros = Self::new(robot, &there, self.axes)?.zeros();
            zero.retain(|place| zeros.contains(place));
        }
        Ok(zero)
    }

    /// Returns the components that are zero up to rounding.
    fn zeros(&self) -> BTreeSet<Place> {
        let places = self.lines.iter().enumerate().flat_map(|(index, line)| {
            let rounding = ROUNDING * self.largest(line.unit());
            let zero = line.values.iter().enumerate().filter(move |(_, value)| value.abs() <= rounding);
            zero.map(move |(component, _)| (index, component))
        });
        places.collect()
    }
}

impl Formulas<'_> {
    /// Computes the line of a quantity of a joint, counted from 1, by its formula from the values of `links`. `None` if
    /// no formula of the seven steps gives the quantity.
    pub(super) fn by_formula(&self, joint: usize, quantity: Quantity) -> Option<Line> {
        let mut line = self.line(joint, quantity)?;
        let handed_on = matches!(quantity, Quantity::NextForce | Quantity::NextMoment);
        if handed_on {
            let next = self.links.get(joint)?;
            let own = if quantity == Quantity::NextForce { next.joint_force } else { next.joint_moment };
            line.values = self.turned(joint, own);
        } else {
            let sum = |component: usize| line.terms.iter().map(|term| term.values[component]).sum();
            line.values = (0..line.values.len()).map(sum).collect();
        }
        Some(line)
    }
}

/// Sets a component of a result of the steps in the values of a link.
pub(super) fn set(link: &mut LinkTrace<f64>, quantity: Quantity, component: usize, value: f64) {
    let vector = vector(link, quantity).filter(|_| quantity.step() > 0);
    if let Some(own) = vector.and_then(|vector| vector.get_mut(component)) {
        *own = value;
    }
}

/// Returns the vector of a link for a quantity.
pub(super) fn vector(link: &mut LinkTrace<f64>, quantity: Quantity) -> Option<&mut [f64; 3]> {
    Some(match quantity {
        Quantity::D => &mut link.d,
        Quantity::R => &mut link.r,
        Quantity::Omega => &mut link.omega,
        Quantity::OmegaDot => &mut link.omega_dot,
        Quantity::Velocity => &mut link.velocity,
        Quantity::Acceleration => &mut link.acceleration,
        Quantity::Gravity => &mut link.gravity,
        Quantity::InertiaForce => &mut link.inertia_force,
        Quantity::InertiaMoment => &mut link.inertia_moment,
        Quantity::NextForce => &mut link.next_force,
        Quantity::NextMoment => &mut link.next_moment,
        Quantity::JointForce => &mut link.joint_force,
        Quantity::JointMoment => &mut link.joint_moment,
        _ => return None,
    })
}
