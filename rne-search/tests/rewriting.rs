//! What is rewritten, and what of it a search keeps.

use std::collections::BTreeMap;

use common::robot;
use rne_codegen::plan::{Accuracy, Plan, PlanSet, Rewriting, Rewritten, divides_by_zero};
use rne_codegen::{Algorithm, Compiler, Form, Function};
use rne_model::Robot;
use rne_search::{PlanFile, Progress, REWRITTEN, Reduced, SearchOptions, fingerprint, search};

mod common;

/// A function of a robot after some rounds of rewriting, and whether that made it smaller.
fn rewritten(robot: &Robot, plan: &Plan, function: Function) -> (Rewritten, bool) {
    let of = if Algorithm::is_planned(function) {
        let (plan, algorithm) = PlanSet::from(plan.clone()).cheapest(robot, function);
        Rewritten { plan: Some(plan), algorithm, ..Rewritten::default() }
    } else {
        Rewritten::default()
    };
    let mut rewriting = Rewriting::of(robot, function, of).unwrap();
    let before = rewriting.cost();
    let mut looks = 0;
    let mut clock = |_| {
        looks += 1;
        (looks < 20).then(|| f64::from(looks) / 20.0)
    };
    assert!(rewriting.anneal(1, 0.2, &mut clock).is_break(), "the clock ended it");
    let is_smaller = rewriting.cost().weight() < before.weight();
    (rewriting.written(), is_smaller)
}

/// Any function is rewritten and read again: those by algorithms of their own, and those that no choice touches, of
/// arms with offsets of angles, prismatic joints, a tool and a base.
#[test]
fn every_function_survives_rewriting_and_its_text() {
    let of_offsets = vec![Function::ForwardKinematics, Function::KineticEnergy, Function::CentreOfMass];
    let all = Function::ALL.into_iter().filter(|function| function.can_be_rewritten()).step_by(2).collect();
    for (name, mut functions) in [("spherical_rrp", all), ("dense6_2p", of_offsets)] {
        let robot = robot(name);
        functions.retain(|&function| !divides_by_zero(&robot, function));
        let plan = PlanSet::default_of(&robot).plan;
        let mut smaller = 0;
        let mut graphs = BTreeMap::new();
        for &function in &functions {
            let (rewritten, is_smaller) = rewritten(&robot, &plan, function);
            smaller += usize::from(is_smaller);
            graphs.insert(function, rewritten);
        }
        assert!(3 * smaller > 2 * functions.len(), "{name}: {smaller} of {}", functions.len());
        let reduced = Reduced { operations: graphs[&functions[0]].operations, accuracy: Accuracy::default(), plan };
        let file = PlanFile { robot: robot.name.clone(), fingerprint: fingerprint(&robot), reduced, rewritten: graphs };
        assert_eq!(PlanFile::read(name, &file.to_yaml(), &robot).unwrap(), file, "{name}");
        let compiler = Compiler::new(&robot).with_plans(file.clone());
        for (&function, rewritten) in &file.rewritten {
            let program = compiler.compile(function, Form::Reduced).unwrap();
            assert!(program.is_rewritten && program.proof.is_some(), "{name}, {function}");
            let (count, written) = (program.operations(), rewritten.operations);
            assert_eq!((count.mul, count.add), (written.mul, written.add), "{name}, {function}");
        }
    }
}

/// A graph is most of its plan file: one that saves little, or that nobody calls in a loop, is not kept.
#[test]
fn a_search_keeps_the_graphs_that_are_worth_their_bytes() {
    let robot = robot("spherical_rrp");
    let functions = Function::ALL.into_iter().filter(|function| function.can_be_rewritten());
    let options = SearchOptions { rewrite: functions.collect(), seed: 1 };
    let mut over = 0.0;
    let mut clock = |_: &Progress| {
        over += if over < 0.45 { 0.02 } else { 0.002 };
        (over < 1.0).then_some(over)
    };
    let found = search(&robot, None, &options, &mut clock).unwrap();
    assert!(!found.rewritten.is_empty());
    let planned = Compiler::new(&robot).with_plans(found.reduced.plan.clone());
    for (function, rewritten) in &found.rewritten {
        assert!(REWRITTEN.contains(function), "{function}");
        let planned = planned.compile(*function, Form::Reduced).unwrap().operations().total();
        assert!(1000 * rewritten.operations.total() <= 979 * planned, "{function}: {rewritten:?} of {planned}");
    }
}
