//! Fused multiply-adds: fewer instructions, the same operations but for their order, proved to be the same function.

mod common;

use common::{compiled, plans, shipped};
use rne_codegen::{Compiler, Form, Function, Name, Program, Target, ValueId, fma};
use std::collections::BTreeSet;

/// What is defined, in order, is what is used, later.
fn check_definitions(program: &Program) {
    let mut known: BTreeSet<Name> = program.arguments().collect();
    known.extend(program.constants().map(|constant| constant.name));
    known.extend(program.sines_and_cosines.iter().flat_map(|turn| [turn.sine, turn.cosine]).flatten());
    let mut used = BTreeSet::new();
    for statement in &program.statements {
        let operands: BTreeSet<Name> = program.values.defined(statement.value).names().collect();
        assert!(operands.is_subset(&known), "{} of {}", statement.name, program.robot);
        used.extend(operands);
        assert!(known.insert(statement.name), "{} of {} twice", statement.name, program.robot);
    }
    used.extend(program.outputs.iter().flat_map(|output| program.values.used(output.value).names()));
    let idle = program.statements.iter().find(|statement| !used.contains(&statement.name));
    assert_eq!(idle.map(|statement| statement.name), None, "of {}", program.robot);
    // text nests what has no name, so it must not be used twice; counts of the list are then those of the text
    let mut uses = vec![0; program.values.len()];
    for (id, value) in program.values.iter() {
        assert!(value.operands().all(|operand| operand < id), "{id:?} of {}", program.robot);
        value.operands().for_each(|operand| uses[operand.index()] += 1);
    }
    program.outputs.iter().for_each(|output| uses[output.value.index()] += 1);
    let nameless = program.values.iter().filter(|(id, _)| program.values.name(*id).is_none());
    let turned = |id: ValueId| program.sines_and_cosines.iter().any(|turn| turn.angle == id);
    for (id, value) in nameless.filter(|(id, _)| !turned(*id)) {
        assert_eq!(uses[id.index()], 1, "{value:?} of {}", program.robot);
    }
}

#[test]
fn every_program_takes_fewer_instructions_and_no_more_sums() {
    for (_, programs) in compiled() {
        for program in programs {
            let fused = fma::contracted(&program);
            check_definitions(&fused);
            let (before, after) = (program.operations(), fused.operations());
            assert!(fma::instructions(&fused) <= fma::instructions(&program), "{}", program.robot);
            assert_eq!(after.add, before.add, "{} of {}", program.function, program.robot);
            // a product that is fused with several sums is computed with each of them
            assert!(after.mul >= before.mul, "{} of {}", program.function, program.robot);
        }
    }
}

/// The terms of sums change places, nothing else.
#[test]
fn the_shortest_wait_has_the_same_operations_under_the_same_names() {
    for (_, programs) in compiled() {
        for program in programs.into_iter().filter(|program| program.form != Form::SevenSteps) {
            let ordered_for_latency = fma::ordered_for_latency(&program);
            check_definitions(&ordered_for_latency);
            assert_eq!(
                ordered_for_latency.operations(),
                program.operations(),
                "{} of {}",
                program.function,
                program.robot
            );
            let names = |program: &Program| program.statements.iter().map(|s| s.name).collect::<Vec<_>>();
            assert_eq!(names(&ordered_for_latency), names(&program), "{} of {}", program.function, program.robot);
            assert!(
                fma::ordered_for_latency(&ordered_for_latency) == ordered_for_latency,
                "{} of {}",
                program.function,
                program.robot
            );
        }
    }
}

/// The proof runs in two prime fields; a program that it refuses is an error here.
#[test]
fn every_reduced_program_is_proved_as_it_is_fused() {
    for robot in shipped() {
        let plans = plans(&robot);
        let program = Compiler::new(&robot)
            .with_plans(&plans)
            .for_target(Target::Throughput)
            .compile(Function::InverseDynamics, Form::Reduced)
            .expect("proved");
        let proof = program.proof.expect("a proof");
        assert!(proof.rounding < 1e-13, "{}: {:e}", robot.name, proof.rounding);
        let plain =
            Compiler::new(&robot).with_plans(&plans).compile(Function::InverseDynamics, Form::Reduced).expect("proved");
        let [before, after] = [&plain, &program].map(fma::instructions);
        println!("{:<20} {before} instructions as written, {after} fused", robot.name);
        assert!(after <= before, "{}", robot.name);
    }
}
