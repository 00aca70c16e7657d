//! Writes a program as a Rust function.

use std::fmt::Write;

use rne_codegen::{ArgumentArray, Layout, Name, Program, SineCosine};
use rne_model::Robot;

use super::piece::Piece;
use super::{SinCos, about_frame};
use crate::annotated::Annotated;
use crate::expression::line;
use crate::inert::markdown;
use crate::listing::{Line, Selection, listing};
use crate::parameters::{self, Parameter};
use crate::syntax::Syntax;
use crate::wrap::WIDTH;

/// The longest array pattern that rustfmt writes in one line.
const PATTERN: usize = 62;

/// Returns the type of an argument: a number, or a reference to an array.
fn argument_type(array: &ArgumentArray) -> String {
    if array.is_number { "T".to_owned() } else { format!("&{}", array_type(&array.lengths())) }
}

/// The longest tuple that rustfmt writes in one line.
const TUPLE: usize = 60;

/// Returns the function of a program.
pub(super) fn function(robot: &Robot, program: &Program, sin_cos: SinCos) -> String {
    let mut text = format!("/// {}\n", program.function.summary());
    if let Some(frame) = about_frame(program) {
        let _ = writeln!(text, "///\n/// {}", markdown(&frame));
    }
    text.push_str("#[allow(clippy::all, clippy::pedantic)]\n#[must_use]\n");
    let arrays = program.arrays_without_parameters();
    text.push_str(&head(program, &arrays));
    text.extend(arrays.iter().map(taken_apart));
    for (index, name) in parameters::used(program) {
        let members = Parameter::of(robot, parameters::OF_RUST);
        let _ = writeln!(text, "    let {name} = parameters.{};", members[index].member);
    }
    if program.returns_zero() || program.constants().next().is_some() {
        text.push_str("\n    // constants\n");
    }
    if program.returns_zero() {
        text.push_str("    let zero: T = Scalar::from_f64(0.0);\n");
    }
    for constant in program.constants() {
        let _ = writeln!(text, "    let {}: T = Scalar::from_f64({:?});", constant.name, constant.value);
    }
    if !program.sines_and_cosines.is_empty() {
        text.push_str("\n    // sines and cosines of all angles\n");
        for statement in &program.angles {
            let _ = writeln!(text, "{}", Line::statement(program, statement));
        }
        let _ = writeln!(text, "{}", turns(program, sin_cos));
    }
    let statements = listing(robot, program, Selection::default());
    if !statements.is_empty() {
        let _ = write!(text, "\n{statements}");
    }
    text.push('\n');
    if let Some(returned) = returned(program) {
        let _ = writeln!(text, "    {returned}\n}}");
    }
    text
}

/// Returns the signature of the function: the name, the arguments and the result.
fn head(program: &Program, arrays: &[ArgumentArray]) -> String {
    let mut parameters: Vec<String> =
        arrays.iter().map(|array| format!("{}: {}", array.name, argument_type(array))).collect();
    if parameters::are_used(program) {
        parameters.push("parameters: &Parameters<T>".to_owned());
    }
    let start = format!("pub fn {}<T: Scalar>(", program.name);
    let mut end = format!(") -> {} {{", returned_type(&program.layout()));
    let line = format!("{start}{}{end}\n", parameters.join(", "));
    if line.len() <= WIDTH + 1 {
        return line;
    }
    if let Layout::Record(_, parts) = program.layout()
        && end.len() > ") -> () {".len() + TUPLE
    {
        let parts: Vec<String> = parts.iter().map(returned_type).collect();
        end = format!(") -> (\n    {},\n) {{", parts.join(",\n    "));
    }
    format!("{start}\n    {},\n{end}\n", parameters.join(",\n    "))
}

/// Returns the statement that gives names to the elements of an argument.
fn taken_apart(ArgumentArray { name, elements, row, is_number }: &ArgumentArray) -> String {
    if elements.iter().all(Option::is_none) {
        return format!("    let _ = {name};\n");
    }
    let all = names(elements.iter().copied());
    if *is_number {
        return format!("    let {all} = {name};\n");
    }
    let parts: Vec<String> = match row {
        Some(row) => elements.chunks(*row).map(|row| format!("[{}]", names(row.iter().copied()))).collect(),
        None => all.split(", ").map(str::to_owned).collect(),
    };
    let line = parts.join(", ");
    if line.len() + 2 <= PATTERN || row.is_some() && parts.len() == 1 {
        return format!("    let [{line}] = *{name};\n");
    }
    format!("    let [\n        {},\n    ] = *{name};\n", parts.join(",\n        "))
}

/// Returns the type of nested arrays with these lengths.
fn array_type(lengths: &[usize]) -> String {
    lengths.iter().rev().fold("T".to_owned(), |of, length| format!("[{of}; {length}]"))
}

/// Returns the names in a pattern, with `_` for each element that is not used.
fn names(names: impl Iterator<Item = Option<Name>>) -> String {
    names.map(|name| name.map_or_else(|| "_".to_owned(), |name| name.to_string())).collect::<Vec<_>>().join(", ")
}

/// Returns the results of a function, for a line that is indented by four.
pub(crate) fn returned(program: &Program) -> Option<Annotated> {
    let mut outputs =
        program.outputs.iter().map(|output| Piece::Number(line(Syntax::Rust, program.values.used(output.value))));
    let array = |elements| Piece::List('[', ']', elements);
    let record = |_, parts| Piece::List('(', ')', parts);
    let layout = program.layout();
    Some(layout.fold(&mut outputs, &array, &record)?.broken(4))
}

/// Returns the type of a result; a record is a tuple in this code.
fn returned_type(layout: &Layout) -> String {
    match layout {
        Layout::Number => "T".to_owned(),
        Layout::Array(length, of) => format!("[{}; {length}]", returned_type(of)),
        Layout::Record(_, parts) => {
            let parts: Vec<String> = parts.iter().map(returned_type).collect();
            format!("({})", parts.join(", "))
        }
    }
}

/// Returns the statements that compute all sines and cosines, with the line breaks of rustfmt. If the file has its own
/// sine, each angle has its own call, because compilers keep the calls over an array of five or more angles as a loop.
fn turns(program: &Program, sin_cos: SinCos) -> String {
    let turns = &program.sines_and_cosines[..];
    let groups = turns.chunks(if sin_cos == SinCos::InFile { 1 } else { turns.len() });
    groups.map(statement_of_turns(program)).collect::<Vec<_>>().join("\n")
}

fn statement_of_turns(program: &Program) -> impl Fn(&[SineCosine]) -> String {
    |turns| {
        let sines = names(turns.iter().map(|turn| turn.sine));
        let cosines = names(turns.iter().map(|turn| turn.cosine));
        let angles = turns.iter().map(|turn| line(Syntax::Rust, program.values.used(turn.angle)));
        let angles = Annotated::join(angles, ", ");
        if turns.len() == 1 {
            return format!("    let ({sines}, {cosines}) = Scalar::sin_cos({angles});");
        }
        let (left, right) =
            (format!("    let ([{sines}], [{cosines}]) ="), format!("Scalar::sin_cos_array([{angles}]);"));
        let gap = if left.len() + 1 + right.len() <= WIDTH { " " } else { "\n        " };
        left + gap + &right
    }
}
