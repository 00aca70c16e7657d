//! The functions of a robot that can be compiled, and the forms they can take.

mod answer;
mod capability;
mod entry;
mod layout;
mod table;
#[cfg(test)]
mod tests;

use std::fmt;
use std::str::FromStr;

use crate::ir::quantity::Quantity;

pub use answer::{Answer, AnswerTable, Labels, MatrixUnit};
use entry::{Entry, Own};
pub use layout::{Layout, Length, Record, Shape};
use table::TABLE;
pub use table::{Capability, Function};

/// An argument of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// Sines of the joint positions.
    Sines,
    /// Cosines of the joint positions.
    Cosines,
    /// Joint positions.
    Positions,
    /// Joint rates.
    Rates,
    /// Joint accelerations.
    Accelerations,
    /// Joint torques.
    Torques,
    /// Force and moment at the tip.
    Wrench,
    /// Motion of the base, and gravity.
    Base,
}

impl Function {
    /// All functions, in the order of the traits.
    pub const ALL: [Self; TABLE.len()] = {
        let mut all = [Self::InverseDynamics; TABLE.len()];
        let mut index = 0;
        while index < all.len() {
            all[index] = TABLE[index].function;
            index += 1;
        }
        all
    };

    /// Those of the trait `InverseDynamics`: torques of an arm whose base stands still.
    pub const TORQUES: [Self; 5] = [
        Self::InverseDynamics,
        Self::InverseDynamicsWithWrench,
        Self::InverseDynamicsSc,
        Self::GravityTorques,
        Self::BiasTorques,
    ];

    /// Its entry in the table.
    pub(crate) const fn entry(self) -> &'static Entry {
        &TABLE[self as usize]
    }

    /// The name of its trait method.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.entry().name
    }

    /// The trait that it is a method of.
    #[must_use]
    pub const fn capability(self) -> Capability {
        self.entry().capability
    }

    /// What it computes, for the first line of its documentation.
    #[must_use]
    pub const fn summary(self) -> &'static str {
        self.entry().summary
    }

    /// Its arguments, in order.
    #[must_use]
    pub const fn arguments(self) -> &'static [Argument] {
        self.entry().arguments
    }

    /// Whether it has an argument.
    #[must_use]
    pub fn takes(self, argument: Argument) -> bool {
        self.arguments().contains(&argument)
    }

    /// Whether what it returns are the torques of the joints.
    #[must_use]
    pub const fn returns_torques(self) -> bool {
        self.entry().returns_torques
    }

    /// Whether what it returns are the accelerations of the joints.
    #[must_use]
    pub const fn returns_accelerations(self) -> bool {
        matches!(self.entry().answer, Answer::Accelerations)
    }

    /// The shape of what it returns, for any number of joints.
    #[must_use]
    pub const fn shape(self) -> &'static Shape {
        &self.entry().shape
    }

    /// The shape of what it returns for so many joints.
    #[must_use]
    pub fn layout(self, dof: usize) -> Layout {
        self.shape().layout(dof)
    }

    /// How its numbers are laid out for reading.
    #[must_use]
    pub const fn answer(self) -> &'static Answer {
        &self.entry().answer
    }

    /// What is told of a quantity in its listing alone.
    pub(crate) fn own(self, quantity: Quantity) -> Option<&'static Own> {
        self.entry().own.iter().find(|own| own.quantity == quantity)
    }

    /// Whether it has a reduced form, whose graph can be rewritten.
    #[must_use]
    pub const fn can_be_rewritten(self) -> bool {
        !self.entry().is_irreducible
    }

    /// What it means that its numbers are not finite, for a function that divides.
    #[must_use]
    pub const fn divides(self) -> Option<&'static str> {
        self.entry().divides
    }
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl From<Function> for &str {
    fn from(function: Function) -> Self {
        function.name()
    }
}

impl TryFrom<String> for Function {
    type Error = UnknownName;

    fn try_from(text: String) -> Result<Self, UnknownName> {
        text.parse()
    }
}

impl FromStr for Function {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        Self::ALL.into_iter().find(|function| function.name() == text).ok_or_else(|| UnknownName {
            found: text.to_owned(),
            what: "function",
            allowed: Self::ALL.iter().map(|function| function.name()).collect(),
        })
    }
}

/// How a function is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Form {
    /// The seven steps: every intermediate is the lecture's.
    #[default]
    SevenSteps,
    /// Fewest operations: only the torques keep a physical meaning.
    Reduced,
}

impl Form {
    /// All forms.
    pub const ALL: [Self; 2] = [Self::SevenSteps, Self::Reduced];

    /// Its name in the attribute and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::SevenSteps => "seven_steps",
            Self::Reduced => "reduced",
        }
    }
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Form {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        Self::ALL.into_iter().find(|form| form.name() == text).ok_or_else(|| UnknownName {
            found: text.to_owned(),
            what: "form",
            allowed: Self::ALL.iter().map(|form| form.name()).collect(),
        })
    }
}

/// A name that is none of those allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownName {
    found: String,
    what: &'static str,
    allowed: Vec<&'static str>,
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let allowed: Vec<String> = self.allowed.iter().map(|name| format!("`{name}`")).collect();
        write!(f, "`{}` is no {}; there are {}", self.found, self.what, allowed.join(", "))
    }
}

impl std::error::Error for UnknownName {}
