//! Robots that no shop sells, and rewriting far from the smallest graph: what the proof has to see there too.

use std::cell::{Cell, RefCell};

use super::*;
use crate::reduced::sheet::Dag;

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
    let spindle = robot("spindle");
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
    let spindle = robot("spindle");
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
