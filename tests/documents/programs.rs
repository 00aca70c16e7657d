//! Blocks with programs and functions: calls, emitted code, the stubs of Python, costs of functions.

use std::fmt::Write;

use rne_codegen::{Argument, Capability, Compiler, Form, Function, Length, Record, Shape, Step};
use rne_emit::{Selection, listing};

use crate::tables::plans;
use crate::{inverse_dynamics, read, robot, root};

/// The derive of an example, and its lines from `start` to the one that prints.
fn example(name: &str, start: &str) -> (String, String) {
    let program = read(&root().join(format!("examples/{name}.rs")));
    let between = |start: &str, end: &str| {
        let lines = program.lines().skip_while(|line| !line.contains(start)).take_while(|line| !line.contains(end));
        let lines = lines.map(str::trim).filter(|line| !line.is_empty());
        lines.fold(String::new(), |text, line| text + line + "\n")
    };
    (between("#[derive", "fn main"), between(start, "println!"))
}

/// The derive and the calls of an example, with the robot file of the commands above them.
pub(crate) fn control() -> String {
    let (derive, calls) = example("control", "let gravity");
    let derive = derive.replace("../robots/puma560.yaml", "../arm.yaml");
    assert!(derive.contains("path = \"../arm.yaml\"") && calls.lines().count() == 4, "{derive}{calls}");
    format!("```rust\n{derive}{calls}```\n")
}

/// The derive and the calls of an example with two tips, for a file in the folder of the page.
pub(crate) fn two_hands() -> String {
    let (derive, calls) = example("two_hands", "let mut w");
    let derive = derive.replace("../docs/", "");
    assert!(derive.contains("path = \"dual_arm.yaml\"") && calls.lines().count() == 3, "{derive}{calls}");
    format!("```rust,ignore\n{derive}{calls}```\n")
}

/// The emitted code of steps 1 and 2 of joint 3 of the PUMA 560.
pub(crate) fn code() -> String {
    let robot = robot(&root().join("robots/puma560.yaml"));
    let program = inverse_dynamics(&robot);
    let what = |&step| Selection { joint: Some(3), step: Some(step), ..Selection::default() };
    let steps = Step::ALL[..2].iter().map(|step| listing(&robot, &program, what(step)));
    let code: Vec<String> = steps.filter(|listing| !listing.is_empty()).map(|listing| listing.to_string()).collect();
    let code = code.join("\n");
    let emitted = rne_emit::rust_file(&robot, &[program]);
    assert!(emitted.contains(&code), "the heading of the block says where it is from");
    format!("```rust\n{code}```\n")
}

/// The PUMA 560 on the Cortex-M4F, by the first table of docs/measured/embedded.md, and the loop that it is compared
/// with there.
pub(crate) fn embedded() -> String {
    let document = read(&root().join("docs/measured/embedded.md"));
    let rows = || document.lines().map(|line| line.split(" | ").collect::<Vec<_>>());
    let mut text = String::from(
        "| PUMA 560 on a Cortex-M4F, `f32` | instructions of a call | bytes of code and constants | bytes of stack |\n\
         |---|---:|---:|---:|\n",
    );
    for form in ["seven_steps", "reduced"] {
        let row = rows().find(|row| row.starts_with(&["| puma560", form])).expect("a row of the table");
        let [instructions, code, constants, stack] =
            [2, 3, 4, 5].map(|column| row[column].parse::<usize>().expect("a number"));
        let bytes = code + constants;
        let _ = writeln!(text, "| derived, `{form}` | {instructions} | {bytes} | {stack} |");
    }
    let row = rows().find(|row| row[0].starts_with("| `rne::Arm`")).expect("the loop");
    let _ = writeln!(text, "| `rne::Arm`, a loop over a table in flash | {} | | |", row[1]);
    text
}

/// The methods of Python's class `Arm` that are functions of the compiler.
pub(crate) fn stubs() -> String {
    const BASE: &str = "base_omega: ArrayLike | None = ..., base_omega_dot: ArrayLike | None = ...,
        base_acceleration: ArrayLike | None = ..., base_gravity: ArrayLike | None = ...,
        ";
    let mut text = String::new();
    for function in Function::ALL {
        let frame = if function.of_frame().is_some() { "frame: str | None = ..., " } else { "" };
        let payload = if function.with_payload().is_some() { "payload: ArrayLike | None = ..., " } else { "" };
        let arguments = function.arguments().iter().filter(|argument| **argument != Argument::Base);
        let joints: String = arguments
            .map(|argument| match (argument.name(), argument.shape()) {
                (name, Shape::Array(Length::Joints | Length::Passive, _)) => format!("{name}: Joints, "),
                (name, Shape::Array(Length::Tips, _)) if function.is_of_floating_base() => {
                    format!("{name}: ArrayLike | dict[str, ArrayLike] | None = ..., ")
                }
                (name, Shape::Array(Length::Tips, _)) => format!("{name}: ArrayLike | dict[str, ArrayLike], "),
                (name, _) => format!("{name}: ArrayLike, "),
            })
            .collect();
        let base = if function.takes(Argument::Base) { BASE } else { "" };
        let returned = match arrays(function.shape()) {
            0 => "Floats | float".to_owned(),
            1 => "Floats".to_owned(),
            count => format!("tuple[{}]", vec!["Floats"; count].join(", ")),
        };
        let summary = function.summary();
        // a pose of the tip has the name that it has at a frame, too
        let other = function.of_frame().filter(|_| function == Function::ForwardKinematics);
        for name in [Some(function.name()), other].into_iter().flatten() {
            let _ = writeln!(
                text,
                "    def {name}(\n        self, {joints}*,\n        {base}{frame}{payload}\
                 parameters: Parameters = ..., out: Floats | None = ...,\n    \
                 ) -> {returned}:\n        \"\"\"{summary}\"\"\""
            );
        }
    }
    text
}

/// How many arrays Python returns: none for a number, one for a matrix of rows or of a record of one frame.
fn arrays(shape: &Shape) -> usize {
    match shape {
        Shape::Number => 0,
        Shape::Array(..) => 1,
        // the matrices A and B of a step
        Shape::Record(Record::NextStateDerivatives | Record::FloatingStepDerivatives, _) => 2,
        Shape::Record(record, parts) if record.sizes().is_empty() => parts.len().min(1),
        Shape::Record(_, parts) => parts.iter().map(arrays).sum(),
    }
}

/// What every function of the PUMA 560 costs in both forms.
pub(crate) fn functions() -> String {
    let path = root().join("robots/puma560.yaml");
    let robot = robot(&path);
    let (plans, _) = plans(&path, &robot);
    let mut text = String::from(
        "| derive | method | seven steps | reduced | divisions | angles |\n\
         |---|---|---|---|---|---|\n",
    );
    // the page has other tables of the functions of floating bases, and names those with a payload or wrenches
    let elsewhere = ["Floating", "Centroidal", "Contact", "Payload", "TipWrenches"];
    let is_listed = |capability: &&Capability| !elsewhere.iter().any(|start| capability.name().starts_with(start));
    for capability in Capability::ALL.iter().filter(is_listed) {
        // the PUMA 560 has no closed loops
        for function in capability.functions().filter(|function| !function.is_of_closed_loops()) {
            let count = |form| {
                Compiler::new(&robot).with_plans(&plans).compile(function, form).expect("finite constants").operations()
            };
            let [plain, reduced] = [Form::SevenSteps, Form::Reduced].map(count);
            let angles = if plain.sincos == reduced.sincos {
                plain.sincos.to_string()
            } else {
                format!("{} → {}", plain.sincos, reduced.sincos)
            };
            let _ = writeln!(
                text,
                "| `{}` | `{function}` | {} | {} | {} | {angles} |",
                capability.name(),
                plain.total(),
                reduced.total(),
                reduced.div
            );
        }
    }
    text
}
