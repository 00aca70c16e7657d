//! Forms that were tried before a function got the code that it has, and why they were refused.

use std::fmt;

use crate::error::CompileError;
use crate::function::Function;

/// Largest difference of torques from the seven steps, relative to the largest torque, with which a program is emitted.
const LARGEST_ROUNDING: f64 = 1e-11;

/// Largest difference of accelerations from the seven steps, relative to the largest one. Accelerations lose precision
/// by the condition number of the matrix that they are solved with: 10⁵ for the mass matrix of the PUMA 560 without the
/// inertia of its rotors, and 10⁸ for contacts that hold more than the robot can move, as their damping is 10⁻⁸ beside
/// numbers near 1.
const LARGEST_ROUNDING_OF_ACCELERATIONS: f64 = 1e-7;

/// The largest rounding error of a program that is emitted.
pub(crate) const fn largest_rounding(function: Function) -> f64 {
    if function.inverts_mass() { LARGEST_ROUNDING_OF_ACCELERATIONS } else { LARGEST_ROUNDING }
}

/// The largest error in single precision, in parts of the largest number that a function returns, that is not reported
/// to users.
pub(crate) const fn largest_loss(function: Function) -> f64 {
    if function.inverts_mass() { 1e-2 } else { 1e-4 }
}

/// A reduced form of a function that was refused, so that the function has another one, or the seven steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The form that was refused.
    pub attempt: Attempt,
    /// The reason for the refusal.
    pub reason: Reason,
}

/// A way to write the reduced form of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Attempt {
    /// Any reduced form.
    Any,
    /// By the choices of the plan, with some of them left out.
    Planned(LeftOut),
    /// The plain formulas with every value computed once.
    EveryValueOnce,
}

/// The choices of a plan that are not made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftOut {
    /// Every choice of the plan is made.
    Nothing,
    /// The choices of frames: the turned last frame, and the carried prismatic links.
    Frames,
    /// All choices of the plan are left out; inertial parameters are regrouped.
    Choices,
    /// All choices of the plan are left out, and inertial parameters are not regrouped.
    Regrouping,
}

/// Why a reduced form was refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// The seven steps divide by zero in every state. No code can be proved to be identical to them.
    DividesByZero,
    /// The code does not compile, or the proof refuses it: it is another function, or it rounds too much.
    Error(CompileError),
    /// The code takes more operations than the seven steps.
    Longer {
        /// Its operations.
        operations: usize,
        /// The operations of the seven steps.
        of_seven_steps: usize,
    },
}

impl Refusal {
    pub(crate) const fn new(attempt: Attempt, reason: Reason) -> Self {
        Self { attempt, reason }
    }

    pub(crate) const fn of_error(attempt: Attempt, error: CompileError) -> Self {
        Self { attempt, reason: Reason::Error(error) }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.attempt, self.reason)
    }
}

impl fmt::Display for Attempt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Any => "any reduced form",
            Self::Planned(LeftOut::Nothing) => "the choices of the plan",
            Self::Planned(LeftOut::Frames) => "the choices of the plan, except the choices of frames",
            Self::Planned(LeftOut::Choices) => "regrouped inertial parameters without other choices",
            Self::Planned(LeftOut::Regrouping) => "the reduced recursion without choices",
            Self::EveryValueOnce => "the plain formulas with every value computed once",
        })
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let largest = |function: &Function| if function.returns_torques() { "torque" } else { "number returned" };
        match self {
            Self::DividesByZero => f.write_str(
                "the seven steps divide by zero in every state, so no other code can be proved identical to them",
            ),
            Self::Error(CompileError::NotIdentical { function, output, .. }) => {
                let what = if function.returns_torques() { "the torque of joint" } else { "returned number" };
                write!(f, "the proof fails, because {what} {output} differs from that of the seven steps")
            }
            Self::Error(CompileError::Imprecise { function, rounding, .. }) => {
                let most = largest_rounding(*function);
                let largest = largest(function);
                write!(
                    f,
                    "it differs too much from the seven steps by rounding: by {rounding:.1e} of the largest {largest}; \
                     the limit is {most:.0e}"
                )
            }
            Self::Error(error) => error.fmt(f),
            Self::Longer { operations, of_seven_steps } => {
                write!(f, "it needs {operations} operations; the seven steps need {of_seven_steps}")
            }
        }
    }
}
