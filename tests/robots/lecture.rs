//! The lecture on one page, `examples/lecture.rs`, beside the runtime.

use rne::DynArm;
use rne::model::{Convention, Robot};

#[path = "../../examples/lecture.rs"]
#[allow(dead_code)] // its program
mod on_one_page;

#[test]
fn the_lecture_on_one_page_has_the_bits_of_the_runtime() {
    let mut random = fastrand::Rng::with_seed(38);
    let mut robots = 0;
    for shipped in rne_robots::ROBOTS {
        let name = shipped.name;
        let robot = Robot::from_yaml(shipped.yaml).unwrap_or_else(|report| panic!("{name}: {report}"));
        let is_of_lecture = robot.convention == Convention::Standard && robot.floating_base.is_none();
        if !is_of_lecture {
            continue;
        }
        robots += 1;
        let arm = DynArm::from_robot(&robot);
        for _ in 0..100 {
            let mut list = || (0..robot.dof()).map(|_| 6.0 * random.f64() - 3.0).collect::<Vec<_>>();
            let (q, qd, qdd) = (list(), list(), list());
            let expected = arm.inverse_dynamics(&q, &qd, &qdd).expect("one per joint");
            assert_eq!(on_one_page::inverse_dynamics(&robot, &q, &qd, &qdd), expected, "{name}");
        }
    }
    assert!(robots >= 8, "{robots} robots with a standard table");
}
