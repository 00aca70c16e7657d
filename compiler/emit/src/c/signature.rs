//! Declares functions in C: first the arrays of arguments, then the results.

use std::fmt::Write;

use rne_codegen::{ArgumentArray, Layout, Program, Record};

use super::{File, runge_kutta};
use crate::parameters;
use crate::syntax::Precision;
use crate::wrap::{TIED, WIDTH, fill};

/// Returns the argument arrays of a function; none of them has the name of a function of the C library.
pub(crate) fn inputs(program: &Program) -> Vec<ArgumentArray> {
    let mut arrays = program.arrays_without_parameters();
    for array in &mut arrays {
        array.name = array_name(array.name);
    }
    arrays
}

/// Returns lengths or indices in square brackets.
pub(crate) fn subscript(numbers: &[usize]) -> String {
    numbers.iter().fold(String::new(), |text, number| text + &format!("[{number}]"))
}

/// Returns the name of an argument array in C, whose library has functions `sin` and `cos`.
pub(crate) fn array_name(name: &'static str) -> &'static str {
    match name {
        "sin" => "sine",
        "cos" => "cosine",
        name => name,
    }
}

/// Returns the signature of a function up to its closing parenthesis.
pub(super) fn head(file: &File, program: &Program) -> String {
    let real = file.precision.c_type();
    let layout = program.layout();
    let mut arguments: Vec<String> = inputs(program)
        .iter()
        .map(|array| format!("const {real} {}{}", array.name, subscript(&array.lengths())))
        .collect();
    if parameters::are_used(program) {
        arguments.push(format!("const {} *parameters", parameters_type(file)));
    }
    let returned = if layout == Layout::Number { real } else { "void" };
    if layout != Layout::Number {
        arguments.push(declared(file, &layout, program.function.entry().output));
    }
    wrapped(&format!("{returned} {}_{}(", file.prefix, program.name), &arguments)
}

/// Returns a signature with its arguments, in several lines if it is too long for one.
pub(super) fn wrapped(start: &str, arguments: &[String]) -> String {
    let line = format!("{start}{})", arguments.join(", "));
    // one column is left for the semicolon
    if line.len() < WIDTH {
        return line;
    }
    let arguments: Vec<String> = arguments.iter().map(|argument| argument.replace(' ', TIED)).collect();
    format!("{start}\n{}", fill(&(arguments.join(", ") + ")"), WIDTH, "    ", "    "))
}

/// Returns the lengths of nested arrays as C declares them, and the layout of their elements.
pub(crate) fn elements_of(layout: &Layout) -> (String, &Layout) {
    let (mut lengths, mut of) = (String::new(), layout);
    while let Layout::Array(length, element) = of {
        let _ = write!(lengths, "[{length}]");
        of = element;
    }
    (lengths, of)
}

/// Returns the type of an element.
pub(crate) fn element_type(prefix: &str, precision: Precision, element: &Layout) -> String {
    match element {
        Layout::Record(record, _) => record_name(prefix, *record),
        _ => precision.c_type().to_owned(),
    }
}

/// Returns the declaration of a parameter for a result: the address of a record, or an array.
fn declared(file: &File, layout: &Layout, name: &str) -> String {
    let star = if matches!(layout, Layout::Record(..)) { "*" } else { "" };
    variable(file, layout, &format!("{star}{name}"))
}

fn variable(file: &File, layout: &Layout, name: &str) -> String {
    let (lengths, of) = elements_of(layout);
    format!("{} {name}{lengths}", element_type(file.prefix, file.precision, of))
}

/// Returns the name of a record's type.
pub(super) fn record_type(file: &File, record: Record) -> String {
    record_name(file.prefix, record)
}

/// Returns the name of a record's type in a file with this prefix.
#[must_use]
pub fn record_name(prefix: &str, record: Record) -> String {
    format!("{prefix}_{}", record.c_name())
}

/// Returns the name of the type of the run-time parameters.
pub(super) fn parameters_type(file: &File) -> String {
    format!("{}_parameters", file.prefix)
}

/// Returns the declarations of the fields of a record.
pub(super) fn fields(file: &File, record: Record, parts: &[Layout]) -> Vec<String> {
    record.fields().iter().zip(parts).map(|(name, part)| variable(file, part, name)).collect()
}

/// Returns every record that the functions return, without duplicates; a record that is part of another one comes
/// before it.
pub(super) fn records(file: &File) -> Vec<(Record, Vec<Layout>)> {
    fn put(layout: &Layout, records: &mut Vec<(Record, Vec<Layout>)>) {
        let (_, Layout::Record(record, parts)) = elements_of(layout) else { return };
        for part in parts {
            put(part, records);
        }
        if records.iter().all(|(other, _)| other != record) {
            records.push((*record, parts.clone()));
        }
    }
    let mut records = Vec::new();
    for layout in file.programs.iter().map(Program::layout).chain(runge_kutta::layouts(file)) {
        put(&layout, &mut records);
    }
    records
}

/// Returns the variables to which the numbers of a result are written, in order.
pub(super) fn places(program: &Program) -> Vec<String> {
    let mut places = Vec::new();
    // the parameter for a record is its address
    elements(&program.layout(), program.function.entry().output, "->", &mut places);
    places
}

/// Returns expressions for the numbers of a result that is stored in a variable.
#[must_use]
pub fn result_elements(program: &Program, variable: &str) -> Vec<String> {
    layout_elements(&program.layout(), variable)
}

/// Returns expressions for the numbers of a variable with this layout, in order.
pub(crate) fn layout_elements(layout: &Layout, variable: &str) -> Vec<String> {
    let mut places = Vec::new();
    elements(layout, variable, ".", &mut places);
    places
}

fn elements(layout: &Layout, name: &str, dot: &str, places: &mut Vec<String>) {
    match layout {
        Layout::Number => places.push(name.to_owned()),
        Layout::Array(length, of) => {
            (0..*length).for_each(|index| elements(of, &format!("{name}[{index}]"), ".", places));
        }
        Layout::Record(record, parts) => {
            let fields = record.fields().iter().zip(parts);
            fields.for_each(|(field, part)| elements(part, &format!("{name}{dot}{field}"), ".", places));
        }
    }
}
