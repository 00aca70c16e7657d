//! Whatever a search may find is the function of the seven steps.

use std::collections::HashMap;

use common::robot;
use rne_codegen::plan::{Formulation, Plan, PlanSet, Reference};
use rne_codegen::{Algorithm, CompileError, Compiler, Form, Function, Reason, Target};
use rne_model::{Reader, Robot};
use rne_search::Neighbourhood;

mod common;
#[path = "../../../tests/random/motors.rs"]
mod motors;
#[allow(dead_code)] // arms, which are not asked for here
#[path = "../../../tests/random/robots.rs"]
mod robots;
#[path = "../../../tests/random/trees.rs"]
mod trees;

/// The functions of one robot by the seven steps, each compiled when it is first needed.
struct SevenSteps<'r> {
    robot: &'r Robot,
    of: HashMap<Function, Reference<'r>>,
}

impl<'r> SevenSteps<'r> {
    fn new(robot: &'r Robot) -> Self {
        Self { robot, of: HashMap::new() }
    }

    /// Whether a plan applies to the robot. Fails where what it gives is another function, with these words, by which
    /// `cargo xtask mutate` knows that it was the proof that refused.
    fn must_be_given_by(&mut self, plan: &Plan, function: Function, algorithm: Algorithm) -> bool {
        let robot = self.robot;
        let formulation = match Formulation::by_plan(robot, plan, function, algorithm) {
            Err(CompileError::PlanDoesNotFit { .. }) => return false,
            other => other.expect("no other error"),
        };
        let reference = self.of.entry(function).or_insert_with(|| Reference::of(robot, function).expect("finite"));
        let loss = reference.loss_of_precision(function, formulation, 1).expect("it can be lowered");
        let choices = plan.choices();
        assert!(loss.is_some(), "the proof refuses {}, {function}, {algorithm:?}\n{choices:#?}", robot.name);
        true
    }
}

/// The same of what a build gives by the plan, arranged for both targets.
fn must_be_compiled(robot: &Robot, plan: &Plan, function: Function) {
    for target in [Target::Latency, Target::Throughput] {
        let compiler = Compiler::new(robot).with_plans(plan.clone()).for_target(target);
        let refused = match compiler.compile(function, Form::Reduced) {
            Ok(program) => program.refusals.into_iter().find_map(|refusal| match refusal.reason {
                Reason::Error(error @ CompileError::NotIdentical { .. }) => Some(error),
                _ => None,
            }),
            Err(error) => Some(error).filter(|error| matches!(error, CompileError::NotIdentical { .. })),
        };
        if let Some(error) = refused {
            panic!("the proof refuses {}, {function}, {target:?}: {error}\n{:#?}", robot.name, plan.choices());
        }
    }
}

/// How many rounds of random changes: with `RNE_EXHAUSTIVE` set, all.
fn rounds(all: usize) -> usize {
    if std::env::var_os("RNE_EXHAUSTIVE").is_some() { all } else { all / 3 }
}

const SEVERAL: [&str; 8] =
    ["puma560", "stanford", "ur5", "scara_cobra600", "planar3", "panda", "cylindrical_rpp", "dense6_2p"];

#[test]
fn random_plans_are_the_seven_steps() {
    for name in SEVERAL {
        let robot = robot(name);
        let (neighbourhood, mut steps) = (Neighbourhood::of(&robot), SevenSteps::new(&robot));
        let mut rng = fastrand::Rng::with_seed(7);
        let mut plan = Plan::new(robot.dof());
        let mut tried = 0;
        for round in 0..rounds(60) {
            let other = neighbourhood.random(&plan, &mut rng);
            let function = Function::TORQUES[round % Function::TORQUES.len()];
            if steps.must_be_given_by(&other, function, Algorithm::Rnea) {
                must_be_compiled(&robot, &other, function);
                plan = other;
                tried += 1;
            }
        }
        assert!(tried > rounds(60) / 2, "{name}: {tried}");
    }
}

#[test]
fn every_single_choice_is_the_seven_steps() {
    for name in ["ur5", "dense6_2p"] {
        let robot = robot(name);
        let (neighbourhood, mut steps) = (Neighbourhood::of(&robot), SevenSteps::new(&robot));
        let plan = PlanSet::default_of(&robot).plan;
        for other in neighbourhood.neighbours(&plan).iter().step_by(9) {
            if steps.must_be_given_by(other, Function::InverseDynamics, Algorithm::Rnea) {
                must_be_compiled(&robot, other, Function::InverseDynamics);
            }
        }
    }
}

#[test]
fn all_algorithms_under_random_plans_are_the_seven_steps() {
    for name in ["puma560", "scara_cobra600", "stanford", "ur5", "dense6_2p"] {
        let tried = wander_with_all_algorithms(&robot(name), rounds(40), 11);
        assert!(tried > rounds(40) / 2, "{name}: {tried}");
    }
}

/// Some rounds of random changes, every plan that applies proved for an algorithm in turn; how many applied.
fn wander_with_all_algorithms(robot: &Robot, rounds: usize, seed: u64) -> usize {
    const FUNCTIONS: [Function; 8] = [
        Function::GravityTorques,
        Function::MassMatrix,
        Function::ForwardDynamics,
        Function::CoriolisMatrix,
        Function::InverseDynamicsDerivatives,
        Function::InverseMassMatrixTimesTorques,
        Function::TorqueGradient,
        Function::TorqueHessian,
    ];
    let (neighbourhood, mut steps) = (Neighbourhood::of(robot), SevenSteps::new(robot));
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut plan = Plan::new(robot.dof());
    let mut tried = 0;
    for round in 0..rounds {
        let other = neighbourhood.random(&plan, &mut rng);
        let function = FUNCTIONS[round % FUNCTIONS.len()];
        // articulated bodies are those of links alone
        let is_of_robot = |it: &Algorithm| !(matches!(it, Algorithm::Aba(_)) && robot.has_spinning_rotors());
        let algorithms: Vec<_> = Algorithm::of(function).iter().copied().filter(is_of_robot).collect();
        let algorithm = algorithms[(round / FUNCTIONS.len()) % algorithms.len()];
        if steps.must_be_given_by(&other, function, algorithm) {
            plan = other;
            tried += 1;
        }
    }
    tried
}

/// Some rounds of random changes, every plan that applies proved for a function in turn.
fn wander(robot: &Robot, rounds: usize, seed: u64) {
    let (neighbourhood, mut steps) = (Neighbourhood::of(robot), SevenSteps::new(robot));
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut plan = Plan::new(robot.dof());
    for function in Function::TORQUES {
        assert!(steps.must_be_given_by(&plan, function, Algorithm::Rnea), "the plain plan applies to {}", robot.name);
        must_be_compiled(robot, &plan, function);
    }
    for frames in 1..4 {
        let framed =
            Plan { turned_last_frame: frames & 1 != 0, carried_prismatics: frames & 2 != 0, ..Plan::new(robot.dof()) };
        steps.must_be_given_by(&framed, Function::InverseDynamicsWithWrench, Algorithm::Rnea);
    }
    for round in 0..rounds {
        let other = neighbourhood.random(&plan, &mut rng);
        let function = Function::TORQUES[round % Function::TORQUES.len()];
        if steps.must_be_given_by(&other, function, Algorithm::Rnea) {
            plan = other;
        }
    }
}

#[test]
fn unusual_robots_are_the_seven_steps() {
    wander(&robot("spindle"), 90, 1);
    wander(&robot("dense6_2p"), 0, 0);
    let seeds = if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 40 } else { 20 };
    for name in (0..seeds).map(|seed| seed.to_string()) {
        wander(&robot(&name), 8, 2);
    }
}

/// Links that carry several joints, and rows that begin at placements: every choice of a joint is one beside siblings.
#[test]
fn random_plans_of_trees_are_the_seven_steps() {
    let mut tried = 0;
    for index in 0..rounds(45) {
        let seed = u64::try_from(index).expect("small");
        let yaml = trees::yaml(seed, 3 + index % 6);
        let robot = Reader::new("tree").trees().read(&yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}")).robot;
        // of many placements that are turned in any way, no reading of the numbers may have all roots
        let plain = Plan::new(robot.dof());
        if !SevenSteps::new(&robot).must_be_given_by(&plain, Function::InverseDynamics, Algorithm::Rnea) {
            continue;
        }
        wander(&robot, 8, seed);
        // of a joint that moves no mass, algorithms divide by zero
        if robot.rows().all(|row| row.link.mass > 0.0 || row.link.has_first_moment()) {
            tried += wander_with_all_algorithms(&robot, 15, seed);
        }
    }
    assert!(tried > rounds(45) * 4, "{tried}");
}

/// Rotors on links: about axes that are parallel to joints or not, of motors that turn with one joint or several.
#[test]
fn random_plans_with_rotors_are_the_seven_steps() {
    let mut tried = 0;
    for index in 0..rounds(45) {
        let seed = u64::try_from(index).expect("small");
        let dof = 2 + index % 4;
        let tree = trees::yaml(seed, dof);
        let without: Vec<&str> = tree.lines().filter(|line| !line.starts_with("    motor:")).collect();
        let yaml = without.join("\n") + "\n" + &motors::yaml(&mut fastrand::Rng::with_seed(seed), dof);
        let reader = Reader::new("tree").trees().couplings();
        let robot = reader.read(&yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}")).robot;
        let plain = Plan::new(robot.dof());
        if !SevenSteps::new(&robot).must_be_given_by(&plain, Function::InverseDynamics, Algorithm::Rnea) {
            continue;
        }
        wander(&robot, 4, seed);
        if robot.rows().all(|row| row.link.mass > 0.0 || row.link.has_first_moment()) {
            tried += wander_with_all_algorithms(&robot, 15, seed);
        }
    }
    assert!(tried > rounds(45) * 4, "{tried}");
}

/// Floating bases: they take matter from the links that they carry, and every choice of a joint on them is
/// one of a joint on a link.
#[test]
fn random_plans_of_floating_bases_are_the_seven_steps() {
    const FUNCTION: Function = Function::InverseDynamicsOfFloatingBase;
    // the bias is a part of the others
    const SOLVED: [Function; 10] = [
        Function::FloatingMassMatrix,
        Function::FloatingForwardDynamics,
        Function::FloatingMassMatrixWithPayload,
        Function::FloatingForwardDynamicsWithPayload,
        Function::FloatingEulerStep,
        Function::FloatingEulerStepDerivatives,
        Function::CentroidalBias,
        Function::CentroidalMomentum,
        Function::ForwardDynamicsInContact,
        Function::FloatingInverseDynamicsDerivatives,
    ];
    let (mut robots, mut tried, mut solved) = (0, 0, 0);
    for index in 0..rounds(60) {
        let seed = 500 + u64::try_from(index).expect("small");
        let yaml = trees::yaml(seed, 2 + index % 6);
        let robot = Reader::new("tree").trees().read(&yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}")).robot;
        let mut steps = SevenSteps::new(&robot);
        let mut plan = Plan::new(robot.dof());
        if robot.floating_base.is_none() || !steps.must_be_given_by(&plan, FUNCTION, Algorithm::Rnea) {
            continue;
        }
        robots += 1;
        let neighbourhood = Neighbourhood::of(&robot);
        let mut rng = fastrand::Rng::with_seed(seed);
        for round in 0..16 {
            let other = neighbourhood.random(&plan, &mut rng);
            if steps.must_be_given_by(&other, FUNCTION, Algorithm::Rnea) {
                if round % 5 == 0 {
                    must_be_compiled(&robot, &other, FUNCTION);
                    let has_matter = robot.rows().all(|row| row.link.mass > 0.0 || row.link.has_first_moment());
                    for function in SOLVED.into_iter().filter(|it| has_matter || it.divides().is_none()) {
                        for &algorithm in Algorithm::of(function) {
                            assert!(steps.must_be_given_by(&other, function, algorithm), "{function}, {algorithm:?}");
                            solved += 1;
                        }
                    }
                }
                plan = other;
                tried += 1;
            }
        }
    }
    assert!(robots > 5 && tried > 8 * robots && solved > robots, "{tried} plans of {robots} robots, {solved}");
}
