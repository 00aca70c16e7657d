//! Offsets of friction that gravity hides, and those that it does not.

use fastrand::Rng;
use rne_identify::{FrictionExcitation, Identification, MotionError, Options, identify, prediction_errors};
use rne_logs::Motion;
use rne_model::Robot;
use rne_runtime::DynArm;

/// Viscous friction 0.8 and Coulomb friction 2 at both joints; the axis of the first is horizontal.
fn arm(asymmetry: f64) -> Robot {
    let mut robot = Robot::from_yaml(include_str!("two.yaml")).unwrap_or_else(|report| panic!("{report}"));
    for joint in &mut robot.joints {
        let motor = joint.motor.as_mut().unwrap();
        (motor.gear_ratio, motor.viscous) = (1.0, 0.8);
        motor.coulomb = [2.0 * (1.0 + asymmetry), -2.0 * (1.0 - asymmetry)];
        (joint.coulomb_width, joint.coulomb_displacement) = (Some(0.025), None);
    }
    robot
}

/// Friction that a robot file has before.
fn without_friction(robot: &Robot) -> Robot {
    let mut bare = robot.clone();
    for joint in &mut bare.joints {
        (joint.motor, joint.coulomb_width) = (None, None);
    }
    bare
}

/// 20 s of both joints about some angles, with noise of 0.6 N m. The first link is
/// upright, so gravity is as small as friction.
fn log(robot: &Robot, amplitude: f64, seed: u64) -> Motion {
    let arm = DynArm::from_robot(robot);
    let mut rng = Rng::with_seed(seed);
    let mut motion = Motion::default();
    let empty = || vec![Vec::new(); 2];
    (motion.q, motion.qd, motion.qdd, motion.tau) = (empty(), empty(), empty(), empty());
    for k in 0..4000 {
        let time = f64::from(k) / 200.0;
        let (mut q, mut qd, mut qdd) = ([1.5, 0.3], [0.0; 2], [0.0; 2]);
        for joint in 0..2 {
            for (part, rate) in [(1.0, 1.9), (0.5, 3.1), (0.25, 4.3)] {
                let (a, w) = (amplitude * part, if joint == 0 { rate } else { 1.17 * rate });
                let (sin, cos) = (w * time).sin_cos();
                q[joint] += a * sin;
                qd[joint] += a * w * cos;
                qdd[joint] -= a * w * w * sin;
            }
        }
        let tau = arm.inverse_dynamics(&q, &qd, &qdd).unwrap();
        motion.time.push(time);
        for joint in 0..2 {
            motion.q[joint].push(q[joint]);
            motion.qd[joint].push(qd[joint]);
            motion.qdd[joint].push(qdd[joint]);
            let noise = 2.0 * (rng.f64() - 0.5);
            motion.tau[joint].push(tau[joint] + robot.joints[joint].friction(qd[joint]) + noise);
        }
    }
    motion
}

fn found(file: &Robot, motion: &Motion) -> Identification {
    identify(file, Options::default(), 1.0, |take| -> Result<(), MotionError> { take(motion) }).unwrap()
}

fn error(robot: &Robot, motion: &Motion, joint: usize) -> f64 {
    prediction_errors(robot, [motion], Some(2.0)).unwrap()[joint].error
}

/// A joint that moves by a few degrees: the offset may be anything, Coulomb friction may not.
#[test]
fn an_offset_that_gravity_hides_does_not_take_coulomb_friction_along() {
    let robot = arm(0.0);
    let (motion, other) = (log(&robot, 0.04, 1), log(&robot, 0.04, 2));
    let found = found(&without_friction(&robot), &motion);
    let hidden = &found.joints[0];
    assert_eq!(hidden.friction_excitation, FrictionExcitation::WithoutOffset, "{hidden:?}");
    let [_, forward, backward] = hidden.friction.unwrap();
    assert!(forward.0 == backward.0 && (forward.0 - 2.0).abs() < 5.0 * forward.1 && forward.1 < 0.4, "{hidden:?}");
    let [plus, minus] = found.robot.joints[0].motor.unwrap().coulomb;
    assert!(plus == -minus && plus > 0.0);
    assert!(hidden.error.error < 0.1 && error(&found.robot, &other, 0) < 0.1, "{hidden:?}");
}

/// The ratio of both directions that a file has stays where the log does not tell it.
#[test]
fn a_ratio_of_the_file_stays() {
    let robot = arm(0.25);
    let motion = log(&robot, 0.04, 3);
    let found = found(&robot, &motion);
    assert!(found.joints[0].is_offset_unknown());
    let [plus, minus] = found.robot.joints[0].motor.unwrap().coulomb;
    assert!((plus / -minus - 1.25 / 0.75).abs() < 1e-6 && (plus - 2.5).abs() < 0.5, "{plus} {minus}");
    assert!(found.joints[0].error.error < 0.1);
}

/// An asymmetry that the log tells is no guess: whatever the file has, it is what the log tells.
#[test]
fn an_asymmetry_that_is_told_stays() {
    let robot = arm(0.25);
    let found = found(&without_friction(&robot), &log(&robot, 0.8, 4));
    for joint in &found.joints {
        assert_eq!(joint.friction_excitation, FrictionExcitation::Full);
        let [_, forward, backward] = joint.friction.unwrap();
        assert!((forward.0 - 2.5).abs() < 0.1 && (backward.0 - 1.5).abs() < 0.1, "{joint:?}");
    }
}
