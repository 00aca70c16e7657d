//! The functions as C declares them: arrays in, then what is returned.

use std::fmt::Write;

use rne_codegen::{ArgumentArray, Layout, Program, Record};

use super::File;
use crate::parameters;
use crate::wrap::{TIED, WIDTH, fill};

/// The argument arrays of a function, by names that are no functions of the C library.
pub(crate) fn inputs(program: &Program) -> Vec<ArgumentArray> {
    let mut arrays = program.arrays_without_parameters();
    for array in &mut arrays {
        array.name = match array.name {
            "sin" => "sine",
            "cos" => "cosine",
            name => name,
        };
    }
    arrays
}

/// A function's head, without what follows its parentheses.
pub(super) fn head(file: &File, program: &Program) -> String {
    let real = file.precision.c_type();
    let layout = program.function.layout(program.dof);
    let mut arguments: Vec<String> = inputs(program)
        .iter()
        .map(|ArgumentArray { name, elements }| format!("const {real} {name}[{}]", elements.len()))
        .collect();
    if parameters::are_used(program) {
        arguments.push(format!("const {} *parameters", parameters_type(file)));
    }
    let returned = if layout == Layout::Number { real } else { "void" };
    if layout != Layout::Number {
        arguments.push(declared(file, &layout, program.function.entry().output));
    }
    let start = format!("{returned} {}_{}(", file.prefix, program.function);
    let line = format!("{start}{})", arguments.join(", "));
    // one column is for the semicolon
    if line.len() < WIDTH {
        return line;
    }
    let arguments: Vec<String> = arguments.iter().map(|argument| argument.replace(' ', TIED)).collect();
    start + "\n" + &fill(&(arguments.join(", ") + ")"), WIDTH, "    ", "    ")
}

/// A parameter through which a result is written: a record by its address, arrays as what they are.
fn declared(file: &File, layout: &Layout, name: &str) -> String {
    let mut lengths = String::new();
    let mut of = layout;
    while let Layout::Array(length, element) = of {
        let _ = write!(lengths, "[{length}]");
        of = element;
    }
    match of {
        Layout::Record(record, _) if lengths.is_empty() => format!("{} *{name}", record_type(file, *record)),
        Layout::Record(record, _) => format!("{} {name}{lengths}", record_type(file, *record)),
        _ => format!("{} {name}{lengths}", file.precision.c_type()),
    }
}

/// The name of a record's type.
pub(super) fn record_type(file: &File, record: Record) -> String {
    record_name(file.prefix, record)
}

/// The name of a record's type with a prefix.
pub(crate) fn record_name(prefix: &str, record: Record) -> String {
    let name = match record {
        Record::Pose => "pose",
        Record::Wrench => "wrench",
        Record::TorqueDerivatives => "torque_derivatives",
        Record::MomentumAndRate => "momentum",
    };
    format!("{prefix}_{name}")
}

/// The type of the run-time parameters.
pub(super) fn parameters_type(file: &File) -> String {
    format!("{}_parameters", file.prefix)
}

/// The fields of a record as they are declared.
pub(super) fn fields(file: &File, record: Record, parts: &[Layout]) -> Vec<String> {
    record.fields().iter().zip(parts).map(|(name, part)| declared(file, part, name)).collect()
}

/// Every record that the functions return, once.
pub(super) fn records(file: &File) -> Vec<(Record, Vec<Layout>)> {
    let mut records: Vec<(Record, Vec<Layout>)> = Vec::new();
    for program in file.programs {
        let mut layout = program.function.layout(program.dof);
        while let Layout::Array(_, of) = layout {
            layout = *of;
        }
        if let Layout::Record(record, parts) = layout
            && records.iter().all(|(other, _)| *other != record)
        {
            records.push((record, parts));
        }
    }
    records
}

/// Where the numbers of a result are written, in their order.
pub(super) fn places(program: &Program) -> Vec<String> {
    let mut places = Vec::new();
    // a record is written by its address
    elements(&program.function.layout(program.dof), program.function.entry().output, "->", &mut places);
    places
}

/// The numbers of a result that is a variable.
pub(crate) fn result_elements(program: &Program, variable: &str) -> Vec<String> {
    let mut places = Vec::new();
    elements(&program.function.layout(program.dof), variable, ".", &mut places);
    places
}

fn elements(layout: &Layout, name: &str, dot: &str, places: &mut Vec<String>) {
    match layout {
        Layout::Number => places.push(name.to_owned()),
        Layout::Array(length, of) => {
            (0..*length).for_each(|index| elements(of, &format!("{name}[{index}]"), ".", places));
        }
        Layout::Record(record, parts) => {
            let fields = record.fields().into_iter().zip(parts);
            fields.for_each(|(field, part)| elements(part, &format!("{name}{dot}{field}"), ".", places));
        }
    }
}
