//! The functions of a robot that can be compiled, and the forms they can take.

use std::fmt;
use std::str::FromStr;

/// A function of a robot, named as its trait method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Function {
    /// τ(q, q̇, q̈).
    InverseDynamics,
    /// τ(q, q̇, q̈) when the last link exerts a wrench on its environment.
    InverseDynamicsWithWrench,
    /// τ(q, q̇, q̈) from the sines and cosines of the positions.
    InverseDynamicsSc,
    /// τ(q, 0, 0).
    GravityTorques,
    /// τ(q, q̇, 0).
    BiasTorques,
}

impl Function {
    /// All functions, in the order of the traits.
    pub const ALL: [Self; 5] = [
        Self::InverseDynamics,
        Self::InverseDynamicsWithWrench,
        Self::InverseDynamicsSc,
        Self::GravityTorques,
        Self::BiasTorques,
    ];

    /// The name of its trait method.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::InverseDynamics => "inverse_dynamics",
            Self::InverseDynamicsWithWrench => "inverse_dynamics_with_wrench",
            Self::InverseDynamicsSc => "inverse_dynamics_sc",
            Self::GravityTorques => "gravity_torques",
            Self::BiasTorques => "bias_torques",
        }
    }

    /// What it computes, for the first line of its documentation.
    #[must_use]
    pub const fn summary(self) -> &'static str {
        match self {
            Self::InverseDynamics => {
                "Torques for positions `q`, velocities `qd` and accelerations `qdd`, with a free tip."
            }
            Self::InverseDynamicsWithWrench => {
                "Torques when the last link exerts a force and a moment on its environment, at the tip, in tip axes."
            }
            Self::InverseDynamicsSc => {
                "Torques from the sines and cosines of the joint positions; `q` is used for prismatic joints alone."
            }
            Self::GravityTorques => "Torques that hold the arm still against gravity, τ(q, 0, 0).",
            Self::BiasTorques => "Coriolis, centrifugal and gravity torques, τ(q, q̇, 0).",
        }
    }

    /// Whether the joint rates are an argument.
    pub(crate) const fn has_rates(self) -> bool {
        !matches!(self, Self::GravityTorques)
    }

    /// Whether the joint accelerations are an argument.
    pub(crate) const fn has_accelerations(self) -> bool {
        matches!(self, Self::InverseDynamics | Self::InverseDynamicsWithWrench | Self::InverseDynamicsSc)
    }

    /// Whether sines and cosines are arguments.
    pub(crate) const fn has_turns(self) -> bool {
        matches!(self, Self::InverseDynamicsSc)
    }

    /// Whether the wrench at the tip is an argument.
    pub(crate) const fn has_wrench(self) -> bool {
        matches!(self, Self::InverseDynamicsWithWrench)
    }
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
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
    /// The reduced form after algebraic rewriting, which no longer resembles a recursion. `inverse_dynamics` alone is
    /// rewritten, and only where a plan file holds the result.
    Rewritten,
}

impl Form {
    /// All forms.
    pub const ALL: [Self; 3] = [Self::SevenSteps, Self::Reduced, Self::Rewritten];

    /// Its name in the attribute and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::SevenSteps => "seven_steps",
            Self::Reduced => "reduced",
            Self::Rewritten => "rewritten",
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
