//! Functions of a C file for CasADi's external interface, with Jacobians and directional derivatives.
//!
//! `casadi.external("inverse_dynamics", "arm.so")` finds a function by its name, and its derivatives by theirs:
//! `jac_inverse_dynamics`, `fwd1_inverse_dynamics`, `adj1_inverse_dynamics`, and the second derivatives
//! `jac_adj1_inverse_dynamics`. The names, the order of inputs and outputs and the compressed columns are those of the
//! code that CasADi 3.6 to 3.8 generates.

use rne_codegen::{ArgumentArray, Function, Layout, Program, Value};

use super::casadi_derivatives::Derivatives;
use super::casadi_interface::{Bodies, Interface};
use super::signature::{inputs, wrapped};
use super::{File, Prefix};
use crate::parameters;

/// The code that all functions share; PREFIX, DOF and LONGEST are replaced.
const INTERFACE: &str = include_str!("casadi.c");

/// The operations on matrices that the derivatives need.
const MATRICES: &str = include_str!("casadi_matrices.c");

/// The bodies of the functions for acados, in the order of [`Writer::of_acados`].
const ACADOS: &str = include_str!("acados.c");

/// Returns the program of the second derivatives of weighted torques, if the file has it.
pub(super) fn hessian<'a>(file: &File<'a>) -> Option<&'a Program> {
    file.programs.iter().find(|program| program.function == Function::TorqueHessian)
}

/// Whether CasADi can call a program: all its arguments must be vectors, and it must return a number, a vector, a
/// matrix, or the state after a step.
#[must_use]
pub fn is_for_casadi(program: &Program) -> bool {
    let are_vectors = || inputs(program).iter().all(|array| array.lengths().len() == 1);
    let is_shaped = program.function == Function::EulerStep || are_vectors() && shape(&program.layout()).is_some();
    is_shaped && !parameters::are_used(program)
}

/// Returns a name that both a function for CasADi and a function of C with this prefix would have, if there is one:
/// this happens if a robot is called `jac`, for example.
#[must_use]
pub fn casadi_collision(programs: &[Program], prefix: &Prefix) -> Option<String> {
    let of_casadi: Vec<String> = programs
        .iter()
        .flat_map(|program| ["", "jac_", "fwd1_", "adj1_", "jac_adj1_"].map(|of| format!("{of}{}", program.name)))
        .collect();
    programs.iter().map(|program| format!("{prefix}_{}", program.name)).find(|name| of_casadi.contains(name))
}

/// Returns the number of rows and columns of a result; `None` if it is no number, vector or matrix.
fn shape(layout: &Layout) -> Option<(usize, usize)> {
    match layout {
        Layout::Number => Some((1, 1)),
        Layout::Array(rows, of) => match &**of {
            Layout::Number => Some((*rows, 1)),
            Layout::Array(columns, of) if **of == Layout::Number => Some((*rows, *columns)),
            _ => None,
        },
        Layout::Record(..) => None,
    }
}

/// Whether an element of a matrix can differ from zero. The matrix begins after the first `skipped` outputs and is
/// stored row by row.
pub(super) fn is_there(program: &Program, skipped: usize, row: usize, column: usize) -> bool {
    program.values.get(program.outputs[skipped + row * program.dof + column].value) != Value::Constant(0.0)
}

/// Writes the functions for CasADi.
pub(super) fn definitions(file: &File) -> String {
    if !file.additions.casadi {
        return String::new();
    }
    let mut writer = Writer { file, patterns: Vec::new() };
    let programs: Vec<&Program> = file.programs.iter().filter(|program| is_for_casadi(program)).collect();
    let mut interfaces: Vec<Interface> = programs.iter().flat_map(|program| writer.interfaces(program)).collect();
    if file.additions.acados {
        interfaces.extend(writer.of_acados());
    }
    let derived: Vec<Derivatives> = programs.iter().filter_map(|program| writer.sources(program)).collect();
    let longest = programs.iter().flat_map(|program| inputs(program)).map(|array| array.elements.len()).max();

    let mut text = "\n".to_owned();
    let interface = INTERFACE.replace("LONGEST", &longest.unwrap_or(1).to_string());
    text.push_str(&writer.filled(&interface));
    if !derived.is_empty() {
        text.push_str(&writer.filled(MATRICES));
    }
    if derived.iter().any(|derivatives| derivatives.gradient.is_none()) {
        text.push_str(&writer.helper_of_motion());
    }
    let is_step = |derivatives: &Derivatives| derivatives.sources.iter().all(|source| source.blocks.is_empty());
    if derived.iter().any(is_step) {
        text.push_str(&writer.helper_of_step());
    }
    text.push_str("\n// rows, columns; then 1 if all elements are there, else starts of the columns and the rows\n");
    for (index, pattern) in writer.patterns.iter().enumerate() {
        let numbers: Vec<String> = pattern.iter().map(ToString::to_string).collect();
        let start = format!("static const casadi_int {}_pattern_{index}[] = {{", file.prefix);
        text.push_str(wrapped(&start, &numbers).trim_end_matches(')'));
        text.push_str("};\n");
    }
    for interface in &interfaces {
        text.push_str(&writer.definition(interface));
    }
    text.push_str("\n#ifdef __cplusplus\n}\n#endif\n");
    text
}

pub(super) struct Writer<'a> {
    pub(super) file: &'a File<'a>,
    /// The sparsity patterns, as compressed columns, without duplicates.
    pub(super) patterns: Vec<Vec<usize>>,
}

impl Writer<'_> {
    /// Replaces the placeholders in a text by the numbers and names of the file. The prefix is replaced last, because
    /// it may contain a placeholder.
    pub(super) fn filled(&self, text: &str) -> String {
        text.replace("DOF", &self.file.robot.dof().to_string()).replace("PREFIX", self.file.prefix)
    }

    /// Returns the name of a sparsity pattern in the code.
    pub(super) fn pattern(&mut self, pattern: Vec<usize>) -> String {
        let index = self.patterns.iter().position(|other| *other == pattern).unwrap_or_else(|| {
            self.patterns.push(pattern);
            self.patterns.len() - 1
        });
        self.pattern_name(index)
    }

    pub(super) fn pattern_name(&self, index: usize) -> String {
        format!("{}_pattern_{index}", self.file.prefix)
    }

    pub(super) fn dense(&mut self, rows: usize, columns: usize) -> String {
        self.pattern(vec![rows, columns, 1])
    }

    /// Returns the pattern of a square matrix of zeros.
    pub(super) fn nothing(&mut self) -> String {
        let dof = self.file.robot.dof();
        self.pattern([vec![dof, dof], vec![0; dof + 1]].concat())
    }

    /// Returns the pattern of a square matrix with the elements for which `is_there` is true.
    pub(super) fn square(&mut self, size: usize, is_there: impl Fn(usize, usize) -> bool) -> String {
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for column in 0..size {
            rows.extend((0..size).filter(|&row| is_there(row, column)));
            starts.push(rows.len());
        }
        if rows.len() == size * size {
            return self.dense(size, size);
        }
        self.pattern([vec![size, size], starts, rows].concat())
    }

    pub(super) fn find(&self, function: Function) -> Option<&Program> {
        self.file.programs.iter().find(|program| program.function == function)
    }

    /// Returns a function, and its derivatives if it has any.
    fn interfaces(&mut self, program: &Program) -> Vec<Interface> {
        let arrays = inputs(program);
        let given: Vec<(String, String)> =
            arrays.iter().map(|array| (array.name.to_owned(), self.dense(array.elements.len(), 1))).collect();
        if program.function == Function::EulerStep {
            return self.of_step(program, &given);
        }
        let Some((rows, columns)) = shape(&program.layout()) else { return Vec::new() };
        let result = match program.function {
            Function::ForwardDynamics => "qdd",
            function if function.returns_torques() => "tau",
            function => match function.entry().output {
                "" => function.name(),
                output => output,
            },
        };
        let returned = (result.to_owned(), self.dense(rows, columns));
        let value = self.value(program, &arrays, columns);
        let Some(derivatives) = self.sources(program) else {
            return vec![Interface { name: program.name.clone(), inputs: given, outputs: vec![returned], body: value }];
        };
        let blocks = self.blocks(&derivatives, false);
        let bodies = Bodies {
            value,
            jacobian: self.jacobian(&arrays, &derivatives, &blocks),
            forward: self.forward(&arrays, &derivatives),
            reverse: self.reverse(&arrays, &derivatives),
        };
        let [value, jacobian, forward, reverse] = self.family(&program.name, &given, &[returned], &blocks, bodies);
        let second = match derivatives.gradient {
            Some(_) => self.second(&reverse, &arrays, &derivatives),
            None => self.second_of_motion(&reverse),
        };
        [value, jacobian, forward, reverse].into_iter().chain(second).collect()
    }

    /// Returns the functions of an explicit differential equation in the form that acados generates with CasADi: x =
    /// (q, qd), u = tau, and no parameters p. Sx and Su are the derivatives of x with respect to the initial state and
    /// to u, as matrices by columns. The Hessian is that of λᵀ ẋ with respect to the initial state and u; its lower
    /// triangle is stored column by column.
    fn of_acados(&mut self) -> Vec<Interface> {
        let (prefix, dof) = (self.file.prefix, self.file.robot.dof());
        let functions: [(&str, &[&str], &[&str]); 4] = [
            ("expl_ode_fun", &["x", "u", "p"], &["xdot"]),
            ("expl_vde_forw", &["x", "Sx", "Su", "u", "p"], &["xdot", "Sxdot", "Sudot"]),
            ("expl_vde_adj", &["x", "lambda", "u", "p"], &["adj"]),
            ("expl_ode_hess", &["x", "Sx", "Su", "lambda", "u", "p"], &["adj", "hess"]),
        ];
        let bodies = ACADOS.split("// next function\n");
        let bodies: Vec<String> = bodies.map(|body| self.filled(body)).collect();
        let mut named = |names: &[&str]| -> Vec<(String, String)> {
            let pattern = |name: &str| match name {
                "Sx" | "Sxdot" => vec![2 * dof, 2 * dof, 1],
                "Su" | "Sudot" => vec![2 * dof, dof, 1],
                "u" => vec![dof, 1, 1],
                "p" => vec![0, 0, 0],
                "adj" => vec![3 * dof, 1, 1],
                "hess" => vec![3 * dof * (3 * dof + 1) / 2, 1, 1],
                _ => vec![2 * dof, 1, 1],
            };
            names.iter().map(|&name| (name.to_owned(), self.pattern(pattern(name)))).collect()
        };
        let interface = |((name, inputs, outputs), body): ((&str, &[&str], &[&str]), String)| Interface {
            name: format!("{prefix}_{name}"),
            inputs: named(inputs),
            outputs: named(outputs),
            body,
        };
        functions.into_iter().zip(bodies).map(interface).collect()
    }

    /// Returns a call of a function of the file; an argument for which the CasADi function has no input is zero.
    pub(super) fn call(&self, function: Function, arrays: &[ArgumentArray], last: &[String]) -> String {
        let prefix = self.file.prefix;
        let Some(program) = self.find(function) else { return String::new() };
        let input = |name: &str| match arrays.iter().position(|array| array.name == name) {
            Some(index) => format!("{prefix}_given(arg[{index}])"),
            None if name == "multipliers" => format!("{prefix}_given(arg[{}])", arrays.len() + 1),
            None => format!("{prefix}_zeros"),
        };
        let arguments: Vec<String> = inputs(program).iter().map(|array| input(array.name)).collect();
        format!("{prefix}_{}({})", program.name, [arguments, last.to_vec()].concat().join(", "))
    }

    fn value(&self, program: &Program, arrays: &[ArgumentArray], columns: usize) -> String {
        // in C, a function at a frame has a name of its own; only in Rust's trait it has the name of the function
        let prefix = self.file.prefix;
        let mut arguments: Vec<String> =
            (0..arrays.len()).map(|index| format!("{prefix}_given(arg[{index}])")).collect();
        let call = |arguments: &[String]| format!("{prefix}_{}({})", program.name, arguments.join(", "));
        let Layout::Array(rows, _) = program.layout() else {
            return format!("    if (res[0]) {{\n        *res[0] = {};\n    }}\n", call(&arguments));
        };
        if columns == 1 && !matches!(program.layout(), Layout::Array(_, of) if *of != Layout::Number) {
            arguments.push("res[0]".to_owned());
            return format!("    if (res[0]) {{\n        {};\n    }}\n", call(&arguments));
        }
        arguments.push("matrix".to_owned());
        let call = call(&arguments);
        format!(
            "    if (res[0]) {{\n        casadi_real matrix[{rows}][{columns}];\n        {call};\n        \
             for (int column = 0; column < {columns}; column++) {{\n            \
             for (int row = 0; row < {rows}; row++) {{\n                \
             res[0][column * {rows} + row] = matrix[row][column];\n            }}\n        }}\n    }}\n"
        )
    }
}
