//! The gate: a program is emitted only if it is the same function of the robot as the seven steps.
//!
//! Both are evaluated at random points of two prime fields, without rounding. Rational functions that agree there are
//! identical, but for a probability below 10⁻¹⁰⁰ (J. T. Schwartz, J. ACM 27, 1980). That says nothing of how constants
//! were rounded, so both are run in double precision at random states as well.

use rne_model::{Angle, Robot};

use crate::exact::ExactFunction;
use crate::function::Function;
use crate::interpret::{Arguments, Interpreter, Real};
use crate::ir::{Embedding, Exactly, Input, Name, Quantity, Residue, SamplePoint, composed, operators};
use crate::program::{Program, Proof};
use crate::refusal::{largest_loss, largest_rounding};
use crate::{CompileError, Suspect};

/// Number of random points in each field at which torques are compared.
const POINTS: u64 = 4;
/// States at which rounding is measured when code is generated.
const STATES: usize = 24;
/// Operations that may be run to measure a loss of single precision once [`STATES`] show that it is too much. Users are
/// told that number, and a few states give a third of it: large errors are rare.
const OPERATIONS_OF_LOSS: usize = 4_000_000;
/// If single precision changes accelerations by this part of the largest, the mass matrix counts as singular but for
/// rounding.
const SINGULAR: f64 = 0.1;

/// The payload at the random states, a body of 2 kg some centimetres from the tip: mass, centre of mass, inertia, as
/// numbers that single precision has, too.
const PAYLOAD: [f64; 10] = [2.0, 0.0625, -0.03125, 0.125, 0.125, 0.125, 0.09375, 0.03125, -0.03125, 0.03125];

/// Parts of the torques of motion, and their derivatives, may vanish but for rounding: they count as this part of those
/// torques at least.
const LEAST_SCALE: f64 = 1e-2;

/// The seven steps, compiled: programs are compared with them.
#[derive(Debug)]
pub struct Reference<'r> {
    robot: &'r Robot,
    faithful: Program,
    /// The program with joints near the arm, where the table has them far away: numbers are compared with its numbers.
    near: Option<Program>,
    /// The torques of motion, of which what the function returns are parts.
    motion: Option<Program>,
}

impl<'r> Reference<'r> {
    /// `compiled` compiles a function of the robot by the seven steps, with joints near the arm. `is_far` says that the
    /// table has joints far from the arm.
    ///
    /// # Errors
    /// When they cannot be compiled.
    pub(crate) fn new(
        robot: &'r Robot,
        faithful: Program,
        is_far: bool,
        compiled: impl Fn(Function) -> Result<Program, CompileError>,
    ) -> Result<Self, CompileError> {
        let function = faithful.function;
        let of_motion =
            if function.is_of_closed_loops() { Function::InverseDynamicsOfLoops } else { Function::InverseDynamics };
        let motion = if function.entry().is_of_motion { Some(compiled(of_motion)?) } else { None };
        let near = if is_far { Some(compiled(function)?) } else { None };
        Ok(Self { robot, faithful, near, motion })
    }

    pub(crate) const fn robot(&self) -> &'r Robot {
        self.robot
    }

    /// Whether the table has joints far from the arm, and other code than the seven steps has not.
    pub(crate) const fn is_near(&self) -> bool {
        self.near.is_some()
    }

    /// The function by the seven steps.
    pub(crate) fn into_program(self) -> Program {
        self.faithful
    }

    /// Their operations.
    pub(crate) fn operations(&self) -> usize {
        self.faithful.operations().total()
    }
}

/// Compares a program with the seven steps; then what it loses in single precision, if that is too much.
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
    identical(reference.robot, program, constants, embedding)?;
    let errors = errors(reference, program, STATES);
    let proof = rounding(reference, &errors);
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

/// Whether the plain formulas of a function divide by what is zero in every state: no inverse of a mass matrix that is
/// always singular is the same function as another.
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
    /// A number that is no angle: its sine would be wrong whatever it is.
    const fn number(number: Residue) -> Self {
        Self { number, turn: (Residue::ZERO, Residue::ZERO), position: None }
    }

    /// A product, which is an angle if it is that of a position and a ratio.
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
    /// No rational function: an unknown, the same for the same operands.
    fn by_sign(self, positive: Self, negative: Self) -> Self {
        Self::number(Residue::by_sign([self, positive, negative].map(|value| value.number)))
    }
}

/// An argument. The position of a joint that slides is a length, and is the angle of a revolute joint that follows it.
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
        // A number of the table that is the offset of an angle, too, was not made as an angle.
        let of_number = || robot.has_couplings().then(|| point.embedding().turn(&Angle::new(number.to_f64())));
        let turn = turn.or_else(of_number);
        let turn = turn.map_or((Residue::ZERO, Residue::ZERO), |turn| (turn.sin.residue, turn.cos.residue));
        Some(Value { turn, ..Value::number(number.residue) })
    };
    let sin_cos = |angle: Value| (Value::number(angle.turn.0), Value::number(angle.turn.1));
    // sines and cosines that are arguments belong to the positions
    let turn = |name: Name| argument(point, Name::scalar(Quantity::Position, name.joint)).turn;
    let input = |name: Name| match name.quantity {
        Quantity::Sine => Some(Value::number(turn(name).0)),
        Quantity::Cosine => Some(Value::number(turn(name).1)),
        _ => Some(argument(point, name)),
    };
    let outputs = program.run_named(input, constant, sin_cos)?;
    Some(outputs.into_iter().map(|output| output.number).collect())
}

/// The error of a program of the seven steps in single precision, if that is too much.
///
/// # Errors
/// When what it is compared with cannot be compiled.
pub(crate) fn loss_of_seven_steps(robot: &Robot, program: &Program) -> Result<Option<f64>, CompileError> {
    let reference = Reference::to(robot, program.clone())?;
    Ok(loss(&reference, program, &errors(&reference, program, STATES)))
}

/// Factor between the error that is reported and the largest error that was measured: at 20 other states of 200
/// calibrated tables, errors were up to 6.4 times as large, in 22 functions more than 3 times
/// (docs/measured/accuracy.md).
const MARGIN: f64 = 3.0;

/// The largest error in single precision times the margin, in parts of the largest number that the function returns at
/// any of the states, if that is too much.
fn loss(reference: &Reference<'_>, program: &Program, few: &[Errors]) -> Option<f64> {
    let error = |errors: &[Errors]| {
        let largest = |of: fn(&Errors) -> f64| errors.iter().map(of).fold(0.0, larger);
        let error = MARGIN * largest(|errors| errors.single * errors.scale) / largest(|errors| errors.scale);
        (!errors.is_empty() && (error.is_nan() || error > largest_loss(program.function))).then_some(error)
    };
    let states = OPERATIONS_OF_LOSS / program.operations().total().max(1);
    error(few).and_then(|_| error(&errors(reference, program, states.clamp(10 * STATES, 100 * STATES))))
}

/// The program and the seven steps in floating point.
fn rounding(reference: &Reference<'_>, errors: &[Errors]) -> Proof {
    let mut proof = Proof {
        points: usize::try_from(POINTS).unwrap_or_default(),
        states: 0,
        rounding: 0.0,
        single: 0.0,
        single_of_seven_steps: 0.0,
        before: reference.faithful.fold_report.before(),
    };
    for errors in errors.iter().filter(|errors| errors.is_regular) {
        proof.states += 1;
        proof.rounding = larger(proof.rounding, errors.double);
        proof.single = larger(proof.single, errors.single);
        proof.single_of_seven_steps = larger(proof.single_of_seven_steps, errors.single_of_seven_steps);
    }
    proof
}

/// How much larger the error of a program in single precision is than that of the seven steps, on the average: the
/// largest error depends on which rare states one meets.
pub(crate) fn loss_of_precision(reference: &Reference<'_>, program: &Program, states: usize) -> f64 {
    let errors = errors(reference, program, states);
    let sum = |error: fn(&Errors) -> f64| errors.iter().filter(|errors| errors.is_regular).map(error).sum::<f64>();
    let (found, expected) = (sum(|errors| errors.single), sum(|errors| errors.single_of_seven_steps));
    if found == 0.0 { 0.0 } else { found / expected }
}

/// Differences from the seven steps in double precision at one state, relative to the largest torque.
struct Errors {
    double: f64,
    single: f64,
    single_of_seven_steps: f64,
    /// The largest torque.
    scale: f64,
    /// Whether accelerations mean something: the mass matrix is not singular but for rounding.
    is_regular: bool,
}

/// The range of the positions of a joint at which programs are compared: within ±3 where the limits allow it.
fn positions(limits: Option<(f64, f64)>) -> (f64, f64) {
    let (low, high) = limits.unwrap_or((-3.0, 3.0));
    if low.max(-3.0) <= high.min(3.0) { (low.max(-3.0), high.min(3.0)) } else { (low, high) }
}

/// Runs a program and the seven steps in floating point at random states: positions within the limits of the joints, ±3
/// without limits, |q̇| ≤ 2, |q̈| ≤ 4. Closed loops are at positions that close them.
#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
fn errors(reference: &Reference<'_>, program: &Program, states: usize) -> Vec<Errors> {
    let Reference { robot, faithful, near, motion } = reference;
    let mut all = Vec::with_capacity(states);
    let steps = Interpreter::new(faithful);
    let precise = near.as_ref().map(Interpreter::new);
    let precise = precise.as_ref().unwrap_or(&steps);
    let motion = motion.as_ref().map(Interpreter::new);
    let reduced = Interpreter::new(program);
    // as they stand in the file, and rounded
    let parameters = robot.run_time.values(robot);
    let parameters_in_single: Vec<f32> = parameters.iter().map(|&value| value as f32).collect();
    let parameters: Vec<f64> = parameters_in_single.iter().copied().map(f64::from).collect();
    let mut rng = fastrand::Rng::with_seed(2024);
    for state_index in 0..states {
        // numbers of single precision, so that both precisions are given the same state
        let mut between = |low: f64, high: f64| f64::from((low + (high - low) * rng.f64()) as f32);
        // where no loop is closed, its equations may be nearly singular
        let closures = &robot.closed.closures;
        let closure = closures.get(state_index % closures.len().max(1));
        let closed = |closure: &Vec<f64>, joint: usize| f64::from(closure[joint] as f32);
        let q: Vec<f64> = robot
            .coordinates()
            .map(|joint| {
                let (low, high) = positions(robot.joints[joint].limits.position);
                closure.map_or_else(|| between(low, high), |closure| closed(closure, joint))
            })
            .collect();
        let passive: Vec<f64> =
            closure.map(|it| robot.closed.passive.iter().map(|&joint| closed(it, joint)).collect()).unwrap_or_default();
        let mut random = |range: f64| (0..robot.dof()).map(|_| between(-range, range)).collect::<Vec<f64>>();
        let (qd, qdd) = (random(2.0), random(4.0));
        // users read the largest error of these states: the base must move in many ways, not in one
        let vectors = [(); 4].map(|()| match state_index {
            ..STATES => [5.0, -3.0, 2.0],
            _ => [(); 3].map(|()| between(-10.0, 10.0)),
        });
        let wrenches = at_tips(robot, vectors[0]);
        let arguments = state([&q, &passive, &qd, &qdd], vectors, &wrenches, PAYLOAD, &parameters);
        let [expected, found] =
            [precise, &reduced].map(|code| code.run(&arguments, |x| x, f64::sin_cos).unwrap_or_default());
        let largest = |torques: &[f64]| torques.iter().fold(0.0_f64, |largest, torque| largest.max(torque.abs()));
        let torques = motion.as_ref().and_then(|motion| motion.run(&arguments, |x| x, f64::sin_cos));
        let scale = largest(&expected).max(LEAST_SCALE * torques.map_or(0.0, |torques| largest(&torques)));
        // a singular mass matrix has no accelerations to compare
        if scale == 0.0 || !expected.iter().all(|value| value.is_finite()) {
            continue;
        }
        let error = |torques: &[f64]| {
            let difference = |(a, b): (&f64, &f64)| (a - b).abs() / scale;
            torques.iter().zip(&expected).map(difference).fold(0.0, larger)
        };
        let single = |code: &Interpreter| {
            let round = |values: &[f64]| values.iter().map(|&x| x as f32).collect::<Vec<f32>>();
            let [q, passive, qd, qdd] = [&q, &passive, &qd, &qdd].map(|numbers| round(numbers));
            let vectors = vectors.map(|vector| vector.map(|x| x as f32));
            let payload = PAYLOAD.map(|x| x as f32);
            let wrenches = at_tips(robot, vectors[0]);
            let arguments = state([&q, &passive, &qd, &qdd], vectors, &wrenches, payload, &parameters_in_single);
            let torques = code.run(&arguments, |x| x as f32, f32::sin_cos).unwrap_or_default();
            torques.into_iter().map(f64::from).collect::<Vec<f64>>()
        };
        let [single, single_of_seven_steps] = [&reduced, &steps].map(|code| error(&single(code)));
        // far from the arm, the seven steps alone say nothing
        let least = if near.is_some() { single.min(single_of_seven_steps) } else { single_of_seven_steps };
        // nor has one that is singular but for rounding
        let is_regular = least < SINGULAR || !program.function.returns_accelerations();
        all.push(Errors { double: error(&found), single, single_of_seven_steps, scale, is_regular });
    }
    all
}

/// Arguments of any function: `base` is its motion, and the first of these vectors the forces and the pose.
fn state<'a, T: Copy>(
    [q, passive, qd, qdd]: [&'a [T]; 4],
    base: [[T; 3]; 4],
    wrenches: &'a [[T; 6]],
    payload: [T; 10],
    parameters: &'a [T],
) -> Arguments<'a, T> {
    let [vector @ [x, y, z], _, velocity, _] = base;
    Arguments {
        force: vector,
        moment: vector,
        payload,
        tau: qdd,
        wrenches,
        base,
        velocity,
        pose: [x, y, z, y, z, x, z, x, y, x, y, z],
        base_rotation: [x, y, z, z, x, y, y, z, x],
        step: z,
        parameters,
        passive,
        ..Arguments::of_joints(q, qd, qdd, x)
    }
}

/// A wrench for each tip, no two of them the same.
fn at_tips<T: Copy>(robot: &Robot, [x, y, z]: [T; 3]) -> Vec<[T; 6]> {
    [[x, y, z, z, x, y], [y, z, x, x, y, z], [z, x, y, y, z, x]].into_iter().cycle().take(robot.tip_count()).collect()
}

/// The larger of two; what is no number is larger than any.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    #[test]
    fn positions_are_within_the_limits() {
        let cases = [
            (None, (-3.0, 3.0)),
            (Some((-1.0, 7.0)), (-1.0, 3.0)),
            (Some((3.5, 6.0)), (3.5, 6.0)),
            (Some((-9.0, -4.0)), (-9.0, -4.0)),
        ];
        for (limits, expected) in cases {
            assert_eq!(super::positions(limits), expected);
        }
    }
}
