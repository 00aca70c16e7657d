//! Logs that are made up, of arms that are known: what is found is what was put in.

use fastrand::Rng;
use nalgebra::DVector;
use rne_identify::{
    Feasible, Identification, Information, LeastSquares, MotionError, Options, Parameter, Structure, identify,
    prediction_errors, pseudo_inertia,
};
use rne_logs::Motion;
use rne_model::{Friction, FrictionTransition, Robot};
use rne_runtime::DynArm;

/// Two bodies in three dimensions, with friction.
const ARM: &str = include_str!("two.yaml");

fn arm() -> Robot {
    Robot::from_yaml(ARM).unwrap_or_else(|report| panic!("{report}"))
}

/// A motion through random sums of sines, as it is.
struct Sines {
    /// By joint: amplitude, frequency, phase.
    parts: Vec<Vec<(f64, f64, f64)>>,
}

impl Sines {
    fn new(rng: &mut Rng, dof: usize) -> Self {
        let part =
            |rng: &mut Rng, k: u32| (0.5 / f64::from(k), 0.17 * f64::from(k) + 0.05 * rng.f64(), 6.3 * rng.f64());
        Self { parts: (0..dof).map(|_| (1..=4).map(|k| part(rng, k)).collect()).collect() }
    }

    fn at(&self, time: f64) -> [Vec<f64>; 3] {
        let tau = std::f64::consts::TAU;
        let sum = |of: &dyn Fn(f64, f64, f64) -> f64| -> Vec<f64> {
            self.parts.iter().map(|parts| parts.iter().map(|&(a, f, p)| of(a, tau * f, p)).sum()).collect()
        };
        [
            sum(&|a, w, p| a * (w * time + p).sin()),
            sum(&|a, w, p| a * w * (w * time + p).cos()),
            sum(&|a, w, p| -a * w * w * (w * time + p).sin()),
        ]
    }
}

fn torques(robot: &Robot, arm: &DynArm, state: &[Vec<f64>; 3]) -> Vec<f64> {
    let tau = arm.inverse_dynamics(&state[0], &state[1], &state[2]).unwrap();
    tau.iter().zip(&robot.joints).zip(&state[1]).map(|((tau, joint), qd)| tau + joint.friction(*qd)).collect()
}

fn gaussian(rng: &mut Rng) -> f64 {
    (-2.0 * (1.0 - rng.f64()).ln()).sqrt() * (std::f64::consts::TAU * rng.f64()).cos()
}

fn quantised(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}

/// How signals are spoilt.
#[derive(Clone, Copy)]
struct Spoilt {
    noise: f64,
    /// rad, N m
    steps: Option<(f64, f64)>,
    /// s
    delay: f64,
}

/// States at a rate, from a time on.
fn log(robot: &Robot, sines: &Sines, start: f64, count: usize, rate: f64, spoilt: Spoilt, rng: &mut Rng) -> Motion {
    let arm = DynArm::from_robot(robot);
    let dof = robot.dof();
    let empty = || vec![Vec::with_capacity(count); dof];
    let mut motion =
        Motion { time: Vec::new(), q: empty(), qd: empty(), qdd: empty(), tau: empty(), ..Motion::default() };
    for k in 0..count {
        let time = start + f64::from(u32::try_from(k).unwrap()) / rate;
        let [q, qd, qdd] = sines.at(time);
        let tau = torques(robot, &arm, &sines.at(time - spoilt.delay));
        motion.time.push(time);
        for joint in 0..dof {
            let step = spoilt.steps.unwrap_or((0.0, 0.0));
            let of = |value: f64, step: f64| if step > 0.0 { quantised(value, step) } else { value };
            motion.q[joint].push(of(q[joint], step.0));
            // as a controller measures them, over 5 ms
            motion.qd[joint].push(of(qd[joint], step.0 / 0.005));
            motion.qdd[joint].push(qdd[joint]);
            motion.tau[joint].push(of(tau[joint] + spoilt.noise * gaussian(rng), step.1));
        }
    }
    if spoilt.steps.is_some() {
        // accelerations are differences of what was measured
        for joint in 0..dof {
            for k in 1..count.saturating_sub(1) {
                motion.qdd[joint][k] = (motion.qd[joint][k + 1] - motion.qd[joint][k - 1]) * 0.5 * rate;
            }
        }
    }
    motion
}

const CLEAN: Spoilt = Spoilt { noise: 0.0, steps: None, delay: 0.0 };

/// The unknowns that were put in.
fn truth(structure: &Structure, robot: &Robot) -> DVector<f64> {
    let parameters = structure.parameters();
    let mut unknowns: Vec<f64> = (&parameters.regrouping * parameters.of_robot(robot)).iter().copied().collect();
    for joint in &robot.joints {
        let motor = joint.motor.unwrap();
        let [p, n] = motor.coulomb;
        unknowns.extend([motor.viscous, 0.5 * (p - n), 0.5 * (p + n)]);
    }
    DVector::from_vec(unknowns)
}

fn with_few_transitions(options: &mut Options) {
    options.widths = vec![0.025, 0.05];
    options.displacements = vec![0.005];
}

#[test]
fn a_clean_log_gives_the_arm_back() {
    let robot = arm();
    let mut rng = Rng::with_seed(3);
    let motion = log(&robot, &Sines::new(&mut rng, 2), 0.0, 4000, 200.0, CLEAN, &mut rng);
    let mut options = Options::default();
    with_few_transitions(&mut options);
    options.delay = false;
    let found = identify(&robot, options, 1e-4, |take| take(&motion)).unwrap();
    let truth = truth(&found.structure, &robot);
    for (at, base) in found.bases.iter().enumerate() {
        assert!((base.value - truth[at]).abs() < 1e-6 * (1.0 + truth[at].abs()), "{} {}", base.name, base.value);
        assert!(base.is_excited(), "{}", base.name);
    }
    // the file says it again
    let text = found.robot_file("a made-up log");
    let read = Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}\n{text}"));
    assert_eq!(read.joints, found.robot.joints);
    assert!(read.joints.iter().all(rne_model::Joint::is_physical));
    for error in prediction_errors(&read, [&motion], Some(2.0)).unwrap() {
        assert!(error.error < 1e-4 && error.unfiltered < 1e-4, "{error:?}");
    }
}

#[test]
fn parts_in_any_order_are_the_whole() {
    let robot = arm();
    let mut rng = Rng::with_seed(5);
    let sines = Sines::new(&mut rng, 2);
    let spoilt = Spoilt { noise: 0.1, ..CLEAN };
    let mut options = Options::default();
    options.cutoff = None;
    options.delay = false;
    // friction that remembers does not know what was before a part
    options.displacements.clear();
    let structure = Structure::new(&robot, options);
    let parts: Vec<Motion> =
        (0..64).map(|part| log(&robot, &sines, 0.5 * f64::from(part), 50, 100.0, spoilt, &mut rng)).collect();
    let mut whole = Information::new(&structure);
    let joined = joined(&parts);
    whole.absorb(&structure, &joined, None).unwrap();
    let mut order: Vec<usize> = (0..64).collect();
    rng.shuffle(&mut order);
    let mut merged = Information::new(&structure);
    for part in order {
        let mut one = Information::new(&structure);
        one.absorb(&structure, &parts[part], None).unwrap();
        merged.merge(one);
    }
    let of = |information: &Information| LeastSquares::of(&structure, information, &information.scales(&structure));
    let (whole, merged) = (of(&whole), of(&merged));
    assert_eq!(whole.transitions, merged.transitions);
    for (a, b) in whole.solution.iter().zip(merged.solution.iter()) {
        assert!((a - b).abs() <= 1e-10 * whole.solution.amax(), "{a} {b}");
    }
}

/// The arm with friction that turns over a displacement, and a log of it.
fn remembering(displacements: [f64; 2], noise: f64) -> (Robot, Motion) {
    let mut robot = arm();
    for (joint, displacement) in robot.joints.iter_mut().zip(displacements) {
        joint.coulomb_width = None;
        joint.coulomb_displacement = Some(displacement);
    }
    let mut rng = Rng::with_seed(13);
    let without = {
        let mut bare = robot.clone();
        bare.joints.iter_mut().for_each(|joint| joint.motor = None);
        bare
    };
    let spoilt = Spoilt { noise, ..CLEAN };
    let mut motion = log(&without, &Sines::new(&mut rng, 2), 0.0, 6000, 200.0, spoilt, &mut rng);
    for (at, joint) in robot.joints.iter().enumerate() {
        let mut friction = Friction::of(joint);
        for ((tau, q), qd) in motion.tau[at].iter_mut().zip(&motion.q[at]).zip(&motion.qd[at]) {
            *tau += friction.next(*q, *qd);
        }
    }
    (robot, motion)
}

/// Friction that remembers is told from friction that does not, and the file says it again.
#[test]
fn friction_that_remembers_is_found() {
    let (robot, motion) = remembering([0.02, 0.01], 0.0);
    let mut options = Options::default();
    options.delay = false;
    let found = identify(&robot, options.clone(), 1e-4, |take| take(&motion)).unwrap();
    let transitions: Vec<_> = found.joints.iter().map(|joint| joint.transition.unwrap()).collect();
    assert_eq!(transitions, [FrictionTransition::Displacement(0.02), FrictionTransition::Displacement(0.01)]);
    let truth = truth(&found.structure, &robot);
    for (at, value) in truth.iter().enumerate() {
        let error = found.least_squares.solution[at] - value;
        assert!(error.abs() < 1e-6 * (1.0 + value.abs()), "{at}: {error}");
    }
    let read = Robot::from_yaml(&found.robot_file("a made-up log")).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(read.joints, found.robot.joints);
    for error in prediction_errors(&read, [&motion], Some(2.0)).unwrap() {
        assert!(error.error < 1e-4 && error.unfiltered < 1e-4, "{error:?}");
    }
    // speeds alone do not explain it
    options.displacements.clear();
    let speeds = identify(&robot, options, 1e-4, |take| take(&motion)).unwrap();
    assert!(speeds.joints.iter().all(|joint| joint.error.unfiltered > 0.01));
    // and in noise it is found, too
    let (robot, noisy) = remembering([0.02, 0.01], 0.1);
    let found = identify(&robot, Options::default(), 1.0, |take| take(&noisy)).unwrap();
    assert!(found.joints.iter().all(|joint| matches!(joint.transition, Some(FrictionTransition::Displacement(_)))));
}

/// What is not excited is said by the file alone.
#[test]
fn a_file_says_which_joints_were_not_excited() {
    let robot = arm();
    let mut rng = Rng::with_seed(17);
    let mut motion = log(&robot, &Sines::new(&mut rng, 2), 0.0, 4000, 200.0, CLEAN, &mut rng);
    let plain = identify(&robot, Options::default(), 1.0, |take| take(&motion)).unwrap();
    let read = Robot::from_yaml(&plain.robot_file("a made-up log")).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(Identification::not_excited(&read), [false, false]);
    // noise where there was a torque
    motion.tau[1] = (0..4000).map(|_| gaussian(&mut rng)).collect();
    let found = identify(&robot, Options::default(), 1.0, |take| take(&motion)).unwrap();
    assert!(!found.joints[1].is_excited());
    let read = Robot::from_yaml(&found.robot_file("a made-up log")).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(Identification::not_excited(&read), [false, true]);
    assert_eq!(Identification::not_excited(&robot), [false, false]);
}

fn joined(parts: &[Motion]) -> Motion {
    let join = |of: fn(&Motion) -> &Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        (0..of(&parts[0]).len()).map(|joint| parts.iter().flat_map(|part| of(part)[joint].clone()).collect()).collect()
    };
    Motion {
        time: parts.iter().flat_map(|part| part.time.clone()).collect(),
        q: join(|part| &part.q),
        qd: join(|part| &part.qd),
        qdd: join(|part| &part.qdd),
        tau: join(|part| &part.tau),
        ..Motion::default()
    }
}

/// The minimum of a convex problem is known by its multipliers, whatever found it: the gradient is theirs, they are
/// positive, and what they forbid is not used.
#[test]
fn bodies_are_the_best_ones() {
    let robot = arm();
    let mut rng = Rng::with_seed(7);
    let sines = Sines::new(&mut rng, 2);
    let motion = log(&robot, &sines, 0.0, 3000, 100.0, Spoilt { noise: 2.0, ..CLEAN }, &mut rng);
    let mut options = Options::default();
    options.delay = false;
    options.rotors = true;
    let structure = Structure::new(&robot, options);
    let mut information = Information::new(&structure);
    information.absorb(&structure, &motion, None).unwrap();
    let scales = information.scales(&structure);
    let fit = LeastSquares::of(&structure, &information, &scales);
    let regularization = 1e-3;
    let found = Feasible::of(&structure, &fit, &scales, regularization);
    assert!(found.certificate.margin > 0.0 && found.certificate.decrement < 1e-8, "{:?}", found.certificate);
    assert!(found.certificate.misfit >= found.certificate.least_misfit - 1e-9);
    // the gradient of the squares by the base parameters, from values of the misfit alone
    let gradient = fit.gradient(&found.unknowns);
    let priors = rne_identify::prior::links(&robot);
    let parameters = structure.parameters();
    let units = pseudo_inertia::units();
    for (link, pseudo) in found.links.iter().enumerate() {
        let inverse = pseudo.try_inverse().unwrap();
        let multiplier = (inverse - priors[link].pseudo_inertia.try_inverse().unwrap()) * regularization;
        assert!((inverse * regularization).symmetric_eigenvalues().min() > 0.0);
        for (index, unit) in units.iter().enumerate() {
            let column = parameters.regrouping.column(link * 10 + index);
            let of_squares: f64 = column.iter().zip(gradient.iter()).map(|(factor, slope)| factor * slope).sum();
            let of_multiplier = (multiplier * unit).trace();
            let scale = 1.0 + of_squares.abs() + (inverse * unit).trace().abs() * regularization;
            assert!((of_squares - of_multiplier).abs() < 1e-5 * scale, "{link} {index}: {of_squares} {of_multiplier}");
        }
    }
    let rank = parameters.rank();
    assert!(parameters.bases.iter().any(|base| matches!(base.kept, Parameter::Rotor(_))) || rank > 0);
}

/// Five million states, and as many numbers are kept as of a hundred thousand.
#[test]
#[ignore = "long: cargo test -p rne-identify --test all -- synthetic --ignored"]
fn five_million_states_need_no_more_memory() {
    let robot = arm();
    let mut rng = Rng::with_seed(11);
    let sines = Sines::new(&mut rng, 2);
    let structure = Structure::new(&robot, Options::default());
    let mut information = Information::new(&structure);
    let mut sizes = Vec::new();
    for piece in 0..100 {
        let start = 50.0 * f64::from(piece);
        let motion = log(&robot, &sines, start, 50_000, 1000.0, Spoilt { noise: 0.2, ..CLEAN }, &mut rng);
        information.absorb(&structure, &motion, None).unwrap();
        sizes.push(information.size());
    }
    assert_eq!(information.states(), 5_000_000);
    // between half of the segments that are kept at most, and all
    let (least, most) = (sizes.iter().min().unwrap(), sizes.iter().max().unwrap());
    assert!(most <= &(2 * least), "{sizes:?}");
    let fit = LeastSquares::of(&structure, &information, &information.scales(&structure));
    let truth = truth(&structure, &robot);
    for (at, value) in truth.iter().enumerate().take(structure.parameters().rank()) {
        assert!((fit.solution[at] - value).abs() < 6.0 * fit.deviation(at) + 1e-4, "{at}");
    }
}

/// Noise, signals in steps and a delay: intervals of 95 % have the truth in 93 to 97 of a hundred.
fn coverage(trials: u64) -> Vec<f64> {
    let robot = arm();
    let mut options = Options::default();
    with_few_transitions(&mut options);
    options.cutoff = Some(4.0);
    let structure = Structure::new(&robot, options);
    let truth = truth(&structure, &robot);
    let mut inside = vec![0.0; truth.len()];
    for trial in 0..trials {
        let mut rng = Rng::with_seed(1000 + trial);
        let sines = Sines::new(&mut rng, 2);
        let spoilt = Spoilt { noise: 0.5, steps: Some((2e-5, 0.05)), delay: 0.004 };
        let motion = log(&robot, &sines, 0.0, 6000, 200.0, spoilt, &mut rng);
        let mut fit: Option<LeastSquares> = None;
        for _ in 0..3 {
            let mut information = Information::new(&structure);
            let weighting = fit.as_ref().map(|fit| fit.weighting(&structure));
            information.absorb(&structure, &motion, weighting.as_ref()).unwrap();
            fit = Some(LeastSquares::of(&structure, &information, &information.scales(&structure)));
        }
        let fit = fit.unwrap();
        for (at, inside) in inside.iter_mut().enumerate() {
            if (fit.solution[at] - truth[at]).abs() <= fit.half_interval(at) {
                *inside += 1.0;
            }
        }
    }
    #[allow(clippy::cast_precision_loss)]
    inside.into_iter().map(|inside| inside / trials as f64).collect()
}

#[test]
fn intervals_have_the_truth() {
    let found = coverage(if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 100 } else { 60 });
    let mean = found.iter().sum::<f64>() / f64::from(u32::try_from(found.len()).unwrap());
    println!("{mean:.4} {found:.3?}");
    assert!((0.92..=0.98).contains(&mean), "{mean} {found:?}");
}

#[test]
#[ignore = "long: cargo test -p rne-identify --test all -- synthetic --ignored"]
fn intervals_have_the_truth_as_often_as_they_say() {
    let found = coverage(1000);
    let mean = found.iter().sum::<f64>() / f64::from(u32::try_from(found.len()).unwrap());
    println!("{mean:.4} {found:.3?}");
    assert!((0.93..=0.97).contains(&mean), "{mean}");
}

#[test]
fn motions_of_another_arm_are_refused() {
    let robot = arm();
    let three = Motion {
        time: vec![0.0],
        q: vec![vec![0.0]; 3],
        qd: vec![vec![0.0]; 3],
        qdd: vec![vec![0.0]; 3],
        tau: vec![vec![0.0]; 3],
        ..Motion::default()
    };
    let refused = |motion: &Motion| prediction_errors(&robot, [motion], None).unwrap_err();
    assert!(matches!(refused(&three), MotionError::Joints { expected: 2, found: 3 }));
    let two = |x: f64| Motion {
        time: vec![0.0],
        q: vec![vec![x]; 2],
        qd: vec![vec![0.0]; 2],
        qdd: vec![vec![0.0]; 2],
        tau: vec![vec![0.0]; 2],
        ..Motion::default()
    };
    assert!(matches!(refused(&two(f64::NAN)), MotionError::NotFinite(0)));
    let mut short = two(0.0);
    short.tau[1].clear();
    assert!(matches!(refused(&short), MotionError::Lengths));
    let short = Motion { recorded: vec![vec![]; 2], ..two(0.0) };
    assert!(matches!(refused(&short), MotionError::Lengths));
    // nothing is known of a log without states, and that is said
    let none = || vec![vec![]; 2];
    let empty = Motion { q: none(), qd: none(), qdd: none(), tau: none(), ..Motion::default() };
    let refused = identify(&robot, Options::default(), 1.0, |take| take(&empty)).unwrap_err();
    assert!(matches!(refused, MotionError::TooFew { rows: 0, needed: 21, .. }), "{refused}");
}
