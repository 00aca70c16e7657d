//! Writes programs as C99 that needs no library: a header that documents the functions, and the source.

mod casadi;
mod casadi_derivatives;
mod casadi_interface;
mod casadi_motion;
mod casadi_step;
pub(crate) mod header;
mod joint_friction;
mod joint_functions;
mod motors;
mod observer;
mod prefix;
pub(crate) mod runge_kutta;
mod signature;
mod source;

use std::fmt;

use rne_codegen::{Function, Name, Program, Quantity};
use rne_model::Robot;

use super::ascii::ascii;
use super::inert::c_comment;
use super::syntax::{Precision, Syntax};
use super::wrap::{WIDTH, fill};

pub use casadi::{casadi_collision, is_for_casadi};
pub use casadi_derivatives::casadi_derivatives;
pub use joint_friction::{JointFriction, NoFriction};
pub use prefix::{BadPrefix, Prefix};
pub(super) use signature::{array_name, element_type, elements_of, inputs, layout_elements};
pub use signature::{record_name, result_elements};
pub(crate) use source::{SIN_COS, UNUSED};

/// The header and the source of one robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CCode {
    title: String,
    header: String,
    body: String,
}

impl CCode {
    /// Returns the code with tests at the end of the source, which [`c_tests`](super::c_tests) writes.
    #[must_use]
    pub fn with_tests(self, tests: &str) -> Self {
        Self { body: self.body + tests, ..self }
    }

    /// Returns the code with comments in ASCII.
    #[must_use]
    pub fn in_ascii(self) -> Self {
        let [title, header, body] = [self.title, self.header, self.body].map(|text| ascii(&text));
        Self { title, header, body }
    }

    /// Returns the header.
    #[must_use]
    pub fn header(&self) -> &str {
        &self.header
    }

    /// Returns the source, which includes the header by the name of its file.
    #[must_use]
    pub fn source(&self, header: &str) -> String {
        format!("{}\n#include \"{header}\"\n\n{}", self.title, self.body)
    }

    /// Returns header and source as one file that includes no other file of this code.
    #[must_use]
    pub fn one_file(&self) -> String {
        format!("{}\n{}", self.header, self.body)
    }
}

/// Writes the programs of one robot as functions of C.
///
/// # Errors
/// When a constant is too large for the number type.
pub fn c_code(
    robot: &Robot,
    programs: &[Program],
    precision: Precision,
    prefix: &Prefix,
) -> Result<CCode, ConstantTooLarge> {
    c_code_with(robot, programs, precision, prefix, &Additions::default())
}

/// Optional parts of the C code, in addition to the programs.
#[derive(Clone, Copy, Debug, Default)]
#[allow(clippy::struct_excessive_bools)] // each is an option
pub struct Additions<'a> {
    /// The robot file that the heading names.
    pub origin: Option<&'a Origin>,
    /// The friction of the joints, for the function `friction_torques`.
    pub friction: Option<&'a [JointFriction]>,
    /// Whether there is a function `limit_torques`, which keeps torques within the effort limits.
    pub limits: bool,
    /// Whether the header has a constant for the index of each joint, named by
    /// [`JointIdentifier`](rne_model::JointIdentifier). If two joints have one identifier, the header does not compile;
    /// [`Checked::identifiers`](rne_model::Checked::identifiers) returns the error in this case.
    pub names: bool,
    /// Whether CasADi can call the programs for which [`is_for_casadi`] is true; with derivatives if the functions of
    /// [`casadi_derivatives`] are among the programs. Needs [`Precision::Double`].
    pub casadi: bool,
    /// Whether acados can integrate the robot: this adds the functions of an explicit differential equation. Needs
    /// `casadi`, and among the programs `forward_dynamics` and `forward_dynamics_derivatives`.
    pub acados: bool,
    /// Whether there is a function `runge_kutta_step`; with one for its derivatives if `forward_dynamics_derivatives`
    /// is among the programs. Needs `forward_dynamics`.
    pub runge_kutta: bool,
    /// Whether [`ptx`](crate::ptx) also writes rollout kernels, for the programs of functions for which
    /// [`is_for_rollouts`](crate::is_for_rollouts) is true.
    pub rollout: bool,
}

/// Writes the code of [`c_code`], with additional parts.
///
/// # Errors
/// When a constant is too large for the number type.
pub fn c_code_with(
    robot: &Robot,
    programs: &[Program],
    precision: Precision,
    prefix: &Prefix,
    additions: &Additions<'_>,
) -> Result<CCode, ConstantTooLarge> {
    let file = File { robot, programs, precision, prefix: prefix.as_str(), additions };
    Ok(CCode { title: header::title(&file), header: header::header(&file)?, body: source::body(&file)? })
}

/// The programs of a file, and how they are written.
pub(crate) struct File<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) programs: &'a [Program],
    pub(crate) precision: Precision,
    pub(crate) prefix: &'a str,
    pub(crate) additions: &'a Additions<'a>,
}

/// The robot file from which the code was generated: its name without folders, and a hash of its contents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    file: String,
    sha256: String,
}

impl Origin {
    /// Returns the origin of code that was generated from a file with this SHA-256, in hexadecimal.
    #[must_use]
    pub fn new(file: &str, sha256: &str) -> Self {
        Self { file: file.to_owned(), sha256: sha256.to_owned() }
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, SHA-256 {}", self.file, self.sha256)
    }
}

impl<'a> File<'a> {
    fn syntax(&self) -> Syntax<'a> {
        Syntax::C { precision: self.precision, prefix: self.prefix }
    }

    /// Whether some program needs sines and cosines.
    pub(crate) fn turns(&self) -> bool {
        self.programs.iter().any(|program| !program.sines_and_cosines.is_empty())
    }

    pub(crate) fn chooses_by_sign(&self) -> bool {
        self.programs.iter().any(Program::chooses_by_sign)
    }
}

/// The error of a constant that is too large for the number type.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantTooLarge {
    /// The name of the constant in the code.
    pub name: Name,
    /// Its value.
    pub value: f64,
    /// The function that needs it.
    pub function: Function,
}

impl fmt::Display for ConstantTooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, value, function } = self;
        if name.quantity == Quantity::Parameter {
            let number = name.joint;
            write!(f, "`{function}` takes run-time parameter {number}, whose value in the file is {value:e}")?;
            return write!(f, ": too large for `float`, whose largest number is {:e}", f32::MAX);
        }
        write!(f, "`{function}` needs the constant {name} ({}", name.quantity.meaning())?;
        if name.joint > 0 {
            write!(f, ", of link {}", name.joint)?;
        }
        write!(f, "), which is {value:e}: too large for `float`, whose largest number is {:e}", f32::MAX)
    }
}

impl std::error::Error for ConstantTooLarge {}

/// Returns words as a comment whose lines begin with `start`; an empty comment if there are no words.
pub(crate) fn comment(start: &str, text: &str) -> String {
    let blank = format!("{start} ");
    let lines = if text.is_empty() { start.to_owned() } else { fill(&c_comment(text), WIDTH, &blank, &blank) };
    lines + "\n"
}
