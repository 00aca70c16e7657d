//! Whatever a search may find is the function of the seven steps, and what is not is refused.

mod unusual;
mod ways;

use rne_model::{Robot, check_bytes};

use super::evaluator::{Evaluator, Frame, frame};
use super::moves::Moves;
use super::rewrite::Rewriting;
use super::search::{Search, default_plan};
use super::transcript::Drawing;
use super::*;
use crate::fusion::{fused, soonest};
use crate::proof::{self, Exactly};
use crate::{CompileError, Expression, Form, Function, Program};

fn robot(name: &str) -> Robot {
    let folder = match name {
        _ if name.starts_with("dense") => "tests/dense",
        _ if name == "spindle" || name.starts_with(|first: char| first.is_ascii_digit()) => "tests/random/files",
        _ => "robots",
    };
    let path = format!("{}/../{folder}/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
    check_bytes(name, &std::fs::read(path).unwrap()).unwrap().robot
}

const SEVERAL: [&str; 8] =
    ["puma560", "stanford", "ur5", "scara_cobra600", "planar3", "panda", "cylindrical_rpp", "dense6_2p"];

fn drawn(robot: &Robot, plan: &Plan, function: Function) -> Option<(Frame, Drawing)> {
    let frame = frame(robot, plan)?;
    let drawing = Drawing::new(&frame, plan, function, super::way::Way::Recursion)?;
    Some((frame, drawing))
}

fn unproved(robot: &Robot, plan: &Plan, function: Function) -> Option<(Program, Exactly, Frame)> {
    let (frame, drawing) = drawn(robot, plan, function)?;
    let (program, exactly) = drawing.unproved(robot, &frame, function, Form::Reduced).unwrap();
    Some((program, exactly, frame))
}

fn is_identical(robot: &Robot, (program, exactly, frame): &(Program, Exactly, Frame)) -> bool {
    proof::identical(robot, program, exactly, frame.table.reading).is_ok()
}

/// Fails with these words, by which `cargo xtask mutate` knows that it was the proof that refused.
fn must_be_identical(robot: &Robot, plan: &Plan, (program, exactly, frame): &(Program, Exactly, Frame)) {
    for (arranged, what) in [(program, ""), (&soonest(program), " soonest"), (&fused(program), " fused")] {
        if let Err(error) = proof::identical(robot, arranged, exactly, frame.table.reading) {
            panic!("the proof refuses {}{what}: {error}\n{:#?}", robot.name, plan.choices());
        }
    }
}

#[test]
fn random_plans_are_the_seven_steps() {
    for name in SEVERAL {
        let robot = robot(name);
        let moves = Moves::new(Evaluator::new(&robot, Function::InverseDynamics).frames());
        let mut rng = fastrand::Rng::with_seed(7);
        let mut plan = Plan::new(robot.dof());
        let mut tried = 0;
        for round in 0..60 {
            let other = moves.random(&plan, &mut rng);
            let function = Function::TORQUES[round % Function::TORQUES.len()];
            let Some(program) = unproved(&robot, &other, function) else { continue };
            must_be_identical(&robot, &other, &program);
            plan = other;
            tried += 1;
        }
        assert!(tried > 30, "{name}: {tried}");
    }
}

#[test]
fn every_single_choice_is_the_seven_steps() {
    for name in ["ur5", "dense6_2p"] {
        let robot = robot(name);
        let moves = Moves::new(Evaluator::new(&robot, Function::InverseDynamics).frames());
        let plan = default_plan(&robot, &[]);
        for other in moves.neighbours(&plan).iter().step_by(9) {
            if let Some(program) = unproved(&robot, other, Function::InverseDynamics) {
                must_be_identical(&robot, other, &program);
            }
        }
    }
}

#[test]
fn the_default_plan_is_the_same_every_time() {
    for name in ["puma560", "dense6_2p"] {
        let robot = robot(name);
        assert_eq!(default_plan(&robot, &[]), default_plan(&robot, &[]));
        let mut search = Search::new(&robot, &[]);
        search.greedy(50);
        assert!(search.plans <= 51, "a bounded number of evaluations");
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
    let (frame, drawing) = drawn(&robot, &plan, Function::InverseDynamics).unwrap();
    let given = drawing.dag.sheet.numbers.len();
    let before = evaluator::cost(&drawing.dag, &frame, &mut Vec::new());
    let mut rewriting = Rewriting::new(drawing.dag.clone(), 3, |dag, live| evaluator::cost(dag, &frame, live));
    let mut ticks = 0;
    let mut clock = |_: &Progress| {
        ticks += 1;
        (ticks < 40).then_some(f64::from(ticks) / 40.0)
    };
    let progress = |best| Progress { plans: 0, best, phase: "rewriting" };
    assert!(rewriting.anneal(0.2, progress, &mut clock).is_err(), "the clock ended it");
    let (cost, dag) = rewriting.best();
    assert!(cost.weight() < before.weight(), "{cost:?} from {before:?}");
    let text = graph_text::written(&dag, given);
    let read = graph_text::read(&text, &frame, &drawing.dag.sheet.numbers).unwrap();
    assert_eq!(evaluator::cost(&read, &frame, &mut Vec::new()), cost);
    let on = graph_text::on_numbers_of(&read, &drawing.dag);
    assert_eq!(evaluator::cost(&on, &frame, &mut Vec::new()), cost);
    // in another order of summands and factors, perhaps
    let again = graph_text::written(&on, given);
    assert_eq!(again.lines().count(), text.lines().count(), "a text goes on as it was");
    let program = drawing
        .with(read)
        .program(&robot, &frame, Function::InverseDynamics, Form::Rewritten, |program| program)
        .unwrap();
    assert_eq!((program.operations().mul, program.operations().add), (cost.mul, cost.add));
}

#[test]
fn mistakes_in_a_graph_name_their_line() {
    let robot = robot("planar2");
    let plan = Plan::new(2);
    let (frame, drawing) = drawn(&robot, &plan, Function::InverseDynamics).unwrap();
    for (text, line, what) in [
        ("t1 = q1 * qd9", 1, "there is no `qd9`"),
        ("t1 = qd1 ^ qd2", 1, "`^` is no operation"),
        ("t1 = qd1 + qd2\nt1 = qd1 * qd2", 2, "twice"),
        ("nonsense", 1, "no line of a graph"),
        ("tau3 = qd1", 1, "no joint 3"),
        ("t1 = qd1 / qd2", 1, "divides by what is no constant"),
        ("tau1 = qd1", 1, "a torque is missing"),
        ("t1 = k999 * qd1", 1, "there is no `k999`"),
    ] {
        let (at, message) = graph_text::read(text, &frame, &drawing.dag.sheet.numbers).unwrap_err();
        assert_eq!(at, line, "{text}");
        assert!(message.contains(what), "{text}: {message}");
    }
}

/// Every place of a program where one sign or one constant is wrong.
fn mutants(program: &Program) -> Vec<Program> {
    fn mutated(expression: &Expression, countdown: &mut usize) -> Expression {
        use Expression::{Difference, Negative, Product, Sum};
        let hit = |countdown: &mut usize| {
            *countdown = countdown.wrapping_sub(1);
            *countdown == usize::MAX
        };
        match expression {
            Sum(a, b) => {
                let here = hit(countdown);
                let (a, b) = (Box::new(mutated(a, countdown)), Box::new(mutated(b, countdown)));
                if here { Difference(a, b) } else { Sum(a, b) }
            }
            Difference(a, b) => {
                let here = hit(countdown);
                let (a, b) = (Box::new(mutated(a, countdown)), Box::new(mutated(b, countdown)));
                if here { Sum(a, b) } else { Difference(a, b) }
            }
            Product(a, b) => {
                let here = hit(countdown);
                let (a, b) = (Box::new(mutated(a, countdown)), Box::new(mutated(b, countdown)));
                if here { Sum(a, b) } else { Product(a, b) }
            }
            Negative(a) => Negative(Box::new(mutated(a, countdown))),
            leaf => leaf.clone(),
        }
    }
    (0..program.operations().total())
        .map(|index| {
            let mut countdown = index;
            let mut program = program.clone();
            for statement in &mut program.statements {
                statement.value = mutated(&statement.value, &mut countdown);
            }
            program
        })
        .collect()
}

#[test]
fn one_wrong_operation_anywhere_is_refused() {
    for name in ["planar3", "scara_cobra600", "stanford", "puma560"] {
        let robot = robot(name);
        let plan = default_plan(&robot, &[]);
        let (program, exactly, frame) = unproved(&robot, &plan, Function::InverseDynamics).unwrap();
        let reading = frame.table.reading;
        let mut refused = 0;
        for mutant in mutants(&program) {
            if mutant == program {
                // an operation of an angle
                continue;
            }
            let verdict = proof::identical(&robot, &mutant, &exactly, reading);
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
    let (program, exactly, frame) = unproved(&robot, &plan, Function::InverseDynamics).unwrap();
    let reading = frame.table.reading;
    assert!(proof::identical(&robot, &program, &exactly, reading).is_ok());
    let tiny = crate::exact::Reading::default().decimal(1e-18);
    for constant in &program.constants {
        let mut wrong = exactly.clone();
        wrong.get_mut(&constant.name).unwrap().0 = exactly[&constant.name].0 + tiny;
        assert!(proof::identical(&robot, &program, &wrong, reading).is_err(), "{}", constant.name);
    }
}

#[test]
fn a_wrong_literal_is_refused_by_rounding() {
    let robot = robot("puma560");
    let plan = default_plan(&robot, &[]);
    let (mut program, exactly, frame) = unproved(&robot, &plan, Function::InverseDynamics).unwrap();
    // the proof does not see how a constant was rounded, the states in double precision do
    let largest = program.constants.iter_mut().max_by(|a, b| a.value.total_cmp(&b.value)).unwrap();
    largest.value *= 1.0 + 1e-9;
    let verdict = proof::prove(&robot, &program, &exactly, frame.table.reading);
    assert!(matches!(verdict, Err(CompileError::Imprecise { .. })), "{verdict:?}");
}

#[test]
fn prismatic_links_are_carried_and_last_frames_turned() {
    let robot = robot("dense6_2p");
    let mut plan = Plan::new(robot.dof());
    let plain = cost(&robot, &plan).unwrap().total();
    plan.carried_prismatics = true;
    let carried = cost(&robot, &plan).unwrap().total();
    assert!(carried < plain - 60, "{carried} of {plain}");
    plan.turned_last_frame = true;
    let turned = cost(&robot, &plan).unwrap().total();
    assert!(turned < carried, "{turned} of {carried}");
    for function in Function::TORQUES {
        assert!(is_identical(&robot, &unproved(&robot, &plan, function).unwrap()), "{function}");
    }
}

#[test]
fn plans_survive_as_files_and_belong_to_one_robot() {
    let robot = robot("ur5");
    let mut clock = |progress: &Progress| (progress.plans < 600).then_some(0.0);
    let found = search(&robot, None, Wanted::default(), &mut clock).unwrap();
    let text = found.to_yaml();
    let read = PlanFile::read("ur5.plan.yaml", &text, &robot).unwrap();
    assert_eq!(read, found.file);
    let again = search(&robot, Some(&read), Wanted::default(), &mut |_| None).unwrap();
    assert!(again.reduced.cost.weight() <= found.reduced.cost.weight(), "never worse");

    let mut other = robot.clone();
    other.joints[2].row.link.mass += 1.0;
    let report = PlanFile::read("ur5.plan.yaml", &text, &other).unwrap_err();
    let error = report.errors().next().unwrap();
    assert_eq!((error.line, error.column), (5, 14));
    assert!(error.message.contains("numbers of its robot file have changed"), "{}", error.message);
    assert!(error.help.as_ref().unwrap().contains("rne search"), "{report}");
    for (from, to, what) in [
        ("format: 1", "format: 2", "format: 1"),
        ("robot:", "robt:", "`robt` is no key"),
        ("  plan:\n", "  plam:\n", "`plam` is no key"),
        ("    joints:\n", "    jonts:\n", "`jonts` is no choice"),
        ("    joints:\n", "    joints:\n      - {}\n", "7 joints"),
        ("length_scale: ", "length_scale: zz", "is no scale"),
        ("    joints:\n", "    turned_last_frame: up\n    joints:\n", "`true` or `false`"),
        ("    joints:\n      - {", "    joints:\n      - {slide: up, ", "`up` is no rule for a slide"),
        ("    joints:\n      - {", "    joints:\n      - {on: [light], ", "`light` is no choice of a joint"),
    ] {
        let wrong = text.replacen(from, to, 1);
        assert_ne!(wrong, text, "{from}");
        let report = PlanFile::read("ur5.plan.yaml", &wrong, &robot).unwrap_err();
        assert!(report.errors().next().unwrap().message.contains(what), "{report}");
    }
}
