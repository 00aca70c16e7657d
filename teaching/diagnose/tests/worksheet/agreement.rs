//! Every line is that of the recursion, and of positions that are differentiated.

use std::f64::consts::FRAC_PI_2;

use rne_diagnose::worksheet::{Axes, Comparison, GivenValue, Quantity, Situation, Worksheet};
use rne_model::Robot;
use rne_runtime::{BaseMotion, Payload};

use crate::lecture::*;

#[test]
fn every_line_is_the_recursion_in_base_axes() {
    let two = ["standard", "modified"].map(|convention| without_mass(six(convention)));
    let bodies = [six("standard"), six("modified"), shipped("stanford"), shipped("puma560"), shipped("puma560_mdh")];
    for robot in bodies.into_iter().chain(two) {
        let still = state(robot.dof());
        let pushed = Situation { wrench: Some(WRENCH), ..still.clone() };
        let base = BaseMotion {
            omega: [0.2, -0.1, 0.3],
            omega_dot: [0.5, 0.4, -0.6],
            velocity: [0.1, 0.2, -0.3],
            acceleration: [0.7, -0.2, 0.1],
            gravity: [1.0, 2.0, -9.0],
        };
        let moving = Situation { base: Some(base), ..pushed.clone() };
        for at in [still, pushed, moving] {
            let links = recursion(&robot, &at, |x| x);
            for axes in ALL_AXES {
                let sheet = Worksheet::new(&robot, &at, axes).unwrap();
                let lines = if axes == Axes::Base { 23 } else { 22 };
                assert_eq!(sheet.lines.len(), lines * robot.dof());
                for line in &sheet.lines {
                    let what = format!("{} {axes:?} {}", robot.name, line.symbol());
                    let expected = expected(&links, &robot, &at, axes, line.joint, line.quantity);
                    close(&line.values, &expected, &what);
                }
            }
        }
    }
}

/// Steps 3 and 4 are the derivatives of where the centres of mass are, which no recursion of velocities knows.
#[test]
fn velocities_and_accelerations_are_derivatives_of_positions() {
    for robot in [six("standard"), six("modified")] {
        let at = state(6);
        let sheet = Worksheet::new(&robot, &at, Axes::Base).unwrap();
        let h = 1e-4;
        let at_time = |t: f64| {
            let moved = at.q.iter().zip(&at.qd).zip(&at.qdd).map(|((q, qd), qdd)| q + qd * t + qdd * t * t / 2.0);
            placed(&robot, &moved.collect::<Vec<_>>()).centres
        };
        let (before, now, after) = (at_time(-h), at_time(0.0), at_time(h));
        for joint in 1..=6 {
            let i = joint - 1;
            let velocity = times(0.5 / h, sub(after[i], before[i]));
            let acceleration = times(1.0 / (h * h), add(sub(after[i], now[i]), sub(before[i], now[i])));
            for (quantity, expected) in [(Quantity::Velocity, velocity), (Quantity::Acceleration, acceleration)] {
                let found = &sheet.line(joint, quantity).unwrap().values;
                let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(off < 1e-6, "{joint} {quantity}: {found:?} {expected:?}");
            }
        }
    }
}

/// The numbers of the lecture's example, section 5.1 of the specification.
#[test]
#[allow(clippy::excessive_precision)] // as they stand there
fn the_lectures_one_link() {
    let text = "{format: 1, name: rod, source: the lecture, convention: standard, gravity: [9.81, 0, 0], joints: \
        [{type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0], inertia: \
        {yy: 2.5*0.64/12, zz: 2.5*0.64/12}}}]}";
    let robot = Robot::from_yaml(text).unwrap();
    let at = Situation { q: vec![0.6], qd: vec![1.3], qdd: vec![-0.7], ..state(1) };
    for axes in [Axes::Joint, Axes::Base] {
        let sheet = Worksheet::new(&robot, &at, axes).unwrap();
        for (quantity, numbers) in [
            (Quantity::Velocity, vec![-0.293_614_086_165_418_39, 0.429_174_519_753_032_71, 0.0]),
            (Quantity::Acceleration, vec![-0.399_826_983_128_332_63, -0.612_792_284_189_753_82, 0.0]),
            (Quantity::InertiaForce, vec![-0.999_567_457_820_831_57, -1.531_980_710_474_384_6, 0.0]),
            (Quantity::InertiaMoment, vec![0.0, 0.0, -0.093_333_333_333_333_333]),
            (Quantity::JointForce, vec![-25.524_567_457_820_832, -1.531_980_710_474_384_6, 0.0]),
            (Quantity::JointMoment, vec![0.0, 0.0, 5.165_809_330_671_963_5]),
            (Quantity::Tau, vec![5.165_809_330_671_963_5]),
        ] {
            close(&sheet.line(1, quantity).unwrap().values, &numbers, quantity.name());
        }
    }
    let sheet = Worksheet::new(&robot, &at, Axes::Link).unwrap();
    close(&sheet.line(1, Quantity::Acceleration).unwrap().values, &[-0.676, -0.28, 0.0], "c̈ in link axes");
}

/// A line is the sum of its terms, or there are none.
#[test]
fn terms_add_up() {
    let robots = shipped::tried().map(|file| Robot::from_yaml(file.yaml).unwrap());
    for robot in robots.chain([without_mass(six("standard"))]) {
        for rotors in [false, true] {
            let robot = Robot { rotors, ..robot.clone() };
            let payload = Payload { mass: 2.0, com: [0.1, 0.2, -0.3], ..Payload::none() };
            let at = state(robot.dof());
            for at in [Situation { payload: Some(payload), ..at.clone() }, Situation { wrench: Some(WRENCH), ..at }] {
                for sheet in ALL_AXES.map(|axes| Worksheet::new(&robot, &at, axes).unwrap()) {
                    for line in sheet.lines.iter().filter(|line| !line.terms.is_empty()) {
                        let what = format!("{} {:?} {}", robot.name, sheet.axes, line.symbol());
                        for (component, value) in line.values.iter().enumerate() {
                            let sum: f64 = line.terms.iter().map(|term| term.values[component]).sum();
                            assert!((sum - value).abs() <= 1e-12 * line.size().max(1.0), "{what}: {sum} {value}");
                        }
                        // a formula names its terms' letters
                        assert!(!line.formula.is_empty(), "{what}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_worksheet_agrees_with_itself() {
    for robot in [six("standard"), shipped("stanford"), shipped("panda")] {
        let at = state(robot.dof());
        for sheet in ALL_AXES.map(|axes| Worksheet::new(&robot, &at, axes).unwrap()) {
            let given = all_values(&sheet);
            let Comparison { compared, differing, steps_not_given, first, .. } =
                sheet.compare(&robot, &at, &given, 15).unwrap();
            assert_eq!((compared, differing, steps_not_given, first), (given.len(), 0, vec![], None));
            let part: Vec<GivenValue> =
                given.into_iter().filter(|value| [1, 4, 7].contains(&value.quantity.step())).collect();
            let found = sheet.compare(&robot, &at, &part, 4).unwrap();
            assert_eq!((found.first, found.steps_not_given), (None, vec![2, 3, 5, 6]));
        }
    }
}

/// A hand that rounds every vector to four digits is right, to three it is not when four are asked for.
#[test]
fn a_hand_that_rounds_is_right() {
    for robot in [six("standard"), six("modified"), shipped("stanford"), shipped("puma560"), shipped("planar2")] {
        for shift in [0.0, 0.4, 1.3, FRAC_PI_2] {
            let mut at = state(robot.dof());
            at.q.iter_mut().for_each(|q| *q += shift);
            let sheet = Worksheet::new(&robot, &at, Axes::Base).unwrap();
            let by_hand = |count: usize| {
                let links = recursion(&robot, &at, |x| digits(x, count));
                let mut given = all_values(&sheet);
                for value in given.iter_mut().filter(|value| value.quantity.step() > 0) {
                    let line = expected(&links, &robot, &at, Axes::Base, value.joint, value.quantity);
                    value.value = digits(line[value.component], count);
                }
                sheet.compare(&robot, &at, &given, 4).unwrap()
            };
            let four = by_hand(4);
            assert_eq!(four.first, None, "{} {shift}", robot.name);
            assert!(by_hand(2).first.is_some(), "{} {shift}", robot.name);
        }
    }
}

/// Few digits are no mistake where they are rounded rightly, and no excuse for a term that is missing.
#[test]
fn written_digits_count() {
    let robot = shipped("planar2");
    let at = Situation { q: vec![0.6, -1.1], qd: vec![1.3, -0.4], qdd: vec![-0.7, 2.1], ..state(2) };
    let sheet = Worksheet::new(&robot, &at, Axes::Link).unwrap();
    let given = |value: f64, resolution: f64| {
        let given = GivenValue { joint: 2, quantity: Quantity::Acceleration, component: 0, value, resolution };
        sheet.compare(&robot, &at, &[given], 4).unwrap().first.is_none()
    };
    // c̈2 x is -0.233366
    assert!(given(-0.23, 0.005) && given(-0.2, 0.05) && given(-0.233, 0.0005));
    assert!(!given(-0.24, 0.005) && !given(-0.2, 0.0) && !given(0.0, 0.5));
}
