//! A robot and its programs in words, for the documentation of the generated code.

use std::fmt::{Debug, Write};

use rne_codegen::{Program, emit};
use rne_model::{Convention, Robot};

/// Which arm this is, and its Denavit-Hartenberg table.
pub(crate) fn robot(robot: &Robot) -> String {
    let mut text = format!("{}\n", emit::title(robot));
    let convention = match robot.convention {
        Convention::Standard => "standard (distal) Denavit-Hartenberg",
        Convention::Modified => "modified (proximal) Denavit-Hartenberg",
    };
    let [x, y, z] = robot.gravity;
    let _ = write!(
        text,
        "{}\n\n{convention}, acceleration of gravity ({x}, {y}, {z}) m/s² in frame 0\n\n{}",
        wrapped(&format!("Source: {}", robot.source.trim_end())),
        emit::dh_table(robot)
    );
    format!("The robot that this type stands for, at compile time.\n\n{}", emit::verbatim(&text))
}

/// What folding made of each program.
pub(crate) fn operations(programs: &[Program]) -> String {
    let mut text = "Straight-line code. Operations of one call, of the unfolded recursion → of this code:\n\n\
                    | method | products | sums | angles |\n|---|---|---|---|\n"
        .to_owned();
    for program in programs {
        let (products, sums) = program.before();
        let after = program.operations();
        let _ = writeln!(
            text,
            "| `{}` | {products} → {} | {sums} → {} | {} |",
            program.function, after.mul, after.add, after.sincos
        );
    }
    text
}

/// Why a form that is not the seven steps can be trusted.
pub(crate) fn evidence(programs: &[Program]) -> Option<String> {
    let (program, proof) = programs.iter().find_map(|program| Some((program, program.proof.as_ref()?)))?;
    Some(emit::verbatim(&emit::evidence(program, proof).join("\n")))
}

/// The documentation of one method.
pub(crate) fn method(program: &Program) -> String {
    let (products, sums) = program.before();
    let after = program.operations();
    format!(
        "{}\n\n{} products, {} sums, {} angles; the unfolded recursion has {products} products and {sums} sums.",
        program.function.summary(),
        after.mul,
        after.add,
        after.sincos
    )
}

/// The values of a constant, which rustdoc does not show of an array.
pub(crate) fn values(values: &[impl Debug]) -> String {
    format!("\n\n{}", emit::verbatim(&format!("{values:?}")))
}

/// Text in lines of a width that a page has room for.
fn wrapped(text: &str) -> String {
    const WIDTH: usize = 100;
    let mut lines = String::new();
    let mut column = 0;
    for word in text.split_whitespace() {
        let width = word.chars().count();
        if column > 0 {
            let breaks = column + 1 + width > WIDTH;
            lines.push(if breaks { '\n' } else { ' ' });
            column = if breaks { 0 } else { column + 1 };
        }
        lines.push_str(word);
        column += width;
    }
    lines
}
