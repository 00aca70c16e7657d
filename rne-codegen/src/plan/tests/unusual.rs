//! Robots that no shop sells, and rewriting far from the smallest graph: what the proof has to see there too.

use std::cell::{Cell, RefCell};

use super::*;
use crate::ir::Trace;

/// Some rounds of random changes, every plan that applies proved for a function in turn.
fn wander(robot: &Robot, rounds: usize, seed: u64) {
    let neighbourhood = Neighbourhood::new(Evaluator::new(robot, Function::InverseDynamics).frames());
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut plan = Plan::new(robot.dof());
    for function in Function::TORQUES {
        must_be_identical(robot, &plan, &unproved(robot, &plan, function).unwrap());
    }
    for frames in 1..4 {
        let framed =
            Plan { turned_last_frame: frames & 1 != 0, carried_prismatics: frames & 2 != 0, ..Plan::new(robot.dof()) };
        if let Some(program) = unproved(robot, &framed, Function::InverseDynamicsWithWrench) {
            must_be_identical(robot, &framed, &program);
        }
    }
    for round in 0..rounds {
        let other = neighbourhood.random(&plan, &mut rng);
        let function = Function::TORQUES[round % Function::TORQUES.len()];
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
    wander(&robot("dense6_2p"), 0, 0);
    for name in (0..20).map(|seed| seed.to_string()) {
        wander(&robot(&name), 8, 2);
    }
}

/// Anneals hot, so that every move is made, and proves the first graph that is worth something else, and some others.
#[test]
fn rewritten_graphs_are_the_seven_steps() {
    for (robot, most) in
        [("planar3", 30), ("spherical_rrp", 150), ("scara_cobra600", 30), ("stanford", 6), ("spindle", 6)]
    {
        let robot = self::robot(robot);
        let function = Function::InverseDynamics;
        let mut plan = Plan::new(robot.dof());
        for joint in &mut plan.joints {
            // squares of cosines
            joint.switches.second_moment_unturned = true;
        }
        let Formulation { names, traced: plain } = drawn(&robot, &plan, function).unwrap();
        let residues = |graph: &Graph| graph.outputs.iter().map(|at| graph.residue(*at)).collect::<Vec<_>>();
        let expected = residues(&plain.graph);
        let (graphs, seen, found) = (RefCell::new(Vec::new()), Cell::new(0_usize), Cell::new(false));
        let cost = |graph: &Graph, live: &mut Vec<bool>| {
            seen.set(seen.get() + 1);
            let is_wrong = !found.get() && residues(graph) != expected;
            found.set(found.get() || is_wrong);
            if is_wrong || seen.get() % 1000 == 0 {
                graphs.borrow_mut().push(graph.clone());
            }
            graph.cost(live)
        };
        let mut rewriting = Rewriting::new(plain.graph.clone(), 5, cost);
        let mut ticks = 0;
        let mut clock = |_: &Progress| {
            ticks += 1;
            (ticks < most && !found.get()).then_some(0.0)
        };
        let progress = |best| Progress { plans: 0, best, phase: "rewriting" };
        assert!(rewriting.anneal(2.0, progress, &mut clock).is_err(), "the clock ended it");
        let graphs = graphs.take();
        assert!(!graphs.is_empty());
        // the last one first: that is the one whose value has changed
        for graph in graphs.into_iter().rev() {
            let written = Traced { graph, trace: Trace::default() }.told_by(&plain);
            let rewritten = Formulation { names: names.clone(), traced: written };
            must_be_identical(&robot, &plan, &lowered(&robot, function, rewritten));
        }
    }
}

/// Any function is rewritten and read again: those by algorithms of their own, and those that no choice touches, of
/// arms with offsets of angles, prismatic joints, a tool and a base.
#[test]
fn every_function_survives_rewriting_and_its_text() {
    let all = Function::ALL.into_iter().filter(|function| function.can_be_rewritten()).step_by(2).collect();
    let of_offsets = vec![Function::ForwardKinematics, Function::KineticEnergy, Function::CentreOfMass];
    for (name, functions) in [("spherical_rrp", all), ("dense6_2p", of_offsets)] {
        let robot = robot(name);
        let options = SearchOptions { rewrite: functions.clone(), seed: 1 };
        // few plans, some rounds for every function
        let mut over = 0.0;
        let mut clock = |_: &Progress| {
            over += if over < 0.45 { 0.02 } else { 0.004 };
            (over < 1.0).then_some(over)
        };
        let found = search(&robot, None, &options, &mut clock).unwrap();
        assert!(3 * found.rewritten.len() > 2 * functions.len(), "{name}: {:?}", found.rewritten.keys());
        assert_eq!(PlanFile::read(name, &found.to_yaml(), &robot).unwrap(), found, "{name}");
        let compiler = Compiler::new(&robot).with_plans(found.clone());
        for (&function, rewritten) in &found.rewritten {
            let program = compiler.compile(function, Form::Reduced).unwrap();
            assert!(program.is_rewritten && program.proof.is_some(), "{name}, {function}");
            let (count, written) = (program.operations(), rewritten.operations);
            assert_eq!((count.mul, count.add), (written.mul, written.add), "{name}, {function}");
        }
    }
}

#[test]
fn angles_that_are_close_have_their_own_constants() {
    let mut robot = robot("close_angles");
    for _ in 0..robot.dof() {
        // that of the first joint goes into gravity
        robot.joints.rotate_right(1);
        let angles: Vec<f64> = robot.joints[1..].iter().map(|joint| joint.row.dh.alpha.radians).collect();
        for (plans, is_plain) in [(PlanSet::none(&robot), true), (PlanSet::default_of(&robot), false)] {
            for function in Function::TORQUES {
                let program = Compiler::new(&robot).with_plans(&plans).compile(function, Form::Reduced).unwrap();
                let has = |value: f64| program.constants().any(|constant| constant.value.abs() == value);
                for angle in angles.iter().filter(|_| is_plain) {
                    assert!(has(angle.sin()), "{function} needs the sine of {angle}");
                }
                assert!(program.proof.as_ref().unwrap().rounding < 4e-15, "{:?}", program.proof);
            }
        }
    }
}
