//! The parts of torques against closed forms and laws, and trajectories against their formulas.

use fastrand::Rng;
use rne_model::Robot;
use rne_plot::{TorqueHistory, TorqueParts, Trajectory, TrajectoryError, svg};
use rne_runtime::DynArm;

fn robots() -> impl Iterator<Item = Robot> {
    shipped::tried().map(|file| Robot::from_yaml(file.yaml).unwrap())
}

fn robot(name: &str) -> Robot {
    Robot::from_yaml(rne_robots::find(name).unwrap().yaml).unwrap()
}

fn numbers(rng: &mut Rng, dof: usize, size: f64) -> Vec<f64> {
    (0..dof).map(|_| (2.0 * rng.f64() - 1.0) * size).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| value.abs().max(largest))
}

#[track_caller]
fn close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= tolerance, "{what}: {found:?} is not {expected:?}");
    }
}

/// Two uniform rods, by Lagrange: M, C and g written out. Gravity along -y.
#[test]
fn the_parts_of_two_links_are_those_of_lagrange() {
    let arm = DynArm::from_robot(&robot("planar2"));
    let (m1, a1, m2, a2, g) = (2.0, 0.5, 1.5, 0.4, 9.81);
    let mut rng = Rng::with_seed(1);
    for _ in 0..50 {
        let (q, qd, qdd) = (numbers(&mut rng, 2, 3.0), numbers(&mut rng, 2, 4.0), numbers(&mut rng, 2, 8.0));
        let parts = TorqueParts::at(&arm, &q, &qd, &qdd).unwrap();
        let (s2, c2) = q[1].sin_cos();
        let m22 = m2 * a2 * a2 / 3.0;
        let m12 = m22 + m2 * a1 * a2 * c2 / 2.0;
        let m11 = m1 * a1 * a1 / 3.0 + m2 * (a1 * a1 + a2 * a2 / 3.0 + a1 * a2 * c2);
        let h = m2 * a1 * a2 * s2;
        let gravity_2 = m2 * g * a2 / 2.0 * (q[0] + q[1]).cos();
        let gravity_1 = (m1 * a1 / 2.0 + m2 * a1) * g * q[0].cos() + gravity_2;
        close(&parts.inertia, &[m11 * qdd[0] + m12 * qdd[1], m12 * qdd[0] + m22 * qdd[1]], 1e-12, "inertia");
        let velocity = [-h * (qd[0] * qd[1] + qd[1] * qd[1] / 2.0), h * qd[0] * qd[0] / 2.0];
        close(&parts.velocity, &velocity, 1e-12, "velocity");
        close(&parts.gravity, &[gravity_1, gravity_2], 1e-12, "gravity");
    }
}

/// Of every shipped robot, with its rotors and without.
#[test]
fn parts_add_up_and_velocities_are_quadratic() {
    let mut rng = Rng::with_seed(2);
    for robot in robots().flat_map(|robot| [robot.clone(), robot.with_rotors()]) {
        let (arm, dof) = (DynArm::from_robot(&robot), robot.dof());
        for _ in 0..5 {
            let (q, qd, qdd) = (numbers(&mut rng, dof, 2.0), numbers(&mut rng, dof, 3.0), numbers(&mut rng, dof, 6.0));
            let parts = TorqueParts::at(&arm, &q, &qd, &qdd).unwrap();
            let sum: Vec<f64> = (0..dof).map(|i| parts.inertia[i] + parts.velocity[i] + parts.gravity[i]).collect();
            let size = [&parts.inertia, &parts.velocity, &parts.gravity].map(|part| largest(part));
            let size = largest(&size).max(1.0);
            close(&sum, &parts.total, 1e-12 * size, &robot.name);
            // twice as fast, four times the torque; backwards, the same
            let of = |factor: f64| {
                let qd: Vec<f64> = qd.iter().map(|qd| factor * qd).collect();
                TorqueParts::at(&arm, &q, &qd, &qdd).unwrap().velocity
            };
            let four: Vec<f64> = parts.velocity.iter().map(|torque| 4.0 * torque).collect();
            close(&of(2.0), &four, 0.0, &robot.name);
            close(&of(-1.0), &parts.velocity, 0.0, &robot.name);
            // accelerations and gravity: linear, and apart from velocities
            let none = TorqueParts::at(&arm, &q, &vec![0.0; dof], &qdd).unwrap();
            assert_eq!((none.velocity, &none.inertia), (vec![0.0; dof], &parts.inertia), "{}", robot.name);
            let share = (0..dof).map(|joint| parts.velocity_share(joint));
            assert!(share.into_iter().all(|share| (0.0..=1.0).contains(&share)));
        }
    }
}

/// What the actuators deliver is what the energy gains.
#[test]
fn powers_are_the_rate_of_energy() {
    for name in ["planar2", "stanford", "puma560_mdh"] {
        let robot = robot(name);
        let arm = DynArm::from_robot(&robot);
        let [from, to] = Trajectory::postures(&robot);
        let steps = if shipped::is_exhaustive() { 3000 } else { 1500 };
        let motion = Trajectory::quintic(&from, &to, 1.5, steps + 1).unwrap();
        let history = TorqueHistory::new(&robot, &motion).unwrap();
        let energy = |at: usize| {
            arm.kinetic_energy(&motion.q[at], &motion.qd[at]).unwrap() + arm.potential_energy(&motion.q[at]).unwrap()
        };
        let mut work = 0.0;
        let mut largest = 1e-9_f64;
        for at in (2..motion.time.len()).step_by(2) {
            let step = motion.time[at] - motion.time[at - 2];
            let power = |at: usize| history.powers[at].iter().sum::<f64>();
            // Simpson's rule
            work += step * (power(at) + 4.0 * power(at - 1) + power(at - 2)) / 6.0;
            let gained = energy(at) - energy(0);
            largest = largest.max(gained.abs());
            assert!((work - gained).abs() <= 1e-9 * largest.max(1.0), "{name} {at}: {work} {gained}");
        }
        assert!(largest > 0.1, "{name}: the arm has moved something");
    }
}

#[test]
fn a_quintic_goes_from_rest_to_rest() {
    let motion = Trajectory::quintic(&[1.0, -2.0], &[2.0, 3.0], 4.0, 401).unwrap();
    let ends = [0, 400];
    close(&motion.q[0], &[1.0, -2.0], 1e-15, "start");
    close(&motion.q[400], &[2.0, 3.0], 1e-14, "end");
    for end in ends {
        close(&motion.qd[end], &[0.0; 2], 1e-14, "rest");
        close(&motion.qdd[end], &[0.0; 2], 1e-14, "rest");
    }
    // in the middle 15/8 of the mean speed
    close(&motion.qd[200], &[15.0 / 8.0 / 4.0, 5.0 * 15.0 / 8.0 / 4.0], 1e-14, "the middle");
    // velocities and accelerations are derivatives
    for at in 1..400 {
        let step = 0.01;
        let rate = |values: &[Vec<f64>]| (values[at + 1][1] - values[at - 1][1]) / (2.0 * step);
        assert!((rate(&motion.q) - motion.qd[at][1]).abs() < 2e-4);
        assert!((rate(&motion.qd) - motion.qdd[at][1]).abs() < 2e-3);
    }
}

/// A parabola is differentiated exactly, at unequal times, at the ends too.
#[test]
fn what_is_not_given_is_derived() {
    let time = vec![0.0, 0.1, 0.35, 0.4, 1.0];
    let of = |f: &dyn Fn(f64) -> f64| time.iter().map(|t| vec![f(*t)]).collect::<Vec<_>>();
    let q = of(&|t| 1.0 - 2.0 * t + 3.0 * t * t);
    let motion = Trajectory::new(time.clone(), q.clone(), None, None).unwrap();
    for (at, t) in time.iter().enumerate() {
        close(&motion.qd[at], &[6.0 * t - 2.0], 1e-12, "q̇");
        close(&motion.qdd[at], &[6.0], 1e-11, "q̈");
    }
    // with velocities, the accelerations are theirs, whatever the positions say
    let qd = of(&|t| 5.0 * t * t);
    let motion = Trajectory::new(time.clone(), q.clone(), Some(qd.clone()), None).unwrap();
    assert_eq!(motion.qd, qd);
    for (at, t) in time.iter().enumerate() {
        close(&motion.qdd[at], &[10.0 * t], 1e-11, "q̈");
    }
    let given = of(&|_| 7.0);
    let motion = Trajectory::new(time.clone(), q.clone(), Some(qd), Some(given.clone())).unwrap();
    assert_eq!(motion.qdd, given);
}

#[test]
fn trajectories_that_are_none() {
    let one = |values: &[f64]| values.iter().map(|value| vec![*value]).collect::<Vec<_>>();
    let new = |time: &[f64], q: &[f64]| Trajectory::new(time.to_vec(), one(q), None, None).unwrap_err();
    assert_eq!(new(&[0.0, 1.0], &[0.0, 1.0]), TrajectoryError::TooFew { found: 2, needed: 3 });
    assert_eq!(new(&[0.0, 1.0, 1.0], &[0.0, 1.0, 2.0]), TrajectoryError::Time(2));
    assert_eq!(new(&[0.0, f64::NAN, 1.0], &[0.0, 1.0, 2.0]), TrajectoryError::Time(1));
    assert_eq!(new(&[0.0, 1.0, 2.0], &[0.0, f64::INFINITY, 2.0]), TrajectoryError::NotFinite(1));
    assert_eq!(new(&[0.0, 1.0, 2.0], &[0.0, 1.0]), TrajectoryError::Length(2));
    assert_eq!(Trajectory::quintic(&[0.0], &[1.0], 0.0, 10), Err(TrajectoryError::Duration));
    assert_eq!(Trajectory::quintic(&[0.0], &[1.0], f64::NAN, 10), Err(TrajectoryError::Duration));
    let short = Trajectory::quintic(&[0.0], &[1.0], 1.0, 10).unwrap();
    assert!(TorqueHistory::new(&robot("planar2"), &short).is_err());
}

#[test]
fn postures_are_inside_the_limits_and_speeds_too() {
    for robot in robots() {
        let [from, to] = Trajectory::postures(&robot);
        let least = Trajectory::least_duration(&robot, &from, &to);
        let motion = Trajectory::quintic(&from, &to, least.max(0.1), 101).unwrap();
        for (joint, index) in robot.joints.iter().zip(0..) {
            assert!(from[index] != to[index], "{}: joint {index} moves", robot.name);
            if let Some((lower, upper)) = joint.limits.position {
                assert!(motion.q.iter().all(|q| (lower..=upper).contains(&q[index])), "{}", robot.name);
            }
            if let Some(limit) = joint.limits.velocity {
                assert!(motion.qd.iter().all(|qd| qd[index].abs() <= limit * (1.0 + 1e-12)), "{}", robot.name);
            }
        }
    }
}

/// A pendulum that swings up: the peak is where the formula has it.
#[test]
fn peaks_are_the_largest_torques() {
    let robot = robot("planar1");
    // m a²/3 q̈ + m g a/2 cos q, hardly any q̈: the largest is that of q = 0
    let motion = Trajectory::quintic(&[-1.0], &[1.0], 1000.0, 2001).unwrap();
    let history = TorqueHistory::new(&robot, &motion).unwrap();
    let peak = history.peaks[0];
    assert!((peak.time - 500.0).abs() < 1.0 && (peak.tau - 2.0 * 9.81 * 0.25).abs() < 1e-6, "{peak:?}");
    assert_eq!(peak.velocity_share, 0.0, "a single joint has no velocity terms");
    assert_eq!(history.overflows(), None);
}

/// The picture is XML that a reader accepts, with every text shown as it is, whatever a robot file says.
#[test]
fn texts_of_a_file_do_nothing() {
    let hostile = "</text><script>alert('&\u{1}\u{202E}\u{FFFE}\")</script> ]]> &amp; \u{7}";
    for name in ["planar1", "stanford", "panda"] {
        let mut robot = robot(name);
        robot.title = Some(hostile.to_owned());
        robot.joints[0].name = hostile.to_owned();
        let [from, to] = Trajectory::postures(&robot);
        let motion = Trajectory::quintic(&from, &to, 2.0, 51).unwrap();
        let history = TorqueHistory::new(&robot, &motion).unwrap();
        let picture = svg(&robot, &motion, &history, hostile);
        let (mut names, mut texts) = (Vec::new(), String::new());
        let mut reader = quick_xml::Reader::from_str(&picture);
        loop {
            match reader.read_event().expect("well-formed") {
                quick_xml::events::Event::Eof => break,
                quick_xml::events::Event::Start(tag) | quick_xml::events::Event::Empty(tag) => {
                    names.push(String::from_utf8_lossy(tag.name().as_ref()).into_owned());
                    for attribute in tag.attributes() {
                        let attribute = attribute.expect("well-formed");
                        let value = String::from_utf8_lossy(&attribute.value).into_owned();
                        assert!(!value.contains("NaN") && !value.contains("inf"), "{value}");
                    }
                }
                quick_xml::events::Event::GeneralRef(name) => {
                    texts.extend(["&", &String::from_utf8_lossy(&name), ";"]);
                }
                quick_xml::events::Event::Text(text) => texts += &String::from_utf8_lossy(&text),
                _ => {}
            }
        }
        names.sort();
        names.dedup();
        assert_eq!(names, ["circle", "line", "polyline", "rect", "svg", "text", "title"]);
        assert!(!picture.contains("<script") && texts.contains("&lt;script&gt;"), "{texts}");
        let forbidden = |c: char| c != '\n' && (rne_model::is_control(c) || "\u{FFFE}\u{FFFF}".contains(c));
        assert!(!picture.contains(forbidden));
        assert_eq!(picture.matches("<circle").count(), robot.dof(), "a peak for each joint");
    }
}

/// A long trajectory makes no longer picture, and loses no peak.
#[test]
fn long_trajectories_keep_their_peaks() {
    let robot = robot("planar1");
    let samples = 20_000;
    let time: Vec<f64> = (0..samples).map(f64::from).collect();
    let at_rest = vec![vec![0.5]; time.len()];
    let mut jolts = vec![vec![0.0]; time.len()];
    jolts[17_037] = vec![1e4];
    let motion = Trajectory::new(time.clone(), at_rest, Some(vec![vec![0.0]; time.len()]), Some(jolts)).unwrap();
    let history = TorqueHistory::new(&robot, &motion).unwrap();
    assert_eq!(history.peaks[0].sample, 17_037);
    let picture = svg(&robot, &motion, &history, "a jolt");
    assert!(picture.len() < 500_000, "{}", picture.len());
    // m a²/3 q̈ is at the top of its axis
    let top = picture.split("<polyline").nth(1).and_then(|line| line.split('"').nth(1)).expect("points");
    let highest = top.split(' ').filter_map(|point| point.split(',').nth(1)?.parse::<f64>().ok()).fold(1e9, f64::min);
    assert!(highest < 220.0, "{highest}");
}
