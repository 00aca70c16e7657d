//! The proof: a program is emitted only if it is the same function of the robot as the seven steps.
//!
//! Both are evaluated at random points of two prime fields, without rounding. Rational functions that agree there are
//! identical, except with a probability below 10⁻¹⁰⁰ (J. T. Schwartz, J. ACM 27, 1980). Constants are exact: a number
//! of the file is the fraction that its digits say, and an angle is a point of the circle over the field. This says
//! nothing about the rounding of constants, so [`crate::rounding`] runs both in double precision at random states, too.
//! Section 11 of docs/teaching/reduced-form.md has the argument in full.

use rne_model::{Angle, Robot};

use crate::exact::ExactFunction;
use crate::function::Function;
use crate::interpret::{Interpreter, Real};
use crate::ir::{Embedding, Exactly, Input, Name, Quantity, Residue, SamplePoint, composed, operators};
use crate::program::{Program, Proof};
use crate::refusal::largest_rounding;
use crate::rounding::{Reference, STATES, errors, loss, proof};
use crate::{CompileError, Suspect};

/// Number of random points in each field at which results are compared.
const POINTS: u64 = 4;
/// Proves that a program is the function of the seven steps. Also returns its loss in single precision, if that is too
/// large.
///
/// # Errors
/// When it is another function, or rounds too badly.
pub(crate) fn prove(
    reference: &Reference<'_>,
    program: &Program,
    constants: &Exactly,
    embedding: Embedding,
) -> Result<(Proof, Option<f64>), CompileError> {
    program.check_names()?;
    identical(reference.robot(), program, constants, embedding)?;
    let errors = errors(reference, program, STATES);
    let points = usize::try_from(POINTS).unwrap_or_default();
    let proof = proof(reference, points, &errors);
    if proof.rounding <= largest_rounding(program.function) {
        Ok((proof, loss(reference, program, &errors)))
    } else {
        Err(CompileError::Imprecise {
            function: program.function,
            rounding: proof.rounding,
            suspect: Suspect::default(),
        })
    }
}

/// Checks that a program returns the same numbers as the seven steps at all points of the fields.
///
/// # Errors
/// When an output differs at a point.
pub(crate) fn identical(
    robot: &Robot,
    program: &Program,
    constants: &Exactly,
    embedding: Embedding,
) -> Result<(), CompileError> {
    let plain = ExactFunction::with(robot, program.function, embedding);
    let interpreter = Interpreter::new(program);
    for index in 1..=POINTS {
        let point = SamplePoint::new(embedding, index);
        let expected = plain.at_point(&point);
        let found = values(robot, &interpreter, constants, &point);
        let differs = |index: &usize| found.as_ref().and_then(|found| found.get(*index)) != expected.get(*index);
        if let Some(index) = (0..expected.len()).find(differs) {
            let suspect = Suspect::default();
            return Err(CompileError::NotIdentical { function: program.function, output: index + 1, suspect });
        }
    }
    Ok(())
}

/// Whether the plain formulas of a function divide by zero in every state, because a mass matrix is always singular. No
/// other code can be proved to be the same as such formulas.
#[must_use]
pub fn divides_by_zero(robot: &Robot, function: Function) -> bool {
    if function.divides().is_none() {
        return false;
    }
    let embedding = Embedding::default();
    ExactFunction::with(robot, function, embedding).divides_by_zero(&SamplePoint::new(embedding, 1))
}

/// A number of a field that may be an angle: then it has a sine and a cosine.
#[derive(Clone, Copy)]
struct Value {
    number: Residue,
    turn: (Residue, Residue),
    /// If it is the position of a joint: the point where it is taken, and the joint, counted from 0.
    position: Option<(SamplePoint, usize)>,
}

impl Value {
    /// A number that is no angle. Its sine and cosine are both 0, which no angle has, so a wrong use is noticed.
    const fn number(number: Residue) -> Self {
        Self { number, turn: (Residue::ZERO, Residue::ZERO), position: None }
    }

    /// Returns the product, which is an angle if one factor is a joint position and the other a ratio.
    fn times(self, other: Self) -> Self {
        let number = self.number * other.number;
        match (self.position, other.position) {
            (Some((point, joint)), None) => {
                Self { turn: point.turn_times(joint, other.number), ..Self::number(number) }
            }
            (None, Some(_)) => other.times(self),
            _ => Self::number(number),
        }
    }
}

operators! { Value:
    a + b => Self { turn: composed(a.turn, b.turn), ..Self::number(a.number + b.number) };
    -a => Self { turn: (-a.turn.0, a.turn.1), ..Self::number(-a.number) };
    a - b => a + -b;
    a * b => a.times(b);
    a / b => Self::number(a.number * b.number.inverse().unwrap_or(Residue::ZERO));
}

impl Real for Value {
    /// A choice by a sign is no rational function. It gives an unknown, the same for the same operands.
    fn by_sign(self, positive: Self, negative: Self) -> Self {
        Self::number(Residue::by_sign([self, positive, negative].map(|value| value.number)))
    }
}

/// Returns an argument. The position of a prismatic joint is a length, but the angle of a revolute joint that follows
/// it.
fn argument(point: &SamplePoint, name: Name) -> Value {
    let number = Value::number(point.argument(Input::new(name)));
    match name.joint.checked_sub(1) {
        Some(index) if name.quantity == Quantity::Position => {
            Value { turn: point.turn(index), position: Some((*point, index)), ..number }
        }
        _ => number,
    }
}

/// The results of a program at a point.
fn values(robot: &Robot, program: &Interpreter, constants: &Exactly, point: &SamplePoint) -> Option<Vec<Residue>> {
    let constant = |name: Option<Name>, _| {
        let Some(name) = name else { return Some(Value::number(Residue::ZERO)) };
        let (number, turn) = constants.get(&name)?;
        // A number of the table may also be the offset of an angle, and was then not made as an angle.
        let of_number = || robot.has_couplings().then(|| point.embedding().turn(&Angle::new(number.to_f64())));
        let turn = turn.or_else(of_number);
        let turn = turn.map_or((Residue::ZERO, Residue::ZERO), |turn| (turn.sin.residue, turn.cos.residue));
        Some(Value { turn, ..Value::number(number.residue) })
    };
    let sin_cos = |angle: Value| (Value::number(angle.turn.0), Value::number(angle.turn.1));
    // a sine or cosine as an argument is that of the joint position
    let turn = |name: Name| argument(point, Name::scalar(Quantity::Position, name.joint)).turn;
    let input = |name: Name| match name.quantity {
        Quantity::Sine => Some(Value::number(turn(name).0)),
        Quantity::Cosine => Some(Value::number(turn(name).1)),
        _ => Some(argument(point, name)),
    };
    let outputs = program.run_named(input, constant, sin_cos)?;
    Some(outputs.into_iter().map(|output| output.number).collect())
}
