//! Robots from robot files.
#![cfg(feature = "std")]

use std::error::Error;

use crate::common::assert_close;
use rne_model::Robot;
use rne_runtime::{Arm, DynArm, InverseDynamics, LoadError, WrongJointCount};

const PUMA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/puma560.yaml");

#[test]
fn text_file_and_robot_give_the_same_arm() {
    let text = std::fs::read_to_string(PUMA).expect("the workspace's robot");
    let robot = Robot::from_yaml(&text).expect("a valid robot");
    let arm: Arm<6> = Arm::from_file(PUMA).expect("six joints");
    assert_eq!(Arm::from_yaml(&text).expect("six joints"), arm);
    assert_eq!(Arm::from_robot(&robot), Ok(arm.clone()));

    let dyn_arm = DynArm::from_file(PUMA).expect("a valid robot");
    assert_eq!(DynArm::from_yaml(&text).expect("a valid robot"), dyn_arm);
    assert_eq!(DynArm::from_robot(&robot), dyn_arm);
    // A plain table has no motors, the file has.
    assert_ne!(DynArm::new(arm.model()), dyn_arm);
    assert_eq!(DynArm::new(arm.model()).with_motors(arm.motors().to_vec()), Ok(dyn_arm.clone()));
    assert_eq!(dyn_arm.gravity_torques(&[0.1_f64; 6]), Ok(arm.gravity_torques(&[0.1; 6]).to_vec()));
}

#[test]
fn the_lecture_s_example_from_text() {
    let yaml = "\
format: 1
name: rod
source: lecture 38, example
convention: standard
gravity: [9.81, 0, 0]
joints:
  - type: revolute
    dh: {theta: 0, d: 0, a: 0.8, alpha: 0}
    link: {mass: 2.5, com: [-0.4, 0, 0], inertia: {yy: 2.5*0.8^2/12, zz: 2.5*0.8^2/12}}
";
    match Arm::<1>::from_yaml(yaml) {
        Ok(arm) => {
            assert_close("τ", &arm.inverse_dynamics(&[0.6], &[1.3], &[-0.7]), &[5.165_809_330_671_964]);
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn mistakes_are_named() {
    let wrong = WrongJointCount { expected: 7, found: 6, followers: 0, drives: 0 };
    let error = Arm::<7>::from_file(PUMA).unwrap_err();
    assert!(matches!(error, LoadError::WrongJointCount(count) if count == wrong), "{error}");
    assert_eq!(error.to_string(), "the robot has 6 joints, but an `Arm<7>` was asked for");

    assert!(error.source().is_none(), "shown as it is");

    let error = DynArm::from_file("no/such/robot.yaml").unwrap_err();
    let cause = error.source().and_then(|cause| cause.downcast_ref::<std::io::Error>());
    assert_eq!(cause.map(std::io::Error::kind), Some(std::io::ErrorKind::NotFound));
    assert!(error.to_string().starts_with("cannot read no/such/robot.yaml: "), "{error}");

    if cfg!(unix) {
        let error = DynArm::from_file("/dev/zero").unwrap_err();
        assert!(error.to_string().contains("not a regular file"), "no end, and no endless reading: {error}");
    }

    let error = DynArm::from_yaml("name: Nameless").unwrap_err();
    assert!(matches!(&error, LoadError::Invalid(report) if report.has_errors()), "{error}");
}
