//! Rows that have no order, as those of a table: parts that travel as numbers and merge in any order are the whole.

use fastrand::Rng;
use nalgebra::DVector;
use rne_identify::{Fit, Information, Options, Structure};
use rne_logs::Motion;
use rne_model::Robot;
use rne_runtime::DynArm;

const ARM: &str = include_str!("two.yaml");

fn arm() -> Robot {
    Robot::from_yaml(ARM).unwrap_or_else(|report| panic!("{report}"))
}

fn structure(robot: &Robot) -> Structure {
    let mut options = Options::default();
    options.cutoff = None;
    options.delay = false;
    options.displacements = Vec::new();
    Structure::new(robot, options)
}

/// Random states with the torques of the arm and white noise.
fn states(robot: &Robot, count: usize, noise: f64, rng: &mut Rng) -> Motion {
    let arm = DynArm::from_robot(robot);
    let mut motion = Motion::default();
    for list in [&mut motion.q, &mut motion.qd, &mut motion.qdd, &mut motion.tau] {
        *list = vec![Vec::new(); robot.dof()];
    }
    for state in 0..count {
        let mut random = |size: f64| -> Vec<f64> { (0..robot.dof()).map(|_| size * (2.0 * rng.f64() - 1.0)).collect() };
        let (q, qd, qdd) = (random(3.0), random(2.0), random(10.0));
        let tau = arm.inverse_dynamics(&q, &qd, &qdd).unwrap();
        motion.time.push(f64::from(u32::try_from(state).unwrap()));
        for (at, joint) in robot.joints.iter().enumerate() {
            // of deviation one, nearly Gaussian
            let white = (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0;
            motion.tau[at].push(tau[at] + joint.friction(qd[at]) + noise * white);
            motion.q[at].push(q[at]);
            motion.qd[at].push(qd[at]);
            motion.qdd[at].push(qdd[at]);
        }
    }
    motion
}

/// Base parameters, then viscous, forward and backward friction of each joint.
fn truth(structure: &Structure, robot: &Robot) -> Vec<f64> {
    let parameters = structure.parameters();
    let bases: DVector<f64> = &parameters.regrouping * parameters.of_robot(robot);
    let motors = robot.joints.iter().map(|joint| joint.motor.unwrap());
    bases.iter().copied().chain(motors.flat_map(|motor| [motor.viscous, motor.coulomb[0], -motor.coulomb[1]])).collect()
}

/// The same, as it was found, with deviations.
fn found(one: &Fit) -> Vec<(f64, f64)> {
    let bases = one.bases.iter().map(|base| (base.value, base.deviation));
    bases.chain(one.friction.iter().flatten().copied()).collect()
}

#[test]
fn sixty_four_shuffled_parts_are_the_whole_in_every_respect() {
    let robot = arm();
    let structure = structure(&robot);
    let mut rng = Rng::with_seed(21);
    let mut parts: Vec<Motion> = (0..64).map(|_| states(&robot, 70, 0.3, &mut rng)).collect();
    let mut whole = Information::unordered(&structure);
    for part in &parts {
        whole.absorb(&structure, part, None).unwrap();
    }
    rng.shuffle(&mut parts);
    let mut merged = Information::unordered(&structure);
    for part in &parts {
        let mut one = Information::unordered(&structure);
        one.absorb(&structure, part, None).unwrap();
        merged.merge(Information::from_numbers(&structure, &one.to_numbers()).unwrap());
    }
    assert_eq!((whole.states(), merged.states(), merged.rows()), (64 * 70, 64 * 70, 64 * 70));
    assert_eq!(whole.size(), merged.size());
    let [whole, merged] = [whole, merged].map(|information| Fit::new(&structure, &information, 1.0));
    for (one, other) in found(&whole).iter().zip(found(&merged)) {
        assert!((one.0 - other.0).abs() <= 1e-10 * one.0.abs().max(1.0), "{one:?} {other:?}");
        assert!((one.1 - other.1).abs() <= 1e-10 * one.1, "{one:?} {other:?}");
    }
    let text = merged.robot_file("a table");
    assert_eq!(Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}\n{text}")).joints, merged.robot.joints);
}

/// Rows that are hardly more than the unknowns are met by any, whatever their noise: nothing is excited by them, and
/// nothing by efforts of zeros, of all joints or of one.
#[test]
fn too_few_rows_and_zeros_excite_nothing() {
    let robot = arm();
    let structure = structure(&robot);
    let identified = |motion: &Motion| {
        let mut information = Information::unordered(&structure);
        information.absorb(&structure, motion, None).unwrap();
        Fit::new(&structure, &information, 1.0)
    };
    let excited = |one: &Fit| {
        let bases = one.bases.iter().filter(|base| base.is_excited()).count();
        bases + (0..2).filter(|joint| one.is_friction_excited(*joint)).count()
    };
    let mut rng = Rng::with_seed(3);
    let unknowns = structure.parameters().rank() + 3 * 2;
    for count in [1, 2, unknowns / 2, unknowns / 2 + 1, unknowns - 1] {
        assert_eq!(excited(&identified(&states(&robot, count, 0.3, &mut rng))), 0, "{count}");
    }
    let many = states(&robot, 400, 0.3, &mut rng);
    assert_eq!(excited(&identified(&many)), structure.parameters().rank() + 2);
    let mut zeros = many.clone();
    zeros.tau[1].fill(0.0);
    let one = identified(&zeros);
    assert!(one.is_friction_excited(0) && !one.is_friction_excited(1));
    for (base, truth) in one.bases.iter().zip(truth(&structure, &robot)) {
        assert!(!base.is_excited() || (base.value - truth).abs() < 5.0 * base.deviation, "{base:?} {truth}");
    }
    zeros.tau[0].fill(0.0);
    assert_eq!(excited(&identified(&zeros)), 0);
    // what overflows tells nothing
    let mut huge = many;
    huge.tau.iter_mut().flatten().for_each(|tau| *tau *= 1e306);
    let one = identified(&huge);
    assert_eq!(excited(&one), 0, "{:?} {:?}", one.bases, one.friction);
}

/// What the deviations say of white noise is so: of many made-up tables, 95 of a hundred intervals have the truth.
#[test]
fn deviations_of_white_noise_are_those_of_many_tables() {
    let robot = arm();
    let structure = structure(&robot);
    let truth = truth(&structure, &robot);
    let bases = structure.parameters().rank();
    let (mut inside, mut all) = (0, 0);
    for table in 0..60 {
        let mut rng = Rng::with_seed(300 + table);
        let mut information = Information::unordered(&structure);
        information.absorb(&structure, &states(&robot, 400, 0.5, &mut rng), None).unwrap();
        let one = Fit::new(&structure, &information, 1e-6);
        for (at, (found, truth)) in found(&one).iter().zip(&truth).enumerate().take(bases) {
            assert!((one.least_squares.half_interval(at) / found.1 - 1.96).abs() < 0.01);
            all += 1;
            inside += i32::from((found.0 - truth).abs() <= one.least_squares.half_interval(at));
        }
    }
    let part = f64::from(inside) / f64::from(all);
    assert!((0.93..=0.97).contains(&part), "{part}");
}

#[test]
fn numbers_are_the_information_bit_for_bit_and_others_are_refused() {
    let robot = arm();
    let structure = structure(&robot);
    let mut rng = Rng::with_seed(5);
    let motion = states(&robot, 300, 0.1, &mut rng);
    for mut information in [Information::new(&structure), Information::unordered(&structure)] {
        let none = Information::from_numbers(&structure, &information.to_numbers()).unwrap();
        assert_eq!((none.states(), none.rows(), none.is_unordered()), (0, 0, information.is_unordered()));
        information.absorb(&structure, &motion, None).unwrap();
        let numbers = information.to_numbers();
        let again = Information::from_numbers(&structure, &numbers).unwrap();
        assert_eq!(again.to_numbers(), numbers);
        assert_eq!((again.states(), again.rows()), (300, 300));
        let refused = |numbers: &[f64]| {
            let said = Information::from_numbers(&structure, numbers).unwrap_err().to_string();
            assert!(said.contains("another robot"), "{said}");
        };
        for length in [0, 3, 5, 6, 7, 20, numbers.len() - 1] {
            refused(&numbers[..length]);
        }
        refused(&[&numbers[..], &[0.0]].concat());
        for (at, wrong) in [(0, -1.0), (0, f64::NAN), (1, 0.5), (4, 1e300), (4, 65.0), (5, -3.0)] {
            let mut numbers = numbers.clone();
            numbers[at] = wrong;
            refused(&numbers);
        }
        let mut options = Options::default();
        options.friction = false;
        let other = Structure::new(&robot, options);
        assert!(Information::from_numbers(&other, &numbers).is_err());
    }
}
