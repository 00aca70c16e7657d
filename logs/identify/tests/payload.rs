//! Payloads that another engine computed into logs: what is found is what was put in.

use std::path::{Path, PathBuf};

use fastrand::Rng;
use rne_identify::{MotionError, Options, Payload, PayloadNumber, identify, prediction_errors};
use rne_logs::{Log, Motion};
use rne_model::{Angle, Inertia, Link, Robot};
use rne_runtime::DynArm;

/// The log's own filter, in cut-offs of the low-pass: as `rne identify` reads logs.
const WIDER: f64 = 4.0;

/// Centre of mass of the payloads in the frame of the last link, m.
const COM: [f64; 3] = [0.03, 0.0, 0.06];

fn read(path: &Path) -> Robot {
    let text = std::fs::read_to_string(path).unwrap();
    Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"))
}

fn shipped(name: &str) -> Robot {
    read(&here(&format!("../../robots/{name}.yaml")))
}

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The motion of a log of one run.
fn motion(path: &str, cutoff: f64) -> Motion {
    let options = rne_logs::Options { cutoff: Some(WIDER * cutoff), ..rne_logs::Options::default() };
    let log = Log::open(&[here(path)], options).unwrap();
    let survey = log.survey(|_| ()).unwrap();
    let mut pieces = log.motions(&survey).unwrap().with_length(1 << 20).with_ends();
    pieces.next().unwrap().unwrap().motion
}

/// The first and the second half of a motion.
fn halves(motion: &Motion) -> [Motion; 2] {
    let middle = motion.len() / 2;
    [0..middle, middle..motion.len()].map(|range| {
        let of = |list: &[Vec<f64>]| list.iter().map(|column| column[range.clone()].to_vec()).collect();
        Motion {
            time: motion.time[range.clone()].to_vec(),
            q: of(&motion.q),
            qd: of(&motion.qd),
            qdd: of(&motion.qdd),
            tau: of(&motion.tau),
            recorded: of(&motion.recorded),
        }
    })
}

fn body(mass: f64) -> Link {
    let moment = mass * 0.004;
    let inertia = Inertia { xx: moment, yy: moment, zz: 0.7 * moment, ..Inertia::default() };
    Link { mass, com: COM, inertia, ..Link::default() }
}

/// The motion with the torques that a body at the last link adds, by an engine that the identification does not use.
fn carrying(robot: &Robot, motion: &Motion, body: Link) -> Motion {
    let mut bare = robot.clone();
    for joint in &mut bare.joints {
        joint.row.link = Link::default();
        joint.motor = None;
    }
    bare.joints.last_mut().unwrap().row.link = body;
    let arm = DynArm::from_robot(&bare);
    let mut loaded = motion.clone();
    for at in 0..motion.len() {
        let of = |list: &[Vec<f64>]| -> Vec<f64> { list.iter().map(|column| column[at]).collect() };
        let torques = arm.inverse_dynamics(&of(&motion.q), &of(&motion.qd), &of(&motion.qdd)).unwrap();
        for (joint, torque) in torques.into_iter().enumerate() {
            loaded.tau[joint][at] += torque;
            if let Some(recorded) = loaded.recorded.get_mut(joint) {
                recorded[at] += torque;
            }
        }
    }
    loaded
}

fn fitted(robot: &Robot, motion: &Motion, cutoff: f64) -> Robot {
    let mut options = Options::default();
    options.cutoff = Some(cutoff);
    identify(robot, options, 1.0, |take| -> Result<(), MotionError> { take(motion) }).unwrap().robot
}

fn payload(robot: &Robot, motion: &Motion, cutoff: f64) -> Payload {
    Payload::identify(robot, cutoff, |take| -> Result<(), MotionError> { take(motion) }).unwrap()
}

fn is_within(found: PayloadNumber, truth: f64, deviations: f64) -> bool {
    (found.value - truth).abs() < deviations * found.deviation
}

fn show(about: &str, found: &Payload) {
    let text = |number: &PayloadNumber| {
        format!("{:.4}±{:.4}{}", number.value, number.deviation, if number.is_excited { "" } else { "?" })
    };
    let list = |numbers: &[PayloadNumber]| numbers.iter().map(text).collect::<Vec<_>>().join(" ");
    println!("{about}: {} | {} | {}", text(&found.mass), list(&found.com), list(&found.inertia));
}

/// The mass is within 0.3 kg and inside three deviations, and so is whatever else is called excited.
fn check(about: &str, found: &Payload, body: Link) {
    show(about, found);
    assert!(found.mass.is_excited, "{about}: {found:?}");
    assert!((found.mass.value - body.mass).abs() < 0.3 && is_within(found.mass, body.mass, 3.0), "{about}: {found:?}");
    for (number, truth) in found.com.iter().zip(body.com) {
        assert!(!number.is_excited || is_within(*number, truth, 3.0), "{about}: {found:?}");
    }
    let Inertia { xx, yy, zz, xy, xz, yz } = body.inertia;
    for (number, truth) in found.inertia.iter().zip([xx, yy, zz, xy, xz, yz]) {
        assert!(!number.is_excited || is_within(*number, truth, 3.0), "{about}: {found:?}");
    }
}

#[test]
fn a_payload_on_a_public_log_is_weighed() {
    for (arm, cutoff) in [("ur10", 2.0), ("panda", 2.1)] {
        let geometry = read(&here(&format!("tests/logs/{arm}_log.yaml")));
        let [first, second] = halves(&motion(&format!("tests/logs/{arm}.csv"), cutoff));
        let robot = fitted(&geometry, &first, cutoff);
        let empty = payload(&robot, &second, cutoff);
        show(&format!("{arm} 0 kg"), &empty);
        assert!(is_within(empty.mass, 0.0, 1.0) && !empty.is_there(), "{empty:?}");
        assert!(empty.com.iter().chain(&empty.inertia).all(|number| !number.is_excited), "{empty:?}");
        for mass in [1.0, 2.0, 3.0] {
            let found = payload(&robot, &carrying(&robot, &second, body(mass)), cutoff);
            assert!(found.is_there(), "{found:?}");
            check(&format!("{arm} {mass} kg"), &found, body(mass));
        }
    }
}

/// A file with the payload predicts the log that has it about as well as the file predicts the log without it.
#[test]
fn the_robot_with_its_payload_predicts() {
    let geometry = read(&here("tests/logs/ur10_log.yaml"));
    let [first, second] = halves(&motion("tests/logs/ur10.csv", 2.0));
    let robot = fitted(&geometry, &first, 2.0);
    let loaded = carrying(&robot, &second, body(3.0));
    let found = payload(&robot, &loaded, 2.0);
    let heavier = found.added_to(&robot).unwrap();
    let last = |robot: &Robot| robot.joints.last().unwrap().row.link;
    assert!((last(&heavier).mass - last(&robot).mass - found.mass.value).abs() < 1e-6);
    let text = found.robot_file(&heavier, true, "the log");
    let read = Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"));
    assert!(read.notes.as_deref().unwrap().contains("- payload: 3.0"), "{text}");
    assert_eq!(last(&read), last(&heavier));
    let residuals = |robot: &Robot, motion: &Motion| -> Vec<f64> {
        prediction_errors(robot, [motion], Some(2.0)).unwrap().iter().map(|error| error.residual).collect()
    };
    let (without, with, before) = (residuals(&robot, &loaded), residuals(&read, &loaded), residuals(&robot, &second));
    println!("{without:.3?} {with:.3?} {before:.3?}");
    for joint in 1..4 {
        assert!(with[joint] < 0.5 * without[joint] && with[joint] < 1.1 * before[joint]);
    }
}

#[test]
fn a_payload_of_the_desk_arm_is_weighed() {
    let robot = read(&here("../../docs/desk_arm.yaml"));
    let [first, second] = halves(&motion("../../docs/desk_arm_log.csv", 1.6));
    let robot = fitted(&robot, &first, 1.6);
    let empty = payload(&robot, &second, 1.6);
    assert!(is_within(empty.mass, 0.0, 1.0) && !empty.is_there(), "{empty:?}");
    for mass in [0.3, 1.0, 2.0] {
        check(
            &format!("desk arm {mass} kg"),
            &payload(&robot, &carrying(&robot, &second, body(mass)), 1.6),
            body(mass),
        );
    }
}

fn gaussian(rng: &mut Rng) -> f64 {
    (-2.0 * (1.0 - rng.f64()).ln()).sqrt() * (std::f64::consts::TAU * rng.f64()).cos()
}

/// A motion of sines about a position with the torques of a robot and noise; `size` is in rad and m.
fn made_up(robot: &Robot, about: &[f64], size: f64, noise: f64, rng: &mut Rng) -> Motion {
    let arm = DynArm::from_robot(robot);
    let dof = robot.dof();
    let empty = || vec![Vec::new(); dof];
    let mut motion =
        Motion { time: Vec::new(), q: empty(), qd: empty(), qdd: empty(), tau: empty(), ..Motion::default() };
    for state in 0..1500_u32 {
        let time = 0.02 * f64::from(state);
        let mut now = [vec![0.0; dof], vec![0.0; dof], vec![0.0; dof]];
        for joint in 0..dof {
            let own = f64::from(u32::try_from(joint).unwrap());
            now[0][joint] = about[joint];
            for (part, frequency) in [(1.0, 1.1 + 0.37 * own), (0.4, 2.9 - 0.53 * own)] {
                let phase = frequency * time + own;
                now[0][joint] += size * part * phase.sin();
                now[1][joint] += size * part * frequency * phase.cos();
                now[2][joint] -= size * part * frequency * frequency * phase.sin();
            }
        }
        let torques = arm.inverse_dynamics(&now[0], &now[1], &now[2]).unwrap();
        motion.time.push(time);
        for joint in 0..dof {
            motion.q[joint].push(now[0][joint]);
            motion.qd[joint].push(now[1][joint]);
            motion.qdd[joint].push(now[2][joint]);
            let friction = robot.joints[joint].friction(now[1][joint]);
            motion.tau[joint].push(torques[joint] + friction + noise * gaussian(rng));
        }
    }
    motion
}

/// The last joint slides: mass is felt, the inertia across the waist is, and no other one.
#[test]
fn a_payload_behind_a_sliding_joint_is_weighed() {
    let robot = shipped("cylindrical_rpp");
    let mut rng = Rng::with_seed(28);
    let motion = made_up(&robot, &[0.3, 0.5, 0.5], 0.15, 0.3, &mut rng);
    for mass in [0.0, 1.0, 5.0] {
        let found = payload(&robot, &carrying(&robot, &motion, body(mass)), 2.0);
        check(&format!("cylindrical {mass} kg"), &found, body(mass));
        assert_eq!(found.is_there(), mass > 0.0, "{found:?}");
        // no torque depends on them
        let [xx, _, zz, ..] = found.inertia;
        assert!(!xx.is_excited && !zz.is_excited && !found.com[1].is_excited, "{found:?}");
    }
}

/// Nothing moves: the mass is felt where joints hold it against gravity, and only there.
#[test]
fn a_log_without_motion_has_a_mass_only_by_gravity() {
    let mut rng = Rng::with_seed(28);
    // upright, gravity acts on no joint but the lift
    for (name, about, is_felt) in
        [("cylindrical_rpp", vec![0.3, 0.5, 0.5], true), ("planar3", vec![0.2, 0.4, 0.3], false)]
    {
        let mut robot = shipped(name);
        if !is_felt {
            robot.gravity = [0.0; 3];
        }
        let motion = made_up(&robot, &about, 0.0, 0.3, &mut rng);
        let found = payload(&robot, &carrying(&robot, &motion, body(5.0)), 2.0);
        show(name, &found);
        assert_eq!(found.mass.is_excited, is_felt, "{name}: {found:?}");
        assert_eq!(found.is_there(), is_felt, "{name}: {found:?}");
        assert!(!is_felt || is_within(found.mass, 5.0, 3.0), "{name}: {found:?}");
        assert!(found.com.iter().chain(&found.inertia).all(|number| !number.is_excited), "{name}: {found:?}");
    }
}

/// The tip is turned and away from the last link: numbers and deviations are in tip axes, and the payload as an
/// argument of functions is the one that the robot file has.
#[test]
fn a_payload_is_identified_in_tip_axes() {
    let geometry = read(&here("tests/logs/ur10_log.yaml"));
    let [first, second] = halves(&motion("tests/logs/ur10.csv", 2.0));
    let robot = fitted(&geometry, &first, 2.0);
    let mut tool = robot.tool;
    tool.xyz = [0.05, -0.03, 0.2];
    tool.rpy = [0.4, -0.7, 1.1].map(Angle::new);
    let robot = Robot { tool, ..robot };
    // the same body, in tip axes
    let Link { mass, com, inertia, .. } = body(2.0);
    let held = rne_runtime::Payload { mass, com, inertia };
    let arm = DynArm::from_robot(&robot);
    let mut loaded = second.clone();
    for at in 0..second.len() {
        let of = |list: &[Vec<f64>]| -> Vec<f64> { list.iter().map(|column| column[at]).collect() };
        let (q, qd, qdd) = (of(&second.q), of(&second.qd), of(&second.qdd));
        let with = arm.inverse_dynamics_with_payload(&q, &qd, &qdd, &held).unwrap();
        let without = arm.inverse_dynamics(&q, &qd, &qdd).unwrap();
        for (joint, torque) in with.into_iter().zip(without).map(|(with, without)| with - without).enumerate() {
            loaded.tau[joint][at] += torque;
            if let Some(recorded) = loaded.recorded.get_mut(joint) {
                recorded[at] += torque;
            }
        }
    }
    let found = payload(&robot, &loaded, 2.0);
    check("ur10 2 kg in tip axes", &found, body(2.0));
    assert!(found.com.iter().all(|number| number.is_excited), "{found:?}");
    let added = DynArm::from_robot(&found.added_to(&robot).expect("a mass"));
    let mut random = Rng::with_seed(57);
    for _ in 0..20 {
        let [q, qd, qdd]: [Vec<f64>; 3] = [(); 3].map(|()| (0..6).map(|_| 4.0 * random.f64() - 2.0).collect());
        let given = arm.inverse_dynamics_with_payload(&q, &qd, &qdd, &found.body()).unwrap();
        let written = added.inverse_dynamics(&q, &qd, &qdd).unwrap();
        let scale = given.iter().fold(0.0, |scale: f64, torque| scale.max(torque.abs()));
        for (given, written) in given.iter().zip(&written) {
            // the link of a file is made a possible body, which moves the ninth digit
            assert!((given - written).abs() < 1e-8 * scale, "{given} {written}");
        }
    }
}
