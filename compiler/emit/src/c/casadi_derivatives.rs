//! Derivatives of functions for CasADi: from which functions they are computed, and the code that computes them.

use std::fmt::Write;

use rne_codegen::{ArgumentArray, Function, Layout, Program};

use super::casadi::{Writer, hessian, is_there};
use super::casadi_interface::Interface;
use super::signature::{record_type, wrapped};

/// Matrices that one call of a function of the file returns. Each has the field of the result, and the number of the
/// CasADi input with respect to which it is the derivative. `blocks` is empty if the derivatives are combined from
/// several functions.
pub(super) struct Source {
    function: Function,
    pub(super) blocks: &'static [(&'static str, usize)],
}

/// The derivatives of a function with respect to all of its inputs.
pub(super) struct Derivatives {
    pub(super) sources: &'static [Source],
    /// The function that returns the product of a row of multipliers with these derivatives, and the fields of its
    /// result.
    pub(super) gradient: Option<(Function, &'static [&'static str])>,
}

/// Returns the functions from which the derivatives of `function` for CasADi are computed; none if it has no
/// derivatives.
#[must_use]
pub fn casadi_derivatives(function: Function) -> Vec<Function> {
    let derivatives = derivatives(function);
    let of_derivatives = |derivatives: Derivatives| {
        let sources = derivatives.sources.iter().map(|source| source.function);
        let gradient = derivatives.gradient.into_iter().flat_map(|(function, _)| [function, Function::TorqueHessian]);
        sources.chain(gradient).collect()
    };
    derivatives.map(of_derivatives).unwrap_or_default()
}

fn derivatives(function: Function) -> Option<Derivatives> {
    const fn source(blocks: &'static [(&'static str, usize)]) -> Source {
        Source { function: Function::InverseDynamicsDerivatives, blocks }
    }
    const MASS: Source = Source { function: Function::MassMatrix, blocks: &[("", 2)] };
    const OF_MOTION: Source =
        Source { function: Function::ForwardDynamicsDerivatives, blocks: &[("dq", 0), ("dqd", 1), ("dtau", 2)] };
    const fn part(function: Function) -> Source {
        Source { function, blocks: &[] }
    }
    const OF_STEP: [Source; 3] =
        [part(Function::ForwardDynamics), part(Function::ForwardDynamicsDerivatives), part(Function::TorqueHessian)];
    let (sources, fields): (&'static [Source], &'static [&'static str]) = match function {
        Function::InverseDynamics => (&const { [source(&[("dq", 0), ("dqd", 1)]), MASS] }, &["dq", "dqd", "dqdd"]),
        Function::BiasTorques => (&const { [source(&[("dq", 0), ("dqd", 1)])] }, &["dq", "dqd"]),
        Function::GravityTorques => (&const { [source(&[("dq", 0)])] }, &["dq"]),
        Function::ForwardDynamics => (&const { [OF_MOTION, part(Function::TorqueHessian)] }, &[]),
        Function::EulerStep => (&OF_STEP, &[]),
        _ => return None,
    };
    let gradient = (!fields.is_empty()).then_some((Function::TorqueGradient, fields));
    Some(Derivatives { sources, gradient })
}

impl Writer<'_> {
    /// Returns the derivatives of a program, if the file has all functions from which they are computed.
    pub(super) fn sources(&self, program: &Program) -> Option<Derivatives> {
        let needed = casadi_derivatives(program.function);
        derivatives(program.function).filter(|_| needed.iter().all(|function| self.find(*function).is_some()))
    }

    /// Returns the patterns of the derivatives with respect to each input, or those of their transposes.
    pub(super) fn blocks(&mut self, derivatives: &Derivatives, is_transposed: bool) -> Vec<String> {
        let mut blocks = Vec::new();
        for source in derivatives.sources {
            for (place, _) in source.blocks.iter().enumerate() {
                let Some(program) = self.file.programs.iter().find(|program| program.function == source.function)
                else {
                    continue;
                };
                blocks.push(self.block(program, place * program.dof * program.dof, is_transposed));
            }
        }
        blocks
    }

    /// Returns the pattern of a square matrix of a program, or of its transpose. The matrix begins after the first
    /// `skipped` outputs and is stored row by row.
    fn block(&mut self, program: &Program, skipped: usize, is_transposed: bool) -> String {
        self.square(program.dof, |row, column| {
            let (row, column) = if is_transposed { (column, row) } else { (row, column) };
            is_there(program, skipped, row, column)
        })
    }

    /// Returns code that calls each function and executes `statement` for each of its matrices, if `condition` is true
    /// for one of its inputs.
    fn with_matrices(
        &self,
        arrays: &[ArgumentArray],
        derivatives: &Derivatives,
        condition: impl Fn(usize) -> String,
        statement: impl Fn(usize, &str) -> String,
    ) -> String {
        let mut text = String::new();
        for source in derivatives.sources.iter().filter(|source| !source.blocks.is_empty()) {
            let Some(program) = self.find(source.function) else { continue };
            let mut conditions: Vec<String> = source.blocks.iter().map(|&(_, input)| condition(input)).collect();
            conditions.dedup();
            let (declaration, place) = match program.layout() {
                Layout::Record(record, _) => (format!("{} by", record_type(self.file, record)), "&by"),
                _ => (format!("casadi_real by[{0}][{0}]", program.dof), "by"),
            };
            let call = self.call(source.function, arrays, &[place.to_owned()]);
            let _ = writeln!(text, "    if ({}) {{", conditions.join(" || "));
            let _ = writeln!(text, "        {declaration};\n        {call};");
            for &(field, input) in source.blocks {
                let matrix = if field.is_empty() { "by".to_owned() } else { format!("by.{field}") };
                let _ = writeln!(text, "        {};", statement(input, &matrix));
            }
            text.push_str("    }\n");
        }
        text
    }

    pub(super) fn jacobian(&self, arrays: &[ArgumentArray], derivatives: &Derivatives, blocks: &[String]) -> String {
        let prefix = self.file.prefix;
        let put = |input: usize, matrix: &str| format!("{prefix}_put({matrix}, {}, res[{input}])", blocks[input]);
        self.with_matrices(arrays, derivatives, |input| format!("res[{input}]"), put)
    }

    pub(super) fn forward(&self, arrays: &[ArgumentArray], derivatives: &Derivatives) -> String {
        let (prefix, first) = (self.file.prefix, arrays.len() + 1);
        let add = |input: usize, matrix: &str| format!("{prefix}_add({matrix}, arg[{}], res[0])", first + input);
        let sums = self.with_matrices(arrays, derivatives, |input| format!("arg[{}]", first + input), add);
        format!("    if (!res[0]) {{\n        return 0;\n    }}\n    {prefix}_copy({prefix}_zeros, res[0]);\n{sums}")
    }

    pub(super) fn reverse(&self, arrays: &[ArgumentArray], derivatives: &Derivatives) -> String {
        let (prefix, last) = (self.file.prefix, arrays.len() + 1);
        let Some((gradient, fields)) = derivatives.gradient else {
            let product = |input: usize, matrix: &str| {
                format!("{prefix}_multiply_row({prefix}_given(arg[{last}]), {matrix}, res[{input}])")
            };
            return self.with_matrices(arrays, derivatives, |input| format!("res[{input}]"), product);
        };
        let Some(Layout::Record(record, _)) = self.find(gradient).map(Program::layout) else { return String::new() };
        let call = self.call(gradient, arrays, &["&by".to_owned()]);
        let mut text = format!("    {} by;\n    {call};\n", record_type(self.file, record));
        for (index, field) in fields.iter().enumerate() {
            let _ = writeln!(text, "    {prefix}_copy(by.{field}, res[{index}]);");
        }
        text
    }

    /// Returns the Jacobian of the reverse derivatives with respect to all of their inputs, if the file has the
    /// Hessian.
    pub(super) fn second(
        &mut self,
        reverse: &Interface,
        arrays: &[ArgumentArray],
        derivatives: &Derivatives,
    ) -> Option<Interface> {
        let (prefix, dof, count) = (self.file.prefix, self.file.robot.dof(), arrays.len());
        let hessian = hessian(self.file)?;
        let Layout::Record(record, _) = hessian.layout() else { return None };
        let call = self.call(Function::TorqueHessian, arrays, &["&by".to_owned()]);
        let columns = count + 2;
        // block rows and columns for q, q̇ and q̈; a function with fewer arguments uses the first ones only
        let places = [(0, 0, 0, false), (0, 1, 1, false), (0, 2, 3, false)];
        let places = [&places[..], &[(1, 0, 1, true), (1, 1, 2, false), (2, 0, 3, true)]].concat();
        let places: Vec<_> = places.into_iter().filter(|(row, column, ..)| (*row).max(*column) < count).collect();
        let patterns: Vec<String> = places
            .iter()
            .map(|&(.., block, is_transposed)| self.block(hessian, block * dof * dof, is_transposed))
            .collect();
        let mut body = String::new();
        let wanted: Vec<_> =
            places.iter().map(|(row, column, ..)| format!("res[{}]", row * columns + column)).collect();
        let condition = wrapped("    if (", &[wanted.join(" || ")]);
        let _ = writeln!(body, "{} {{", condition.trim_end());
        let _ = writeln!(body, "        {} by;\n        {call};", record_type(self.file, record));
        for ((&(.., block, is_transposed), pattern), result) in places.iter().zip(&patterns).zip(&wanted) {
            let (put, field) = (if is_transposed { "put_transposed" } else { "put" }, record.fields()[block]);
            let _ = writeln!(body, "        {prefix}_{put}(by.{field}, {pattern}, {result});");
        }
        body.push_str("    }\n");
        let of_torques = self.blocks(derivatives, true);
        let place = |input: usize| format!("res[{}]", input * columns + count + 1);
        let put = |input: usize, matrix: &str| {
            format!("{prefix}_put_transposed({matrix}, {}, {})", of_torques[input], place(input))
        };
        body.push_str(&self.with_matrices(arrays, derivatives, place, put));
        let nothing = self.nothing();
        let block = |(row, column): (usize, usize)| {
            let place = places.iter().position(|&(i, j, ..)| (i, j) == (row, column));
            let of_multipliers = (column == count + 1).then(|| of_torques[row].clone());
            place.map(|place| patterns[place].clone()).or(of_multipliers).unwrap_or_else(|| nothing.clone())
        };
        let blocks: Vec<_> =
            (0..count).flat_map(|row| (0..columns).map(move |column| (row, column))).map(block).collect();
        Some(self.jacobian_of(reverse, &blocks, body))
    }
}
