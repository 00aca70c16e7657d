//! The equations of motion, collected for reading.

use rne_model::JointKind;

use crate::MOST_LINES;
use crate::collected::{Collector, Sum};
use crate::derivation::TooLong;
use crate::equations::Equations;
use crate::factor::Factor;
use crate::lines::Pieces;
use crate::notation::{Notation, Script};
use crate::polynomial::Polynomial;
use crate::table::Table;

/// Largest number of columns of a line.
pub(crate) const COLUMNS: usize = 80;

/// Largest number of terms of a torque before collecting; the written form is shorter.
pub(crate) const MOST_TERMS: usize = 400;

/// The polynomials of [`Equations`] with collected terms.
#[derive(Debug)]
pub(crate) struct Written {
    pub(crate) torques: Vec<Sum>,
    pub(crate) mass_matrix: Vec<Vec<Sum>>,
    pub(crate) christoffel: Vec<Vec<Vec<Sum>>>,
    pub(crate) gravity: Vec<Sum>,
}

impl Written {
    pub(crate) fn of(table: &Table, equations: &Equations) -> Result<Self, TooLong> {
        let terms = |polynomial: &Polynomial| polynomial.terms().map_or(usize::MAX, std::collections::BTreeMap::len);
        let dof = table.rows.len();
        if (0..dof).any(|i| terms(&equations.torque(i)) > MOST_TERMS) {
            return Err(TooLong);
        }
        let kinds = kinds(table);
        let notation = Notation { script: Script::Unicode, constants: &table.constants, kinds: &kinds };
        let mut collector = Collector::new(&table.constants);
        let mut collected = |polynomial: &Polynomial| collector.collected(polynomial).ok_or(TooLong);
        let mut written =
            Self { torques: Vec::new(), mass_matrix: Vec::new(), christoffel: Vec::new(), gravity: Vec::new() };
        for i in 0..dof {
            let masses = equations.mass_matrix[i].iter().map(&mut collected).collect::<Result<Vec<_>, _>>()?;
            let mut symbols = Vec::new();
            for row in &equations.christoffel[i] {
                symbols.push(row.iter().map(&mut collected).collect::<Result<Vec<_>, _>>()?);
            }
            let gravity = collected(&equations.gravity[i])?;
            let upper = symbols.iter().enumerate().flat_map(|(j, row)| &row[j..]);
            let parts = masses[i..].iter().chain(upper).chain([&gravity]).filter(|sum| !sum.is_zero());
            let lines = parts.map(|sum| Pieces::of(sum, &notation).lines(10, 6, COLUMNS).len()).sum::<usize>();
            if lines > MOST_LINES {
                return Err(TooLong);
            }
            let accelerations = masses.iter().enumerate().flat_map(|(j, sum)| sum.times(Factor::Acceleration(j)));
            let velocity = collected(&equations.velocity_torque(i))?;
            written.torques.push(Sum(accelerations.chain(velocity.0).chain(gravity.0.clone()).collect()));
            written.mass_matrix.push(masses);
            written.christoffel.push(symbols);
            written.gravity.push(gravity);
        }
        Ok(written)
    }
}

/// Returns the kinds of the joints.
pub(crate) fn kinds(table: &Table) -> Vec<JointKind> {
    table.rows.iter().map(|row| row.kind).collect()
}

/// Writes a sum in one line of Unicode.
pub(crate) fn one_line(table: &Table, sum: &Sum) -> String {
    let kinds = kinds(table);
    let notation = Notation { script: Script::Unicode, constants: &table.constants, kinds: &kinds };
    let lines = Pieces::of(sum, &notation).lines(0, 0, usize::MAX);
    lines.into_iter().next().map_or_else(String::new, |(_, line)| line)
}

/// Writes a polynomial in one line of Unicode, with the letters of a table; empty if it is too long.
pub(crate) fn polynomial(table: &Table, polynomial: &Polynomial) -> String {
    Collector::new(&table.constants).collected(polynomial).map_or_else(String::new, |sum| one_line(table, &sum))
}
