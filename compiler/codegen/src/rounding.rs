//! The error of a program in floating point, beside that of the seven steps, at random states.

use rne_model::Robot;

use crate::CompileError;
use crate::function::Function;
use crate::interpret::{Arguments, Interpreter};
use crate::program::{Program, Proof};
use crate::refusal::largest_loss;

/// Number of random states at which rounding is measured when code is generated.
pub(crate) const STATES: usize = 24;
/// Largest number of operations that are run to measure the loss in single precision, after [`STATES`] states have
/// shown that it is too large. Users read this loss, and a few states would give only a third of it, because large
/// errors are rare.
const OPERATIONS_OF_LOSS: usize = 4_000_000;
/// If single precision changes accelerations by this part of the largest one, the mass matrix counts as numerically
/// singular.
const SINGULAR: f64 = 0.1;

/// The payload at the random states, a body of 2 kg some centimetres from the tip: mass, centre of mass, inertia. All
/// numbers are exact in single precision.
const PAYLOAD: [f64; 10] = [2.0, 0.0625, -0.03125, 0.125, 0.125, 0.125, 0.09375, 0.03125, -0.03125, 0.03125];

/// Parts of the torques of motion, and derivatives of such torques, may be zero except for rounding. So errors are
/// relative to at least this part of the torques of motion.
const LEAST_SCALE: f64 = 1e-2;

/// The compiled seven steps, with which programs are compared.
#[derive(Debug)]
pub struct Reference<'r> {
    robot: &'r Robot,
    seven_steps: Program,
    /// The seven steps with joint origins near the arm, if those of the table are far away: results are compared with
    /// these.
    seven_steps_near_arm: Option<Program>,
    /// The program of the torques of motion, if the function returns parts of them.
    motion: Option<Program>,
}

impl<'r> Reference<'r> {
    /// Makes the reference from the seven steps, `seven_steps`. `compiled` compiles a function of the robot by the
    /// seven steps with joint origins near the arm. `is_far` says that the table has joint origins far from the arm.
    ///
    /// # Errors
    /// When they cannot be compiled.
    pub(crate) fn new(
        robot: &'r Robot,
        seven_steps: Program,
        is_far: bool,
        compiled: impl Fn(Function) -> Result<Program, CompileError>,
    ) -> Result<Self, CompileError> {
        let function = seven_steps.function;
        let of_motion =
            if function.is_of_closed_loops() { Function::InverseDynamicsOfLoops } else { Function::InverseDynamics };
        let motion = if function.entry().is_of_motion { Some(compiled(of_motion)?) } else { None };
        let seven_steps_near_arm = if is_far { Some(compiled(function)?) } else { None };
        Ok(Self { robot, seven_steps, seven_steps_near_arm, motion })
    }

    pub(crate) const fn robot(&self) -> &'r Robot {
        self.robot
    }

    /// Whether the table has joint origins far from the arm, so that all code except the seven steps uses origins near
    /// the arm.
    pub(crate) const fn is_near(&self) -> bool {
        self.seven_steps_near_arm.is_some()
    }

    /// The function by the seven steps.
    pub(crate) fn into_program(self) -> Program {
        self.seven_steps
    }

    /// Number of operations of the seven steps.
    pub(crate) fn operations(&self) -> usize {
        self.seven_steps.operations().total()
    }
}

/// Factor between the error that is reported and the largest error that was measured: at 20 other states of 200
/// calibrated tables, errors were up to 6.4 times as large, in 22 functions more than 3 times
/// (docs/measured/accuracy.md).
const MARGIN: f64 = 3.0;

/// Returns the largest error in single precision times the margin, in parts of the largest number that the function
/// returns at any of the states, if that is too large.
pub(crate) fn loss(reference: &Reference<'_>, program: &Program, few: &[Errors]) -> Option<f64> {
    let error = |errors: &[Errors]| {
        let largest = |of: fn(&Errors) -> f64| errors.iter().map(of).fold(0.0, larger);
        let error = MARGIN * largest(|errors| errors.single * errors.scale) / largest(|errors| errors.scale);
        (!errors.is_empty() && (error.is_nan() || error > largest_loss(program.function))).then_some(error)
    };
    let states = OPERATIONS_OF_LOSS / program.operations().total().max(1);
    error(few).and_then(|_| error(&errors(reference, program, states.clamp(10 * STATES, 100 * STATES))))
}

/// Collects the errors of a program and of the seven steps in floating point into a proof.
pub(crate) fn proof(reference: &Reference<'_>, points: usize, errors: &[Errors]) -> Proof {
    let mut proof = Proof {
        points,
        states: 0,
        rounding: 0.0,
        single: 0.0,
        single_of_seven_steps: 0.0,
        before: reference.seven_steps.fold_report.before(),
    };
    for errors in errors.iter().filter(|errors| errors.is_regular) {
        proof.states += 1;
        proof.rounding = larger(proof.rounding, errors.double);
        proof.single = larger(proof.single, errors.single);
        proof.single_of_seven_steps = larger(proof.single_of_seven_steps, errors.single_of_seven_steps);
    }
    proof
}

/// Returns how many times larger the error of a program in single precision is than that of the seven steps, on the
/// average: the largest error depends on which rare states are drawn.
pub(crate) fn loss_of_precision(reference: &Reference<'_>, program: &Program, states: usize) -> f64 {
    let errors = errors(reference, program, states);
    let sum = |error: fn(&Errors) -> f64| errors.iter().filter(|errors| errors.is_regular).map(error).sum::<f64>();
    let (found, expected) = (sum(|errors| errors.single), sum(|errors| errors.single_of_seven_steps));
    if found == 0.0 { 0.0 } else { found / expected }
}

/// Differences from the seven steps in double precision at one state, relative to the largest torque.
pub(crate) struct Errors {
    double: f64,
    single: f64,
    single_of_seven_steps: f64,
    /// The largest torque, to which the differences are relative.
    scale: f64,
    /// Whether accelerations can be compared: the mass matrix is not numerically singular.
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
pub(crate) fn errors(reference: &Reference<'_>, program: &Program, states: usize) -> Vec<Errors> {
    let Reference { robot, seven_steps, seven_steps_near_arm, motion } = reference;
    let mut all = Vec::with_capacity(states);
    let steps = Interpreter::new(seven_steps);
    let near_arm = seven_steps_near_arm.as_ref().map(Interpreter::new);
    let precise = near_arm.as_ref().unwrap_or(&steps);
    let motion = motion.as_ref().map(Interpreter::new);
    let reduced = Interpreter::new(program);
    // run-time parameters of the file, rounded so that they are equal in both precisions
    let parameters = robot.run_time.values(robot);
    let parameters_in_single: Vec<f32> = parameters.iter().map(|&value| value as f32).collect();
    let parameters: Vec<f64> = parameters_in_single.iter().copied().map(f64::from).collect();
    let mut rng = fastrand::Rng::with_seed(2024);
    for state_index in 0..states {
        // random numbers that single precision can represent, so that both precisions are given the same state
        let mut between = |low: f64, high: f64| f64::from((low + (high - low) * rng.f64()) as f32);
        // positions that close the loops: elsewhere their equations may be nearly singular
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
        // the base moves in different ways at the states beyond `STATES`, whose largest error users read
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
        // if the table has origins far from the arm, the error of the seven steps alone says nothing
        let least = if near_arm.is_some() { single.min(single_of_seven_steps) } else { single_of_seven_steps };
        // nor has a numerically singular mass matrix
        let is_regular = least < SINGULAR || !program.function.returns_accelerations();
        all.push(Errors { double: error(&found), single, single_of_seven_steps, scale, is_regular });
    }
    all
}

/// Makes the arguments of any function. `base` is the motion of the base; its first vector also gives the force and the
/// moment at the tip, and the pose.
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

/// A wrench for each tip; neighbouring tips have different ones.
fn at_tips<T: Copy>(robot: &Robot, [x, y, z]: [T; 3]) -> Vec<[T; 6]> {
    [[x, y, z, z, x, y], [y, z, x, x, y, z], [z, x, y, y, z, x]].into_iter().cycle().take(robot.tip_count()).collect()
}

/// The larger of two numbers; NaN counts as larger than any number.
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
