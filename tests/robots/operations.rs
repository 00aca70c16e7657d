//! Operation counts against an independent count of a faithful unrolling.

use rne_codegen::{Form, Function, compile};
use rne_model::Robot;

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
        let program = compile(&model, Function::InverseDynamics, Form::SevenSteps).expect("finite constants");
        let counted = program.operations();
        let independent = products + sums;
        println!("{robot:24} {}/{} = {}, independent {independent}", counted.mul, counted.add, counted.total());
        let difference = counted.total().abs_diff(independent);
        assert!(100 * difference <= 3 * independent, "{robot}: {} against {independent}", counted.total());
        assert_eq!(program.ledger.after(), (counted.mul, counted.add), "{robot}: the ledger's balance");
    }
}
