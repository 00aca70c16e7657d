//! What a search rewrites.

use common::robot;
use rne_codegen::{Compiler, Form, Function};
use rne_search::{PlanFile, Progress, SearchOptions, search};

mod common;

/// Any function is rewritten and read again: those by algorithms of their own, and those that no choice touches, of
/// arms with offsets of angles, prismatic joints, a tool and a base.
#[test]
fn every_function_survives_rewriting_and_its_text() {
    let (one_in, part) = if std::env::var_os("RNE_EXHAUSTIVE").is_some() { (1, 0.002) } else { (2, 0.004) };
    let all = Function::OF_TREES.into_iter().filter(|function| function.can_be_rewritten()).step_by(one_in).collect();
    let of_offsets = vec![Function::ForwardKinematics, Function::KineticEnergy, Function::CentreOfMass];
    for (name, functions) in [("spherical_rrp", all), ("dense6_2p", of_offsets)] {
        let robot = robot(name);
        let options = SearchOptions { rewrite: functions.clone(), seed: 1 };
        // few plans, some rounds for every function
        let mut over = 0.0;
        let mut clock = |_: &Progress| {
            over += if over < 0.45 { 0.02 } else { part };
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
