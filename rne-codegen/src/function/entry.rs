//! What the table has of each function.

use super::table::{Capability, Function};
use super::{Answer, Argument, Returned};
use crate::ir::Quantity;

/// What a caller must know of a function.
#[derive(Debug)]
pub(super) struct Signature {
    /// What it computes, for the first line of its documentation.
    pub(super) summary: &'static str,
    /// What else a caller must know: shapes, units, frames and signs that the names do not tell.
    pub(super) details: &'static str,
    /// What it takes, in order.
    pub(super) arguments: &'static [Argument],
    /// What it returns.
    pub(super) returned: Returned,
}

/// What else there is to know of a function.
#[derive(Debug)]
#[allow(clippy::struct_excessive_bools)] // each is a property by itself
pub struct Entry {
    /// The variant, which is at this place.
    pub function: Function,
    /// The trait.
    pub capability: Capability,
    /// The argument of C behind which the result is written. A single number is returned.
    pub output: &'static str,
    /// What a listing says above the returned numbers.
    pub listed: &'static str,
    /// The quantities that its listing shows under headings of its own.
    pub own: &'static [Own],
    /// How its results are shown to people.
    pub answer: Answer,
    /// Whether it returns the torques of the joints, by the seven steps.
    pub returns_torques: bool,
    /// Whether what it returns is a part of the torques of motion, or how they change: it may vanish but for rounding.
    pub is_of_motion: bool,
    /// Whether rotors that belong to the arm change what it returns, though it is no torque by accelerations.
    pub feels_rotors: bool,
    /// Whether it has the seven steps as its only form: bearings feel what regrouping moves from link to link, and
    /// motors have nothing to reduce.
    pub is_irreducible: bool,
    /// Whether it solves by the mass matrix, so that its numbers are worth nothing where that is nearly singular.
    pub inverts_mass: bool,
    /// What it means that its numbers are not finite, for a function that divides.
    pub divides: Option<&'static str>,
}

/// A quantity in the listing of a function.
#[derive(Debug)]
pub struct Own {
    /// Which.
    pub quantity: Quantity,
    /// What stands above its statements at a joint.
    pub heading: fn(usize) -> String,
    /// What its names stand for, where that is not what they stand for elsewhere.
    pub meaning: Option<&'static str>,
}

impl Entry {
    /// What most functions have in common.
    pub(super) const fn of(function: Function, capability: Capability) -> Self {
        Self {
            function,
            capability,
            output: "",
            listed: "returned",
            own: &[],
            answer: Answer::Torques,
            returns_torques: false,
            is_of_motion: false,
            feels_rotors: false,
            is_irreducible: false,
            inverts_mass: false,
            divides: None,
        }
    }

    /// What functions that return the torques of the joints have in common.
    pub(super) const fn torques(function: Function, capability: Capability) -> Self {
        Self { output: "tau", returns_torques: true, ..Self::of(function, capability) }
    }
}

impl Own {
    /// A quantity under a heading of its own.
    pub(super) const fn of(quantity: Quantity, heading: fn(usize) -> String) -> Self {
        Self { quantity, heading, meaning: None }
    }

    /// An argument whose names stand for something of this function.
    pub(super) const fn names(quantity: Quantity, meaning: &'static str) -> Self {
        Self::meaning(quantity, meaning, |_| String::new())
    }

    /// The same, whose names stand for something else here.
    pub(super) const fn meaning(quantity: Quantity, meaning: &'static str, heading: fn(usize) -> String) -> Self {
        Self { quantity, heading, meaning: Some(meaning) }
    }
}
