//! The functions of frames in both forms, of random arms: the code is the runtime.

use fastrand::Rng;
use rne::{BaseMotion, Payload, Wrench};
use rne_codegen::{Compiler, Form, Function};
use rne_model::{Angle, FixedFrame, Frame, FrameId, Robot, Transform};

use crate::arm::{Arm, Given, Maker, base_rotation};
use crate::arms;
use crate::check::{json, numbers, wrench};
use crate::equality;

/// An arm with a frame on the base, one on the first link and one on another link, of which some angles are right ones.
fn robot(rng: &mut Rng, seed: u64) -> Robot {
    let yaml = arms::yaml(seed);
    let mut robot = Robot::from_yaml(&yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}"));
    let number = |rng: &mut Rng| if rng.bool() { 0.0 } else { 2.0 * rng.f64() - 1.0 };
    let angle = |rng: &mut Rng| match rng.u8(0..3) {
        0 => Angle::ZERO,
        1 => Angle::new(std::f64::consts::FRAC_PI_2),
        _ => Angle::new(6.0 * rng.f64() - 3.0),
    };
    let links = [None, Some(0), Some(rng.usize(0..robot.dof()))];
    robot.frames = links
        .into_iter()
        .enumerate()
        .map(|(index, on)| Frame {
            name: format!("frame_{index}"),
            fixed: FixedFrame {
                on,
                placement: Transform { xyz: [(); 3].map(|()| number(rng)), rpy: [(); 3].map(|()| angle(rng)) },
            },
        })
        .collect();
    robot
}

fn of_random_arms(form: Form, arms: u64, tolerance: f64) {
    let mut rng = Rng::with_seed(31);
    let mut worst = 0.0_f64;
    for seed in 0..arms {
        let robot = robot(&mut rng, seed);
        let array = |rng: &mut Rng| -> Vec<f64> { (0..robot.dof()).map(|_| 4.0 * rng.f64() - 2.0).collect() };
        let triple = |rng: &mut Rng| [(); 3].map(|()| 20.0 * rng.f64() - 10.0);
        let (q, qd, zeros) = (array(&mut rng), array(&mut rng), vec![0.0; robot.dof()]);
        let wrench = Wrench { force: triple(&mut rng), moment: triple(&mut rng) };
        let (payload, base) = (Payload::none(), BaseMotion::fixed([0.0; 3]));
        let given = Given {
            q: &q,
            qd: &qd,
            qdd: &zeros,
            tau: &zeros,
            wrench,
            payload,
            base,
            base_rotation: base_rotation(),
            step: 0.5,
        };
        // those of the list, and a link frame
        for frame in robot.frame_ids().take(4) {
            let at = robot.clone().at_frame(frame);
            let maker = Maker::Code(form);
            let arm = Arm::by_no_choice(&at, maker);
            for function in Function::of_frames() {
                let found = arm.numbers(function, &given);
                let error = equality::error(&arm, maker, function, &given, &found, tolerance);
                assert!(
                    error <= tolerance,
                    "{}, seed {seed}, {function} of {}: {error:e}",
                    robot.name,
                    robot.frame_name(frame)
                );
                worst = worst.max(error);
            }
        }
    }
    println!("{form}: {worst:e}");
}

#[test]
fn frames_of_twenty_arms_are_those_of_pinocchio() {
    let reference = json("tests/reference/frames.json");
    let arms = reference["arms"].as_array().expect("arms");
    assert_eq!(arms.len(), 20);
    let mut compared = 0;
    for expected in arms {
        let text = expected["robot"].as_str().expect("a robot file");
        let robot = Robot::from_yaml(text).unwrap_or_else(|report| panic!("{report}"));
        let array = |key: &str| numbers(&expected["state"][key]);
        let (q, qd, zeros) = (array("q"), array("qd"), vec![0.0; robot.dof()]);
        let wrench = wrench(array("wrench").try_into().expect("six numbers"));
        let given = Given { wrench, ..Given::of_joints(&q, &qd, &zeros) };
        let frames = expected["frames"].as_array().expect("frames");
        assert_eq!(frames.len(), robot.frames.len());
        for (index, expected) in frames.iter().enumerate() {
            let at = robot.clone().at_frame(FrameId::Named(index));
            for maker in Maker::ALL {
                let arm = Arm::by_no_choice(&at, maker);
                for function in Function::of_frames() {
                    let (found, expected) = (arm.numbers(function, &given), numbers(&expected[function.name()]));
                    assert_eq!(found.len(), expected.len());
                    for (found, expected) in found.iter().zip(expected) {
                        let error = (found - expected).abs() / expected.abs().max(1.0);
                        assert!(
                            error < 1e-12,
                            "{maker}, {function} of {}: {found} {expected}",
                            robot.frames[index].name
                        );
                        compared += 1;
                    }
                }
            }
        }
    }
    println!("{compared} numbers");
    assert!(compared > 10_000, "{compared}");
}

/// By difference quotients of the Jacobian at the frame, which are not the runtime's.
#[test]
fn the_jacobian_of_a_frame_changes_as_its_derivatives_say() {
    const STEP: f64 = 1e-5;
    let mut rng = Rng::with_seed(32);
    let mut compared = 0;
    for seed in 0..40 {
        let robot = robot(&mut rng, seed);
        let array = |rng: &mut Rng| -> Vec<f64> { (0..robot.dof()).map(|_| 4.0 * rng.f64() - 2.0).collect() };
        let (q, qd, zeros) = (array(&mut rng), array(&mut rng), vec![0.0; robot.dof()]);
        for frame in robot.frame_ids().take(4) {
            let at = robot.clone().at_frame(frame);
            for maker in Maker::ALL {
                let arm = Arm::by_no_choice(&at, maker);
                let of = |function, q: &[f64]| arm.numbers(function, &Given::of_joints(q, &qd, &zeros));
                let quotient = |direction: &[f64]| -> Vec<f64> {
                    let [before, after] = [-STEP, STEP].map(|step| {
                        let moved: Vec<f64> = q.iter().zip(direction).map(|(q, along)| q + step * along).collect();
                        of(Function::Jacobian, &moved)
                    });
                    before.iter().zip(&after).map(|(before, after)| (after - before) / (2.0 * STEP)).collect()
                };
                let mut same = |function: Function, found: &[f64], expected: &[f64]| {
                    assert_eq!(found.len(), expected.len());
                    let error = found.iter().zip(expected).fold(0.0, |worst, (a, b)| f64::max(worst, (a - b).abs()));
                    let of = robot.frame_name(frame);
                    assert!(error < 1e-7, "seed {seed}, {maker}, {function} of {of}: {error:e}");
                    compared += found.len();
                };
                same(Function::JacobianRate, &of(Function::JacobianRate, &q), &quotient(&qd));
                let derivatives = of(Function::JacobianDerivatives, &q);
                for joint in 0..robot.dof() {
                    let unit: Vec<f64> = (0..robot.dof()).map(|other| f64::from(u8::from(other == joint))).collect();
                    let found: Vec<f64> = derivatives.iter().skip(joint).step_by(robot.dof()).copied().collect();
                    same(Function::JacobianDerivatives, &found, &quotient(&unit));
                }
            }
        }
    }
    assert!(compared > 10_000, "{compared}");
}

/// How many random arms: with `RNE_EXHAUSTIVE` set, all.
fn tried(all: u64) -> u64 {
    if shipped::is_exhaustive() { all } else { all / 4 }
}

#[test]
fn seven_steps_of_random_arms_are_the_runtime() {
    of_random_arms(Form::SevenSteps, tried(500), 1e-13);
}

#[test]
fn reduced_forms_of_random_arms_are_the_runtime() {
    of_random_arms(Form::Reduced, tried(100), 1e-12);
}

#[test]
fn a_frame_at_the_tip_takes_the_operations_of_the_tip() {
    let text = include_str!("../../robots/puma560.yaml");
    let mut robot = Robot::from_yaml(text).unwrap_or_else(|report| panic!("{report}"));
    let fixed = FixedFrame { on: Some(robot.dof() - 1), placement: robot.tool };
    robot.frames = vec![Frame { name: "flange".to_owned(), fixed }];
    let at = robot.clone().at_frame(robot.frame("flange").expect("there"));
    for form in Form::ALL {
        for function in Function::of_frames() {
            let [tip, frame] = [&robot, &at].map(|robot| Compiler::new(robot).compile(function, form).expect("finite"));
            assert_eq!(frame.operations(), tip.operations(), "{form} {function}");
            assert_eq!(frame.statements, tip.statements, "{form} {function}");
            assert_eq!((tip.name.as_str(), tip.frame.as_deref()), (function.name(), None));
            assert_eq!(frame.frame.as_deref(), Some("flange"));
            assert!(frame.name.ends_with("_of_flange"), "{}", frame.name);
        }
    }
    // what is no function of a frame stays that of the tip
    for function in [Function::InverseDynamicsWithWrench, Function::LinkPoses, Function::MassMatrix] {
        let [tip, frame] =
            [&robot, &at].map(|robot| Compiler::new(robot).compile(function, Form::SevenSteps).expect("finite"));
        assert_eq!(frame, tip, "{function}");
    }
}

#[test]
fn joints_behind_a_frame_cost_nothing() {
    let text = include_str!("../../robots/puma560.yaml");
    let robot = Robot::from_yaml(text).unwrap_or_else(|report| panic!("{report}"));
    let counts = |form| -> Vec<usize> {
        let count = |frame| {
            let at = robot.clone().at_frame(frame);
            Compiler::new(&at).compile(Function::Jacobian, form).expect("finite").operations().total()
        };
        robot.frame_ids().map(count).collect()
    };
    for form in Form::ALL {
        let counts = counts(form);
        assert!(counts.is_sorted() && counts[0] < counts[5] / 4, "{form}: {counts:?}");
    }
}
