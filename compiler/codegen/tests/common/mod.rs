//! The shipped robots, for the tests of the compiler.
#![allow(dead_code)] // no test needs all of it

use std::sync::OnceLock;

use rne_codegen::plan::PlanSet;
use rne_codegen::{Compiler, Form, Function, Program};
use rne_model::Robot;
use rne_search::PlanFile;

/// A shipped robot.
pub(crate) fn robot(name: &str) -> Robot {
    let file = rne_robots::find(name).unwrap_or_else(|| panic!("{name} is not shipped"));
    Robot::from_yaml(file.yaml).unwrap_or_else(|report| panic!("{report}"))
}

/// The robots of few joints and the PUMA 560, or all shipped ones where all is asked for; by the order of names.
pub(crate) fn shipped() -> Vec<Robot> {
    let robots = shipped::tried().map(|file| Robot::from_yaml(file.yaml).unwrap_or_else(|report| panic!("{report}")));
    robots.filter(|robot| shipped::is_exhaustive() || robot.dof() <= 4 || robot.name == "puma560").collect()
}

/// The robots of the other tests as well: dense and random ones.
pub(crate) fn all() -> Vec<Robot> {
    let mut robots = shipped();
    for folder in ["tests/dense", "tests/random/files"] {
        let folder = format!("{}/../../{folder}", env!("CARGO_MANIFEST_DIR"));
        let entries = std::fs::read_dir(folder).expect("the folder of robots");
        let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
        paths.retain(|path| !path.to_string_lossy().ends_with(".plan.yaml"));
        paths.sort();
        let read = |path| Robot::from_yaml(&std::fs::read_to_string(path).expect("a readable file"));
        robots.extend(paths.iter().map(|path| read(path).unwrap_or_else(|report| panic!("{report}"))));
    }
    robots
}

/// All functions of a robot that is shipped, those of the trait `InverseDynamics` of another.
pub(crate) fn programs(robot: &Robot) -> Vec<Program> {
    static SHIPPED: OnceLock<Vec<String>> = OnceLock::new();
    let names = SHIPPED.get_or_init(|| shipped().into_iter().map(|robot| robot.name).collect());
    let functions = if names.contains(&robot.name) { &Function::OF_TREES[..] } else { &Function::TORQUES };
    functions
        .iter()
        .map(|&function| Compiler::new(robot).compile(function, Form::SevenSteps).expect("finite constants"))
        .collect()
}

/// The plan file of a shipped robot.
pub(crate) fn plans(robot: &Robot) -> PlanSet {
    let path = format!("{}/../../robots/{}.plan.yaml", env!("CARGO_MANIFEST_DIR"), robot.name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let plan = PlanFile::read(&path, &text, robot).unwrap_or_else(|report| panic!("{report}"));
    PlanSet::from(plan)
}

/// All functions of a shipped robot in the reduced form of its plan file, and `inverse_dynamics` as its plan gives it
/// before it is rewritten.
pub(crate) fn reduced_programs(robot: &Robot) -> Vec<Program> {
    let plans = plans(robot);
    let compiled = |plans: &PlanSet, function| {
        let program = Compiler::new(robot).with_plans(plans).compile(function, Form::Reduced);
        program.unwrap_or_else(|error| panic!("{error}"))
    };
    let mut programs = Function::OF_TREES.map(|function| compiled(&plans, function)).to_vec();
    programs.push(compiled(&PlanSet::from(plans.plan.clone()), Function::InverseDynamics));
    programs
}

/// Every robot with its programs: the seven steps of all, and the reduced forms of those that are shipped.
pub(crate) fn compiled() -> Vec<(Robot, Vec<Program>)> {
    let faithful = all().into_iter().map(|robot| {
        let programs = programs(&robot);
        (robot, programs)
    });
    let reduced = shipped().into_iter().flat_map(|robot| {
        let programs = reduced_programs(&robot);
        let (reduced, planned) = programs.split_at(Function::OF_TREES.len());
        // functions of one name are in different files
        [(robot.clone(), reduced.to_vec()), (robot, planned.to_vec())]
    });
    faithful.chain(reduced).collect()
}
