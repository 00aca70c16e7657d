//! The plain formulas of a function with every value computed once, however often and in whatever way the formulas compute
//! it: the reduced form of what has no recursion of its own.

use rne_model::{Angle, Robot};

use crate::exact::{Number, Reading, Turn};
use crate::function::Form;
use crate::graph::Term;
use crate::program::Program;
use crate::proof::{self, Exactly};
use crate::quantity::Quantity;
use crate::worksheet::Worksheet;
use crate::{CompileError, derivation, schedule};

/// The function of the plain program, `arranged` and proved to be that of the plain formulas.
pub(crate) fn program(
    robot: &Robot,
    plain: &Program,
    arranged: fn(Program) -> Program,
) -> Result<Program, CompileError> {
    let function = plain.function;
    let reading = Reading::default();
    let sheet = Worksheet::merged(reading);
    let outputs = derivation::outputs(&sheet, robot, function);
    let written = sheet.finish();
    let numbers: Vec<Option<Number>> =
        written.graph.nodes().map(|(node, _)| written.graph.number(Term { node, negative: false })).collect();
    let heading = schedule::Heading {
        robot: &robot.name,
        dof: robot.dof(),
        parameters: robot.run_time.names.len(),
        function,
        form: Form::Reduced,
    };
    let (program, nodes) = schedule::program_and_constants(&heading, written, &outputs)?;
    let mut exactly = Exactly::new();
    for (constant, node) in program.constants.iter().zip(nodes) {
        let Some(number) = numbers[node.index()] else { continue };
        let turn = (constant.name.quantity == Quantity::Theta).then(|| reading.turn(&Angle::new(constant.value.abs())));
        let signed = if constant.value < 0.0 { (-number, turn.map(Turn::back)) } else { (number, turn) };
        exactly.insert(constant.name, signed);
    }
    let mut program = arranged(program);
    program.proof = Some(proof::prove_beside(plain, robot, &program, &exactly, reading)?);
    Ok(program)
}
