//! The tests that a derive writes into a user's crate pass for shipped robots, trees and closed loops, in both forms:
//! for some of them, and with `RNE_EXHAUSTIVE` for all. The code is interpreted here.

use rne::testing::{RobotFile, is_that_of_the_runtime, numbers};
use rne::{BaseMotion, Inputs};
use rne_codegen::{Argument, Arguments, CheckFor as _, Compiler, Form, Function, Interpreter};
use rne_model::{Reader, Robot};

use crate::check::ROOT;
use crate::equality::is_compared;

/// What the code of a function returns.
fn interpreted(code: &Interpreter, function: Function, given: &Inputs<'_, f64>) -> Vec<f64> {
    let wrenches: Vec<[f64; 6]> = given.wrenches.iter().map(|wrench| of(numbers(wrench))).collect();
    let BaseMotion { omega, omega_dot, acceleration, gravity, .. } = *given.base;
    let omega = if function.takes(Argument::Base) { omega } else { *given.omega };
    let arguments = Arguments {
        passive: given.passive,
        force: given.wrench.force,
        moment: given.wrench.moment,
        payload: given.payload.to_array(),
        tau: given.tau,
        wrenches: &wrenches,
        base: [omega, omega_dot, acceleration, gravity],
        velocity: given.twist.linear,
        pose: of(numbers(given.pose)),
        base_rotation: of(numbers(given.base_rotation)),
        step: given.step,
        ..Arguments::of_joints(given.q, given.qd, given.qdd, 0.0)
    };
    code.run(&arguments, |constant| constant, rne::Scalar::sin_cos).expect("all arguments")
}

fn of<const N: usize>(numbers: Vec<f64>) -> [f64; N] {
    numbers.try_into().expect("as many numbers")
}

/// The tests of each function of a robot, in both forms.
fn pass(text: &str) {
    let text: &'static str = text.to_owned().leak();
    let read = Reader::new("robot").trees().couplings().loops().read(text.as_bytes());
    let robot: Robot = read.unwrap_or_else(|report| panic!("{}", report.render(false))).robot;
    let compiler = Compiler::new(&robot);
    for form in Form::ALL {
        let file = RobotFile { text, rotors: false, seven_steps: form == Form::SevenSteps };
        let is_there = |&function: &Function| is_compared(&robot, function) && function.check_for(&robot).is_ok();
        for function in rne_codegen::functions_of(&robot).filter(is_there) {
            let program = compiler.compile(function, form).unwrap_or_else(|error| panic!("{error}"));
            let code = Interpreter::new(&program);
            is_that_of_the_runtime(&file, function.name(), |given| interpreted(&code, function, given));
        }
    }
}

#[test]
fn tests_of_derives_pass_for_shipped_robots() {
    for robot in shipped::tried() {
        println!("{}", robot.name);
        pass(robot.yaml);
    }
}

#[test]
fn tests_of_derives_pass_for_trees_and_closed_loops() {
    let mut names = vec![
        "robots/trees/panda_hand",
        "robots/trees/wam7_coupled",
        "benches/trees/loops/four_bar",
        "benches/trees/loops/palletiser",
        "benches/trees/loops/floating_four_bar_leg",
    ];
    if shipped::is_exhaustive() {
        names.extend(["robots/trees/mini_cheetah", "benches/trees/loops/five_bar", "benches/trees/loops/g1_ankle"]);
    }
    for name in names {
        println!("{name}");
        let path = format!("{ROOT}/{name}.yaml");
        pass(&std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}")));
    }
}
