//! Bounds the error of a function in single precision rigorously, at random states within the limits of an arm.
//!
//! At each state of a sample, the program runs in `f32`, as the emitted code does. It also runs on intervals of `f64`
//! ([`Interval`]), which enclose the exact result. The distance of the `f32` result from the farthest number of the
//! interval is an upper bound of the error. It is valid at the states of the sample only.

use rne_codegen::{Argument, Arguments, Interpreter, Output, Program, Real, Value};
use rne_model::{JointKind, Limits, Robot};
use serde::Serialize;

use crate::interval::Interval;

/// The states at which the error is bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// Number of states.
    pub states: usize,
    /// The seed of the random numbers.
    pub seed: u64,
}

/// The ranges of a joint from which states are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Positions, rad or m.
    pub position: (f64, f64),
    /// Largest speed, rad/s or m/s.
    pub velocity: f64,
    /// Largest acceleration, rad/s² or m/s².
    pub acceleration: f64,
    /// Largest torque, N m or N, for functions that take torques.
    pub torque: f64,
}

/// The error of one number of the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Error {
    /// The largest magnitude of the number in the sample.
    pub largest: f64,
    /// The largest bound of its error in the sample.
    pub bound: f64,
    /// The state of the sample at which the bound is largest, counted from 0.
    pub state: usize,
}

/// Largest speed, acceleration and torque of a joint without limits.
const SPEED: f64 = 2.0;
const ACCELERATION: f64 = 4.0;
const TORQUE: f64 = 10.0;
/// Largest position of a prismatic joint without limits, in both directions, m.
const SLIDE: f64 = 1.0;

/// Force, N, and moment, N m, at a tip.
static WRENCH: [f32; 6] = [5.0, -3.0, 20.0, 0.4, -0.6, 0.25];
/// Mass, kg; centre of mass, m; inertia about the centre of mass, xx, yy, zz, xy, xz, yz, kg m².
static PAYLOAD: [f32; 10] = [1.5, 0.01, -0.02, 0.06, 0.003, 0.004, 0.002, 2e-4, -1e-4, 3e-4];
/// Angular velocity, rad/s; angular acceleration, rad/s²; acceleration, m/s²; gravity, m/s², in the axes of frame 0.
static BASE: [[f32; 3]; 4] = [[0.5, -0.3, 0.7], [1.2, -0.8, 0.6], [0.4, 1.1, -0.9], [0.6, -0.4, -9.78]];
/// Velocity of the origin of frame 0, m/s, and angular velocity of the base, rad/s.
static TWIST: [f32; 6] = [0.4, 1.1, -0.9, BASE[0][0], BASE[0][1], BASE[0][2]];
static STEP: [f32; 1] = [0.01];
/// The rotation of the base, by rows.
pub static BASE_ROTATION: [f32; 9] = [0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6];

/// The rotation of the base, by rows, and the origin of frame 0, m.
static POSE: [f32; 12] = {
    let [xx, xy, xz, yx, yy, yz, zx, zy, zz] = BASE_ROTATION;
    [xx, xy, xz, yx, yy, yz, zx, zy, zz, 0.3, -0.2, 0.5]
};

/// The arrays that are the same at each state: the name, the numbers (of one tip, if there are several), and a clause
/// about them, with `{}` instead of the numbers.
static SAME: [(&str, &[f32], &str); 13] = [
    ("payload", &PAYLOAD, "the payload is {}: mass (kg), centre of mass (m), inertia (kg m²)"),
    ("base_omega", &BASE[0], "the base has the angular velocity {} (rad/s)"),
    ("base_omega_dot", &BASE[1], "its angular acceleration is {} (rad/s²)"),
    ("base_acceleration", &BASE[2], "its acceleration is {} (m/s²)"),
    ("base_gravity", &BASE[3], "gravity is {} (m/s²)"),
    ("omega", &BASE[0], "the base has the angular velocity {} (rad/s)"),
    ("twist", &TWIST, "the base has the velocity and the angular velocity {} (m/s, rad/s)"),
    ("base_rotation", &BASE_ROTATION, "the rotation of the base, row by row, is {}"),
    ("pose", &POSE, "the rotation of the base, row by row, and the origin of frame 0 are {} (1, m)"),
    ("force", WRENCH.split_at(3).0, "the force at the tip is {} (N)"),
    ("moment", WRENCH.split_at(3).1, "the moment at the tip is {} (N m)"),
    ("wrenches", &WRENCH, "the force and the moment at each tip are {} (N, N m)"),
    ("step", &STEP, "the step takes {} s"),
];

/// Returns the numbers of an array that is the same at each state, those of one tip if it has a row for each, and a
/// clause that describes them. `None` for an array that differs from state to state.
#[must_use]
pub fn same(array: &str) -> Option<(&'static [f32], String)> {
    let (_, numbers, clause) = SAME.into_iter().find(|(name, ..)| *name == array)?;
    let list = numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    Some((numbers, clause.replace("{}", &list)))
}

/// Returns the ranges of the joints: the limits of the robot file, or defaults.
#[must_use]
pub fn ranges(robot: &Robot) -> Vec<Range> {
    let range = |(joint, limits): (&rne_model::Joint, Limits)| Range {
        position: limits.position.unwrap_or(match joint.row.kind {
            JointKind::Revolute => (-std::f64::consts::PI, std::f64::consts::PI),
            JointKind::Prismatic => (-SLIDE, SLIDE),
        }),
        velocity: limits.velocity.unwrap_or(SPEED),
        acceleration: ACCELERATION,
        torque: limits.effort.unwrap_or(TORQUE),
    };
    robot.independent_joints().zip(robot.coordinate_limits()).map(range).collect()
}

/// Returns positions that close the loops of a robot: of the coordinates, and of the dependent joints.
fn closures(robot: &Robot) -> Vec<(Vec<f32>, Vec<f32>)> {
    let of = |closure: &[f64], joints: &mut dyn Iterator<Item = usize>| joints.map(|at| single(closure[at])).collect();
    let passive = || robot.closed.passive.iter().copied();
    let closures = robot.closed.closures.iter();
    closures.map(|closure| (of(closure, &mut robot.coordinates()), of(closure, &mut passive()))).collect()
}

/// Returns positions of the dependent joints of closed loops: those of the first closure in the robot file, even if the
/// other joints have positions that do not close the loops. Empty for a robot without closed loops.
#[must_use]
pub fn passive(robot: &Robot) -> Vec<f32> {
    closures(robot).into_iter().next().map(|(_, passive)| passive).unwrap_or_default()
}

/// Returns the errors of the numbers that a program returns; `None` if the interpreter cannot run it with the arguments
/// that are available here. `sin_cos` must be that of the emitted code.
#[must_use]
pub fn errors(
    robot: &Robot,
    program: &Program,
    sample: Sample,
    sin_cos: impl Fn(f32) -> (f32, f32),
) -> Option<Vec<Error>> {
    let interpreter = Interpreter::new(program);
    let ranges = ranges(robot);
    let closed = closures(robot);
    let takes_torques = program.function.takes(Argument::Torques);
    let errors = largest_errors(sample, program.outputs.len(), |state, rng| {
        let mut between = |(low, high): (f64, f64)| single(low + (high - low) * rng.f64());
        let (q, passive) = match closed.get(state % closed.len().max(1)) {
            Some(closure) => closure.clone(),
            None => (ranges.iter().map(|range| between(range.position)).collect(), Vec::new()),
        };
        let qd: Vec<f32> = ranges.iter().map(|range| between((-range.velocity, range.velocity))).collect();
        let last = |range: &Range| if takes_torques { range.torque } else { range.acceleration };
        let last: Vec<f32> = ranges.iter().map(|range| between((-last(range), last(range)))).collect();
        let found = single_precision(robot, &interpreter, [&q, &passive, &qd, &last], &sin_cos)?;
        Some((found, enclosed(robot, &interpreter, [&q, &passive, &qd, &last])?))
    });
    // an output that is the constant 0, which has no name, is exact
    let is_zero = |id| program.values.name(id).is_none() && matches!(program.values.get(id), Value::Constant(_));
    let exact = |(error, output): (Error, &Output)| if is_zero(output.value) { Error::default() } else { error };
    Some(errors?.into_iter().zip(&program.outputs).map(exact).collect())
}

/// Returns the largest errors of `length` numbers over the states of a sample. `at` is called for each state in order,
/// and returns the numbers in single precision, and intervals that enclose the exact ones.
pub(crate) fn largest_errors(
    sample: Sample,
    length: usize,
    mut at: impl FnMut(usize, &mut fastrand::Rng) -> Option<(Vec<f32>, Vec<Interval>)>,
) -> Option<Vec<Error>> {
    let mut rng = fastrand::Rng::with_seed(sample.seed);
    let mut errors = vec![Error::default(); length];
    for state in 0..sample.states {
        let (found, exact) = at(state, &mut rng)?;
        for ((error, found), exact) in errors.iter_mut().zip(found).zip(exact) {
            let found = f64::from(found);
            error.largest = error.largest.max(found.abs());
            let bound = exact.farthest(found);
            if bound > error.bound || bound.is_nan() {
                (error.bound, error.state) = (bound, state);
            }
        }
    }
    Some(errors)
}

/// Returns intervals that enclose the exact numbers that a program returns; the last array has accelerations or
/// torques.
pub(crate) fn enclosed(robot: &Robot, interpreter: &Interpreter, arrays: [&[f32]; 4]) -> Option<Vec<Interval>> {
    let exactly = |x: f32| Interval::exactly(f64::from(x));
    run(robot, interpreter, arrays, exactly, Interval::rounded, Interval::sin_cos)
}

/// Returns the numbers that a program returns in single precision for joint positions, those of the dependent joints,
/// velocities, and accelerations or torques.
#[must_use]
pub fn single_precision(
    robot: &Robot,
    interpreter: &Interpreter,
    arrays: [&[f32]; 4],
    sin_cos: impl Fn(f32) -> (f32, f32),
) -> Option<Vec<f32>> {
    run(robot, interpreter, arrays, |x| x, single, sin_cos)
}

/// Runs a program in the arithmetic of `T`: `exactly` converts the numbers of the arguments, `rounded` the constants.
fn run<T: Real>(
    robot: &Robot,
    interpreter: &Interpreter,
    arrays: [&[f32]; 4],
    exactly: impl Fn(f32) -> T,
    rounded: impl Fn(f64) -> T,
    sin_cos: impl Fn(T) -> (T, T),
) -> Option<Vec<T>> {
    let all = |numbers: &[f32]| -> Vec<T> { numbers.iter().map(|&x| exactly(x)).collect() };
    let parameters: Vec<T> = robot.run_time.values(robot).into_iter().map(|x| exactly(single(x))).collect();
    let [q, passive, qd, last] = arrays.map(all);
    let ([fx, fy, fz, nx, ny, nz], [vx, vy, vz, ..]) = (WRENCH.map(&exactly), TWIST.map(&exactly));
    let wrenches = vec![[fx, fy, fz, nx, ny, nz]; robot.tip_count()];
    let arguments = Arguments {
        tau: &last,
        parameters: &parameters,
        force: [fx, fy, fz],
        moment: [nx, ny, nz],
        payload: PAYLOAD.map(&exactly),
        wrenches: &wrenches,
        base: BASE.map(|triple| triple.map(&exactly)),
        velocity: [vx, vy, vz],
        step: exactly(STEP[0]),
        pose: POSE.map(&exactly),
        base_rotation: BASE_ROTATION.map(&exactly),
        passive: &passive,
        ..Arguments::of_joints(&q, &qd, &last, exactly(0.0))
    };
    interpreter.run(&arguments, rounded, sin_cos)
}

#[allow(clippy::cast_possible_truncation)] // rounding to f32 is the purpose
pub(crate) fn single(x: f64) -> f32 {
    x as f32
}

#[cfg(test)]
mod tests {
    use rne_codegen::{Compiler, Form, Function};
    use rne_model::Robot;

    use super::{Error, Sample, errors, same};

    /// A function with another argument could not be certified.
    #[test]
    fn each_argument_is_that_of_a_joint_or_the_same_at_each_state() {
        const OF_JOINTS: [&str; 8] = ["q", "qd", "qdd", "tau", "multipliers", "sin", "cos", "passive"];
        for function in Function::ALL {
            for part in function.arguments().iter().flat_map(|argument| argument.parts()) {
                assert_ne!(OF_JOINTS.contains(&part.name), same(part.name).is_some(), "{function}: {}", part.name);
            }
        }
    }

    /// A pendulum, whose torque is τ = (I + m c²) q̈ + m g c cos q.
    const PENDULUM: &str = "{format: 1, name: one, source: doc, convention: standard, gravity: [0, -9.81, 0], joints: [
        {type: revolute, dh: {theta: 0, d: 0, a: 0.7, alpha: 0}, link: {mass: 1.3, com: [-0.3, 0, 0]}}]}";

    #[test]
    fn the_bound_is_that_of_single_precision() {
        let robot = Robot::from_yaml(PENDULUM).expect("a robot");
        let program = Compiler::new(&robot).compile(Function::InverseDynamics, Form::Reduced).expect("it compiles");
        let sample = Sample { states: 2000, seed: 1 };
        let error = errors(&robot, &program, sample, f32::sin_cos).expect("errors")[0];
        // 1.3 (9.81 0.4 + 0.4² 4)
        assert!(error.largest > 5.0 && error.largest < 5.94, "{error:?}");
        // several rounding errors of 2⁻²⁴ of the largest torque, and at least half of one
        assert!(error.bound < 8.0 * 5.94 / f64::from(1 << 24) && error.bound > 1e-7, "{error:?}");
        // without gravity, the torque that holds it is exactly zero
        let robot = Robot::from_yaml(&PENDULUM.replace("-9.81", "0")).expect("a robot");
        let none = Compiler::new(&robot).compile(Function::GravityTorques, Form::Reduced).expect("it compiles");
        assert_eq!(errors(&robot, &none, sample, f32::sin_cos), Some(vec![Error::default()]));
        // a cosine with an error of 1e-3 is detected
        let wrong = errors(&robot, &program, sample, |x| (x.sin(), x.cos() + 1e-3)).expect("errors")[0];
        assert!(wrong.bound > 4e-3, "{wrong:?}");
    }
}
