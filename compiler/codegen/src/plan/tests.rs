//! Every program that a search can find computes the function of the seven steps; every other program is refused.

mod algorithms;
mod unusual;

use std::collections::BTreeSet;

use rne_model::{Reader, Robot};

use super::*;
use crate::fma::{contracted, ordered_for_latency};
use crate::ir::{Embedding, Exactly, Graph, Input, Name, SamplePoint, Traced};
use crate::plan::cost::{Evaluator, frame};
use crate::plan::descent::default_plan;
use crate::plan::rewriting::Annealing;
use crate::proof;
use crate::reduced::Algorithm;
use crate::{CompileError, Compiler, Form, Function, Operator, Program, Value};

fn robot(name: &str) -> Robot {
    let folder = match name {
        _ if name.starts_with("dense") => "tests/dense",
        "spindle" | "close_angles" | "about_origin" => "tests/random/files",
        _ if name.starts_with(|first: char| first.is_ascii_digit()) => "tests/random/files",
        _ => "robots",
    };
    let path = format!("{}/../../{folder}/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    Reader::new(name).read(&std::fs::read(path).unwrap()).unwrap().robot
}

const SEVERAL: [&str; 8] =
    ["puma560", "stanford", "ur5", "scara_cobra600", "planar3", "panda", "cylindrical_rpp", "dense6_2p"];

fn drawn(robot: &Robot, plan: &Plan, function: Function) -> Option<Formulation> {
    frame(robot, plan, function)?.written(plan, function, Algorithm::Rnea)
}

/// A program that has not been proved, with what its constants are exactly and how they are read.
type Unproved = (Program, Exactly, Embedding);

fn lowered(robot: &Robot, function: Function, formulation: Formulation) -> Unproved {
    let embedding = formulation.embedding();
    let (program, exactly) = formulation.lowered(robot, function).unwrap();
    (program, exactly, embedding)
}

fn unproved(robot: &Robot, plan: &Plan, function: Function) -> Option<Unproved> {
    Some(lowered(robot, function, drawn(robot, plan, function)?))
}

fn is_identical(robot: &Robot, (program, exactly, embedding): &Unproved) -> bool {
    proof::identical(robot, program, exactly, *embedding).is_ok()
}

/// Fails with these words, by which `cargo xtask mutate` knows that it was the proof that refused.
fn must_be_identical(robot: &Robot, plan: &Plan, (program, exactly, embedding): &Unproved) {
    for (arranged, what) in
        [(program, ""), (&ordered_for_latency(program), " ordered for latency"), (&contracted(program), " contracted")]
    {
        if let Err(error) = proof::identical(robot, arranged, exactly, *embedding) {
            panic!("the proof refuses {}{what}: {error}\n{:#?}", robot.name, plan.choices());
        }
    }
}

/// Two arguments with one random number would let the proof take one for the other.
#[test]
fn no_two_arguments_of_a_function_have_the_same_random_number() {
    let mut tested = 0;
    for file in
        ["robots/planar2.yaml", "benches/trees/loops/five_bar.yaml", "benches/trees/loops/floating_four_bar_leg.yaml"]
    {
        let path = format!("{}/../../{file}", env!("CARGO_MANIFEST_DIR"));
        let reader = Reader::new(file).trees().couplings().loops();
        let robot = reader.read(&std::fs::read(path).unwrap()).unwrap().robot;
        let point = SamplePoint::new(Embedding::default(), 1);
        for function in Function::ALL {
            let Ok(program) = Compiler::new(&robot).compile(function, Form::SevenSteps) else { continue };
            let names: Vec<Name> =
                program.argument_arrays().into_iter().flat_map(|array| array.elements).flatten().collect();
            let numbers: BTreeSet<u64> = names.iter().map(|&name| point.argument(Input::new(name)).key()).collect();
            assert_eq!(numbers.len(), names.len(), "{} of {file}: {names:?}", function.name());
            tested += 1;
        }
    }
    assert!(tested >= 100, "{tested}");
}

#[test]
fn the_default_plan_is_the_same_every_time() {
    for name in ["puma560", "dense6_2p"] {
        let robot = robot(name);
        assert_eq!(default_plan(&robot, &[]), default_plan(&robot, &[]));
        let mut search = Descent::new(&robot, &[]);
        search.greedy(50);
        assert!(search.counted() <= 51, "a bounded number of evaluations");
    }
}

#[test]
fn a_trick_that_is_left_out_is_not_used() {
    let robot = robot("puma560");
    for trick in Trick::ALL {
        let plan = default_plan(&robot, &[trick]);
        assert!(!trick.is_in(&plan), "{trick}");
        assert!(is_identical(&robot, &unproved(&robot, &plan, Function::InverseDynamics).unwrap()), "{trick}");
    }
}

#[test]
fn rewritten_graphs_survive_as_text() {
    let robot = robot("puma560");
    let plan = default_plan(&robot, &[]);
    let Formulation { names, traced: plain, scales } = drawn(&robot, &plan, Function::InverseDynamics).unwrap();
    let given = plain.graph.factors();
    let before = plain.graph.cost(&mut Vec::new());
    let mut rewriting = Annealing::new(plain.graph.clone(), 3, Graph::cost);
    let mut ticks = 0;
    let mut clock = |_: Cost| {
        ticks += 1;
        (ticks < 40).then_some(f64::from(ticks) / 40.0)
    };
    assert!(rewriting.anneal(0.2, &mut clock).is_break(), "the clock ended it");
    let (cost, graph) = rewriting.best;
    assert!(cost.weight() < before.weight(), "{cost:?} from {before:?}");
    let text = graph_text::written(&graph, &given);
    let read = graph_text::read(&text, &plain.graph, Function::InverseDynamics).unwrap();
    assert_eq!(read.graph.cost(&mut Vec::new()), cost);
    let on = graph_text::on_numbers_of(&read.graph, &plain.graph);
    assert_eq!(on.cost(&mut Vec::new()), cost);
    // in another order of summands and factors, perhaps
    let again = graph_text::written(&on, &given);
    let words = |text: &str| text.split_whitespace().count();
    assert_eq!(words(&again), words(&text), "a text goes on as it was");
    let rewritten = Formulation { names, traced: read.told_by(&plain), scales };
    let (program, exactly, embedding) = lowered(&robot, Function::InverseDynamics, rewritten);
    proof::prove(&Reference::of(&robot, Function::InverseDynamics).unwrap(), &program, &exactly, embedding).unwrap();
    assert_eq!((program.operations().mul, program.operations().add), (cost.mul, cost.add));
}

#[test]
fn mistakes_in_a_graph_name_their_word() {
    let robot = robot("planar2");
    let plan = Plan::new(2);
    let plain = drawn(&robot, &plan, Function::InverseDynamics).unwrap().traced;
    for (text, word, what) in [
        ("operations q1*qd9", 2, "the graph defines no value `qd9`"),
        ("operations q1^qd2", 2, "`q1^qd2` is not an operation"),
        ("operations qd1", 2, "`qd1` is not an operation"),
        ("operations qd1*qd2 2*1", 3, "the graph defines no value `2`"),
        ("operations qd1*qd2 0+1", 3, "the graph defines no value `0`"),
        ("operations qd1*qd2 +1*1", 3, "the graph defines no value `+1`"),
        ("operations ü*qd2", 2, "the graph defines no value `ü`"),
        ("nonsense", 1, "a graph begins with `constants` or `operations`, not with `nonsense`"),
        ("results qd1 qd1 qd2", 4, "returns 2 numbers, but the graph has 3 results"),
        ("results qd1", 2, "returns 2 numbers, but the graph has 1 results"),
        ("", 0, "returns 2 numbers, but the graph has 0 results"),
        ("operations k999*qd1", 2, "the graph defines no value `k999`"),
        ("constants 0.123456", 2, "the number 0.123456 does not occur"),
        ("constants qd1", 2, "`qd1` is not an operation"),
        ("constants inf", 2, "`inf` is not a finite number"),
        ("constants 1e999", 2, "`1e999` is not a finite number"),
        ("constants /1", 2, "the graph defines no value `1`"),
    ] {
        let read = graph_text::read(text, &plain.graph, Function::InverseDynamics);
        let Err((at, mistake)) = read else { panic!("{text}") };
        let message = mistake.to_string();
        assert!(message.contains(what), "{text}: {message}");
        assert_eq!(at, word, "{text}");
    }
}

/// The program with one wrong operation, for each of its operations.
fn mutants(program: &Program) -> Vec<Program> {
    let wrong = |operator| if operator == Operator::Sum { Operator::Difference } else { Operator::Sum };
    let operations = program.values.iter().filter_map(|(id, value)| match value {
        Value::Binary(operator, a, b) => Some((id, Value::Binary(wrong(operator), a, b))),
        _ => None,
    });
    operations
        .map(|(id, wrong)| {
            let mut program = program.clone();
            program.values.replace(id, wrong);
            program
        })
        .collect()
}

#[test]
fn one_wrong_operation_anywhere_is_refused() {
    for name in ["planar3", "scara_cobra600", "stanford", "puma560"] {
        let robot = robot(name);
        let plan = default_plan(&robot, &[]);
        let (program, exactly, embedding) = unproved(&robot, &plan, Function::InverseDynamics).unwrap();
        let mut refused = 0;
        for mutant in mutants(&program) {
            let verdict = proof::identical(&robot, &mutant, &exactly, embedding);
            assert!(matches!(verdict, Err(CompileError::NotIdentical { .. })), "{name}");
            refused += 1;
        }
        assert!(refused > 20, "{name}: {refused}");
    }
}

#[test]
fn one_constant_off_by_the_last_digit_is_refused() {
    let robot = robot("puma560");
    let plan = default_plan(&robot, &[]);
    let (program, exactly, embedding) = unproved(&robot, &plan, Function::InverseDynamics).unwrap();
    assert!(proof::identical(&robot, &program, &exactly, embedding).is_ok());
    let tiny = crate::ir::Embedding::default().decimal(1e-18);
    for constant in program.constants() {
        let mut wrong = exactly.clone();
        wrong.get_mut(&constant.name).unwrap().0 = exactly[&constant.name].0 + tiny;
        assert!(proof::identical(&robot, &program, &wrong, embedding).is_err(), "{}", constant.name);
    }
}

#[test]
fn a_wrong_literal_is_refused_by_rounding() {
    let robot = robot("puma560");
    let plan = default_plan(&robot, &[]);
    let (mut program, exactly, embedding) = unproved(&robot, &plan, Function::InverseDynamics).unwrap();
    // the proof does not see how a constant was rounded; the states in double precision do
    let numbers = program.values.iter().filter_map(|(id, value)| match value {
        Value::Constant(number) => Some((id, number)),
        _ => None,
    });
    let (id, largest) = numbers.max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap();
    program.values.replace(id, Value::Constant(largest * (1.0 + 1e-9)));
    let verdict =
        proof::prove(&Reference::of(&robot, Function::InverseDynamics).unwrap(), &program, &exactly, embedding);
    assert!(matches!(verdict, Err(CompileError::Imprecise { .. })), "{verdict:?}");
}

#[test]
fn prismatic_links_are_carried_and_last_frames_turned() {
    let robot = robot("dense6_2p");
    let mut plan = Plan::new(robot.dof());
    let mut evaluator = Evaluator::new(&robot, Function::InverseDynamics);
    let plain = evaluator.cost(&plan).unwrap().total();
    plan.carried_prismatics = true;
    let carried = evaluator.cost(&plan).unwrap().total();
    assert!(carried < plain - 60, "{carried} of {plain}");
    plan.turned_last_frame = true;
    let turned = evaluator.cost(&plan).unwrap().total();
    assert!(turned < carried, "{turned} of {carried}");
    for function in Function::TORQUES {
        assert!(is_identical(&robot, &unproved(&robot, &plan, function).unwrap()), "{function}");
    }
}

/// A torso with two arms of two joints, and two legs of three beside it; nothing folds.
fn two_arms_and_two_legs() -> Robot {
    const TWISTS_AND_LENGTHS: [(f64, f64); 7] =
        [(0.3, 0.1), (0.7, 0.15), (-0.4, 0.2), (0.2, 0.25), (1.1, 0.3), (-0.6, 0.35), (0.5, 0.4)];
    let joints = [
        (0, "base"),
        (1, "0"),
        (2, "1"),
        (3, "2"),
        (2, "1"),
        (3, "4"),
        (4, "base"),
        (5, "6"),
        (6, "7"),
        (4, "base"),
        (5, "9"),
        (6, "10"),
    ];
    let row = |(index, (like, parent)): (usize, (usize, &str))| {
        let parent = if parent == "base" { parent.to_owned() } else { format!("j{parent}") };
        let (twist, length) = TWISTS_AND_LENGTHS[like];
        format!(
            "{{name: j{index}, parent: {parent}, type: revolute, dh: {{theta: 0, d: {length}, a: 0.{index}1, \
             alpha: {twist}}}, link: {{mass: 1{length}, com: [0.03, -0.02, {length}], inertia: {{xx: 0.05, yy: 0.06, \
             zz: 0.07, xy: 0.003, xz: -0.004, yz: 0.002}}}}}}"
        )
    };
    let rows: Vec<String> = joints.into_iter().enumerate().map(row).collect();
    let yaml = format!(
        "{{format: 2, name: two_arms_and_two_legs, source: test, tool: {{on: j11}}, convention: modified, \
         gravity: [0, 0, -9.81], joints: [{}]}}",
        rows.join(",\n")
    );
    Reader::new("tree").trees().read(&yaml).unwrap_or_else(|report| panic!("{report}")).robot
}

#[test]
fn branches_of_the_base_are_counted_one_by_one() {
    let robot = two_arms_and_two_legs();
    let mut evaluator = Evaluator::new(&robot, Function::InverseDynamics);
    let open = evaluator.open_choices();
    let alike = |index: usize| open.joints[index].alike.as_slice();
    assert_eq!([0, 2, 3, 6, 11].map(alike), [&[0][..], &[2, 4], &[3, 5], &[6, 9], &[8, 11]]);
    assert_eq!(open.joints[6].scaled, [6, 7, 8]);
    assert!(open.joints[7].scaled.is_empty());

    let mut plan = Plan::new(robot.dof());
    let mut check = |plan: &Plan| {
        let cost = evaluator.cost(plan).expect("it fits");
        assert_eq!(Some(cost), evaluator.cost_of(plan, Algorithm::Rnea), "{:#?}", plan.choices());
        for function in Function::TORQUES {
            assert!(is_identical(&robot, &unproved(&robot, plan, function).unwrap()), "{function}");
        }
        cost.total()
    };
    let plain = check(&plan);
    plan.length_scale = Scale::A(2);
    let one_scale = check(&plan);
    for joint in [6, 9] {
        plan.joints[joint].length_scale = Scale::A(joint + 2);
    }
    let scale_per_branch = check(&plan);
    assert!(scale_per_branch < one_scale && one_scale < plain, "{scale_per_branch} {one_scale} {plain}");
    let scales = drawn(&robot, &plan, Function::InverseDynamics).unwrap().scales;
    assert_eq!(scales.iter().map(|of| of.behind).collect::<Vec<_>>(), [Some(1), Some(7), Some(10)]);

    let mut changed = plan.clone();
    changed.joints[6].switches.second_moment_unturned = true;
    changed.joints[3].moment = Moment::Inertia;
    let followed = changed.clone().followed(&plan, alike);
    assert!(followed.joints[9].switches.second_moment_unturned && followed.joints[5].moment == Moment::Inertia);
    check(&followed);
    // only a joint on the base has scales
    changed.joints[7].force_scale = Scale::One;
    assert_eq!(evaluator.cost(&changed), None);
}

/// An arm in which nothing folds.
fn dense(dof: usize) -> Robot {
    let mut robot = robot("dense7");
    let joints: Vec<_> = robot.joints.iter().cycle().take(dof).cloned().collect();
    robot.joints = joints;
    robot
}

#[test]
fn long_arms_take_no_more_plans_and_no_ways_that_lose() {
    for dof in [4, 16, 32] {
        let mut search = Descent::new(&dense(dof), &[]);
        search.greedy(240);
        assert!(search.counted() <= 240, "{} plans for {dof} joints", search.counted());
    }
    for function in Function::OF_TREES {
        // of the Hessian, the recursion of forward over reverse mode is short for a few joints alone
        let joints = if function == Function::TorqueHessian { 4 } else { 7 };
        assert_eq!(Algorithm::of_robot(function, &dense(joints)), Algorithm::of(function), "{function}");
        let many = Algorithm::of_robot(function, &dense(32));
        assert_eq!(many.is_empty(), Algorithm::of(function).is_empty(), "{function}");
        assert!(!many.contains(&Algorithm::UnitColumns), "{function}");
    }
}
