//! Robots some of whose joints follow others, and whose motors have rotors on links: the base parameters that are
//! identified from torques give these torques back, and those of other states.

use fastrand::Rng;
use nalgebra::{DMatrix, DVector};
use rne_identify::{Fit, Information, Options, Parameter, Structure, identify, prediction_errors};
use rne_logs::Motion;
use rne_model::{Link, Reader, Robot};
use rne_runtime::DynArm;

const GRIPPER: &str = include_str!("../../../docs/gripper.yaml");
const PALLETISER: &str = include_str!("../../../docs/palletiser.yaml");

/// An arm whose second motor turns with both joints, and a finger that follows with a ratio that is no whole number.
const ROTORS: &str = "
format: 2
name: rotors
source: Invented, to test.
convention: modified
gravity: [0.5, 0, -9.7]
joints:
  - {name: shoulder, type: revolute, dh: {theta: 0, d: 0.3, a: 0, alpha: 0.4},
     link: {mass: 4, com: [0.1, 0.02, 0], inertia: {xx: 0.04, yy: 0.05, zz: 0.03, xy: 0.002}},
     motor: {inertia: 1e-4, gear_ratio: 50, viscous: 2e-3, coulomb: [0.01, -0.012]}}
  - {name: elbow, type: revolute, dh: {theta: 0, d: 0, a: 0.3, alpha: pi/2},
     link: {mass: 2, com: [0.2, 0, 0.03], inertia: {xx: 0.01, yy: 0.03, zz: 0.03, xz: 0.001}}}
  - {name: finger, type: revolute, dh: {theta: 0.3, d: 0, a: 0.25, alpha: -pi/2},
     link: {mass: 0.5, com: [0.04, 0.01, 0], inertia: {xx: 0.001, yy: 0.002, zz: 0.002}}}
couplings:
  - {joint: finger, follows: {elbow: 0.7}, offset: 0.2}
motors:
  - {name: m2, turns: {elbow: 20, finger: 3}, rotor: {axis: [0, 1, 0.5], on: shoulder, inertia: 4e-4}}
";

fn read(text: &str) -> Robot {
    let read = Reader::new("robot").trees().couplings().read(text);
    read.unwrap_or_else(|report| panic!("{report}\n{text}")).robot
}

/// The default options with a change.
fn with(change: impl Fn(&mut Options)) -> Options {
    let mut options = Options::default();
    change(&mut options);
    options
}

/// Torques at random states, one after the other, with the friction of the file.
fn states(robot: &Robot, count: u32, seed: u64) -> Motion {
    let (arm, dof, mut rng) = (DynArm::from_robot(&robot.clone().with_rotors()), robot.dof(), Rng::with_seed(seed));
    let empty = || vec![Vec::new(); dof];
    let mut motion =
        Motion { time: Vec::new(), q: empty(), qd: empty(), qdd: empty(), tau: empty(), ..Motion::default() };
    for sample in 0..count {
        let mut numbers = |size: f64| (0..dof).map(|_| size * (2.0 * rng.f64() - 1.0)).collect::<Vec<_>>();
        let (q, qd, qdd) = (numbers(1.5), numbers(2.0), numbers(5.0));
        let tau = arm.inverse_dynamics(&q, &qd, &qdd).unwrap();
        motion.time.push(f64::from(sample) * 0.01);
        for (at, joint) in robot.independent_joints().enumerate() {
            motion.q[at].push(q[at]);
            motion.qd[at].push(qd[at]);
            motion.qdd[at].push(qdd[at]);
            motion.tau[at].push(tau[at] + joint.friction(qd[at]));
        }
    }
    motion
}

fn state(motion: &Motion, sample: usize) -> [Vec<f64>; 4] {
    [&motion.q, &motion.qd, &motion.qdd, &motion.tau].map(|lists| lists.iter().map(|list| list[sample]).collect())
}

/// The robot without its links: what is left are its rotors.
fn without_links(robot: &Robot) -> DynArm {
    let mut robot = robot.clone().with_rotors();
    robot.joints.iter_mut().for_each(|joint| joint.row.link = Link::default());
    DynArm::from_robot(&robot)
}

/// The rows of base parameters at the states of a motion, and the torques less those of rotors: by the runtime alone.
fn equations(robot: &Robot, kept: &[Parameter], motion: &Motion) -> (DMatrix<f64>, DVector<f64>) {
    let (arm, rotors, dof) = (DynArm::from_robot(robot), without_links(robot), robot.dof());
    let mut matrix = DMatrix::zeros(motion.len() * dof, kept.len());
    let mut target = DVector::zeros(motion.len() * dof);
    for sample in 0..motion.len() {
        let [q, qd, qdd, tau] = state(motion, sample);
        let rows = arm.regressor(&q, &qd, &qdd).unwrap();
        let known = rotors.inverse_dynamics(&q, &qd, &qdd).unwrap();
        for (at, joint) in robot.independent_joints().enumerate() {
            for (column, parameter) in kept.iter().enumerate() {
                let Parameter::Link(link, index) = *parameter else { panic!("{parameter:?}") };
                matrix[(sample * dof + at, column)] = rows[at][link][index];
            }
            target[sample * dof + at] = tau[at] - joint.friction(qd[at]) - known[at];
        }
    }
    (matrix, target)
}

/// As many base parameters as the regressor has rank: solved for from torques, they give those of other states.
#[test]
fn base_parameters_of_coupled_robots_give_the_torques_back() {
    for text in [GRIPPER, PALLETISER, ROTORS] {
        let robot = read(text);
        let structure = Structure::new(&robot, with(|options| options.friction = false));
        let kept: Vec<Parameter> = structure.parameters().bases.iter().map(|base| base.kept).collect();
        let (matrix, target) = equations(&robot, &kept, &states(&robot, 60, 1));
        let factors = matrix.svd(true, true);
        let largest = factors.singular_values.max();
        assert!(factors.singular_values.min() > 1e-6 * largest, "{}: the columns are dependent", robot.name);
        let found = factors.solve(&target, 0.0).unwrap();
        let (matrix, target) = equations(&robot, &kept, &states(&robot, 60, 2));
        let error = (&matrix * &found - &target).amax();
        assert!(error < 1e-9 * target.amax(), "{}: {error:e} of {:e}", robot.name, target.amax());
        // and they are the combinations that the regrouping says
        let parameters = structure.parameters();
        let truth = &parameters.regrouping * parameters.of_robot(&robot);
        let scale = truth.amax();
        assert!((&found - &truth).amax() < 1e-9 * scale, "{}: {found} {truth}", robot.name);
    }
}

/// Bound as for a clean log of a tree: passes with weights and a prior are between the rows and the result.
#[test]
fn an_identification_of_exact_torques_is_exact() {
    for text in [GRIPPER, PALLETISER, ROTORS] {
        let robot = read(text);
        let has_friction = robot.joints.iter().any(|joint| joint.motor.is_some());
        let options = with(|options| {
            (options.friction, options.delay, options.cutoff) = (has_friction, false, None);
            (options.widths, options.displacements) = (vec![0.0], Vec::new());
        });
        // the masses of the file are no help
        let mut unknown = robot.clone();
        unknown.joints.iter_mut().for_each(|joint| joint.row.link = Link::default());
        let motion = states(&robot, 2000, 3);
        let found = identify(&unknown, options, 1e-6, |take| take(&motion)).unwrap();
        let parameters = found.structure.parameters();
        let truth = &parameters.regrouping * parameters.of_robot(&robot);
        for (base, truth) in found.bases.iter().zip(truth.iter()) {
            let error = (base.value - truth).abs();
            assert!(error < 1e-6 * (1.0 + truth.abs()), "{} {} {} {truth}", robot.name, base.name, base.value);
        }
        assert_eq!(found.joints.len(), robot.dof());
        // the file that is written is of the same robot: its couplings and motors are those of before
        let identified = read(&found.robot_file("made-up states"));
        let couplings = |robot: &Robot| robot.joints.iter().map(|joint| joint.coupling.clone()).collect::<Vec<_>>();
        assert_eq!((couplings(&identified), &identified.drives), (couplings(&robot), &robot.drives));
        for error in prediction_errors(&identified, [&states(&robot, 500, 4)], None).unwrap() {
            assert!(error.error < 1e-3, "{}: {error:?}", robot.name);
        }
    }
}

/// Rotors of the list `motors` are known: who asks for rotors gets those of no joint besides.
#[test]
fn rotors_of_the_list_are_known() {
    let robot = read(ROTORS);
    let structure = Structure::new(&robot, with(|options| options.rotors = true));
    assert!(!structure.options().rotors);
    assert!(structure.parameters().bases.iter().all(|base| matches!(base.kept, Parameter::Link(..))));
    // of a gripper without them, the rotors of the three coordinates are unknown
    let gripper = read(GRIPPER);
    let structure = Structure::new(&gripper, with(|options| options.rotors = true));
    assert_eq!(structure.parameters().regrouping.ncols(), 4 * 10 + 3);
    let (mut information, motion) = (Information::new(&structure), states(&gripper, 300, 5));
    information.absorb(&structure, &motion, None).unwrap();
    assert_eq!(Fit::new(&structure, &information, 1.0).efforts.len(), 3);
}
