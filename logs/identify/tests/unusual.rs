//! Logs and options that leave little to identify: what is found is said to be so little, or why nothing is found.

use fastrand::Rng;
use rne_identify::{
    BaseReport, Identification, MotionError, Options, Parameter, Structure, identify, prediction_errors,
};
use rne_logs::Motion;
use rne_model::Robot;
use rne_runtime::DynArm;

/// Two bodies in three dimensions, with gears; at the joints the friction of the file.
fn file() -> String {
    let geared = |text: &str, at_joint: &str, of_motor: &str| {
        assert!(text.contains(at_joint), "{text}");
        text.replace(at_joint, of_motor)
    };
    let first = geared(
        include_str!("two.yaml"),
        "viscous: 1.2, coulomb: [1.5, -1.1]",
        "inertia: 0.0001, gear_ratio: 100, viscous: 0.00012, coulomb: [0.015, -0.011]",
    );
    geared(
        &first,
        "viscous: 0.7, coulomb: [0.6, -0.8]",
        "inertia: 0.00005, gear_ratio: 80, viscous: 0.0001, coulomb: [0.0075, -0.01]",
    )
}

fn arm() -> Robot {
    Robot::from_yaml(&file()).unwrap_or_else(|report| panic!("{report}"))
}

/// States at a rate along sums of sines; torques are the arm's with its rotors and its friction, and answer late.
fn log(robot: &Robot, count: u32, rate: f64, delay: f64) -> Motion {
    let arm = DynArm::from_robot(&robot.clone().with_rotors());
    let mut rng = Rng::with_seed(9);
    let parts: Vec<Vec<(f64, f64, f64)>> = (0..robot.dof())
        .map(|_| (1..=4).map(|k| (0.5 / f64::from(k), 1.1 * f64::from(k) + 0.3 * rng.f64(), 6.3 * rng.f64())).collect())
        .collect();
    let at = |time: f64| -> [Vec<f64>; 3] {
        let sum = |of: fn(f64, f64, f64) -> f64| -> Vec<f64> {
            let of_joint = |parts: &Vec<(f64, f64, f64)>| parts.iter().map(|&(a, w, p)| a * of(w, time, p)).sum();
            parts.iter().map(of_joint).collect()
        };
        [
            sum(|w, time, p| (w * time + p).sin()),
            sum(|w, time, p| w * (w * time + p).cos()),
            sum(|w, time, p| -w * w * (w * time + p).sin()),
        ]
    };
    let mut motion = Motion::default();
    for list in [&mut motion.q, &mut motion.qd, &mut motion.qdd, &mut motion.tau] {
        *list = vec![Vec::new(); robot.dof()];
    }
    for state in 0..count {
        let time = f64::from(state) / rate;
        let [q, qd, qdd] = at(time);
        let before = at(time - delay);
        let tau = arm.inverse_dynamics(&before[0], &before[1], &before[2]).unwrap();
        motion.time.push(time);
        for (joint, of) in robot.joints.iter().enumerate() {
            motion.q[joint].push(q[joint]);
            motion.qd[joint].push(qd[joint]);
            motion.qdd[joint].push(qdd[joint]);
            motion.tau[joint].push(tau[joint] + of.friction(before[1][joint]));
        }
    }
    motion
}

fn options() -> Options {
    let mut options = Options::default();
    options.widths = vec![0.025, 0.05];
    options.displacements = Vec::new();
    options
}

fn found(robot: &Robot, options: Options, motion: &Motion) -> Result<Identification, MotionError> {
    identify(robot, options, 1e-3, |take| take(motion))
}

#[test]
fn what_tells_nothing_is_refused() {
    let robot = arm();
    let mut motion = log(&robot, 2000, 200.0, 0.0);
    let short = log(&robot, 200, 200.0, 0.0);
    let refused = found(&robot, options(), &short).unwrap_err();
    assert!(matches!(refused, MotionError::TooFew { needed: 21, .. }), "{refused}");
    for scale in [0.0, 1e-200, 1e-20] {
        motion.tau.iter_mut().flatten().for_each(|tau| *tau *= scale);
        assert!(matches!(found(&robot, options(), &motion), Err(MotionError::NoEfforts)), "{scale}");
    }
    // one joint that is not measured does not make others infinite
    let mut motion = log(&robot, 2000, 200.0, 0.0);
    motion.tau[1].fill(0.0);
    let found = found(&robot, options(), &motion).unwrap();
    assert!(found.bases.iter().all(|base| base.value.is_finite() && base.deviation.is_finite()));
    Robot::from_yaml(&found.robot_file("a made-up log")).unwrap_or_else(|report| panic!("{report}"));
}

/// An arm that stands still tells nothing, with noise and without; and its friction is no guess.
#[test]
fn an_arm_that_stands_still_excites_nothing() {
    let robot = arm();
    let moving = log(&robot, 3000, 200.0, 0.0);
    let mut rng = Rng::with_seed(2);
    for noise in [0.0, 0.02] {
        let mut motion = moving.clone();
        for joint in 0..2 {
            let torque = motion.tau[joint][7];
            motion.q[joint].fill(0.3);
            motion.qd[joint].fill(0.0);
            motion.qdd[joint].fill(0.0);
            motion.tau[joint].iter_mut().for_each(|tau| *tau = torque + noise * (rng.f64() - 0.5));
        }
        let found = found(&robot, options(), &motion).unwrap();
        assert!(!found.is_anything_excited(), "{noise}: {:?} {:?}", found.bases, found.joints);
        for (joint, of_file) in found.robot.joints.iter().zip(&robot.joints) {
            assert_eq!(joint.motor, of_file.motor);
        }
        // a column without a number in it is as unknown as before
        for base in &found.bases {
            assert!(base.deviation > 0.0, "{base:?}");
        }
    }
    let moved = found(&robot, options(), &moving).unwrap();
    assert!(moved.is_anything_excited() && moved.joints.iter().all(rne_identify::JointReport::is_friction_excited));
}

/// Efforts of a joint that are zeros, or the noise of no sensor, say nothing of it, and nothing false of the others.
#[test]
fn a_dead_channel_is_of_no_account() {
    let robot = arm();
    let mut rng = Rng::with_seed(4);
    for noise in [0.0, 1e-9] {
        let mut motion = log(&robot, 6000, 200.0, 0.0);
        motion.tau[0].iter_mut().for_each(|tau| *tau += 0.02 * (rng.f64() - 0.5));
        motion.tau[1].iter_mut().for_each(|tau| *tau = noise * (rng.f64() - 0.5));
        let found = found(&robot, options(), &motion).unwrap();
        assert!(found.joints[0].is_excited() && !found.joints[1].is_excited(), "{:?}", found.joints);
        assert!(found.joints[0].error.error < 0.01, "{:?}", found.joints[0].error);
        let truth = [1.2, 1.5, 1.1];
        for ((value, deviation), truth) in found.joints[0].friction.unwrap().into_iter().zip(truth) {
            assert!((value - truth).abs() < 5.0 * deviation && deviation < 0.1, "{value} ± {deviation}, {truth}");
        }
        assert!(!found.joints[1].is_friction_excited());
        assert_eq!(found.robot.joints[1].motor, robot.joints[1].motor);
        let parameters = found.structure.parameters();
        let truth = &parameters.regrouping * parameters.of_robot(&robot);
        for (base, truth) in found.bases.iter().zip(truth.iter()).filter(|(base, _)| base.is_excited()) {
            assert!((base.value - truth).abs() < 5.0 * base.deviation + 1e-6, "{noise} {base:?} {truth}");
        }
        let text = found.robot_file("a log");
        assert!(text.contains("joint not excited: its effort changes only by noise"), "{text}");
    }
}

/// What no model of the arm explains is said to be so, and what a robot file cannot hold is not passed over.
#[test]
fn wrong_signs_and_large_offsets_are_found() {
    let robot = arm();
    let right = log(&robot, 6000, 200.0, 0.0);
    let of_right = found(&robot, options(), &right).unwrap();
    assert!(of_right.joints.iter().all(|joint| !joint.is_unexplained() && joint.offset.is_none()));
    let mut wrong = right.clone();
    wrong.tau[0].iter_mut().for_each(|tau| *tau = -*tau);
    let of_wrong = found(&robot, options(), &wrong).unwrap();
    assert!(of_wrong.joints[0].is_unexplained() && !of_wrong.joints[0].is_excited());
    assert!(!of_wrong.joints[1].is_unexplained());
    assert!(of_wrong.robot_file("a log").contains("joint not excited: no model explains 1"));
    // Coulomb friction is 1.3, its offset 0.2
    for (more, said) in [(0.5, None), (-1.3, None), (2.0, Some(2.2)), (-3.0, Some(-2.8))] {
        let mut motion = right.clone();
        motion.tau[0].iter_mut().for_each(|tau| *tau += more);
        let found = found(&robot, options(), &motion).unwrap();
        let offset = found.joints[0].offset;
        // links and Coulomb friction are those of the arm, whatever a file can hold
        assert!(found.joints[0].is_excited() && found.bases.iter().all(BaseReport::is_excited));
        for (base, of_right) in found.bases.iter().zip(&of_right.bases) {
            assert!((base.written - of_right.written).abs() < 1e-3, "{more}: {base:?} {of_right:?}");
        }
        let [(viscous, _), (forward, _), (backward, _)] = found.joints[0].friction.unwrap();
        assert!((viscous - 1.2).abs() < 0.01 && (0.5 * (forward + backward) - 1.3).abs() < 0.01);
        assert_eq!(offset.is_some(), said.is_some(), "{more}: {offset:?}");
        if let (Some((offset, coulomb)), Some(said)) = (offset, said) {
            assert!((offset - said).abs() < 0.02 && (coulomb - 1.3).abs() < 0.02, "{offset} {coulomb}");
        }
    }
}

/// A rotor of a joint that slides is as a mass.
#[test]
fn units_are_those_of_the_joint() {
    let slides = Robot::from_yaml(&file().replacen("revolute", "prismatic", 1));
    let slides = slides.unwrap_or_else(|report| panic!("{report}"));
    for (robot, units) in [(arm(), ["kg m²", "kg m²"]), (slides, ["kg", "kg m²"])] {
        let structure = Structure::new(&robot, options());
        for (joint, unit) in units.into_iter().enumerate() {
            assert_eq!(structure.unit(Parameter::Rotor(joint)), unit);
        }
        assert_eq!(structure.unit(Parameter::Link(0, 9)), "kg m²");
    }
}

/// Without friction the arm has none, whatever its file says: neither in what is written nor in what is predicted.
#[test]
fn without_friction_the_arm_has_none() {
    let robot = arm();
    let mut smooth = robot.clone();
    for joint in &mut smooth.joints {
        let motor = joint.motor.as_mut().unwrap();
        (motor.viscous, motor.coulomb) = (0.0, [0.0; 2]);
    }
    let motion = log(&smooth, 4000, 200.0, 0.0);
    let mut without = options();
    without.friction = false;
    without.delay = false;
    let found = found(&robot, without, &motion).unwrap();
    for (joint, of_file) in found.robot.joints.iter().zip(&robot.joints) {
        let (motor, of_file) = (joint.motor.unwrap(), of_file.motor.unwrap());
        assert_eq!((motor.viscous, motor.coulomb, joint.coulomb_width), (0.0, [0.0; 2], None));
        assert_eq!((motor.inertia, motor.gear_ratio), (of_file.inertia, of_file.gear_ratio));
    }
    for joint in &found.joints {
        assert!(joint.error.unfiltered < 1e-3, "{:?}", joint.error);
    }
}

/// Rotors of the file that nobody asked for are known: links do not take their torque over, which the file has already.
#[test]
fn rotors_of_the_file_are_no_links() {
    let robot = arm();
    let motion = log(&robot, 4000, 200.0, 0.0);
    for cutoff in [Some(2.0), None] {
        let mut options = options();
        options.cutoff = cutoff;
        options.delay = false;
        let found = found(&robot, options, &motion).unwrap();
        let parameters = found.structure.parameters();
        let truth = &parameters.regrouping * parameters.of_robot(&robot);
        for (base, truth) in found.bases.iter().zip(truth.iter()) {
            assert!((base.value - truth).abs() < 1e-6, "{cutoff:?} {}: {} {truth}", base.name, base.value);
        }
        for error in prediction_errors(&found.robot, [&motion], Some(2.0)).unwrap() {
            assert!(error.unfiltered < 1e-3, "{cutoff:?} {error:?}");
        }
    }
}

/// Without a filter rows are states, and torques that answer late are taken late: of several windows each at its place.
#[test]
fn a_delay_is_found_without_a_filter() {
    let robot = arm();
    let delay = 0.0123;
    let motion = log(&robot, 6000, 400.0, delay);
    let mut options = options();
    options.cutoff = None;
    let found = found(&robot, options, &motion).unwrap();
    let (lag, _) = found.delay.unwrap();
    assert!((lag - delay).abs() < 2e-5, "{lag}");
    let parameters = found.structure.parameters();
    let truth = &parameters.regrouping * parameters.of_robot(&robot);
    for (base, truth) in found.bases.iter().zip(truth.iter()) {
        assert!((base.value - truth).abs() < 2e-3, "{}: {} {truth}", base.name, base.value);
    }
}

/// A low-pass that is narrower than the step makes no more rows than there are states.
#[test]
fn rows_are_no_denser_than_states() {
    let robot = arm();
    let motion = log(&robot, 2000, 200.0, 0.0);
    for cutoff in [60.0, 1e5, 1e12] {
        let mut options = options();
        options.cutoff = Some(cutoff);
        options.delay = false;
        let found = found(&robot, options, &motion).unwrap();
        assert!((1980..=2000).contains(&found.rows), "{cutoff}: {}", found.rows);
        assert!(found.joints.iter().all(|joint| joint.error.error < 1e-3), "{cutoff}");
    }
}
