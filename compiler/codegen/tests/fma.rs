//! Fused multiply-adds: fewer instructions, the same operations but for their order, proved to be the same function.

mod common;

use common::{compiled, plans, shipped};
use rne_codegen::{
    Compiler, Form, Function, Name, Program, Statement, Target, ValueId, fma, ordered_for_registers,
    statements_of_outputs,
};
use std::collections::{BTreeMap, BTreeSet};

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

/// How many values of statements are alive after each statement: used later, or returned where no statement needs them.
fn alive(program: &Program) -> Vec<usize> {
    let names = |statement: &Statement| program.values.defined(statement.value).names().collect::<Vec<_>>();
    let last_use = |name: Name| program.statements.iter().rposition(|statement| names(statement).contains(&name));
    let lives: Vec<Option<usize>> = program.statements.iter().map(|statement| last_use(statement.name)).collect();
    (0..lives.len()).map(|at| lives[..=at].iter().filter(|last| last.is_some_and(|last| last > at)).count()).collect()
}

/// The statements change places, nothing else; so no bit of a result changes.
#[test]
fn the_order_for_registers_has_the_same_statements_and_fewer_lives() {
    let (mut before, mut after) = (0, 0);
    for (_, programs) in compiled() {
        for program in programs.into_iter().filter(|program| program.form == Form::Reduced) {
            let ordered = ordered_for_registers(&program);
            check_definitions(&ordered);
            let statements = |program: &Program| -> BTreeMap<Name, String> {
                let text = |statement: &Statement| format!("{:?}", listed(program, statement.value));
                program.statements.iter().map(|statement| (statement.name, text(statement))).collect()
            };
            assert!(statements(&ordered) == statements(&program), "{} of {}", program.function, program.robot);
            assert_eq!(ordered.operations(), program.operations(), "{} of {}", program.function, program.robot);
            let [given, new] = [&program, &ordered].map(|program| alive(program).into_iter().max().unwrap_or(0));
            // the greedy choice is not always the best one, but never far from it
            assert!(new <= given + 4, "{} of {}: {given}, {new}", program.function, program.robot);
            (before, after) = (before + given, after + new);
            check_outputs(&ordered);
        }
    }
    println!("the most values alive at once, summed over the programs: {before}, in the order for registers {after}");
    assert!(10 * after < 9 * before, "{after} of {before}");
}

/// A value written out down to what has a name.
fn listed(program: &Program, value: ValueId) -> Vec<String> {
    let this = program.values.get(value);
    let written =
        |id: ValueId| program.values.name(id).map_or_else(|| listed(program, id), |name| vec![name.to_string()]);
    let operands = this.operands().flat_map(written);
    // the kind of operation, without the numbers of its operands
    let kind = format!("{this:?}").chars().filter(|character| !character.is_ascii_digit()).collect();
    std::iter::once(kind).chain(operands).collect()
}

/// An output is known after its statement, and not before.
fn check_outputs(program: &Program) {
    let position = |name: &Name| program.statements.iter().position(|statement| statement.name == *name);
    for (output, after) in program.outputs.iter().zip(statements_of_outputs(program)) {
        let needed = program.values.used(output.value).names().collect::<Vec<_>>();
        assert_eq!(after, needed.iter().filter_map(position).max(), "{} of {}", output.name, program.robot);
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
