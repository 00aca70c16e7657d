//! The momentum observer in C: a struct for its state between two control cycles, its initialisation and its update.
//!
//! It does the same operations as `ObserverState` of the runtime in the same order, joint by joint. Only the weight of
//! the low-pass filter is computed in the number type of the file.

use std::fmt::Write;

use rne_codegen::{Function, Program, Record};

use super::signature::{parameters_type, record_type, wrapped};
use super::{File, comment};
use crate::parameters;

/// Returns the program that the observer calls, if the file has it.
fn program<'a>(file: &'a File) -> Option<&'a Program> {
    file.programs.iter().find(|program| program.function == Function::MomentumAndRate)
}

/// Returns the struct and the declarations for the header.
pub(super) fn declarations(file: &File) -> String {
    let Some(program) = program(file) else { return String::new() };
    let (real, prefix, dof) = (file.precision.c_type(), file.prefix, program.dof);
    let mut text = "\n".to_owned();
    text.push_str(&comment("///", "What a momentum observer knows from one tick of a controller to the next."));
    let _ = writeln!(text, "typedef struct {{");
    for (about, member) in [
        ("M q' of the last update.", format!("momentum[{dof}]")),
        ("Its rate without external torques.", format!("rate[{dof}]")),
        ("The external torques, N m or N.", format!("external[{dof}]")),
        ("The weight of the next update: 0 of the first one.", "next".to_owned()),
        ("1 - exp(-2 pi gain period).", "weight".to_owned()),
        ("1 / period, Hz.", "frequency".to_owned()),
    ] {
        let _ = writeln!(text, "    /// {about}\n    {real} {member};");
    }
    let _ = writeln!(text, "}} {prefix}_observer;\n");
    text.push_str(&comment(
        "///",
        "Begins an observer whose low-pass has a gain of `gain` Hz (a time constant of 1/(2 pi gain) s), to be updated \
         every `period` s. Stable for every gain and period above zero. With a gain or a period that is not above \
         zero, and with a period below 1e-30 s, every update writes zeros.",
    ));
    let _ = writeln!(text, "{};\n", begin_head(file));
    text.push_str(&comment(
        "///",
        "One tick: what was measured at its end. external: torques of the environment on the arm, positive along the \
         joint, through the low-pass; friction shows in them, unless it is taken out of tau. The first update after \
         the beginning writes zeros. After a sample that is not finite they are not finite until the observer is begun \
         anew.",
    ));
    let _ = writeln!(text, "{};", update_head(file, program));
    text
}

/// Returns the definitions of the functions.
pub(super) fn definitions(file: &File) -> String {
    let Some(program) = program(file) else { return String::new() };
    let (real, prefix, dof) = (file.precision.c_type(), file.prefix, program.dof);
    let number = |value: f64| file.precision.literal(value).unwrap_or_default();
    let [zero, one, two, half] = [0.0, 1.0, 2.0, 0.5].map(number);
    let mut text = format!("\n{}\n{{\n", begin_head(file));
    let _ = writeln!(text, "    // a 64th of the exponent, between 0 and 1/2");
    let _ = writeln!(text, "    {real} x = {} * gain * period;", number(core::f64::consts::TAU));
    let _ = writeln!(text, "    x = (x > {zero}) ? ((x < {}) ? x : {}) : {zero};", number(32.0), number(32.0));
    let _ = writeln!(text, "    x = {} * x;", number(1.0 / 64.0));
    let _ = writeln!(text, "    // 1 - exp(-x), by its series; then six times that of twice x");
    let _ = writeln!(text, "    {real} w = {one};");
    for k in (2..=TERMS).rev() {
        let _ = writeln!(text, "    w = {one} - ({} * x * w);", number(1.0 / f64::from(k)));
    }
    let _ = writeln!(text, "    w = x * w;");
    for _ in 0..6 {
        let _ = writeln!(text, "    w = w * ({two} - w);");
    }
    for joint in 0..dof {
        for member in ["momentum", "rate", "external"] {
            let _ = writeln!(text, "    observer->{member}[{joint}] = {zero};");
        }
    }
    let shortest = number(SHORTEST_PERIOD);
    let _ = writeln!(text, "    // of a shorter tick the frequency may not be finite");
    let _ = writeln!(text, "    const {real} frequency = {one} / period;");
    let _ = writeln!(text, "    observer->next = {zero};");
    let _ = writeln!(text, "    observer->weight = (period >= {shortest}) ? w : {zero};");
    let _ = writeln!(text, "    observer->frequency = (period >= {shortest}) ? frequency : {zero};\n}}");

    let _ = writeln!(text, "\n{}\n{{", update_head(file, program));
    let record = record_type(file, Record::MomentumAndRate);
    let given = if parameters::are_used(program) { ", parameters" } else { "" };
    let _ = writeln!(text, "    {record} now;\n    {real} mean;");
    let _ = writeln!(text, "    {prefix}_{}(q, qd, tau{given}, &now);", program.function);
    for i in 0..dof {
        let lines = [
            format!("mean = (now.momentum[{i}] - observer->momentum[{i}]) * observer->frequency;"),
            format!("mean = mean - ((now.rate[{i}] + observer->rate[{i}]) * {half});"),
            format!("mean = (mean - observer->external[{i}]) * observer->next;"),
            format!("observer->external[{i}] = observer->external[{i}] + mean;"),
            format!("observer->momentum[{i}] = now.momentum[{i}];"),
            format!("observer->rate[{i}] = now.rate[{i}];"),
            format!("external[{i}] = observer->external[{i}];"),
        ];
        let _ = writeln!(text, "\n    // joint {}", i + 1);
        for line in lines {
            let _ = writeln!(text, "    {line}");
        }
    }
    text.push_str("\n    observer->next = observer->weight;\n}\n");
    text
}

/// The shortest control period, s, as in the runtime.
const SHORTEST_PERIOD: f64 = 1e-30;

/// Number of terms of the series: at 1/2, the next term is below one unit in the last place of a double.
const TERMS: u32 = 14;

fn begin_head(file: &File) -> String {
    let (real, prefix) = (file.precision.c_type(), file.prefix);
    format!("void {prefix}_observer_begin({prefix}_observer *observer, {real} gain, {real} period)")
}

fn update_head(file: &File, program: &Program) -> String {
    let (real, prefix, dof) = (file.precision.c_type(), file.prefix, program.dof);
    let mut arguments = vec![format!("{prefix}_observer *observer")];
    arguments.extend(["q", "qd", "tau"].map(|name| format!("const {real} {name}[{dof}]")));
    if parameters::are_used(program) {
        arguments.push(format!("const {} *parameters", parameters_type(file)));
    }
    arguments.push(format!("{real} external[{dof}]"));
    wrapped(&format!("void {prefix}_observer_update("), &arguments)
}
