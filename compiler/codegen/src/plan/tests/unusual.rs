//! Robots that no shop sells, and rewriting far from the smallest graph: what the proof has to see there too.

use std::cell::{Cell, RefCell};

use super::*;
use crate::ir::Trace;

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
        let Formulation { names, traced: plain, scales } = drawn(&robot, &plan, function).unwrap();
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
        let mut rewriting = Annealing::new(plain.graph.clone(), 5, cost);
        let mut ticks = 0;
        let mut clock = |_: Cost| {
            ticks += 1;
            (ticks < most && !found.get()).then_some(0.0)
        };
        assert!(rewriting.anneal(2.0, &mut clock).is_break(), "the clock ended it");
        let graphs = graphs.take();
        assert!(!graphs.is_empty());
        // the last one first: that is the one whose value has changed
        for graph in graphs.into_iter().rev() {
            let written = Traced { graph, trace: Trace::default() }.told_by(&plain);
            let rewritten = Formulation { names: names.clone(), traced: written, scales: scales.clone() };
            must_be_identical(&robot, &plan, &lowered(&robot, function, rewritten));
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

/// The sine of a length of a joint that slides is a number of its own for each ratio and offset of its follower.
#[test]
fn another_ratio_of_a_follower_of_a_slide_is_refused() {
    let winch = |ratio: &str, offset: &str| {
        let link = "mass: 2, com: [0.1, 0.1, 0.3], inertia: {xx: 0.5, yy: 0.8, zz: 0.8}";
        let text = format!(
            "{{format: 2, name: winch, source: own, convention: modified, gravity: [0, 0, -9.81], joints: [
            {{name: slide, type: prismatic, dh: {{theta: 0, d: 0, a: 0.2, alpha: 0}}, link: {{{link}}}}},
            {{name: drum, type: revolute, dh: {{theta: 0, d: 0, a: 0.2, alpha: 0.3}}, link: {{{link}}}}}],
            couplings: [{{joint: drum, follows: {{slide: {ratio}}}, offset: {offset}}}]}}"
        );
        Reader::new("winch").trees().couplings().read(&text).unwrap().robot
    };
    for (ratio, offset) in [("1", "0"), ("1", "0.3"), ("5", "0.3"), ("-0.37", "0")] {
        let robot = winch(ratio, offset);
        let program = unproved(&robot, &Plan::new(2), Function::InverseDynamics).unwrap();
        assert!(is_identical(&robot, &program), "{ratio} {offset}");
        for other in [winch("1.000001", offset), winch("1.0000000000001", offset), winch(ratio, "0.3000001")] {
            assert!(!is_identical(&other, &program), "{ratio} {offset}");
        }
    }
}
