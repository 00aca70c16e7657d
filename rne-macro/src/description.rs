//! Describes a robot and its programs, for the documentation of the generated code.

use std::fmt::Debug;

use rne_codegen::Program;
use rne_model::Robot;

/// Describes the arm and its Denavit-Hartenberg table.
pub(crate) fn robot(robot: &Robot) -> String {
    let rne_emit::Heading { title, source, frames, table, .. } = rne_emit::Heading::of(robot);
    let text = format!("{title}\n{source}\n\n{frames}\n\n{table}");
    format!("The robot that this type represents, as a constant at compile time.\n\n{}", rne_emit::verbatim(&text))
}

/// Describes the operations of each program, before and after terms are removed.
pub(crate) fn operations(programs: &[Program]) -> String {
    let table = rne_emit::operations_table(programs);
    format!("Straight-line code. Operations of one call, of the unfolded recursion -> of this code:\n\n{table}")
}

/// Says why a form other than the seven steps can be trusted, which reduced forms were refused, and how much accuracy
/// single precision loses.
pub(crate) fn evidence(programs: &[Program]) -> Vec<String> {
    let proved = programs.iter().find_map(|program| Some(rne_emit::evidence(program, program.proof.as_ref()?)));
    let others = programs.iter().map(rne_emit::refusals).chain([rne_emit::losses(programs)]);
    let others = others.filter(|lines| !lines.is_empty());
    proved.into_iter().chain(others).map(|lines| rne_emit::verbatim(&lines.join("\n"))).collect()
}

/// The documentation of one method: its cost, its steps, and links. `of_trait` is the trait's path.
pub(crate) fn method(robot: &Robot, program: &Program, of_trait: &str) -> String {
    let (products, sums) = program.before();
    let after = program.operations();
    let steps = rne_emit::steps(robot, program);
    let steps = if steps.is_empty() {
        String::new()
    } else {
        let numbers = if robot.is_serial() {
            "joint i, h = i - 1, j = i + 1"
        } else {
            "joint i, its parent h, and each joint or loaded tip j on its link"
        };
        format!("Its steps, for {numbers}:\n\n{}\n\n", rne_emit::verbatim(&steps.join("\n")))
    };
    format!(
        "{}\n\n{} products, {} sums, {} angles; the unfolded recursion has {products} products and {sums} \
         sums.\n\n{steps}`rne explain NAME FILE` explains how a name is computed. Signs and units: \
         [`trait@{of_trait}`].",
        program.function.summary(),
        after.mul,
        after.add,
        after.sincos
    )
}

/// The values of a constant, which rustdoc does not show of an array.
pub(crate) fn values(values: &[impl Debug]) -> String {
    format!("\n\n{}", rne_emit::verbatim(&format!("{values:?}")))
}
