//! Blocks with programs and functions: calls, emitted code, the stubs of Python, costs of functions.

use std::fmt::Write;

use rne_codegen::{Argument, Capability, Compiler, Form, Function, Returned, Step};
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
    let derive = derive.replace("../robots/puma560.yaml", "arm.yaml");
    assert!(derive.contains("path = \"arm.yaml\"") && calls.lines().count() == 4, "{derive}{calls}");
    format!("```rust\n{derive}{calls}```\n")
}

/// The derive and the calls of an example with two tips, for a file in the folder of the page.
pub(crate) fn two_hands() -> String {
    let (derive, calls) = example("two_hands", "let mut w");
    let derive = derive.replace("../docs/", "");
    assert!(derive.contains("path = \"dual_arm.yaml\"") && calls.lines().count() == 3, "{derive}{calls}");
    format!("```rust,ignore\n{derive}{calls}```\n")
}

/// The emitted code of the first steps of joint 3 of the PUMA 560.
pub(crate) fn code(steps: usize) -> String {
    let robot = robot(&root().join("robots/puma560.yaml"));
    let program = inverse_dynamics(&robot);
    let what = |&step| Selection { joint: Some(3), step: Some(step), ..Selection::default() };
    let steps = Step::ALL[..steps].iter().map(|step| listing(&robot, &program, what(step)));
    let code: Vec<String> = steps.filter(|listing| !listing.is_empty()).map(|listing| listing.to_string()).collect();
    let code = code.join("\n");
    let emitted = rne_emit::rust_file(&robot, &[program]);
    assert!(emitted.contains(&code), "the heading of the block says where it is from");
    format!("```rust\n{code}```\n")
}

/// The PUMA 560 on the Cortex-M4F, by the first table of docs/embedded.md, and the loop that it is compared with there.
pub(crate) fn embedded() -> String {
    let document = read(&root().join("docs/embedded.md"));
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
    let mut stub = |function: Function, arguments: &[(&str, Argument)], returned: Returned, summary: &str| {
        let frame = if function.of_frame().is_some() { "frame: str | None = ..., " } else { "" };
        let payload = if function.with_payload().is_some() { "payload: ArrayLike | None = ..., " } else { "" };
        let joints = arguments.iter().filter(|(_, kind)| *kind != Argument::Base);
        let joints: Vec<String> = joints
            .map(|(name, kind)| match kind {
                Argument::Wrench
                | Argument::Payload
                | Argument::BaseVelocity
                | Argument::BaseTwist
                | Argument::BasePose
                | Argument::BaseRotation
                | Argument::Step => format!("{name}: ArrayLike, "),
                Argument::Wrenches if function.is_of_floating_base() => {
                    format!("{name}: ArrayLike | dict[str, ArrayLike] | None = ..., ")
                }
                Argument::Wrenches => format!("{name}: ArrayLike | dict[str, ArrayLike], "),
                _ => format!("{name}: Joints, "),
            })
            .collect();
        let joints = joints.concat();
        let base = if arguments.iter().any(|(_, kind)| *kind == Argument::Base) { BASE } else { "" };
        let returned = match returned {
            Returned::Number => "Floats | float",
            Returned::TorqueDerivatives
            | Returned::MomentumAndRate
            | Returned::FloatingTorques
            | Returned::FloatingAccelerations
            | Returned::NextState
            | Returned::NextStateDerivatives
            | Returned::FloatingStepDerivatives
            | Returned::ClosureStep => "tuple[Floats, Floats]",
            Returned::AccelerationsAndWrenches
            | Returned::FloatingTorqueDerivatives
            | Returned::TorqueGradient
            | Returned::AccelerationDerivatives => "tuple[Floats, Floats, Floats]",
            Returned::TorqueHessian | Returned::FloatingNextState => "tuple[Floats, Floats, Floats, Floats]",
            _ => "Floats",
        };
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
    };
    macro_rules! methods {
        ($(
            $variant:ident $axes:tt =
                $name:ident($($argument:ident: $kind:ident),*) -> $returned:ident $(at $of_frame:ident)?:
                $summary:literal $(, $details:literal)?;
        )*) => {
            $(stub(
                Function::$variant,
                &[$((stringify!($argument), Argument::$kind)),*],
                Returned::$returned,
                $summary,
            );)*
        };
    }
    rne_codegen::functions!(methods);
    text
}

/// What every function of the PUMA 560 costs in both forms.
pub(crate) fn functions() -> String {
    let path = root().join("robots/puma560.yaml");
    let robot = robot(&path);
    let (plans, _) = plans(&path, &robot);
    let mut text = String::from(
        "| derive | method | seven steps: products | sums | reduced: products | sums | divisions | angles |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for capability in Capability::ALL {
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
                "| `{}` | `{function}` | {} | {} | {} | {} | {} | {angles} |",
                capability.name(),
                plain.mul,
                plain.add,
                reduced.mul,
                reduced.add,
                reduced.div
            );
        }
    }
    text
}
