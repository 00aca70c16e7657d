//! Tests of emitted C: a program for the end of its source, inside `#ifdef RNE_TEST`.

use std::fmt::Write;

use rne_codegen::{Function, Layout, Program};
use rne_model::Robot;

use super::{Call, Golden, Law, filled, floor, program, results};
use crate::Precision;
use crate::c::runge_kutta::STEPS;
use crate::c::{
    Additions, JointFriction, Prefix, array_name, element_type, elements_of, inputs, layout_elements, result_elements,
};
use crate::parameters::{self};
use crate::wrap::{WIDTH, fill};

/// The line with which the tests begin.
const GUARD: &str = "\n#ifdef RNE_TEST\n";

/// Returns a source of C without its tests.
#[must_use]
pub fn without_c_tests(source: &str) -> &str {
    source.split_once(GUARD).map_or(source, |(code, _)| code)
}

/// Returns a function `main` for the end of a source of [`c_code`](crate::c_code), inside `#ifdef RNE_TEST`: it
/// compares the results of the programs at the given states with expected values, and tests laws of mechanics. It
/// prints all errors, and returns 0 if there are none. The numbers of the states are of the number type.
#[must_use]
pub fn c_tests(
    robot: &Robot,
    programs: &[Program],
    precision: Precision,
    prefix: &Prefix,
    golden: &[Golden],
    additions: &Additions<'_>,
) -> String {
    let tests = Tests { robot, programs, precision, prefix: prefix.as_str(), golden };
    let mut functions: Vec<(String, String)> = (0..programs.len()).filter_map(|index| tests.values(index)).collect();
    functions.extend(Law::of(programs).filter_map(|law| tests.law(law)));
    functions.extend(additions.friction.into_iter().flat_map(|frictions| tests.friction(frictions)));
    functions.extend(additions.limits.then(|| tests.limits()));
    let is_there = |at: &usize| additions.runge_kutta && (*at == 0 || tests.has(Function::ForwardDynamicsDerivatives));
    functions.extend((0..2).filter(is_there).filter_map(|at| tests.step(at, STEPS[at])));
    let (mut bodies, mut calls) = (String::new(), String::new());
    for (name, body) in &functions {
        let _ = write!(bodies, "\n{body}");
        let _ = writeln!(calls, "    {name}();");
    }
    let (upper, states) = (tests.prefix.to_ascii_uppercase(), tests.states(&bodies));
    let real = precision.c_type();
    let zeros = if bodies.contains("test_zero") {
        let zero = precision.literal(0.0).unwrap_or_default();
        format!("static const {real} test_zero[{upper}_DOF] = {{{zero}}};\n")
    } else {
        String::new()
    };
    // a helper that no test calls is left out, because compilers warn about it
    let helpers = [
        ("test_largest(", largest(real)),
        ("test_compare(", COMPARE.to_owned()),
        ("test_tolerance", format!("static const double test_tolerance = {};\n", tests.tolerance())),
    ];
    let helpers: String =
        helpers.iter().filter(|(name, _)| bodies.contains(name)).map(|(_, text)| text.as_str()).collect();
    let tests_are = match functions.len() {
        0 => "0 tests, as no state has results to compare".to_owned(),
        1 => "1 test".to_owned(),
        several => format!("{several} tests"),
    };
    format!(
        "{GUARD}\n\
         // A program that tests this code: with -DRNE_TEST it compiles alone, and returns 0 where all is well.\n\
         // Values are those of the runtime library of rne, which shares no code with this file; laws are those of\n\
         // mechanics.\n\n\
         #include <stdio.h>\n\n{states}{zeros}\nstatic unsigned test_failures = 0u;\n\n\
         {helpers}{bodies}\n\
         int main(void)\n{{\n{calls}    \
         printf(\"{tests_are}, %u wrong numbers\\n\", test_failures);\n    \
         return (test_failures == 0u) ? 0 : 1;\n}}\n\n#endif\n"
    )
}

/// Returns a function of C that finds the largest magnitude among numbers of a type.
fn largest(real: &str) -> String {
    format!(
        "static double test_largest(const {real} *numbers, unsigned count, double largest)\n{{\n    \
         unsigned i;\n    for (i = 0u; i < count; ++i) {{\n        \
         const double x = (double)numbers[i];\n        \
         largest = (x > largest) ? x : ((-x > largest) ? -x : largest);\n    }}\n    return largest;\n}}\n\n"
    )
}

/// A function of C that compares a number with the expected one.
const COMPARE: &str = "\
// Compares a number with the expected one: the difference may be `allowed` at most. NaN is always wrong.
static void test_compare(const char *what, unsigned state, unsigned number, double found, double expected,
    double allowed)
{
    const double error = found - expected;
    if (!((error <= allowed) && (-error <= allowed))) {
        printf(\"%s, state %u, number %u: %.17g, not %.17g\\n\", what, state, number, found, expected);
        ++test_failures;
    }
}

";

/// The body of the test of each law except the last.
const LAWS: &str = include_str!("c_laws.txt");

struct Tests<'a> {
    robot: &'a Robot,
    programs: &'a [Program],
    precision: Precision,
    prefix: &'a str,
    golden: &'a [Golden],
}

impl Tests<'_> {
    /// Returns the tolerance for the rounding errors of the number type, of its constants, and of sums of hundreds of
    /// terms.
    const fn tolerance(&self) -> &'static str {
        match self.precision {
            Precision::Single => "1e-4",
            Precision::Double => "1e-9",
        }
    }

    fn numbers(&self, numbers: &[f64]) -> String {
        // a number that is too large for the type is written as infinity, so that the test fails
        let numbers = numbers.iter().map(|&number| self.precision.literal(number).unwrap_or("(1.0f / 0.0f)".into()));
        numbers.collect::<Vec<_>>().join(", ")
    }

    /// Returns a table with one line per state.
    fn table(&self, start: &str, rows: &[&[f64]]) -> String {
        let mut text = format!("{start} = {{\n");
        for row in rows {
            let line = format!("{{{}}},", self.numbers(row));
            let _ = writeln!(text, "{}", fill(&line, WIDTH, "    ", "     "));
        }
        text + "};\n"
    }

    /// Returns those arguments at all states that occur in the text `tests`.
    fn states(&self, tests: &str) -> String {
        let real = self.precision.c_type();
        let Some(first) = self.golden.first() else { return String::new() };
        let mut text = String::new();
        for (name, numbers) in &first.arguments {
            let (array, count) = (array(name), numbers.len());
            if !tests.contains(&format!("{array}[")) {
                continue;
            }
            let rows: Vec<&[f64]> = self.golden.iter().map(|state| state.argument(name)).collect();
            let kind = match *name {
                "parameters" => format!("static const {}_parameters {array}[{}]", self.prefix, rows.len()),
                _ => format!("static const {real} {array}[{}][{count}]", rows.len()),
            };
            text.push_str(&self.table(&kind, &rows));
        }
        text
    }

    /// Returns statements that call a function at a state and store the numbers of its result in an array `name`.
    /// `others` replaces some arguments by other expressions.
    fn call(&self, program: &Program, others: &[(&str, &str)], name: &str) -> String {
        let real = self.precision.c_type();
        let mut given: Vec<String> = inputs(program)
            .iter()
            .map(|input| {
                let other = others.iter().find(|(name, _)| *name == input.name);
                let rows = input.row.map_or_else(String::new, |row| format!("(const {real} (*)[{row}])"));
                let only = if input.is_number { "[0]" } else { "" };
                let given = || format!("{rows}{}[state]{only}", array(input.name));
                other.map_or_else(given, |(_, other)| (*other).to_owned())
            })
            .collect();
        if parameters::are_used(program) {
            given.push(format!("&{}[state]", array("parameters")));
        }
        let (given, function, prefix) = (given.join(", "), &program.name, self.prefix);
        let layout = program.layout();
        let elements = result_elements(program, "result");
        let count = elements.len();
        if layout == Layout::Number {
            return format!("        const {real} {name}[1] = {{{prefix}_{function}({given})}};\n");
        }
        let (declared, address) = self.declared(program, "result");
        let mut copies = String::new();
        for (index, element) in elements.iter().enumerate() {
            let _ = writeln!(copies, "            {name}[{index}] = {element};");
        }
        format!(
            "        {real} {name}[{count}];\n        {{\n            {declared};\n            \
             {prefix}_{function}({given}, {address});\n{copies}        }}\n"
        )
    }

    /// Returns a call of the program of a function; `None` if the file does not have it.
    fn call_of(&self, function: Function, others: &[(&str, &str)], name: &str) -> Option<String> {
        Some(self.call(program(self.programs, function)?, others, name))
    }

    /// Returns the declaration of a variable for the result of a function, and the expression that passes it.
    fn declared(&self, program: &Program, name: &str) -> (String, String) {
        let layout = program.layout();
        let (lengths, of) = elements_of(&layout);
        let kind = element_type(self.prefix, self.precision, of);
        let address = if lengths.is_empty() { format!("&{name}") } else { name.to_owned() };
        (format!("{kind} {name}{lengths}"), address)
    }

    /// Returns the function that compares a program with expected values: its name and its text.
    fn values(&self, index: usize) -> Option<(String, String)> {
        let (program, expected) = (self.programs.get(index)?, results(self.golden, index)?);
        let (real, function, count) = (self.precision.c_type(), program.function, expected.first()?.len());
        // the closer the mass matrix is to a singular one, the larger are the errors of accelerations
        let parts = if function.divides().is_some() && self.precision == Precision::Single {
            "100.0 * test_tolerance"
        } else {
            "test_tolerance"
        };
        let table = self.table(&format!("    static const {real} expected[{}][{count}]", expected.len()), &expected);
        let name = format!("test_{}", program.name);
        let text = format!(
            "static void {name}(void)\n{{\n{}    unsigned state;\n    \
             const double scale = test_largest(&expected[0][0], {}u, {:?});\n    \
             for (state = 0u; state < {}u; ++state) {{\n        unsigned i;\n{}        \
             for (i = 0u; i < {count}u; ++i) {{\n            \
             test_compare(\"{function}\", state, i, (double)found[i], (double)expected[state][i], \
             {parts} * scale);\n        \
             }}\n    }}\n}}\n",
            table.replace("\n};", "\n    };"),
            count * expected.len(),
            floor(self.golden, index, if self.precision == Precision::Single { 1e-2 } else { 1e-4 }),
            expected.len(),
            self.call(program, &[], "found"),
        );
        Some((name, text))
    }

    /// Returns the functions that compare friction and its derivatives with their formulas in double precision, at the
    /// speeds of the states.
    fn friction(&self, frictions: &[JointFriction]) -> [(String, String); 2] {
        let speeds: Vec<&[f64]> = self.golden.iter().map(|state| state.argument("qd")).collect();
        let laws = [
            ("friction_torques", JointFriction::torque as fn(&_, _) -> _),
            ("friction_derivatives", JointFriction::derivative),
        ];
        laws.map(|(function, law)| {
            let of_state = |qd: &&[f64]| frictions.iter().zip(*qd).map(|(of_joint, qd)| law(of_joint, *qd)).collect();
            let expected: Vec<Vec<f64>> = speeds.iter().map(of_state).collect();
            let largest = expected.iter().flatten().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            let compared = format!("{}_{function}(test_qd[state], found);", self.prefix);
            self.joints(function, &compared, "", &expected, &format!("test_tolerance * {largest:?}"))
        })
    }

    /// Returns the function that compares limited torques: above, below and within the limits of each joint.
    fn limits(&self) -> (String, String) {
        let efforts = || self.robot.independent_joints().map(|joint| joint.limits.effort);
        let parts = [2.0, -2.0, 0.5];
        let given: Vec<Vec<f64>> =
            parts.iter().map(|part| efforts().map(|effort| part * effort.unwrap_or(1.0)).collect()).collect();
        let limited = |torque: f64, effort: Option<f64>| effort.map_or(torque, |effort| torque.clamp(-effort, effort));
        let expected: Vec<Vec<f64>> = given
            .iter()
            .map(|torques| torques.iter().zip(efforts()).map(|(torque, effort)| limited(*torque, effort)).collect())
            .collect();
        let (real, dof) = (self.precision.c_type(), self.robot.dof());
        let rows: Vec<&[f64]> = given.iter().map(Vec::as_slice).collect();
        let table = self.table(&format!("    static const {real} given[{}][{dof}]", rows.len()), &rows);
        let call = format!("{}_limit_torques(given[state], found);", self.prefix);
        // the code and this test have the same constants for the limits, so no tolerance is needed
        self.joints("limit_torques", &call, &table.replace("\n};", "\n    };"), &expected, "0.0")
    }

    fn has(&self, function: Function) -> bool {
        program(self.programs, function).is_some()
    }

    /// Returns the function that compares a step of the Runge-Kutta method, or its derivatives, with expected values:
    /// its name and its text. The result has the type of the Euler step function `of`. For positions and velocities,
    /// the test compares their changes during the step, because the step is short.
    fn step(&self, at: usize, (what, of): (&str, Function)) -> Option<(String, String)> {
        let accelerations = program(self.programs, Function::ForwardDynamics)?;
        let expected: Vec<&[f64]> = self.golden.iter().map(|state| state.steps[at].as_slice()).collect();
        let count = expected.first()?.len();
        if expected.iter().any(|numbers| numbers.is_empty()) {
            return None;
        }
        let (real, prefix, states) = (self.precision.c_type(), self.prefix, expected.len());
        let layout = of.layout(rne_codegen::sizes_of(self.robot));
        let mut copies = String::new();
        for (index, element) in layout_elements(&layout, "result").iter().enumerate() {
            let start = element.strip_prefix("result.").filter(|_| at == 0);
            let start = start.map_or_else(String::new, |start| format!(" - test_{}", start.replace('[', "[state][")));
            let _ = writeln!(copies, "        found[{index}] = {element}{start};");
        }
        // positions and velocities, or the blocks of derivatives, are compared with separate scales
        let blocks = if at == 0 { 2 } else { 6 };
        let size = count / blocks;
        // scale for numbers that are only rounding errors of terms that cancel
        let floors = vec![format!("{:?}", 1e-2 * Golden::STEP); blocks].join(", ");
        let parameters = if parameters::are_used(accelerations) { ", &test_parameters[state]" } else { "" };
        // the tolerance is that of the accelerations
        let parts = if self.precision == Precision::Single { "100.0 * test_tolerance" } else { "test_tolerance" };
        let text = format!(
            "static void test_{what}(void)\n{{\n{}    unsigned state;\n    \
             double scales[{blocks}] = {{{floors}}};\n    \
             for (state = 0u; state < {states}u; ++state) {{\n        unsigned i;\n        \
             for (i = 0u; i < {blocks}u; ++i) {{\n            \
             scales[i] = test_largest(&expected[state][{size}u * i], {size}u, scales[i]);\n        }}\n    }}\n    \
             for (state = 0u; state < {states}u; ++state) {{\n        unsigned i;\n        \
             {real} found[{count}];\n        {} result;\n        \
             {prefix}_{what}(\n            \
             test_q[state], test_qd[state], test_tau[state], {}{parameters}, &result);\n{copies}        \
             for (i = 0u; i < {count}u; ++i) {{\n            \
             test_compare(\"{what}\", state, i, (double)found[i], (double)expected[state][i],\n                \
             {parts} * scales[i / {size}u]);\n        }}\n    }}\n}}\n",
            self.table(&format!("    static const {real} expected[{states}][{count}]"), &expected)
                .replace("\n};", "\n    };"),
            element_type(prefix, self.precision, &layout),
            self.precision.literal(Golden::STEP).unwrap_or_default(),
        );
        Some((format!("test_{what}"), text))
    }

    /// Returns a function that compares `found`, one number per joint that `call` writes, with a row of `expected` for
    /// each state.
    fn joints(&self, what: &str, call: &str, tables: &str, expected: &[Vec<f64>], allowed: &str) -> (String, String) {
        let (real, dof, states) = (self.precision.c_type(), self.robot.dof(), expected.len());
        let rows: Vec<&[f64]> = expected.iter().map(Vec::as_slice).collect();
        let table = self.table(&format!("    static const {real} expected[{states}][{dof}]"), &rows);
        let text = format!(
            "static void test_{what}(void)\n{{\n{tables}{}    unsigned state;\n    \
             for (state = 0u; state < {states}u; ++state) {{\n        unsigned i;\n        \
             {real} found[{dof}];\n        {call}\n        for (i = 0u; i < {dof}u; ++i) {{\n            \
             test_compare(\"{what}\", state, i, (double)found[i], (double)expected[state][i],\n                \
             {allowed});\n        }}\n    }}\n}}\n",
            table.replace("\n};", "\n    };"),
        );
        (format!("test_{what}"), text)
    }

    fn law(&self, law: Law) -> Option<(String, String)> {
        let states = self.golden.len();
        // this law needs differences of energies, for which single precision is not accurate enough
        if law == Law::Power {
            return None;
        }
        let mut values = vec![
            ("words", law.name().replace('_', " ")),
            ("dof", self.robot.dof().to_string()),
            ("real", self.precision.c_type().to_owned()),
        ];
        for Call { result, function, others } in law.calls(["sum", "test_qdd[state]", "test_tau[state]", "test_zero"]) {
            values.push((result, self.call_of(function, &others, result)?));
        }
        let body = filled(law.part_of(LAWS), &values);
        let name = format!("test_{}", law.name());
        let indices = if body.contains("j = 0u") { "i, j" } else { "i" };
        Some((
            name.clone(),
            format!(
                "static void {name}(void)\n{{\n    unsigned state;\n    for (state = 0u; state < {states}u; ++state) \
                 {{\n        unsigned {indices};\n{body}    }}\n}}\n"
            ),
        ))
    }
}

/// Returns the name of the table of an argument at all states.
fn array(name: &'static str) -> String {
    format!("test_{}", array_name(name))
}
