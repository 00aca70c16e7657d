//! The C source: sine and cosine, and every function.

use std::fmt::Write;

use rne_codegen::{ArgumentArray, Layout, Order, Program, statements_of_outputs};

use super::header::columns;
use super::signature::{head, inputs, places, subscript};
use super::{ConstantTooLarge, File, casadi, joint_functions, motors, observer, runge_kutta};
use crate::expression::line;
use crate::line_breaks::statement;
use crate::listing::{Line, Selection, listing};
use crate::parameters::{self, Parameter};
use crate::syntax::Precision;
use crate::text::legend;

/// Sine and cosine in C; PREFIX is replaced by the prefix.
pub(crate) const SIN_COS: [&str; 2] = [include_str!("sin_cos_float.c"), include_str!("sin_cos_double.c")];

/// Returns the source after the line that includes the header.
pub(super) fn body(file: &File) -> Result<String, ConstantTooLarge> {
    let mut text = String::new();
    if file.turns() {
        text.push_str("#include <float.h>\n#include <stdint.h>\n\n");
    } else if joint_functions::needs_bits(file) {
        text.push_str("#include <stdint.h>\n\n");
    }
    text.push_str("// Names, for link or joint i and axis x, in frame i at joint i, fixed to link i:\n//\n");
    let names: Vec<_> =
        legend(file.robot, file.programs).into_iter().map(|(name, meaning)| [name, meaning.to_owned()]).collect();
    text.push_str(&columns(&names));
    if file.turns() {
        let [float, double] = SIN_COS;
        let kernel = match file.precision {
            Precision::Single => float,
            Precision::Double => double,
        };
        let _ = write!(text, "\n{}", kernel.replace("PREFIX", file.prefix));
    }
    if file.chooses_by_sign() {
        let _ = write!(text, "\n{}", by_sign(file));
    }
    for program in file.programs {
        let _ = write!(text, "\n{}", function(file, program)?);
    }
    text.push_str(&runge_kutta::definitions(file));
    text.push_str(&observer::definitions(file));
    text.push_str(&joint_functions::definitions(file)?);
    text.push_str(&motors::definitions(file)?);
    text.push_str(&casadi::definitions(file));
    Ok(text)
}

fn by_sign(file: &File) -> String {
    let (real, prefix, zero) = (file.precision.c_type(), file.prefix, file.syntax().zero());
    format!(
        "// `positive` where x is above 0, `negative` where it is below, else 0.\n\
         static {real} {prefix}_by_sign({real} x, {real} positive, {real} negative)\n{{\n    \
         return (x > {zero}) ? positive : ((x < {zero}) ? negative : {zero});\n}}\n"
    )
}

fn function(file: &File, program: &Program) -> Result<String, ConstantTooLarge> {
    let syntax = file.syntax();
    let mut text = format!("{}\n{{\n", head(file, program));
    text.push_str(&arguments(file, program));
    if program.constants().next().is_some() {
        text.push_str("\n    // constants\n");
    }
    for constant in program.constants() {
        let literal = file.precision.literal(constant.value).ok_or(ConstantTooLarge {
            name: constant.name,
            value: constant.value,
            function: program.function,
        })?;
        let _ = writeln!(text, "    {} {} = {literal};", syntax.declaration(), constant.name);
    }
    if !program.sines_and_cosines.is_empty() {
        text.push_str("\n    // sines and cosines of all angles\n");
        for statement in &program.angles {
            let _ = writeln!(text, "{}", Line::statement(program, statement).indented(syntax));
        }
        text.push_str(&turns(file, program));
    }
    if program.order == Order::Registers && program.layout() != Layout::Number {
        text.push('\n');
        text.push_str(&stored_at_once(file, program));
        text.push_str("}\n");
        return Ok(text);
    }
    let statements = listing(file.robot, program, Selection::default());
    if !statements.is_empty() {
        let _ = write!(text, "\n{}", statements.text(syntax));
    }
    text.push('\n');
    text.extend(result(file, program));
    text.push_str("}\n");
    Ok(text)
}

/// Returns the statements, with each result stored as soon as it is known, so that its register becomes free. Arguments
/// are read before, so a result array may be the same memory as an argument.
fn stored_at_once(file: &File, program: &Program) -> String {
    let mut results = result(file, program).into_iter().zip(statements_of_outputs(program)).collect::<Vec<_>>();
    // the sort is stable, so the results of one statement keep their order
    results.sort_by_key(|(_, after)| *after);
    let mut results = results.into_iter().peekable();
    let mut text = String::new();
    let mut store = |text: &mut String, known: Option<usize>| {
        while let Some((line, _)) = results.next_if(|(_, after)| *after <= known) {
            text.push_str(&line);
        }
    };
    store(&mut text, None);
    for (index, statement) in program.statements.iter().enumerate() {
        let _ = writeln!(text, "{}", Line::statement(program, statement).indented(file.syntax()));
        store(&mut text, Some(index));
    }
    text
}

/// Returns declarations for the elements of arguments that the program uses, with their names.
fn arguments(file: &File, program: &Program) -> String {
    let declaration = file.syntax().declaration();
    let mut text = String::new();
    for argument in inputs(program) {
        let ArgumentArray { name: array, elements, .. } = &argument;
        if elements.iter().all(Option::is_none) {
            let _ = writeln!(text, "    (void){array};");
        }
        for (index, name) in elements.iter().enumerate() {
            if let Some(name) = name {
                let place = subscript(&argument.places(index));
                let _ = writeln!(text, "    {declaration} {name} = {array}{place};");
            }
        }
    }
    let members = Parameter::of(file.robot, parameters::OF_C);
    for (index, name) in parameters::used(program) {
        let _ = writeln!(text, "    {declaration} {name} = parameters->{};", members[index].member);
    }
    text
}

/// The variable for a sine or cosine that is not needed.
pub(crate) const UNUSED: &str = "unused";

/// Returns one call of sine and cosine for each angle. Results that are not needed go to one shared variable.
fn turns(file: &File, program: &Program) -> String {
    let (real, prefix) = (file.precision.c_type(), file.prefix);
    let (mut places, mut calls) = (String::new(), String::new());
    if program.sines_and_cosines.iter().any(|turn| turn.sine.is_none() || turn.cosine.is_none()) {
        let _ = writeln!(places, "    {real} {UNUSED};");
    }
    for turn in &program.sines_and_cosines {
        for name in [turn.sine, turn.cosine].into_iter().flatten() {
            let _ = writeln!(places, "    {real} {name};");
        }
        let [sine, cosine] =
            [turn.sine, turn.cosine].map(|name| name.map_or(UNUSED.to_owned(), |name| name.to_string()));
        let _ = writeln!(
            calls,
            "    {prefix}_sin_cos({}, &{sine}, &{cosine});",
            line(file.syntax(), program.values.used(turn.angle))
        );
    }
    places + &calls
}

/// Returns the lines that return the results, in the order of the results.
fn result(file: &File, program: &Program) -> Vec<String> {
    let syntax = file.syntax();
    let values = program.outputs.iter().map(|output| program.values.used(output.value));
    let starts = match program.layout() {
        Layout::Number => vec!["return".to_owned()],
        _ => places(program).into_iter().map(|place| place + " =").collect(),
    };
    let lines = starts.into_iter().zip(values);
    lines.map(|(start, value)| statement(syntax, "    ", start.into(), value).to_string() + "\n").collect()
}
