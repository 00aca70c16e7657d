//! The parts of a function's name: its result, the base, the load, and whether there are closed loops.

use crate::{Argument, What};

/// The base of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// It stands still.
    Held,
    /// Something else moves it.
    Moving,
    /// It moves freely.
    Floating,
}

/// The load of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Load {
    /// Nothing.
    Free,
    /// The last link exerts a wrench at the tip.
    Wrench,
    /// The robot exerts a wrench at each tip.
    Wrenches,
    /// A payload is fixed to the tip.
    Payload,
}

/// The parts of a function's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes {
    /// Its result.
    pub what: What,
    /// The base.
    pub base: Base,
    /// The load.
    pub load: Load,
    /// Whether the robot has closed loops.
    pub loops: bool,
}

impl Axes {
    /// The parts for a robot whose base stands still, without a load and without closed loops.
    #[must_use]
    pub const fn of(what: What) -> Self {
        Self { what, base: Base::Held, load: Load::Free, loops: false }
    }

    /// With a floating base.
    #[must_use]
    pub const fn floating(self) -> Self {
        Self { base: Base::Floating, ..self }
    }

    /// On a base that something else moves.
    #[must_use]
    pub const fn moving(self) -> Self {
        Self { base: Base::Moving, ..self }
    }

    /// With a wrench at the tip.
    #[must_use]
    pub const fn with_wrench(self) -> Self {
        Self { load: Load::Wrench, ..self }
    }

    /// With a wrench at each tip.
    #[must_use]
    pub const fn with_wrenches(self) -> Self {
        Self { load: Load::Wrenches, ..self }
    }

    /// With a payload at the tip.
    #[must_use]
    pub const fn with_payload(self) -> Self {
        Self { load: Load::Payload, ..self }
    }

    /// For a robot with closed loops.
    #[must_use]
    pub const fn of_loops(self) -> Self {
        Self { loops: true, ..self }
    }
}

impl Load {
    /// Its argument.
    #[must_use]
    pub const fn argument(self) -> Option<Argument> {
        match self {
            Self::Free => None,
            Self::Wrench => Some(Argument::Wrench),
            Self::Wrenches => Some(Argument::Wrenches),
            Self::Payload => Some(Argument::Payload),
        }
    }
}
