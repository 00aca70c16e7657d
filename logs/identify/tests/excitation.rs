//! Motions that excite an arm: within its limits everywhere, from rest to rest, as well conditioned as they say, and
//! such that an identification finds the arm by a log of them.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use fastrand::Rng;
use nalgebra::DMatrix;
use rne_identify::{
    AskedLimits, Excitation, ExcitationError, ExcitationOptions, Fourier, MotionLimits, Options, excite, identify,
};
use rne_logs::Motion;
use rne_model::Robot;
use rne_runtime::DynArm;

fn shipped(name: &str) -> Robot {
    let file = rne_robots::find(name).unwrap();
    Robot::from_yaml(file.yaml).unwrap_or_else(|report| panic!("{report}"))
}

fn robot(yaml: &str) -> Robot {
    Robot::from_yaml(yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}"))
}

fn desk_arm() -> Robot {
    robot(include_str!("../../../docs/desk_arm.yaml"))
}

fn options(evaluations: u64) -> ExcitationOptions {
    let mut options = ExcitationOptions::default();
    options.evaluations = evaluations;
    options
}

fn found(robot: &Robot, options: &ExcitationOptions) -> Excitation {
    let limits = MotionLimits::of(robot, &AskedLimits::default()).unwrap();
    excite(robot, &limits, options, &mut |_| true).unwrap_or_else(|error| panic!("{error}"))
}

/// The series as the paper writes it, and not by the code that is tested: q, q̇, q̈ of a joint.
fn series(motion: &Fourier, joint: usize, time: f64) -> [f64; 3] {
    let series = &motion.joints()[joint];
    let mut state = [series.centre, 0.0, 0.0];
    for (k, (a, b)) in (1..).zip(series.a.iter().zip(&series.b)) {
        let omega = f64::from(k) * TAU / motion.period();
        let (sin, cos) = (omega * time).sin_cos();
        state[0] += a / omega * sin - b / omega * cos;
        state[1] += a * cos + b * sin;
        state[2] += -a * omega * sin + b * omega * cos;
    }
    state
}

fn state(motion: &Fourier, time: f64) -> [Vec<f64>; 3] {
    let each: Vec<[f64; 3]> = (0..motion.joints().len()).map(|joint| series(motion, joint, time)).collect();
    [0, 1, 2].map(|derivative| each.iter().map(|state| state[derivative]).collect())
}

/// By the runtime's regressor and its own base parameters: all rows at once, divided by effort limits where every joint
/// has one.
fn rows(robot: &Robot, motion: &Fourier, instants: usize, with_friction: bool) -> DMatrix<f64> {
    let arm = DynArm::from_robot(robot);
    let bases = arm.base_parameters();
    let (dof, rank) = (robot.dof(), bases.rank());
    let efforts: Option<Vec<f64>> = robot.joints.iter().map(|joint| joint.limits.effort).collect();
    let mut rows = DMatrix::zeros(instants * dof, rank + if with_friction { 3 * dof } else { 0 });
    for instant in 0..instants {
        let part = f64::from(u32::try_from(instant).unwrap()) / f64::from(u32::try_from(instants).unwrap());
        let [q, qd, qdd] = state(motion, motion.period() * part);
        for (joint, torque) in bases.regressor(&arm, &q, &qd, &qdd).unwrap().into_iter().enumerate() {
            let row = instant * dof + joint;
            for (column, element) in torque.into_iter().enumerate() {
                rows[(row, column)] = element;
            }
            if with_friction {
                // the smooth sign as docs/control/identify.md has it
                let sign = qd[joint] / (qd[joint] * qd[joint] + 0.025 * 0.025).sqrt();
                for (column, element) in [qd[joint], sign, 1.0].into_iter().enumerate() {
                    rows[(row, rank + 3 * joint + column)] = element;
                }
            }
            if let Some(efforts) = &efforts {
                rows.row_mut(row).scale_mut(1.0 / efforts[joint]);
            }
        }
    }
    rows
}

fn condition(robot: &Robot, motion: &Fourier, instants: usize, with_friction: bool) -> f64 {
    let mut rows = rows(robot, motion, instants, with_friction);
    for mut column in rows.column_iter_mut() {
        column.normalize_mut();
    }
    let values = rows.singular_values();
    values.max() / values.min()
}

#[test]
fn the_condition_is_that_of_the_runtimes_regressor() {
    for (name, with_friction) in [("planar2", true), ("stanford", false), ("puma560", true)] {
        let robot = shipped(name);
        let mut options = options(60);
        options.friction = with_friction;
        let found = found(&robot, &options);
        let other = condition(&robot, &found.motion, found.instants, with_friction);
        assert!((found.condition - other).abs() < 1e-6 * other, "{name}: {} {other}", found.condition);
        // nor does it depend on which instants are taken
        let denser = condition(&robot, &found.motion, 7 * found.instants + 3, with_friction);
        assert!((denser / other - 1.0).abs() < 0.2, "{name}: {other} {denser}");
        assert!(found.condition < 0.7 * found.first_condition, "{name}: {} {}", found.first_condition, found.condition);
    }
    let arm = desk_arm();
    let found = found(&arm, &options(100));
    let other = condition(&arm, &found.motion, found.instants, true);
    assert!((found.condition - other).abs() < 1e-6 * other, "{} {other}", found.condition);
    // deviations are those of least squares with noise of a hundredth of the limits; what is known before hardly counts
    let rows = rows(&arm, &found.motion, found.instants, true) * 100.0;
    let covariance = (rows.tr_mul(&rows)).try_inverse().unwrap();
    for (at, base) in found.bases.iter().enumerate() {
        let deviation = covariance[(at, at)].sqrt();
        let off = (base.deviation - deviation).abs();
        assert!(off < 0.01 * deviation, "{} {} {deviation}", base.name, base.deviation);
    }
}

/// A chain of joints of both kinds, with limits of every kind, masses and friction.
fn random_arm(rng: &mut Rng) -> (String, Robot) {
    let dof = rng.usize(1..=5);
    let mut text = format!(
        "format: 1\nname: arm\nsource: random\nconvention: {}\ngravity: [0, 0, -9.81]\njoints:\n",
        if rng.bool() { "standard" } else { "modified" }
    );
    for _ in 0..dof {
        let slides = rng.u8(0..3) == 0;
        let angles = ["0", "pi/2", "-pi/2", "0.7"];
        let mut number = |from: f64, to: f64| from + (to - from) * rng.f64();
        let (d, a, mass, com) = (number(0.0, 0.4), number(0.1, 0.5), number(0.5, 6.0), number(-0.2, 0.2));
        let (lower, width) = (number(-2.0, 1.0), number(0.1, 3.0));
        let velocity = if number(0.0, 1.0) < 0.5 { format!(", velocity: {}", number(0.3, 4.0)) } else { String::new() };
        let effort = if number(0.0, 1.0) < 0.3 { format!(", effort: {}", number(150.0, 600.0)) } else { String::new() };
        let position = format!("position: [{lower}, {}]", lower + width);
        let has_limits = slides || number(0.0, 1.0) < 0.8;
        let limits = if has_limits { format!("limits: {{{position}{velocity}{effort}}}") } else { String::new() };
        let motor = format!(
            "motor: {{inertia: {}, gear_ratio: 50, viscous: {}, coulomb: [0.01, -0.02]}}",
            number(1e-5, 1e-4),
            number(0.0, 1e-3)
        );
        let alpha = angles[rng.usize(..angles.len())];
        let _ = write!(
            text,
            "  - type: {}\n    dh: {{theta: 0.3, d: {d}, a: {a}, alpha: {alpha}}}\n    link: {{mass: {mass}, com: \
             [{com}, 0.02, 0.05], inertia: {{xx: 0.05, yy: 0.06, zz: 0.07}}}}\n    {motor}\n    {limits}\n",
            if slides { "prismatic" } else { "revolute" },
        );
    }
    let robot = robot(&text);
    (text, robot)
}

#[test]
fn limits_hold_everywhere_and_motions_start_and_end_at_rest() {
    let mut rng = Rng::with_seed(20);
    let mut limited = 0;
    for trial in 0..40 {
        let (text, robot) = random_arm(&mut rng);
        let limits = MotionLimits::of(&robot, &AskedLimits::default()).unwrap();
        let mut options = options(30);
        options.seed = trial;
        options.harmonics = rng.usize(2..=6);
        options.period = 0.5 + 20.0 * rng.f64();
        options.rotors = rng.bool();
        let found = match excite(&robot, &limits, &options, &mut |_| true) {
            Ok(found) => found,
            // gravity alone is beyond the limits of some
            Err(ExcitationError::Effort { needed, limit, .. }) if needed > limit => continue,
            Err(error) => panic!("{error}\n{text}"),
        };
        let motion = &found.motion;
        let [first, last] = [0.0, motion.period()].map(|time| state(motion, time));
        for joint in 0..robot.dof() {
            for end in [&first, &last] {
                let scale = limits[joint].acceleration * 1e-12;
                assert!(end[1][joint].abs() < scale.max(1e-12) && end[2][joint].abs() < 100.0 * scale, "{end:?}");
            }
            assert!((first[0][joint] - found.joints[joint].start).abs() < 1e-12);
        }
        let arm = DynArm::from_robot(&robot).with_rotors();
        // fifty times the 64 points per harmonic, of torques fewer
        let points = u32::try_from(50 * 64 * options.harmonics).unwrap();
        for point in 0..points {
            let now = state(motion, motion.period() * (f64::from(point) + 0.5) / f64::from(points));
            for (joint, limits) in limits.iter().enumerate() {
                let [q, qd, qdd] = [0, 1, 2].map(|derivative: usize| now[derivative][joint]);
                let bounds = found.joints[joint].bounds;
                assert!(limits.position.0 <= q && q <= limits.position.1, "{q} of {limits:?}\n{text}");
                assert!(qd.abs() <= limits.velocity && qdd.abs() <= limits.acceleration, "{qd} {qdd} {limits:?}");
                assert!(bounds.lower <= q && q <= bounds.upper, "{q} {bounds:?}");
                assert!(qd.abs() <= bounds.velocity && qdd.abs() <= bounds.acceleration, "{bounds:?}");
            }
            if point % 5 == 0 {
                let torques = arm.inverse_dynamics(&now[0], &now[1], &now[2]).unwrap();
                for (joint, torque) in torques.into_iter().enumerate() {
                    let Some(limit) = limits[joint].effort else { continue };
                    let whole = torque + robot.joints[joint].friction(now[1][joint]);
                    let said = found.joints[joint].effort.unwrap();
                    assert!(whole.abs() <= said && said <= limit, "{whole} {said} {limit}\n{text}");
                    limited += 1;
                }
            }
        }
        // a motion, no rest
        assert!(found.joints.iter().all(|used| used.bounds.velocity > 1e-3 * used.limits.velocity), "{text}");
    }
    assert!(limited > 1000, "{limited}");
}

#[test]
fn a_seed_gives_a_motion() {
    let arm = desk_arm();
    let [a, b] = [0, 1].map(|_| found(&arm, &options(80)));
    assert_eq!(a.motion, b.motion);
    assert_eq!(a.condition.to_bits(), b.condition.to_bits());
    let mut other = options(80);
    other.seed = 2;
    assert_ne!(found(&arm, &other).motion, a.motion);
    // who watches ends it
    let limits = MotionLimits::of(&arm, &AskedLimits::default()).unwrap();
    let mut seen = Vec::new();
    let ended = excite(&arm, &limits, &options(80), &mut |progress| {
        seen.push(progress.condition);
        progress.evaluations < 20
    });
    let ended = ended.unwrap();
    assert_eq!((ended.evaluations, seen.len()), (20, 20));
    assert!((seen[19] - ended.condition).abs() < 1e-6 * ended.condition, "{seen:?} {}", ended.condition);
    assert_eq!(seen[0], ended.first_condition);
}

fn gaussian(rng: &mut Rng) -> f64 {
    (-2.0 * (1.0 - rng.f64()).ln()).sqrt() * (TAU * rng.f64()).cos()
}

/// A log of the motion at a rate: torques of the arm with its friction and noise of a hundredth of the effort limits.
fn log(robot: &Robot, motion: &Fourier, seconds: f64, rate: f64, rng: &mut Rng) -> Motion {
    let arm = DynArm::from_robot(robot);
    let empty = || vec![Vec::new(); robot.dof()];
    let mut log = Motion { time: Vec::new(), q: empty(), qd: empty(), qdd: empty(), tau: empty(), ..Motion::default() };
    for sample in 0_u32.. {
        let time = f64::from(sample) / rate;
        if time > seconds {
            break;
        }
        let now = state(motion, time);
        let torques = arm.inverse_dynamics(&now[0], &now[1], &now[2]).unwrap();
        log.time.push(time);
        for (joint, torque) in torques.into_iter().enumerate() {
            log.q[joint].push(now[0][joint]);
            log.qd[joint].push(now[1][joint]);
            log.qdd[joint].push(now[2][joint]);
            let noise = 0.01 * robot.joints[joint].limits.effort.unwrap() * gaussian(rng);
            log.tau[joint].push(torque + robot.joints[joint].friction(now[1][joint]) + noise);
        }
    }
    log
}

#[test]
fn a_log_of_the_motion_gives_the_arm_back() {
    let mut arm = desk_arm();
    for (joint, coulomb) in arm.joints.iter_mut().zip([0.5, 0.8, 0.3]) {
        joint.motor =
            Some(rne_model::Motor { inertia: 0.0, gear_ratio: 1.0, viscous: 0.4, coulomb: [coulomb, -coulomb] });
        joint.coulomb_width = Some(0.025);
    }
    let mut of_motion = options(400);
    of_motion.period = 10.0;
    let found = found(&arm, &of_motion);
    assert!(found.bases.iter().all(rne_identify::BaseExcitation::is_excited));
    let mut rng = Rng::with_seed(8);
    let motion = log(&arm, &found.motion, 60.0, 200.0, &mut rng);
    // identified from the geometry: the links of the file are no help
    let mut bare = arm.clone();
    for joint in &mut bare.joints {
        joint.row.link = rne_model::Link::default();
        joint.motor = None;
    }
    let identified = identify(&bare, Options::default(), 1e-3, |take| take(&motion)).unwrap();
    let parameters = identified.structure.parameters();
    let truth = &parameters.regrouping * parameters.of_robot(&arm);
    let mut inside = 0;
    for (at, base) in identified.bases.iter().enumerate() {
        assert!(base.is_excited(), "{}", base.name);
        let off = (base.value - truth[at]).abs();
        // an interval of 95 % has the truth most often, and one of twice that width nearly always
        assert!(off <= 2.0 * base.half_interval, "{} {} {}", base.name, base.value, truth[at]);
        inside += usize::from(off <= base.half_interval);
    }
    assert!(10 * inside >= 9 * identified.bases.len(), "{inside} of {}", identified.bases.len());
    assert!(identified.joints.iter().all(rne_identify::JointReport::is_excited));
}

/// What moves too slowly to tell a parameter is said before anybody moves.
#[test]
fn a_timid_motion_leaves_parameters_unexcited() {
    let arm = desk_arm();
    let mut asked = AskedLimits::default();
    asked.velocity = Some(vec![0.02]);
    let limits = MotionLimits::of(&arm, &asked).unwrap();
    let timid = excite(&arm, &limits, &options(100), &mut |_| true).unwrap();
    let count = |found: &Excitation| found.bases.iter().filter(|base| !base.is_excited()).count();
    assert!(count(&timid) > 3, "{:?}", timid.bases);
    assert!(count(&timid) > count(&found(&arm, &options(100))) + 2);
}

#[test]
fn what_makes_no_motion_is_refused() {
    let arm = desk_arm();
    let limits = MotionLimits::of(&arm, &AskedLimits::default()).unwrap();
    let refused = |limits: &[MotionLimits], options: &ExcitationOptions| {
        let error = excite(&arm, limits, options, &mut |_| true).map(|_| ()).unwrap_err();
        (error.is_of_request(), error.to_string())
    };
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut options = options(10);
        options.period = period;
        assert_eq!(refused(&limits, &options), (true, "the period must be a number of seconds above 0".to_owned()));
    }
    let mut one = options(10);
    one.harmonics = 1;
    assert!(refused(&limits, &one).1.contains("2 harmonics"));
    assert!(refused(&limits[..2], &options(10)).1.contains("3 joints"));
    // where hardly anything moves, everything looks the same
    let mut asked = AskedLimits::default();
    asked.range = Some(vec![1e-9]);
    let narrow = MotionLimits::of(&arm, &asked).unwrap();
    assert!(refused(&narrow, &options(10)).1.contains("too narrow"));
    // a motor that cannot carry its link
    let mut weak = arm.clone();
    weak.joints[1].limits.effort = Some(0.1);
    let limits = MotionLimits::of(&weak, &AskedLimits::default()).unwrap();
    let error = excite(&weak, &limits, &options(30), &mut |_| true).map(|_| ()).unwrap_err();
    assert!(!error.is_of_request() && error.to_string().contains("shoulder would need"), "{error}");
}
