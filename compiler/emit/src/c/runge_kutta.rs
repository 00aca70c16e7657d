//! The step of the classical Runge-Kutta method and its derivatives, as functions that call the accelerations and their
//! derivatives in the same file four times.
//!
//! They do the same operations as `RungeKuttaStep` and `RungeKuttaStepDerivatives` of the runtime in the same order. A
//! function that contained the accelerations four times would have four times the code.

use std::fmt::Write;

use rne_codegen::{Function, Layout, Program};

use super::signature::{parameters_type, record_type, wrapped};
use super::{File, comment};
use crate::parameters;

/// The C code of both functions, with words in capitals that are replaced in each file.
const TEMPLATE: &str = include_str!("runge_kutta.c");

/// The line of the template between the step and its derivatives.
const DERIVATIVES: &str = "// the derivatives\n";

/// Returns the program of the accelerations, if the file is to have the step.
fn accelerations<'a>(file: &'a File) -> Option<&'a Program> {
    file.programs.iter().find(|program| file.additions.runge_kutta && program.function == Function::ForwardDynamics)
}

/// Whether the file has the derivatives of the step.
fn has_derivatives(file: &File) -> bool {
    file.programs.iter().any(|program| program.function == Function::ForwardDynamicsDerivatives)
}

/// The two functions, each with the function that has the same arguments and results.
pub(crate) const STEPS: [(&str, Function); 2] =
    [("runge_kutta_step", Function::EulerStep), ("runge_kutta_step_derivatives", Function::EulerStepDerivatives)];

/// Returns the layouts of the results of the functions that the file has.
pub(super) fn layouts(file: &File) -> Vec<Layout> {
    let sizes = rne_codegen::sizes_of(file.robot);
    let is_there = accelerations(file).is_some();
    let count = usize::from(is_there) * (1 + usize::from(has_derivatives(file)));
    STEPS[..count].iter().map(|(_, function)| function.layout(sizes)).collect()
}

/// Returns the signature of a function; its result has the type of the Euler step function `of`.
fn head(file: &File, program: &Program, name: &str, of: Function) -> String {
    let (real, dof) = (file.precision.c_type(), program.dof);
    let mut arguments: Vec<_> = ["q", "qd", "tau"].map(|name| format!("const {real} {name}[{dof}]")).into();
    arguments.push(format!("const {real} step"));
    if parameters::are_used(program) {
        arguments.push(format!("const {} *parameters", parameters_type(file)));
    }
    if let Layout::Record(record, _) = of.layout(rne_codegen::sizes_of(file.robot)) {
        arguments.push(format!("{} *{}", record_type(file, record), of.entry().output));
    }
    wrapped(&format!("void {}_{name}(", file.prefix), &arguments)
}

/// Returns the signatures of the step and of its derivatives.
fn heads(file: &File, program: &Program) -> [String; 2] {
    STEPS.map(|(name, of)| head(file, program, name, of))
}

/// Returns the declarations for the header.
pub(super) fn declarations(file: &File) -> String {
    let Some(program) = accelerations(file) else { return String::new() };
    let [step, derivatives] = heads(file, program);
    let mut text = "\n".to_owned();
    text.push_str(&comment(
        "///",
        "A step of the classical Runge-Kutta method under torques tau that do not change during the step: positions \
         and velocities after it. It calls forward_dynamics four times. step: its duration h (s). The error of a \
         motion is of order h^4.",
    ));
    let _ = writeln!(text, "{step};");
    if has_derivatives(file) {
        text.push('\n');
        text.push_str(&comment(
            "///",
            "Derivatives of runge_kutta_step by q, by qd and by tau: the linear model of a step, exact up to rounding. \
             It calls forward_dynamics three times and forward_dynamics_derivatives four times. derivatives: as those \
             of euler_step_derivatives.",
        ));
        let _ = writeln!(text, "{derivatives};");
    }
    text
}

/// Returns the definitions of the functions.
pub(super) fn definitions(file: &File) -> String {
    let Some(program) = accelerations(file) else { return String::new() };
    let (step, derivatives) = TEMPLATE.split_once(DERIVATIVES).unwrap_or((TEMPLATE, ""));
    let template = if has_derivatives(file) { format!("{step}\n{derivatives}") } else { step.to_owned() };
    let number = |value: f64| file.precision.literal(value).unwrap_or_default();
    let (taken, passed, given) = if parameters::are_used(program) {
        (format!("const {} *parameters, ", parameters_type(file)), "parameters, ", ", parameters")
    } else {
        (String::new(), "", "")
    };
    let [of_step, of_derivatives] = heads(file, program);
    let dof = program.dof.to_string();
    let words = [
        ("PASSED", passed),
        ("GIVEN", given),
        ("ZERO", &number(0.0)),
        ("HALF", &number(0.5)),
        ("ONE", &number(1.0)),
        ("SIX", &number(6.0)),
        ("REAL", file.precision.c_type()),
        ("DOF", &dof),
        // the words below whose values contain the prefix are replaced after it
        ("PREFIX", file.prefix),
        ("TAKEN", &taken),
        ("HEAD_OF_STEP", &of_step),
        ("HEAD_OF_DERIVATIVES", &of_derivatives),
    ];
    let code = words.into_iter().fold(template, |code, (word, by)| code.replace(word, by));
    format!("\n{code}")
}
