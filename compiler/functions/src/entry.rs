//! Entries of the table of functions.

use crate::axes::{Axes, Base, Load};
use crate::{Answer, Argument, Capability, Shape, What};

/// The signature of a function, and the words for its callers.
#[derive(Debug)]
pub(crate) struct Signature {
    /// The parts of its name.
    pub(crate) axes: Axes,
    /// The first line of its documentation.
    pub(crate) summary: &'static str,
    /// Shapes, units, frames and signs that the names do not tell.
    pub(crate) details: &'static str,
    /// Its arguments, in order.
    pub(crate) arguments: &'static [Argument],
    /// Its result.
    pub(crate) returned: &'static Shape,
    /// The beginning of its name at a frame, for a function that can be taken there.
    pub(crate) of_frame: Option<&'static str>,
}

/// Properties of what functions compute, on one kind of base.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::struct_excessive_bools)] // each is a property by itself
pub struct Entry {
    /// Their result.
    pub(crate) what: What,
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
    /// Whether it is about places, directions and their changes alone, so that its terms are of about one meter.
    pub is_geometry: bool,
    /// Whether masses and inertias change what it returns, where they are no argument.
    pub feels_links: bool,
    /// Whether what it returns is about the points where the table has its joints and frames.
    pub is_of_table_points: bool,
    /// Whether its seven steps have the operations of the runtime in the same order, and so the same bits.
    pub has_bits_of_runtime: bool,
    /// The meaning of numbers that are not finite, for a function that divides.
    pub divides: Option<&'static str>,
}

impl Entry {
    /// The entry that most functions have in common. The table of results puts in the result and its trait.
    pub(crate) const NEW: Self = Self {
        what: What::ALL[0],
        capability: Capability::ALL[0],
        output: "",
        listed: "returned",
        answer: Answer::Torques,
        returns_torques: false,
        is_of_motion: false,
        feels_rotors: false,
        is_irreducible: false,
        inverts_mass: false,
        is_geometry: false,
        feels_links: true,
        is_of_table_points: false,
        has_bits_of_runtime: false,
        divides: None,
    };

    /// The entry that functions which return joint torques have in common.
    pub(crate) const TORQUES: Self =
        Self { output: "tau", returns_torques: true, has_bits_of_runtime: true, ..Self::NEW };

    /// The entry for a robot with this base, load and loops: their trait is another one, and loops may be singular.
    pub(crate) const fn for_robot(self, Axes { base, load, loops, .. }: Axes) -> Self {
        let capability = match (loops, base, load) {
            (true, Base::Floating, _) => Capability::FloatingClosedLoops,
            (true, _, Load::Payload) => Capability::ClosedLoopsPayloadDynamics,
            (true, _, _) => Capability::ClosedLoops,
            (false, Base::Moving, _) => Capability::MovingBase,
            // the trait of an arm has its torques with a payload, too
            (false, Base::Held, Load::Payload) if !matches!(self.what, What::InverseDynamics) => {
                Capability::PayloadDynamics
            }
            (false, Base::Floating, Load::Payload) => Capability::FloatingPayloadDynamics,
            (false, Base::Held, Load::Wrenches) => Capability::TipWrenches,
            _ => self.capability,
        };
        let divides = match self.divides {
            divides if !loops => divides,
            _ if self.inverts_mass => Some(MOVES_NO_MASS),
            _ => Some(SINGULAR_LOOPS),
        };
        // with loops the dependent joints are eliminated in another order
        Self { capability, divides, has_bits_of_runtime: self.has_bits_of_runtime && !loops, ..self }
    }
}

/// Why a solution of the equations of loops may be none.
pub(crate) const SINGULAR_LOOPS: &str = "the numbers are not finite: the loops are singular in this position (the \
                                         dependent joints are not determined), or the state is too large";

/// Why accelerations of a robot with loops may be none.
const MOVES_NO_MASS: &str = "the accelerations are not finite: the mass matrix is singular (a joint moves no mass), \
                             the loops are singular in this position, or the state is too large";

/// Why a centre of mass may be none.
pub(crate) const WITHOUT_MASS: &str =
    "the centre of mass is not finite: the arm has no mass, or the state is too large";
