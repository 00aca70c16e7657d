//! Valid files.

use std::f64::consts::FRAC_PI_2;

use rne_model::{Convention, Inertia, JointKind, QuarterTurns, Robot, check};

const DEMO: &str = include_str!("robots/rp_demo.yaml");

#[test]
fn the_example_of_the_format() {
    let checked = check("robots/rp_demo.yaml", DEMO).unwrap();
    assert_eq!(checked.lints.to_string(), "");
    let robot = checked.robot;
    assert_eq!(robot.name, "rp_demo");
    assert_eq!(robot.title.as_deref(), Some("Two-joint demonstration arm"));
    assert_eq!(robot.source, "own numbers");
    assert_eq!(robot.convention, Convention::Standard);
    assert_eq!(robot.gravity, [0.0, 0.0, -9.81]);
    assert_eq!(robot.parameters, [("m".to_owned(), 1.5), ("a".to_owned(), 0.6)]);
    let [shoulder, slide] = &robot.joints[..] else { panic!() };
    assert_eq!(shoulder.name, "shoulder");
    assert_eq!(shoulder.row.dh.alpha.radians, FRAC_PI_2);
    assert_eq!(shoulder.row.dh.alpha.right, Some(QuarterTurns::One));
    assert_eq!(shoulder.limits.velocity, Some(2.0));
    assert_eq!(shoulder.motor.unwrap().coulomb, [0.395, -0.435]);
    assert_eq!(slide.row.kind, JointKind::Prismatic);
    assert_eq!(slide.row.link.mass, 1.5);
    let inertia = 1.5 * 0.36 / 12.0;
    assert_eq!(slide.row.link.inertia, Inertia { yy: inertia, zz: inertia, ..Inertia::default() });
    assert_eq!(slide.motor, None);
    assert_eq!(Robot::from_yaml(DEMO).unwrap(), robot);
}
