//! A program in C that calls every function of a robot.

use std::fmt::Write;

use rne_codegen::{Function, Layout, Length, Program, Shape, Sizes};
use rne_emit::Precision;
use rne_model::Robot;

use crate::compiler::Compiler;
use crate::states::State;

/// One emitted file.
pub(crate) struct Unit {
    prefix: String,
    precision: Precision,
    functions: Vec<Function>,
    code: String,
}

impl Unit {
    /// Files that go into one program have prefixes that differ.
    pub(crate) fn new(robot: &Robot, programs: &[Program], precision: Precision, prefix: String) -> Self {
        let name = prefix.parse().expect("an identifier");
        let code = rne_emit::c_code(robot, programs, precision, &name).unwrap_or_else(|error| panic!("{error}"));
        let functions = programs.iter().map(|program| program.function).collect();
        Self { prefix, precision, functions, code: code.one_file() }
    }

    /// The emitted text.
    #[allow(dead_code)] // not in every program of tests
    pub(crate) fn code(&self) -> &str {
        &self.code
    }
}

/// The program of one robot.
pub(crate) struct Driver<'a> {
    pub(crate) name: &'a str,
    pub(crate) units: &'a [Unit],
    pub(crate) dof: usize,
}

/// Words in, words out; of both number types.
pub(crate) fn words(precision: Precision) -> String {
    let (real, bits, format) = match precision {
        Precision::Single => ("float", "uint32_t", "PRIx32"),
        Precision::Double => ("double", "uint64_t", "PRIx64"),
    };
    format!(
        "static int read_{real}({real} *numbers, unsigned count)\n{{\n    \
             unsigned i;\n    \
             for (i = 0u; i < count; ++i) {{\n        \
                 uint64_t word;\n        \
                 union {{ {real} number; {bits} bits; }} read;\n        \
                 if (scanf(\"%\" SCNx64, &word) != 1) {{ return 0; }}\n        \
                 read.bits = ({bits})word;\n        \
                 numbers[i] = read.number;\n    \
             }}\n    \
             return 1;\n\
         }}\n\n\
         static void print_{real}(const {real} *numbers, unsigned count)\n{{\n    \
             unsigned i;\n    \
             for (i = 0u; i < count; ++i) {{\n        \
                 union {{ {real} number; {bits} bits; }} written;\n        \
                 written.number = numbers[i];\n        \
                 printf(\"%\" {format} \"\\n\", written.bits);\n    \
             }}\n\
         }}\n\n"
    )
}

/// What stands in front of the emitted code: it includes what it needs.
pub(crate) const INCLUDES: &str = "#include <inttypes.h>\n#include <stdio.h>\n\n";

impl Driver<'_> {
    /// The words of all results: by state, form, number type and function.
    pub(crate) fn run(&self, compiler: &Compiler, states: &[State]) -> Vec<u64> {
        // the small ones are optimised as users do; the others would take five times as long
        let small = if shipped::is_exhaustive() { 4 } else { 3 };
        let optimisation = if self.dof <= small { "-O2" } else { "-O0" };
        let input: Vec<u64> = states.iter().flat_map(words_of).collect();
        compiler.run(self.name, optimisation, &self.source(), &input)
    }

    fn source(&self) -> String {
        let dof = self.dof;
        let mut text = INCLUDES.to_owned();
        text.extend(self.units.iter().map(|unit| unit.code.as_str()));
        text.extend(Precision::ALL.map(words));
        for unit in self.units {
            let _ = writeln!(text, "{}", self.calls(unit));
        }
        text.push_str("int main(void)\n{\n");
        for precision in Precision::ALL {
            let real = precision.c_type();
            let _ = writeln!(text, "    {real} {real}s[{}];", 6 * dof + 39);
        }
        for precision in Precision::ALL {
            // where no file has this number type
            let _ = writeln!(text, "    (void)print_{};", precision.c_type());
        }
        let count = 6 * dof + 39;
        let _ = writeln!(text, "    while (read_float(floats, {count}u) && read_double(doubles, {count}u)) {{");
        for Unit { prefix, precision, .. } in self.units {
            let _ = writeln!(text, "        {prefix}_all({}s);", precision.c_type());
        }
        text.push_str("    }\n    return 0;\n}\n");
        text
    }

    /// A function that calls all functions of a unit and prints what they return.
    fn calls(&self, unit: &Unit) -> String {
        let (Unit { prefix, precision, functions, .. }, n) = (unit, self.dof);
        let real = precision.c_type();
        let mut text = format!("static void {prefix}_all(const {real} *given)\n{{\n");
        let joints = ["q", "qd", "qdd", "tau", "sine", "cosine"];
        for (index, name) in joints.iter().enumerate() {
            let _ = writeln!(text, "    const {real} *{name} = &given[{}];", index * n);
        }
        let vectors = ["force", "moment", "omega", "omega_dot", "acceleration", "gravity"];
        for (index, name) in vectors.iter().enumerate() {
            let _ = writeln!(text, "    const {real} *{name} = &given[{}];", joints.len() * n + 3 * index);
        }
        // its mass is the last element of a vector
        let _ = writeln!(text, "    const {real} *payload = &given[{}];", joints.len() * n + 3 * vectors.len() + 2);
        let rows = joints.len() * n + 30;
        let _ = writeln!(text, "    const {real} (*base_rotation)[3] = (const {real} (*)[3])&given[{rows}];");
        let _ = writeln!(text, "    {real} pose[12];\n    unsigned i;");
        let _ =
            writeln!(text, "    for (i = 0u; i < 12u; ++i) pose[i] = i < 9u ? given[{rows}u + i] : gravity[i - 9u];");
        for name in joints.iter().chain(&vectors).chain(&["payload", "base_rotation", "pose"]) {
            let _ = writeln!(text, "    (void){name};");
        }
        let wrenches = format!("(const {real} (*)[6])force");
        for function in functions {
            let parts = function.arguments().iter().flat_map(|argument| argument.parts());
            let arguments = parts.map(|part| match part.name {
                "sin" => "sine",
                "cos" => "cosine",
                "multipliers" => "tau",
                "step" => "0.03125f",
                // numbers that stand one after the other: the moment after the force, omega after the moment
                "wrenches" => wrenches.as_str(),
                "twist" => "moment",
                name => name.strip_prefix("base_").filter(|name| *name != "rotation").unwrap_or(name),
            });
            let arguments = arguments.collect::<Vec<_>>().join(", ");
            let layout = function.layout(Sizes { dof: n, tips: 1, passive: 0, equations: 0 });
            let (kind, lengths) = declaration(prefix, real, &layout);
            let (result, address) = match (&layout, function.shape()) {
                (Layout::Number, _) => {
                    let _ =
                        writeln!(text, "    {{ {real} x = {prefix}_{function}({arguments}); print_{real}(&x, 1u); }}");
                    continue;
                }
                (Layout::Record(..), _) => (format!("{kind} x"), "&x"),
                (_, Shape::Array(Length::Joints, Shape::Number)) => {
                    (format!("{real} x[{}_DOF]", prefix.to_ascii_uppercase()), "x")
                }
                _ => (format!("{kind} x{lengths}"), "x"),
            };
            let _ = writeln!(
                text,
                "    {{ {result}; {prefix}_{function}({arguments}, {address});\n      \
                 print_{real}((const {real} *){address}, (unsigned)(sizeof(x) / (sizeof({real})))); }}"
            );
        }
        text.push_str("}\n");
        text
    }
}

/// The type of a result, and the lengths of its arrays.
fn declaration(prefix: &str, real: &str, layout: &Layout) -> (String, String) {
    match layout {
        Layout::Number => (real.to_owned(), String::new()),
        Layout::Array(length, of) => {
            let (kind, lengths) = declaration(prefix, real, of);
            (kind, format!("[{length}]{lengths}"))
        }
        Layout::Record(record, _) => (rne_emit::record_name(prefix, *record), String::new()),
    }
}

/// A state in the order in which the program reads it.
fn words_of(state: &State) -> Vec<u64> {
    let (single, double) = (state.single(), state.double());
    let mut words = Vec::new();
    let singles = single.joints.iter().chain([&single.sine, &single.cosine]).flatten();
    let singles = singles.chain(single.vectors.as_flattened()).chain(single.rotation.as_flattened());
    words.extend(singles.map(|x| u64::from(x.to_bits())));
    let doubles = double.joints.iter().chain([&double.sine, &double.cosine]).flatten();
    let doubles = doubles.chain(double.vectors.as_flattened()).chain(double.rotation.as_flattened());
    words.extend(doubles.map(|x| x.to_bits()));
    words
}
