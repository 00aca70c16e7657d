//! Operation counts against an independent count of a faithful unrolling.

use rne_codegen::plan::{PlanSet, Trick};
use rne_codegen::{Compiler, Form, Function};
use rne_model::Robot;
use rne_search::{PlanFile, savings, without};

/// Products and sums of the seven steps with gravity carried from link to link, unrolled, folded and shared, counted by
/// an experiment in another language on the same parameters.
const INDEPENDENT: [(&str, usize, usize); 13] = [
    ("robots/planar2", 28, 17),
    ("robots/planar3", 48, 36),
    ("robots/puma560", 294, 230),
    ("robots/puma560_mdh", 300, 232),
    ("robots/stanford", 258, 205),
    ("robots/scara_cobra600", 43, 30),
    ("robots/panda", 528, 466),
    ("robots/iiwa14", 387, 327),
    ("robots/ur5", 318, 261),
    ("robots/ur5e", 318, 261),
    ("robots/wam7", 513, 451),
    ("tests/dense/dense6_2p", 594, 493),
    ("tests/dense/dense7", 727, 597),
];

#[test]
fn counts_are_those_of_a_faithful_unrolling() {
    for (robot, products, sums) in INDEPENDENT {
        let text =
            std::fs::read_to_string(format!("{}/{robot}.yaml", env!("CARGO_MANIFEST_DIR"))).expect("a robot file");
        let model = Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"));
        let program =
            Compiler::new(&model).compile(Function::InverseDynamics, Form::SevenSteps).expect("finite constants");
        let counted = program.operations();
        let independent = products + sums;
        println!("{robot:24} {}/{} = {}, independent {independent}", counted.mul, counted.add, counted.total());
        let difference = counted.total().abs_diff(independent);
        assert!(100 * difference <= 3 * independent, "{robot}: {} against {independent}", counted.total());
        assert_eq!(program.fold_report.after(), (counted.mul, counted.add), "{robot}: the ledger's balance");
    }
}

/// What independent experiments reached: the regrouped form without any search, the best found by a search over
/// choices, and after algebraic rewriting. Products and sums together.
const REACHED: [(&str, usize, usize, usize); 13] = [
    ("robots/planar2", 27, 23, 23),
    ("robots/planar3", 56, 52, 51),
    ("robots/puma560", 338, 263, 254),
    ("robots/puma560_mdh", 365, 265, 259),
    ("robots/stanford", 227, 187, 184),
    ("robots/scara_cobra600", 39, 36, 22),
    ("robots/panda", 585, 520, 510),
    ("robots/iiwa14", 414, 346, 345),
    ("robots/ur5", 328, 232, 209),
    ("robots/ur5e", 328, 232, 208),
    ("robots/wam7", 586, 501, 493),
    ("tests/dense/dense6_2p", 691, 642, 578),
    ("tests/dense/dense7", 878, 788, 772),
];

/// The best plan known of this arm loses a digit in single precision; the one that is shipped does not, and takes one
/// operation more.
const PRECISE: (&str, usize) = ("tests/dense/dense7", 789);

fn read(robot: &str) -> (Robot, PlanSet) {
    let path = |extension| format!("{}/{robot}.{extension}", env!("CARGO_MANIFEST_DIR"));
    let model = Robot::from_yaml(&std::fs::read_to_string(path("yaml")).expect("a robot file"));
    let model = model.unwrap_or_else(|report| panic!("{report}"));
    let plan = std::fs::read_to_string(path("plan.yaml")).expect("a plan file");
    let plan = PlanFile::read(robot, &plan, &model).unwrap_or_else(|report| panic!("{report}"));
    (model, PlanSet::from(plan))
}

#[test]
fn the_default_choices_come_close_to_the_best() {
    println!("{:24} default  regrouped  best", "");
    for (robot, regrouped, best, _) in REACHED {
        let (model, _) = read(robot);
        let program = Compiler::new(&model)
            .with_plans(PlanSet::default_of(&model))
            .compile(Function::InverseDynamics, Form::Reduced);
        let total = program.expect("a proof").operations().total();
        println!("{robot:24} {total:7}  {regrouped:9}  {best:4}");
        assert!(total <= regrouped, "{robot}: {total}");
        assert!(10 * total <= 11 * best, "{robot}: {total} is more than 10 % over {best}");
    }
}

#[test]
fn plans_are_as_good_as_the_best_known() {
    println!("{:24} planned  best known  rewritten  best known", "");
    let mut rewritten_as_good = 0;
    for (robot, _, best, best_rewritten) in REACHED {
        let (model, plans) = read(robot);
        let total = |plans: PlanSet| {
            let program = Compiler::new(&model).with_plans(plans).compile(Function::InverseDynamics, Form::Reduced);
            program.unwrap_or_else(|error| panic!("{robot}: {error}")).operations().total()
        };
        let (planned, rewritten) = (total(without(&model, &plans, &[Trick::Rewriting])), total(plans));
        println!("{robot:24} {planned:7}  {best:10}  {rewritten:9}  {best_rewritten:10}");
        let best = if robot == PRECISE.0 { PRECISE.1 } else { best };
        assert!(planned <= best, "{robot}: {planned}");
        assert!(rewritten <= planned, "{robot}: {rewritten}");
        rewritten_as_good += usize::from(rewritten <= best_rewritten);
        assert!(robot != "robots/puma560" || rewritten <= best_rewritten, "{robot}: {rewritten}");
    }
    println!("rewritten as good as the best known: {rewritten_as_good} of {}", REACHED.len());
    assert!(2 * rewritten_as_good >= REACHED.len());
}

#[test]
fn every_trick_saves_somewhere() {
    let mut saved: Vec<(Trick, isize)> = Trick::ALL.map(|trick| (trick, 0)).into();
    for (robot, ..) in REACHED {
        let (model, plans) = read(robot);
        let rewritten = plans.rewritten.values().filter_map(|rewritten| rewritten.plan.clone());
        let of_rewritten: Vec<PlanSet> = rewritten.map(PlanSet::from).collect();
        for (trick, operations) in of_rewritten.iter().chain([&plans]).flat_map(|plans| savings(&model, plans)) {
            if let Some((_, sum)) = saved.iter_mut().find(|(other, _)| *other == trick) {
                *sum += operations;
            }
        }
    }
    for (trick, operations) in saved {
        println!("{trick:18} {operations:4} operations over all plans");
        assert!(operations > 0, "{trick}");
    }
}
