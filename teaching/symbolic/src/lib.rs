//! The dynamics of an arm in closed form, as a lecture writes them: τ = M(θ)θ̈ + h(θ,θ̇) + γ(θ).
//!
//! The compiler's seven steps of recursive Newton-Euler run over polynomials with exact fractions, whose letters are
//! the parameters of the robot file and the other numbers of its table. The torques are split into the mass matrix,
//! Christoffel symbols and gravity, compared with Lagrange's equations, and collected for reading. Written formulas are
//! multiplied out again and must be equal to the derived ones. This crate does not open files and does not print.
//!
//! ```
//! use rne_symbolic::{ClosedForm, read};
//!
//! let text = "
//! format: 1
//! name: pendulum
//! source: the lecture
//! convention: standard
//! gravity: [g, 0, 0]
//! parameters: {m: 2.5, a: 0.8, g: 9.81}
//! joints:
//!   - type: revolute
//!     dh: {theta: 0, d: 0, a: a, alpha: 0}
//!     link: {mass: m, com: [-a/2, 0, 0], inertia: {yy: m*a^2/12, zz: m*a^2/12}}
//! ";
//! let robot = read("pendulum.yaml", text.as_bytes())?;
//! let form = ClosedForm::of(&robot, 1);
//! assert!(form.text().contains("  τ1 = (1/3) m a² θ̈1 + (1/2) m g a sin θ1\n"));
//! let latex = form.latex("pendulum", rne_symbolic::LatexStyle::Body);
//! assert!(latex.contains(r"\tau_{1} &= \tfrac{1}{3}\,m\,a^{2}\,\ddot{\theta}_{1}"));
//! # Ok::<(), rne_model::Report>(())
//! ```
#![forbid(unsafe_code)]

mod collected;
mod derivation;
mod document;
mod equations;
mod factor;
mod lagrange;
mod latex;
mod letters;
mod lines;
mod notation;
mod parameters;
mod polynomial;
mod rational;
mod recursion;
mod symbol;
mod table;
#[cfg(test)]
mod tests;
mod text;
mod trigonometry;
mod vector;
mod written;

pub use crate::latex::LatexStyle;
pub use crate::parameters::read;

use rne_model::Robot;

use crate::collected::Sum;
use crate::derivation::{Derivation, TooLong};
use crate::equations::Equations;
use crate::table::Table;
use crate::written::Written;

/// Largest number of lines of text for one joint, with its torque in parts; a longer formula is not readable.
pub const MOST_LINES: usize = 60;

/// The equations of motion of an arm in letters or, if they are too long, its recursion in letters.
#[derive(Debug)]
pub struct ClosedForm {
    table: Table,
    /// Number of joints of the robot; the form may have only the first of them.
    dof: usize,
    /// The equations; `Err` if they are too long for a page.
    written: Result<(Equations, Written), TooLong>,
    /// Number of joints from the base whose closed form fits a page, if that of all does not.
    shorter: Option<usize>,
}

/// Largest number of joints with a form that fits a page, unless all joints are prismatic.
const MOST_JOINTS: usize = 4;

/// Derives the equations of an arm, if they are short enough and have only the angles of the table.
fn equations(table: &Table) -> Result<(Equations, Written), TooLong> {
    if table.oblique().is_some() {
        return Err(TooLong);
    }
    let equations = Equations::sorted(&Derivation::new(table, &[])?.torques());
    let written = Written::of(table, &equations)?;
    Ok((equations, written))
}

impl ClosedForm {
    /// Derives the closed form of the first `joints` joints of a robot, or of all joints if there are fewer. The links
    /// after them are removed with their masses. Numbers that depend on the run-time parameters of `robot` are formulas
    /// of these; [`read`] makes every possible parameter of a file a run-time parameter.
    #[must_use]
    pub fn of(robot: &Robot, joints: usize) -> Self {
        let table = Table::new(robot, joints);
        let written = equations(&table);
        let fits = |joints: &usize| equations(&Table::new(robot, *joints)).is_ok();
        let fewer = 1..table.rows.len().min(MOST_JOINTS + 1);
        let shorter = if written.is_ok() { None } else { fewer.rev().find(fits) };
        Self { dof: robot.dof(), table, written, shorter }
    }

    /// Number of joints in the form.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.table.rows.len()
    }

    /// The number of joints from the base whose closed form fits a page, if that of all does not.
    #[must_use]
    pub fn shorter(&self) -> Option<usize> {
        self.shorter
    }

    /// Whether the equations are short enough to be read; otherwise, the form is the recursion in letters.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.written.is_ok()
    }

    /// Whether the equations are identical, as polynomials, with those of Lagrange's method; `None` if there is no
    /// closed form, or if the derivation by Lagrange's method becomes too long.
    #[must_use]
    pub fn is_lagranges(&self) -> Option<bool> {
        let (equations, _) = self.written.as_ref().ok()?;
        let lagranges = lagrange::equations(&self.table).ok()?;
        Some(lagranges == *equations)
    }

    /// Evaluates the torques for joint variables q, rates and accelerations, with the values of the letters in the
    /// file. `None` if there is no closed form.
    #[must_use]
    pub fn torques(&self, q: &[f64], qd: &[f64], qdd: &[f64]) -> Option<Vec<f64>> {
        let (equations, _) = self.written.as_ref().ok()?;
        let torque = |joint| equations.torque(joint).evaluate(|symbol| self.table.value(symbol, q, qd, qdd));
        Some((0..self.joints()).map(torque).collect())
    }

    /// Returns the element M_ij, joints from 0, in one line; `None` if there is no closed form or no such element.
    #[must_use]
    pub fn mass(&self, i: usize, j: usize) -> Option<String> {
        self.one_line(|written| written.mass_matrix.get(i)?.get(j))
    }

    /// Returns the Christoffel symbol c_ijk, joints from 0, in one line: h_i = Σ c_ijk q̇_j q̇_k.
    #[must_use]
    pub fn christoffel(&self, i: usize, j: usize, k: usize) -> Option<String> {
        self.one_line(|written| written.christoffel.get(i)?.get(j)?.get(k))
    }

    /// Returns the gravity torque γ_i, joints from 0, in one line.
    #[must_use]
    pub fn gravity(&self, i: usize) -> Option<String> {
        self.one_line(|written| written.gravity.get(i))
    }

    /// Returns the torque τ_i, joints from 0, in one line: terms with accelerations, rates, then gravity.
    #[must_use]
    pub fn torque(&self, i: usize) -> Option<String> {
        self.one_line(|written| written.torques.get(i))
    }

    fn one_line(&self, of: impl Fn(&Written) -> Option<&Sum>) -> Option<String> {
        let (_, written) = self.written.as_ref().ok()?;
        of(written).map(|sum| written::one_line(&self.table, sum))
    }

    /// Returns the form as text in Unicode, in lines of at most 80 columns.
    #[must_use]
    pub fn text(&self) -> String {
        self.text_spelt(str::to_owned)
    }

    /// Returns the text with other spellings of letters, such as `theta1` for θ1: `spelling` converts each part of a
    /// line before lines are broken.
    #[must_use]
    pub fn text_spelt(&self, spelling: impl Fn(&str) -> String) -> String {
        text::text(self, spelling)
    }

    /// Returns the form in LaTeX with the package amsmath; `title` may be any text.
    #[must_use]
    pub fn latex(&self, title: &str, style: LatexStyle) -> String {
        latex::latex(self, title, style)
    }
}
