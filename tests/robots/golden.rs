//! Torques against independent values: Pinocchio's, at 16 states each, for generated code, interpreter and runtime.

use std::fmt::Write as _;

use rne::{InverseDynamics, Scalar, Wrench};
use rne_codegen::{Arguments, Compiler, Form, Function, Interpreter, Program};
use rne_model::Robot;
use serde_json::Value;

use crate::shipped::seven_steps::visit_all;
use crate::shipped::{Shipped, Visitor};

/// Largest error relative to the largest torque of the state.
const TOLERANCE: f64 = 1e-12;

/// The page with the table of errors.
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/measured/accuracy.md");

/// Where the table begins and ends.
const BEGIN: &str = "<!-- begin: measured golden, RNE_EXHAUSTIVE=1 cargo test --test robots golden -->\n";
const END: &str = "<!-- end -->";

/// The table is of rounding, which differs from machine to machine as far as sine and cosine do.
const DOCUMENTED: f64 = 10.0;

/// (robot, worst error relative to the largest torque of the state).
#[derive(Default)]
struct Golden {
    worst: Vec<(&'static str, f64)>,
}

impl Visitor for Golden {
    fn visit<const DOF: usize, R: Shipped<DOF>>(&mut self, robot: &R) {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reference");
        let text = std::fs::read_to_string(format!("{folder}/{}.golden.json", R::NAME)).expect("golden values");
        let golden: Value = serde_json::from_str(&text).expect("JSON");
        let states = golden["states"].as_array().expect("states");
        assert_eq!(states.len(), 16);
        let arm = R::arm();
        let programs = Function::TORQUES.map(|function| compiled(R::NAME, function));
        let mut worst = 0.0_f64;
        for state in states {
            let array = |key: &str| -> [f64; DOF] { numbers(&state[key]).try_into().expect("one number per joint") };
            let (q, qd, qdd) = (array("q"), array("qd"), array("qdd"));
            let [fx, fy, fz, nx, ny, nz] = numbers(&state["wrench"]).try_into().expect("six numbers");
            let wrench = Wrench { force: [fx, fy, fz], moment: [nx, ny, nz] };
            let (gravity, coriolis) = (array("gravity"), array("coriolis"));
            let bias = std::array::from_fn(|joint| gravity[joint] + coriolis[joint]);
            for (function, expected) in [
                (Function::InverseDynamics, array("tau")),
                (Function::InverseDynamicsFromSinCos, array("tau")),
                (Function::InverseDynamicsWithWrench, array("tau_wrench")),
                (Function::GravityTorques, gravity),
                (Function::BiasTorques, bias),
            ] {
                let program = programs.iter().find(|program| program.function == function).expect("of torques");
                let interpreted = interpret(program, &q, &qd, &qdd, &wrench);
                let generated = call(robot, function, &q, &qd, &qdd, &wrench);
                let runtime = call(&arm, function, &q, &qd, &qdd, &wrench);
                for torques in [generated, interpreted, runtime] {
                    worst = worst.max(relative_error(&torques, &expected));
                }
            }
        }
        assert!(worst <= TOLERANCE, "{}: {worst}", R::NAME);
        self.worst.push((R::NAME, worst));
    }
}

/// One of the functions of a robot.
pub(crate) fn call<const DOF: usize>(
    robot: &impl InverseDynamics<DOF>,
    function: Function,
    q: &[f64; DOF],
    qd: &[f64; DOF],
    qdd: &[f64; DOF],
    wrench: &Wrench<f64>,
) -> [f64; DOF] {
    match function {
        Function::InverseDynamics => robot.inverse_dynamics(q, qd, qdd),
        Function::InverseDynamicsWithWrench => robot.inverse_dynamics_with_wrench(q, qd, qdd, wrench),
        Function::InverseDynamicsFromSinCos => {
            let turns = q.map(Scalar::sin_cos);
            robot.inverse_dynamics_from_sin_cos(&turns.map(|turn| turn.0), &turns.map(|turn| turn.1), q, qd, qdd)
        }
        Function::GravityTorques => robot.gravity_torques(q),
        Function::BiasTorques => robot.bias_torques(q, qd),
        _ => unreachable!("no torques of a fixed base"),
    }
}

fn compiled(name: &str, function: Function) -> Program {
    let text = std::fs::read_to_string(format!("{}/robots/{name}.yaml", env!("CARGO_MANIFEST_DIR")));
    let robot = Robot::from_yaml(&text.expect("a robot file")).unwrap_or_else(|report| panic!("{report}"));
    Compiler::new(&robot).compile(function, Form::SevenSteps).expect("finite constants")
}

fn interpret<const DOF: usize>(
    program: &Program,
    q: &[f64; DOF],
    qd: &[f64; DOF],
    qdd: &[f64; DOF],
    wrench: &Wrench<f64>,
) -> [f64; DOF] {
    let arguments = Arguments { force: wrench.force, moment: wrench.moment, ..Arguments::of_joints(q, qd, qdd, 0.0) };
    let torques = Interpreter::new(program).run(&arguments, f64::from_f64, Scalar::sin_cos);
    torques.expect("arrays of the right length").try_into().expect("one torque per joint")
}

pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|number| number.as_f64().expect("a number")).collect()
}

pub(crate) fn relative_error(found: &[f64], expected: &[f64]) -> f64 {
    // `f64::max` drops what is not a number
    assert!(found.iter().chain(expected).all(|torque| torque.is_finite()), "{found:?} {expected:?}");
    assert_eq!(found.len(), expected.len());
    let scale = expected.iter().fold(0.0_f64, |scale, torque| scale.max(torque.abs()));
    let error = found.iter().zip(expected).fold(0.0_f64, |error, (a, b)| error.max((a - b).abs()));
    // gravity does not act on a gantry's horizontal axes alone: a state without torques must be one here as well
    if scale == 0.0 { error } else { error / scale }
}

#[test]
fn torques_are_the_independent_ones() {
    let mut golden = Golden::default();
    visit_all(&mut golden);
    let mut table = String::from("| robot | worst error of f64 |\n|---|---|\n");
    for (robot, worst) in &golden.worst {
        let _ = writeln!(table, "| {robot} | {worst:.0e} |");
    }
    println!("{table}");
    let page = std::fs::read_to_string(PAGE).expect("the page");
    let (head, rest) = page.split_once(BEGIN).expect("the table's beginning");
    let (documented, tail) = rest.split_once(END).expect("its end");
    // not that of a sample
    if shipped::is_exhaustive() && std::env::var_os("RNE_WRITE_DOCUMENTS").is_some() {
        std::fs::write(PAGE, format!("{head}{BEGIN}{table}{END}{tail}")).expect("a writable page");
        return;
    }
    let rows = documented.lines().filter_map(|line| line.strip_prefix("| ")?.strip_suffix(" |")?.split_once(" | "));
    let is_tried = |name: &str| shipped::tried().any(|robot| robot.name == name);
    let figures = rows.filter_map(|(robot, error)| Some((robot, error.parse().ok()?)));
    let figures: Vec<(&str, f64)> = figures.filter(|(robot, _)| is_tried(robot)).collect();
    let write = "RNE_EXHAUSTIVE=1 RNE_WRITE_DOCUMENTS=1 cargo test --test robots torques_are_the_independent_ones";
    assert_eq!(
        figures.iter().map(|row| row.0).collect::<Vec<_>>(),
        golden.worst.iter().map(|row| row.0).collect::<Vec<_>>(),
        "{PAGE} lists other robots: {write}"
    );
    for ((robot, documented), (_, worst)) in figures.into_iter().zip(golden.worst) {
        assert!(worst <= DOCUMENTED * documented, "{robot}: {worst:.0e} is not what {PAGE} says: {write}");
    }
}
