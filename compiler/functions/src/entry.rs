//! Entries of the table of functions.

use crate::{Answer, Argument, Capability, Function, Returned};

/// The signature of a function, and the words for its callers.
#[derive(Debug)]
pub(crate) struct Signature {
    /// The first line of its documentation.
    pub(crate) summary: &'static str,
    /// Shapes, units, frames and signs that the names do not tell.
    pub(crate) details: &'static str,
    /// Its arguments, in order.
    pub(crate) arguments: &'static [Argument],
    /// Its result.
    pub(crate) returned: Returned,
    /// The beginning of its name at a frame, for a function that can be taken there.
    pub(crate) of_frame: Option<&'static str>,
}

/// Properties of a function.
#[derive(Debug)]
#[allow(clippy::struct_excessive_bools)] // each is a property by itself
pub struct Entry {
    /// The variant, which is at this place.
    pub function: Function,
    /// The trait.
    pub capability: Capability,
    /// The argument of C behind which the result is written. A single number is returned.
    pub output: &'static str,
    /// The words of a listing above the returned numbers.
    pub listed: &'static str,
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
    /// The meaning of numbers that are not finite, for a function that divides.
    pub divides: Option<&'static str>,
}

impl Entry {
    /// The entry that most functions have in common.
    pub(crate) const fn of(function: Function, capability: Capability) -> Self {
        Self {
            function,
            capability,
            output: "",
            listed: "returned",
            answer: Answer::Torques,
            returns_torques: false,
            is_of_motion: false,
            feels_rotors: false,
            is_irreducible: false,
            inverts_mass: false,
            divides: None,
        }
    }

    /// The entry that functions which return joint torques have in common.
    pub(crate) const fn torques(function: Function, capability: Capability) -> Self {
        Self { output: "tau", returns_torques: true, ..Self::of(function, capability) }
    }
}

/// Why a centre of mass may be none.
pub(crate) const WITHOUT_MASS: &str =
    "the centre of mass is not finite: the arm has no mass, or the state is too large";
