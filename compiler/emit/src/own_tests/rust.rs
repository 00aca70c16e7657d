//! Tests of emitted Rust: a module for the end of its file.

use std::fmt::Write;

use rne_codegen::{Function, Program, Shape};
use rne_model::Robot;

use super::{Call, Golden, Law, MOTION, filled, floor, program, results};
use crate::parameters::{self, OF_RUST, Parameter};
use crate::wrap::{WIDTH, fill};

/// Returns a module `tests` for the end of a file of [`rust_file`](crate::rust_file): it compares the results of the
/// programs at the given states in `f64` to nine digits, and tests laws of mechanics. It needs `std`, which tests have.
#[must_use]
pub fn rust_tests(robot: &Robot, programs: &[Program], golden: &[Golden]) -> String {
    let tests = Tests { robot, programs, golden };
    let divides = programs.iter().any(|program| program.operations().div > 0);
    let (imported, division) = if divides { ("Add, Div, Mul, Neg, Sub", DIVISION) } else { ("Add, Mul, Neg, Sub", "") };
    let by_sign = if programs.iter().any(Program::chooses_by_sign) { BY_SIGN } else { "" };
    let mut text = format!(
        "\n// Values that rne's runtime has computed, which knows nothing of this code, and laws of mechanics.\n\
         #[cfg(test)]\n#[rustfmt::skip]\n#[allow(clippy::all, clippy::pedantic, dead_code, non_snake_case)]\n\
         mod tests {{\n    extern crate std;\n\n    use core::ops::{{{imported}}};\n    use std::vec::Vec;\n\n    \
         use super::Scalar;\n{NUMBER}{division}{SCALAR}{by_sign}    }}\n{COMPARISON}\n"
    );
    for (count, parts) in [(3, THREE_PARTS), (4, FOUR_PARTS)] {
        let has =
            |program: &Program| matches!(program.function.shape(), Shape::Record(_, parts) if parts.len() == count);
        if programs.iter().any(has) {
            text.push_str(parts);
        }
    }
    text.push_str(&tests.states());
    for index in 0..programs.len() {
        text.push_str(&tests.values(index).unwrap_or_default());
    }
    for law in Law::of(programs) {
        text.push_str(&tests.law(law).unwrap_or_default());
    }
    text + "}\n"
}

/// The body of the test of each law.
const LAWS: &str = include_str!("rust_laws.txt");

const NUMBER: &str = "
    /// A number with the sine of `std`.
    #[derive(Clone, Copy)]
    struct Number(f64);

    impl Neg for Number {
        type Output = Self;
        fn neg(self) -> Self { Self(-self.0) }
    }
    impl Add for Number {
        type Output = Self;
        fn add(self, other: Self) -> Self { Self(self.0 + other.0) }
    }
    impl Sub for Number {
        type Output = Self;
        fn sub(self, other: Self) -> Self { Self(self.0 - other.0) }
    }
    impl Mul for Number {
        type Output = Self;
        fn mul(self, other: Self) -> Self { Self(self.0 * other.0) }
    }
";

const DIVISION: &str = "    impl Div for Number {
        type Output = Self;
        fn div(self, other: Self) -> Self { Self(self.0 / other.0) }
    }
";

const SCALAR: &str = "    impl Scalar for Number {
        fn from_f64(value: f64) -> Self { Self(value) }
        fn sin_cos(self) -> (Self, Self) { (Self(self.0.sin()), Self(self.0.cos())) }
";

const BY_SIGN: &str = "        fn by_sign(self, positive: Self, negative: Self) -> Self {
            if self.0 > 0.0 { positive } else if self.0 < 0.0 { negative } else { Self(0.0) }
        }
";

const THREE_PARTS: &str = "    impl<A: Flat, B: Flat, C: Flat> Flat for (A, B, C) {
        fn flat(&self) -> Vec<f64> { [self.0.flat(), self.1.flat(), self.2.flat()].concat() }
    }

";

const FOUR_PARTS: &str = "    impl<A: Flat, B: Flat, C: Flat, D: Flat> Flat for (A, B, C, D) {
        fn flat(&self) -> Vec<f64> { [self.0.flat(), self.1.flat(), self.2.flat(), self.3.flat()].concat() }
    }

";

const COMPARISON: &str = "
    /// The numbers of a result, in their order.
    trait Flat {
        fn flat(&self) -> Vec<f64>;
    }
    impl Flat for Number {
        fn flat(&self) -> Vec<f64> { Vec::from([self.0]) }
    }
    impl<F: Flat, const N: usize> Flat for [F; N] {
        fn flat(&self) -> Vec<f64> { self.iter().flat_map(Flat::flat).collect() }
    }
    impl<A: Flat, B: Flat> Flat for (A, B) {
        fn flat(&self) -> Vec<f64> { self.0.flat().into_iter().chain(self.1.flat()).collect() }
    }

    /// The largest number, without its sign.
    fn largest(numbers: &[f64]) -> f64 {
        numbers.iter().fold(0.0, |largest, number| number.abs().max(largest))
    }

    /// Panics where a number is not the expected one, to so many parts of `scale`.
    fn compare(what: &str, state: usize, found: &[f64], expected: &[f64], parts: f64, scale: f64) {
        assert_eq!(found.len(), expected.len(), \"{what}\");
        for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
            let is_met = (found - expected).abs() <= parts * scale;
            assert!(is_met, \"{what}, state {state}, number {index}: {found:e}, not {expected:e}\");
        }
    }
";

struct Tests<'a> {
    robot: &'a Robot,
    programs: &'a [Program],
    golden: &'a [Golden],
}

impl Tests<'_> {
    /// Returns the states, with every argument that is used.
    fn states(&self) -> String {
        let mut names: Vec<&str> = MOTION.into();
        for array in self.programs.iter().flat_map(Program::arrays_without_parameters) {
            if !names.contains(&array.name) {
                names.push(array.name);
            }
        }
        let takes_parameters = self.programs.iter().any(parameters::are_used);
        let mut text = "    struct State {\n".to_owned();
        for name in &names {
            let count = self.golden.first().map_or(0, |state| state.argument(name).len());
            let _ = writeln!(text, "        {name}: [f64; {count}],");
        }
        if takes_parameters {
            text.push_str("        parameters: super::Parameters<f64>,\n");
        }
        let _ = writeln!(text, "    }}\n\n    const STATES: [State; {}] = [", self.golden.len());
        for state in self.golden {
            text.push_str("        State {\n");
            for name in &names {
                let _ = writeln!(text, "            {name}: {},", list(state.argument(name), 12));
            }
            if takes_parameters {
                let members = Parameter::of(self.robot, OF_RUST);
                let members = members.iter().zip(state.argument("parameters"));
                let members: Vec<_> = members.map(|(known, value)| format!("{}: {value:?}", known.member)).collect();
                let _ = writeln!(text, "            parameters: super::Parameters {{ {} }},", members.join(", "));
            }
            text.push_str("        },\n");
        }
        text + "    ];\n"
    }

    /// Returns a call at `state`; `others` replaces some arguments by other arrays of `f64`.
    fn call(&self, program: &Program, others: &[(&str, &str)]) -> String {
        let mut given: Vec<String> = program
            .arrays_without_parameters()
            .iter()
            .map(|array| {
                let other = others.iter().find(|(name, _)| *name == array.name);
                other.map_or_else(
                    || match array.row {
                        Some(row) => format!(
                            "&core::array::from_fn(|i| core::array::from_fn(|j| Number(state.{}[{row} * i + j])))",
                            array.name
                        ),
                        None if array.is_number => format!("Number(state.{}[0])", array.name),
                        None => format!("&state.{}.map(Number)", array.name),
                    },
                    |(_, it)| format!("&{it}.map(Number)"),
                )
            })
            .collect();
        if parameters::are_used(program) {
            let members = Parameter::of(self.robot, OF_RUST);
            let members = members.iter().map(|known| format!("{0}: Number(state.parameters.{0})", known.member));
            given.push(format!("&super::Parameters {{ {} }}", members.collect::<Vec<_>>().join(", ")));
        }
        format!("super::{}({}).flat()", program.name, given.join(", "))
    }

    /// Returns a call of the program of a function; `None` if the file does not have it.
    fn call_of(&self, function: Function, others: &[(&str, &str)]) -> Option<String> {
        Some(self.call(program(self.programs, function)?, others))
    }

    /// Returns the test that compares a program with expected values.
    fn values(&self, index: usize) -> Option<String> {
        let (program, expected) = (self.programs.get(index)?, results(self.golden, index)?);
        let name = &program.name;
        let mut rows = String::new();
        for numbers in &expected {
            let _ = writeln!(rows, "            {},", list(numbers, 12));
        }
        Some(format!(
            "\n    #[test]\n    fn {name}_has_the_values_of_the_runtime() {{\n        \
             let expected: [[f64; {}]; {}] = [\n{rows}        ];\n        \
             let scale = largest(expected.as_flattened()).max({:?});\n        \
             for (index, (state, expected)) in STATES.iter().zip(&expected).enumerate() {{\n            \
             let found = {};\n            \
             compare(\"{name}\", index, &found, expected, 1e-9, scale);\n        }}\n    }}\n",
            expected.first()?.len(),
            expected.len(),
            floor(self.golden, index, 1e-4),
            self.call(program, &[]),
        ))
    }

    fn law(&self, law: Law) -> Option<String> {
        let zero = format!("[0.0; {}]", self.robot.dof());
        let name = law.name();
        let mut values = vec![("name", name.to_owned()), ("dof", self.robot.dof().to_string())];
        for Call { result, function, others } in law.calls(["sum", "a", "b", &zero]) {
            values.push((result, self.call_of(function, &others)?));
        }
        let body = filled(law.part_of(LAWS), &values);
        Some(format!(
            "\n    #[test]\n    fn {name}() {{\n        for (index, state) in STATES.iter().enumerate() \
             {{\n{body}        }}\n    }}\n"
        ))
    }
}

/// Returns numbers as an array, broken into lines.
fn list(numbers: &[f64], indent: usize) -> String {
    let numbers = numbers.iter().map(|number| format!("{number:?}")).collect::<Vec<_>>().join(", ");
    let blank = " ".repeat(indent + 4);
    if indent + numbers.len() + 20 <= WIDTH {
        return format!("[{numbers}]");
    }
    format!("[\n{}\n{}]", fill(&numbers, WIDTH, &blank, &blank), " ".repeat(indent))
}
