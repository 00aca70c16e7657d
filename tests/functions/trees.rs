//! Trees: every function of random ones beside projected Newton-Euler by products of 4 × 4 matrices, and beside the
//! runtime; the same tree by rows in another order.
//!
//! A plain `cargo test` tries small trees. Thousands, of up to 20 joints, with
//! `RNE_EXHAUSTIVE=1 cargo test --release --test functions trees`; with 10 instead of 1, every tenth of them.

use std::fmt::Write as _;

use fastrand::Rng;
use rne::DynObserverState;
use rne_codegen::{Algorithm, Compiler, Form, Function, Reason, Refusal};
use rne_model::{Convention, FrameId, Reader, Robot};

use crate::arm::{Arm, Maker};
use crate::check::{Worst, error_on_scale};
use crate::equality::compare_at_states;
use crate::random_arms;
use crate::random_trees;
use crate::tree_functions::{State, expected, magnification, scale, times};

const TOLERANCE: f64 = 1e-12;

pub(crate) fn robot(yaml: &str) -> Robot {
    Reader::new("tree").trees().read(yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}")).robot
}

/// A random tree.
pub(crate) fn random(seed: u64, dof: usize) -> Robot {
    robot(&random_trees::yaml(seed, dof))
}

/// Trees in all, and those that a plain `cargo test` tries, which have few joints.
const TREES: u64 = 2040;
const SOME: u64 = 24;

/// One tree in so many is written by the choices that a build makes for it, if it has few joints; the others by none,
/// which is sooner found.
const CHOSEN: u64 = 10;

/// 2 to 5 joints of most trees, 6 to 10 of a quarter, 11 to 20 of one in twelve: how long a tree takes to compile grows
/// with the square of its joints.
pub(crate) fn dof(seed: u64) -> usize {
    let round = seed / 12;
    let joints = match seed % 12 {
        0 if random_arms::one_in().is_some() => 11 + round % 10,
        1..=3 if random_arms::one_in().is_some() => 6 + round % 5,
        _ => 2 + seed % 4,
    };
    usize::try_from(joints).expect("small")
}

/// Every function of a tree, and those of frames at each of its frames, by every maker.
fn compare(seed: u64, worst: &mut Worst) {
    let (dof, mut robot) = (dof(seed), random(seed, dof(seed)));
    robot.rotors = seed.is_multiple_of(3);
    let state = State::random(seed, dof);
    let at_frames = (0..robot.frames.len()).map(|frame| robot.clone().at_frame(FrameId::Named(frame)));
    for robot in [robot.clone()].into_iter().chain(at_frames) {
        let arms = Maker::ALL.map(|maker| match maker {
            Maker::Code(_) if dof > 5 || !seed.is_multiple_of(CHOSEN) => Arm::by_no_choice(&robot, maker),
            _ => Arm::new(&robot, maker),
        });
        for function in
            Function::OF_TREES.into_iter().filter(|function| robot.at.is_none() || function.of_frame().is_some())
        {
            let expected = expected(&robot, function, &state);
            let Some(magnification) = magnification(&robot, function, &state, &expected) else { continue };
            let scale = scale(&robot, function, &state);
            for (arm, maker) in arms.iter().zip(Maker::ALL) {
                let found = arm.numbers(function, &state.given());
                let error = error_on_scale(&found, &expected, scale) / magnification;
                assert!(error <= TOLERANCE, "{maker}, tree {seed}, {function} of {:?}: {error:e}", robot.at);
                worst.see(function.name(), error);
            }
        }
    }
}

#[test]
fn every_function_of_a_tree_is_projected_newton_euler() {
    let trees = random_arms::one_in().map_or(SOME, |one_in| TREES / one_in);
    let worst = random_arms::of_each(&(0..trees).collect::<Vec<_>>(), compare);
    worst.at_most(TOLERANCE, &format!("{trees} trees"));
    assert_eq!(worst.len(), Function::OF_TREES.len(), "every function is compared");
}

/// Torques are the columns of the regressor that are kept times the values of the base parameters.
#[test]
fn base_parameters_of_a_tree_give_its_torques() {
    let mut worst = Worst::default();
    for seed in 0..random_arms::one_in().map_or(6, |one_in| 300 / one_in) {
        let robot = random(seed, dof(seed));
        let (arm, state) = (Arm::new(&robot, Maker::Runtime).runtime, State::random(seed, robot.dof()));
        let base = arm.base_parameters();
        let values: Vec<f64> = base.parameters.iter().map(|base| base.value).collect();
        let matrix = base.regressor(&arm, &state.q, &state.qd, &state.qdd).expect("one per joint");
        let expected = expected(&robot, Function::InverseDynamics, &state);
        let scale = scale(&robot, Function::InverseDynamics, &state);
        worst.see("τ", error_on_scale(&times(&matrix, &values), &expected, scale));
    }
    worst.at_most(TOLERANCE, "base parameters of trees");
}

/// After two ticks: the low-pass of what the oracle's momentum changes faster than its rate.
#[test]
fn an_observer_of_a_tree_sees_the_external_torques() {
    let (gain, period) = (20.0_f64, 0.01);
    for seed in 0..6 {
        let robot = random(seed, dof(seed));
        let (arm, dof) = (Arm::new(&robot, Maker::Runtime).runtime, robot.dof());
        let mut observer = DynObserverState::new(dof, gain, period);
        let [before, now] = [seed, seed + 1000].map(|seed| State::random(seed, dof));
        let found = [&before, &now].map(|it| observer.update(&arm, &it.q, &it.qd, &it.tau).expect("one per joint"));
        let ticks = [&before, &now].map(|state| expected(&robot, Function::MomentumAndRate, state));
        let weight = 1.0 - (-std::f64::consts::TAU * gain * period).exp();
        let external = |joint: usize| {
            let [change, rate] = [ticks[1][joint] - ticks[0][joint], ticks[1][dof + joint] + ticks[0][dof + joint]];
            weight * (change / period - rate / 2.0)
        };
        let expected: Vec<f64> = (0..dof).map(external).collect();
        assert_eq!(found[0], vec![0.0; dof]);
        let error = error_on_scale(&found[1], &expected, scale(&robot, Function::InverseDynamics, &now));
        assert!(error <= TOLERANCE, "tree {seed}: {error:e}");
    }
}

#[test]
fn code_of_trees_is_the_runtime() {
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        for seed in 0..8 {
            let dof = 2 + usize::try_from(seed).expect("small") % 3;
            compare_at_states(&Arm::new(&random(seed, dof), maker), maker, &mut worst);
        }
        worst.at_most(TOLERANCE, &format!("trees, {maker}"));
    }
}

/// The first of four legs on a base, each with the first axis in another direction: a quadruped whose trunk is held.
fn legs(count: usize) -> Robot {
    let places = [("lf", "pi/2", 0.3), ("rf", "-pi/2", 0.3), ("lh", "pi/2", -0.3), ("rh", "-pi/2", -0.3)];
    let mut yaml = "{format: 2, name: quadruped, source: own, convention: modified, gravity: [0, 0, -9.81], \
                    tool: {on: lf3}, joints: ["
        .to_owned();
    for (name, gamma, d) in places.into_iter().take(count) {
        let hip = format!("gamma: {gamma}, b: 0.1, alpha: pi/2, a: 0.2, theta: 0, d: {d}");
        let _ =
            write!(yaml,
            "{{name: {name}1, parent: base, type: revolute, dh: {{{hip}}}, link: {{mass: 2, com: [0.01, 0.02, 0.15],
               inertia: {{xx: 0.05, yy: 0.055, zz: 0.006, xy: 0.001, xz: -0.002, yz: 0.003}}}}}},
             {{name: {name}2, type: revolute, dh: {{alpha: pi/2, a: 0.08, theta: 0, d: 0}}, link: {{mass: 2.5,
               com: [0.15, -0.03, 0.02], inertia: {{xx: 0.004, yy: 0.027, zz: 0.028, xy: -0.003}}}}}},
             {{name: {name}3, type: revolute, dh: {{alpha: 0, a: 0.35, theta: 0, d: 0}}, link: {{mass: 0.9,
               com: [0.12, 0.01, 0], inertia: {{xx: 0.001, yy: 0.013, zz: 0.013, xy: 0.0002}}}}}}, "
        );
    }
    yaml.push_str("]}");
    robot(&yaml)
}

/// Every function that has a reduced recursion is written by it on trees, and costs less than the seven steps.
#[test]
fn trees_have_the_reduced_recursion() {
    for robot in [legs(4), random(1, 4), random(2, 5), random(3, 6)] {
        let compiler = Compiler::new(&robot);
        let mut seen = 0;
        for function in Function::OF_TREES.into_iter().filter(|function| Algorithm::is_planned(*function)) {
            let [plain, reduced] = [Form::SevenSteps, Form::Reduced].map(|form| compiler.compile(function, form));
            let (plain, reduced) = (plain.expect("a program"), reduced.expect("a program"));
            if matches!(reduced.refusals[..], [Refusal { reason: Reason::DividesByZero, .. }]) {
                continue; // links without mass behind a joint
            }
            assert!(reduced.refusals.is_empty(), "{} {function}: {:?}", robot.name, reduced.refusals);
            assert!(reduced.proof.is_some(), "{} {function}", robot.name);
            let [plain, reduced] = [plain, reduced].map(|program| program.operations().total());
            assert!(reduced < plain, "{} {function}: {reduced} of {plain}", robot.name);
            seen += 1;
        }
        assert!(seen > 10, "{}: {seen} functions", robot.name);
    }
}

/// A joint does not move the links of another branch: no element of M between them is computed, and none of its factors
/// fills. So four legs take four times the operations of one.
#[test]
fn zeros_of_branches_are_not_computed() {
    for function in [Function::MassMatrix, Function::ForwardDynamics, Function::InverseMassMatrix] {
        for form in Form::ALL {
            let [one, four] = [1, 4].map(|count| {
                let program = Compiler::new(&legs(count)).compile(function, form).expect("a program");
                program.operations().total()
            });
            assert!(four <= 4 * one, "{form} {function}: {four} for four legs, {one} for one");
        }
    }
}

/// Rows in another order, each still below its parent: the same torques by name.
#[test]
fn the_order_of_rows_changes_no_torque() {
    for seed in 0..40 {
        let dof = 3 + usize::try_from(seed).expect("small") % 8;
        let robot = random(seed, dof);
        let state = State::random(seed, dof);
        // any joint whose parent stands already is next
        let (mut rng, mut order) = (Rng::with_seed(seed), Vec::new());
        while order.len() < dof {
            let next = rng.usize(0..dof);
            if !order.contains(&next) && robot.parent(next).is_none_or(|parent| order.contains(&parent)) {
                order.push(next);
            }
        }
        let place = |joint: usize| order.iter().position(|other| *other == joint).expect("all are in it");
        let mut other = robot.clone();
        other.tip_on = robot.tip().on.map(place);
        other.joints = order.iter().map(|&joint| robot.joints[joint].clone()).collect();
        for (joint, &old) in other.joints.iter_mut().zip(&order) {
            let placement = robot.joints[old].branch.map_or(rne_model::Transform::IDENTITY, |branch| branch.placement);
            joint.branch = Some(rne_model::FixedFrame { on: robot.parent(old).map(place), placement });
        }
        let ordered = |values: &[f64]| -> Vec<f64> { order.iter().map(|&joint| values[joint]).collect() };
        let (q, qd, qdd) = (ordered(&state.q), ordered(&state.qd), ordered(&state.qdd));
        let [arm, other] = [&robot, &other].map(|robot| Arm::new(robot, Maker::Runtime));
        let expected = ordered(&arm.inverse_dynamics_with_wrench(&state.q, &state.qd, &state.qdd, &state.wrench));
        let found = other.inverse_dynamics_with_wrench(&q, &qd, &qdd, &state.wrench);
        let error = error_on_scale(&found, &expected, scale(&robot, Function::InverseDynamics, &state));
        assert!(error <= TOLERANCE, "tree {seed}: {error:e}");
    }
}

/// Placements: `gamma` and `b` of a modified row are an `at`.
#[test]
fn gamma_and_b_are_a_placement() {
    let file = |row: &str, at: &str| {
        robot(&format!(
            "{{format: 2, name: x, source: own, convention: modified, gravity: [0, 0, -9.81], tool: {{on: c}}, joints: [
            {{name: a, type: revolute, dh: {{theta: 0.1, d: 0.2, a: 0.3, alpha: 0.4}}, link: {{mass: 1}}}},
            {{name: b, type: revolute, dh: {{theta: 0.1, d: 0.2, a: 0.3, alpha: 0.4}}, link: {{mass: 1}}}},
            {{name: c, parent: a, {at} type: prismatic, dh: {{{row} theta: 0.5, d: 0.6, a: 0.7, alpha: 0.8}},
              link: {{mass: 2}}}}]}}"
        ))
    };
    let by_row = file("gamma: pi/3, b: 0.25,", "");
    assert_eq!(by_row, file("", "at: {xyz: [0, 0, 0.25], rpy: [0, 0, pi/3]},"));
    assert_eq!((by_row.convention, by_row.parent(2)), (Convention::Modified, Some(0)));
}

/// The robots of `robots/trees` by their plans: branches, followers, rotors, tips. A plain `cargo test` leaves out
/// those of more than ten coordinates but one.
#[test]
fn code_of_shipped_trees_is_the_runtime() {
    let is_tried = |name: &str, robot: &Robot| robot.dof() <= 10 || name == "mini_cheetah" || shipped::is_exhaustive();
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        for file in rne_robots::TREES {
            let checked = Reader::new(file.name).trees().couplings().read(file.yaml);
            if is_tried(file.name, &checked.unwrap_or_else(|report| panic!("{report}")).robot) {
                compare_at_states(
                    Arm::from_file(&format!("robots/trees/{}.yaml", file.name), maker),
                    maker,
                    &mut worst,
                );
            }
        }
        worst.at_most(TOLERANCE, &format!("shipped trees, {maker}"));
    }
}
