//! Robots that no shop sells, and rewriting far from the smallest graph: what the proof has to see there too.

use std::cell::{Cell, RefCell};

use super::*;
use crate::reduced::sheet::Dag;

/// Anti-parallel axes, oblique twists, constant angles, a tool, tilted gravity, an axisymmetric last link.
const SPINDLE: &str = "
format: 1
name: spindle
source: made for this test
convention: modified
gravity: [1.25, -3.5, -8.75]
tool: {xyz: [0.05, -0.07, 0.11], rpy: [0.4, -0.7, 1.1]}
joints:
  - type: revolute
    dh: {theta: 0.3, d: 0.4, a: 0.1, alpha: 0.2}
    link: {mass: 3, com: [0.1, 0.2, -0.05], inertia: {xx: 0.5, yy: 0.6, zz: 0.4, xy: 0.01, xz: -0.02, yz: 0.03}}
  - type: revolute
    dh: {theta: pi/2, d: 0.15, a: 0.25, alpha: pi/2}
    link: {mass: 4, com: [0.1, -0.02, 0.05], inertia: {xx: 0.15, yy: 0.3, zz: 0.25, xy: 0.02, xz: 0.01, yz: -0.03}}
  - type: revolute
    dh: {theta: 0.7, d: -0.12, a: 0.35, alpha: pi}
    link: {mass: 2, com: [0.07, 0.03, 0.02], inertia: {xx: 0.12, yy: 0.2, zz: 0.17, xy: 0.01, xz: 0.02, yz: 0.015}}
  - type: revolute
    dh: {theta: -0.2, d: 0.08, a: 0.21, alpha: 0}
    link: {mass: 1, com: [0.04, 0.01, 0.03], inertia: {xx: 0.05, yy: 0.06, zz: 0.04, xy: 0.002, xz: 0.001, yz: 0.003}}
  - type: revolute
    dh: {theta: 0.9, d: 0.3, a: 0.09, alpha: 1.2}
    link: {mass: 0.5, com: [0, 0, 0.06], inertia: {xx: 0.03, yy: 0.03, zz: 0.02}}
";

/// Some rounds of random changes, every plan that applies proved for a function in turn.
fn wander(robot: &Robot, rounds: usize, seed: u64) {
    let moves = Moves::new(Evaluator::new(robot, Function::InverseDynamics).frames());
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut plan = Plan::new(robot.dof());
    for function in Function::ALL {
        must_be_identical(robot, &plan, &unproved(robot, &plan, function).unwrap());
    }
    for round in 0..rounds {
        let other = moves.random(&plan, &mut rng);
        let function = Function::ALL[round % Function::ALL.len()];
        if let Some(program) = unproved(robot, &other, function) {
            must_be_identical(robot, &other, &program);
            plan = other;
        }
    }
}

#[test]
fn unusual_robots_are_the_seven_steps() {
    let spindle = check_bytes("spindle", SPINDLE.as_bytes()).unwrap().robot;
    wander(&spindle, 90, 1);
    let turned = Plan { turned_last_frame: true, ..Plan::new(6) };
    let dense = robot("dense6_2p");
    must_be_identical(&dense, &turned, &unproved(&dense, &turned, Function::InverseDynamicsWithWrench).unwrap());
    let carried = Plan { carried_prismatics: true, ..turned };
    must_be_identical(&dense, &carried, &unproved(&dense, &carried, Function::InverseDynamicsWithWrench).unwrap());
    for name in (0..40).map(|seed| seed.to_string()) {
        wander(&robot(&name), 8, 2);
    }
}

/// Anneals hot, so that every move is made, and proves the first graph that is worth something else, and some others.
#[test]
fn rewritten_graphs_are_the_seven_steps() {
    let spindle = check_bytes("spindle", SPINDLE.as_bytes()).unwrap().robot;
    for robot in [robot("planar3"), robot("scara_cobra600"), robot("stanford"), spindle] {
        let function = Function::InverseDynamics;
        let mut plan = Plan::new(robot.dof());
        for joint in &mut plan.joints {
            // squares of cosines
            joint.switches.second_moment_unturned = true;
        }
        let (frame, mut drawing) = drawn(&robot, &plan, function).unwrap();
        let images = |dag: &Dag| dag.outputs.iter().map(|at| dag.sheet.image(*at)).collect::<Vec<_>>();
        let expected = images(&drawing.dag);
        let (graphs, seen, found) = (RefCell::new(Vec::new()), Cell::new(0_usize), Cell::new(false));
        let cost = |dag: &Dag, live: &mut Vec<bool>| {
            seen.set(seen.get() + 1);
            let is_wrong = !found.get() && images(dag) != expected;
            found.set(found.get() || is_wrong);
            if is_wrong || seen.get() % 400 == 0 {
                graphs.borrow_mut().push(dag.clone());
            }
            evaluator::cost(dag, &frame, live)
        };
        let mut rewriting = Rewriting::new(drawing.dag.clone(), 5, cost);
        let mut ticks = 0;
        let mut clock = |_: &Progress| {
            ticks += 1;
            (ticks < 12 && !found.get()).then_some(0.0)
        };
        let progress = |best| Progress { plans: 0, best, phase: "rewriting" };
        assert!(rewriting.anneal(0.6, progress, &mut clock).is_err(), "the clock ended it");
        let graphs = graphs.take();
        assert!(found.get() || graphs.len() > 2, "{} graphs", graphs.len());
        // the last one first: that is the one whose value has changed
        for dag in graphs.into_iter().rev() {
            drawing.dag = dag;
            let (program, exactly) = drawing.unproved(&robot, &frame, function, Form::Rewritten).unwrap();
            let program = (program, exactly, frame.clone());
            must_be_identical(&robot, &plan, &program);
        }
    }
}
