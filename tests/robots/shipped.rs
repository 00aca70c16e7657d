//! Every shipped robot, derived from its file, and a way to do something with each.

use rne::{Arm, InverseDynamics};

/// A derived robot together with what the tests need to know of it.
pub(crate) trait Shipped<const DOF: usize>: InverseDynamics<DOF> {
    /// The name of its file.
    const NAME: &'static str;
    /// Position limits of its file, infinite where it has none.
    const POSITION_LIMITS: [(f64, f64); DOF];

    /// The same robot at run time.
    fn arm() -> Arm<DOF> {
        let path = format!("{}/robots/{}.yaml", env!("CARGO_MANIFEST_DIR"), Self::NAME);
        Arm::from_file(path).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// What a test does with each robot.
pub(crate) trait Visitor {
    fn visit<const DOF: usize, R: Shipped<DOF>>(&mut self, robot: &R);
}

/// The derived robots of a form.
macro_rules! derived {
    ($form:literal $([$robot:ident, $path:literal])*) => {
        use super::{Shipped, Visitor};

        $(
            mod $robot {
                #[derive(rne::InverseDynamics)]
                #[robot(path = $path, form = $form)]
                pub(crate) struct Robot;

                impl super::Shipped<{ Robot::DOF }> for Robot {
                    const NAME: &'static str = Robot::NAME;
                    const POSITION_LIMITS: [(f64, f64); Robot::DOF] = Robot::POSITION_LIMITS;
                }
            }
        )*

        /// Shows every robot of this form to a visitor.
        pub(crate) fn visit_all(visitor: &mut impl Visitor) {
            $(visitor.visit(&$robot::Robot);)*
        }
    };
}

/// The seven steps of every robot.
pub(crate) mod seven_steps {
    shipped::for_each_tried_robot!(derived! "seven_steps");
}

/// The reduced form of every robot, by its plan file.
pub(crate) mod reduced {
    shipped::for_each_tried_robot!(derived! "reduced");
}

#[test]
fn every_robot_that_is_tried_is_here() {
    struct Names(Vec<&'static str>);
    impl Visitor for Names {
        fn visit<const DOF: usize, R: Shipped<DOF>>(&mut self, _: &R) {
            self.0.push(R::NAME);
        }
    }
    let mut derived = Names(Vec::new());
    seven_steps::visit_all(&mut derived);
    let tried: Vec<&str> = shipped::tried().map(|robot| robot.name).collect();
    assert_eq!(derived.0, tried, "each is named as its file");
}

#[test]
fn every_shipped_robot_has_a_plan_and_golden_values() {
    for robot in rne_robots::ROBOTS {
        assert!(robot.plan.is_some(), "{}: there is no plan file", robot.name);
        let golden = format!("{}/tests/reference/{}.golden.json", env!("CARGO_MANIFEST_DIR"), robot.name);
        assert!(std::path::Path::new(&golden).is_file(), "there is no {golden}");
    }
}
