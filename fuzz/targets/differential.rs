//! A random arm, one function in one form: the interpreted program is the runtime, and C of as many operators is
//! written of it.
#![no_main]

use std::fmt::Write as _;

use arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use rne_codegen::{Arguments, Compiler, Form, Function, Interpreter, Program};
use rne_emit::Precision;
use rne_model::Robot;
use rne_runtime::{BaseMotion, BaseTwist, DynArm, Inputs, Payload, Pose, Scalar, Wrench, WrongLength};

fuzz_target!(|bytes: &[u8]| {
    let _ = compare(&mut Unstructured::new(bytes));
});

/// Numbers of tables: those that fold, and those that do not.
const ANGLES: [&str; 8] = ["0", "0", "pi/2", "-pi/2", "pi", "0.3", "-1.1", "pi/3"];
const LENGTHS: [&str; 6] = ["0", "0", "0.4", "-0.25", "1", "0.4318"];
const MASSES: [&str; 5] = ["0", "1", "2.5", "0.75", "10"];
const INERTIAS: [&str; 6] = [
    "{}",
    "{xx: 0.1, yy: 0.1, zz: 0.1}",
    "{zz: 0.02, yy: 0.02}",
    "{xx: 0.3, yy: 0.25, zz: 0.2, xy: 0.01, xz: -0.02, yz: 0.03}",
    "{xx: 1, yy: 2, zz: 2.5}",
    "{zz: 0.4}",
];

/// Motors of joints; friction has a sign for each direction.
const MOTORS: [&str; 4] = [
    "",
    "",
    ", motor: {inertia: 2.0e-4, gear_ratio: -62.5}",
    ", motor: {inertia: 3.3e-5, gear_ratio: 100, viscous: 1.2e-4, coulomb: [0.012, -0.015]}",
];

/// Arguments of every function, in the order of their fields.
struct State {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    tau: Vec<f64>,
    wrench: Wrench<f64>,
    /// A list of one wrench for the functions that take a wrench at each tip. It is the same wrench.
    at_tips: [[f64; 6]; 1],
    payload: [f64; 10],
    base: BaseMotion<f64>,
}

impl State {
    fn new(u: &mut Unstructured<'_>, dof: usize) -> Result<Self> {
        let mut number = |scale: f64| Ok(f64::from(u.arbitrary::<i8>()?) / 128.0 * scale);
        let mut list = |count: usize, scale: f64| (0..count).map(|_| number(scale)).collect::<Result<Vec<f64>>>();
        let (q, qd, qdd, tau) = (list(dof, 3.0)?, list(dof, 2.0)?, list(dof, 5.0)?, list(dof, 20.0)?);
        let mut triple = |scale| list(3, scale).map(|list| [list[0], list[1], list[2]]);
        let wrench = Wrench { force: triple(10.0)?, moment: triple(5.0)? };
        let (centre, inertia, products) = (triple(0.3)?, triple(0.1)?, triple(0.02)?);
        let (omega, omega_dot, acceleration) = (triple(1.0)?, triple(2.0)?, triple(3.0)?);
        let base = BaseMotion { omega, omega_dot, velocity: acceleration, acceleration, gravity: triple(9.81)? };
        let mut payload = [3.0; 10];
        payload[1..].iter_mut().zip([centre, inertia, products].concat()).for_each(|(to, from)| *to = from);
        let ([fx, fy, fz], [nx, ny, nz]) = (wrench.force, wrench.moment);
        let at_tips = [[fx, fy, fz, nx, ny, nz]];
        Ok(Self { q, qd, qdd, tau, wrench, at_tips, payload, base })
    }

    fn twist(&self) -> BaseTwist<f64> {
        BaseTwist { linear: self.base.velocity, angular: self.base.omega }
    }

    fn pose(&self) -> Pose<f64> {
        Pose { rotation: ROTATION, translation: self.base.omega_dot }
    }

    fn arguments(&self) -> Arguments<'_, f64> {
        let Self { q, qd, qdd, tau, wrench, at_tips, payload, base } = self;
        Arguments {
            tau,
            wrenches: at_tips,
            force: wrench.force,
            moment: wrench.moment,
            payload: *payload,
            base: [base.omega, base.omega_dot, base.acceleration, base.gravity],
            velocity: base.velocity,
            pose: [ROTATION.as_flattened(), &base.omega_dot].concat().try_into().unwrap(),
            // so that the changes of a step are those of a second
            step: 1.0,
            base_rotation: std::array::from_fn(|at| base_rotation(base)[at / 3][at % 3]),
            ..Arguments::of_joints(q, qd, qdd, 0.0)
        }
    }
}

fn arm(u: &mut Unstructured<'_>) -> Result<String> {
    let convention = *u.choose(&["standard", "modified"])?;
    let gravity = *u.choose(&["[0, 0, -9.81]", "[0, -9.81, 0]", "[0, 0, 0]", "[1, -2, 9]"])?;
    let mut text = format!("format: 1\nname: arm\nsource: fuzz\nconvention: {convention}\ngravity: {gravity}\n");
    if u.arbitrary()? {
        let (x, z, r) = (u.choose(&LENGTHS)?, u.choose(&LENGTHS)?, u.choose(&ANGLES)?);
        let _ = writeln!(text, "tool: {{xyz: [{x}, 0, {z}], rpy: [{r}, 0, 0]}}");
    }
    text.push_str("joints:\n");
    for _ in 0..u.int_in_range(1..=4)? {
        let kind = *u.choose(&["revolute", "revolute", "revolute", "prismatic"])?;
        let [theta, alpha] = [u.choose(&ANGLES)?, u.choose(&ANGLES)?];
        let [d, a, x, y, z] = [(); 5].map(|()| u.choose(&LENGTHS));
        let (mass, inertia, motor) = (u.choose(&MASSES)?, u.choose(&INERTIAS)?, u.choose(&MOTORS)?);
        let _ = writeln!(
            text,
            "  - {{type: {kind}, dh: {{theta: {theta}, d: {}, a: {}, alpha: {alpha}}}, link: {{mass: {mass}, com: [{}, \
             {}, {}], inertia: {inertia}}}{motor}}}",
            d?, a?, x?, y?, z?
        );
    }
    Ok(text)
}

fn compare(u: &mut Unstructured<'_>) -> Result<()> {
    let text = arm(u)?;
    let robot = Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}\n{text}"));
    let robot = Robot { rotors: u.arbitrary()?, ..robot };
    let function = *u.choose(&Function::OF_TREES)?;
    let form = *u.choose(&Form::ALL)?;
    let state = State::new(u, robot.dof())?;
    // without the plans of a build: they take longer than all the rest
    let Ok(program) = Compiler::new(&robot).compile(function, form) else { return Ok(()) };
    let interpreted = Interpreter::new(&program).run(&state.arguments(), |value| value, Scalar::sin_cos);
    let interpreted = interpreted.expect("arrays of the right length");
    operators_of_c(&robot, &program);
    let arm = DynArm::from_robot(&robot);
    let expected = runtime(&arm, function, &state).expect("arrays of the right length");
    assert_eq!(interpreted.len(), expected.len(), "{function} of\n{text}");
    let mass = || arm.mass_matrix(&state.q).expect("arrays of the right length");
    let is_equal = match function {
        Function::ForwardDynamics
        | Function::ForwardDynamicsWithWrenches
        | Function::FloatingForwardDynamics
        | Function::InverseMassMatrixTimesTorques => {
            accelerate(&arm, function, &state, &interpreted).expect("arrays of the right length")
        }
        Function::EulerStep => {
            let rates = interpreted[robot.dof()..].iter().zip(&state.qd).map(|(next, qd)| next - qd);
            accelerate(&arm, Function::ForwardDynamics, &state, &rates.collect::<Vec<_>>())
                .expect("arrays of the right length")
        }
        Function::FloatingEulerStep => {
            let accelerations = accelerations_of_step(&robot, &state, &interpreted);
            accelerate(&arm, Function::FloatingForwardDynamics, &state, &accelerations)
                .expect("arrays of the right length")
        }
        Function::EulerStepDerivatives => inverts(&mass(), &interpreted[5 * robot.dof() * robot.dof()..]),
        Function::FloatingEulerStepDerivatives => {
            // the derivatives of the velocities after a step of a second by the torques
            let mass = arm.floating_mass_matrix(&state.q).expect("arrays of the right length");
            inverts(&mass, &interpreted[interpreted.len() - mass.len() * robot.dof()..])
        }
        Function::InverseMassMatrix => inverts(&mass(), &interpreted),
        // the others are products with it, and of accelerations that are as far from those of the runtime
        Function::ForwardDynamicsDerivatives | Function::ForwardDynamicsDerivativesWithWrenches => {
            inverts(&mass(), &interpreted[2 * robot.dof() * robot.dof()..])
        }
        _ => {
            // multipliers magnify what cancels
            let is_weighted = matches!(function, Function::TorqueGradient | Function::TorqueHessian);
            let weights = if is_weighted { scale(&state.tau) } else { 1.0 };
            let scale = weights * scale(&expected);
            // an arm without mass has no centre
            let is_close = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-11 * scale || !(a.is_finite() || b.is_finite());
            interpreted.iter().zip(&expected).all(is_close)
        }
    };
    assert!(is_equal, "{function}, {form:?}, rotors {}: {interpreted:?} {expected:?} of\n{text}", robot.rotors);
    Ok(())
}

/// The largest of some numbers, and at least 1: these arms have numbers around it.
fn scale(numbers: &[f64]) -> f64 {
    numbers.iter().filter(|number| number.is_finite()).fold(1.0, |largest: f64, number| largest.max(number.abs()))
}

/// Whether accelerations are those of the torques.
///
/// They are not compared with those of the runtime, from which they may differ by as much as M is badly conditioned,
/// which is without bound where a last link is light. But elimination of a positive definite matrix is backward stable:
/// what it returns solves a system that differs from M q̈ = τ - h by rounding, so M q̈ + h, of the runtime's M and h,
/// gives τ to rounding of the largest product that stands in it, however large q̈ is. A singular M has no answer.
fn accelerate(
    arm: &DynArm,
    function: Function,
    State { q, qd, tau, wrench, base, .. }: &State,
    qdd: &[f64],
) -> std::result::Result<bool, WrongLength> {
    if !qdd.iter().all(|acceleration| acceleration.is_finite()) {
        return Ok(true);
    }
    let zeros = vec![0.0; q.len()];
    let (mass, bias) = match function {
        Function::FloatingForwardDynamics => {
            (arm.floating_mass_matrix(q)?, arm.floating_bias(q, qd, &base.omega, &[*wrench])?)
        }
        Function::ForwardDynamicsWithWrenches => {
            (arm.mass_matrix(q)?, arm.inverse_dynamics_with_wrenches(q, qd, &zeros, &[*wrench])?)
        }
        Function::InverseMassMatrixTimesTorques => (arm.mass_matrix(q)?, zeros),
        _ => (arm.mass_matrix(q)?, arm.bias_torques(q, qd)?),
    };
    // nothing drives a base
    let tau = [vec![0.0; bias.len() - tau.len()], tau.clone()].concat();
    let largest = scale(&mass.concat()) * scale(qdd) + scale(&bias) + scale(&tau);
    let misses = mass.iter().zip(&bias).zip(tau).map(|((row, bias), tau)| {
        let torque: f64 = row.iter().zip(qdd).map(|(m, qdd)| m * qdd).sum();
        (torque + bias - tau).abs()
    });
    Ok(misses.fold(0.0, f64::max) <= 1e-11 * largest)
}

/// The accelerations of a step of a second with a floating base, by the way of its origin.
fn accelerations_of_step(robot: &Robot, state: &State, next: &[f64]) -> Vec<f64> {
    let (pose, twist) = (state.pose(), state.twist());
    let driven = [0, 1, 2].map(|axis| next[9 + axis] - pose.translation[axis] - robot.gravity[axis]);
    let linear =
        (0..3).map(|axis| (0..3).map(|row| pose.rotation[row][axis] * driven[row]).sum::<f64>() - twist.linear[axis]);
    let angular = next[15..18].iter().zip(&twist.angular).map(|(next, omega)| next - omega);
    let joints = next[18 + state.qd.len()..].iter().zip(&state.qd).map(|(next, qd)| next - qd);
    linear.chain(angular).chain(joints).collect()
}

/// Whether a matrix is the inverse of M: its columns are compared as accelerations are.
fn inverts(mass: &[Vec<f64>], inverse: &[f64]) -> bool {
    if !inverse.iter().all(|element| element.is_finite()) {
        return true;
    }
    // of M with the rows of a floating base, the columns of the joints alone
    let columns = inverse.len() / mass.len();
    let largest = scale(&mass.concat()) * scale(inverse);
    let misses = mass.iter().enumerate().flat_map(|(i, row)| {
        (0..columns).map(move |j| {
            let element: f64 = row.iter().zip(inverse.chunks(columns)).map(|(m, column)| m * column[j]).sum();
            (element - if i == mass.len() - columns + j { 1.0 } else { 0.0 }).abs()
        })
    });
    misses.fold(0.0, f64::max) <= 1e-11 * largest
}

/// The C text has the operators that the program counts: between blanks, behind the head of the last function.
fn operators_of_c(robot: &Robot, program: &Program) {
    let prefix = "arm".parse().expect("a prefix");
    let code = rne_emit::c_code(robot, std::slice::from_ref(program), Precision::Double, &prefix).expect("C");
    let code = code.one_file();
    let (_, body) = code.rsplit_once(&format!(" arm_{}(", program.function)).expect("the function");
    let (_, body) = body.split_once("\n{").expect("its body");
    let words = body.lines().filter_map(|line| line.split("//").next()).flat_map(str::split_whitespace);
    let words: Vec<&str> = words.collect();
    let count = |operators: &[&str]| words.iter().filter(|word| operators.contains(word)).count();
    let counted = program.operations();
    assert_eq!((count(&["*"]), count(&["+", "-"]), count(&["/"])), (counted.mul, counted.add, counted.div), "{}", body);
}

/// The rotation of the base in the world.
const ROTATION: [[f64; 3]; 3] = [[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]];

/// Numbers in the place of a rotation, of vectors that no function takes beside it.
const fn base_rotation(base: &BaseMotion<f64>) -> [[f64; 3]; 3] {
    [base.omega_dot, base.acceleration, base.gravity]
}

/// What the runtime says, in the order of a program's outputs.
fn runtime(arm: &DynArm, function: Function, state: &State) -> std::result::Result<Vec<f64>, WrongLength> {
    let State { q, qd, qdd, tau, wrench, payload, base, .. } = state;
    let (sin, cos): (Vec<f64>, Vec<f64>) = q.iter().map(|&q| Scalar::sin_cos(q)).unzip();
    let inputs = Inputs {
        q,
        qd,
        qdd,
        tau,
        sin: &sin,
        cos: &cos,
        passive: &[],
        // as in the interpreter
        multipliers: tau,
        wrench,
        wrenches: &[*wrench],
        payload: &Payload::from_array(*payload),
        base,
        omega: &base.omega,
        twist: &state.twist(),
        pose: &state.pose(),
        base_rotation: &base_rotation(base),
        step: 1.0,
    };
    arm.evaluate(function, &inputs)
}
