//! The list `motors`: every function of random trees with rotors beside the same trees whose rotors are bodies, each a
//! link of its own that follows the joints with which the rotor turns, and beside Lagrange's equations of the energy of
//! the rotors.

use std::fmt::Write as _;

use fastrand::Rng;
use rne_codegen::{Argument, Attempt, Compiler, Form, Function};
use rne_model::{
    Angle, Coupling, Dh, FixedFrame, FloatingBase, Inertia, InertiaReference, Joint, JointKind, Limits, Link, Reader,
    Robot, Row, Transform,
};

use crate::arm::{Arm, Maker};
use crate::check::{Worst, conditioning, error_on_scale};
use crate::equality::compare_at_states;
use crate::tree_functions::{State, contact_condition, expected, scale};
use crate::{random_motors, random_trees};

const TOLERANCE: f64 = 1e-12;

/// How the other axes of a robot are.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Shape {
    /// As those of random trees.
    Any,
    /// All parallel, so that no product of rates is left of most rotors.
    Parallel,
}

/// A random tree with motors, and with followers if they are wanted.
pub(crate) fn robot(seed: u64, dof: usize, shape: Shape, follows: bool) -> Robot {
    let mut rng = Rng::with_seed(seed ^ 0xA0);
    let mut text = String::new();
    for line in random_trees::yaml(seed, dof).lines() {
        let is_placement = line.starts_with("    at:") || line.starts_with("    type:");
        if line.starts_with("    motor:") || shape == Shape::Parallel && is_placement {
            continue;
        }
        let _ = match line.split_once("alpha: ") {
            _ if line.starts_with("  - name:") && shape == Shape::Parallel => {
                writeln!(text, "{line}\n    type: revolute")
            }
            Some((before, alpha)) if shape == Shape::Parallel => {
                let (_, behind) = alpha.split_at(alpha.find([',', '}']).expect("more"));
                let angle = ["0", "0", "pi"][rng.usize(0..3)];
                writeln!(text, "{before}alpha: {angle}{behind}")
            }
            _ => writeln!(text, "{line}"),
        };
    }
    if follows {
        let follower = rng.usize(0..dof);
        let followed = (follower + 1 + rng.usize(0..dof - 1)) % dof;
        let _ = writeln!(text, "couplings:\n  - {{joint: j{follower}, follows: {{j{followed}: -1.5}}, offset: 0.3}}");
    }
    text.push_str(&random_motors::yaml(&mut rng, dof));
    let reader = Reader::new("motors").trees().couplings();
    reader.read(&text).unwrap_or_else(|report| panic!("{report}\n{text}")).robot
}

/// Rotors about any axis on any link, and on a floating base, are in the reduced form of every function that
/// has one: no plan is refused because of them. Where the seven steps themselves cannot be read exactly, none is made.
#[test]
fn rotors_of_floating_bases_have_a_reduced_form() {
    for function in [
        Function::InverseDynamicsOfFloatingBase,
        Function::FloatingMassMatrix,
        Function::FloatingForwardDynamicsWithPayload,
        Function::FloatingInverseDynamicsDerivatives,
    ] {
        let mut reduced = 0;
        for seed in 0..8 {
            let robot = robot(seed, 3, Shape::Any, seed % 2 == 0);
            let program = Compiler::new(&robot).compile(function, Form::Reduced).unwrap_or_else(|it| panic!("{it}"));
            let is_exact = !program.refusals.iter().any(|refusal| refusal.attempt == Attempt::EveryValueOnce);
            assert!(program.refusals.is_empty() || !is_exact, "{seed}, {function}: {:?}", program.refusals);
            reduced += usize::from(program.refusals.is_empty());
        }
        assert!(reduced >= 6, "{function}: {reduced}");
    }
}

/// The same robot with each rotor as a link of its own: the carrier loses the mass and inertia of its rotor.
fn with_bodies(robot: &Robot) -> Robot {
    let mut found = Robot { drives: Vec::new(), tip_on: robot.tip().on, ..robot.clone() };
    for (index, (rotor, turns)) in robot.spinning_rotors().enumerate() {
        let ([x, y, z], inertia) = (rotor.axis, rotor.inertia);
        let without = || FloatingBase { name: "trunk".to_owned(), link: Link::default() };
        let tensor = match rotor.on {
            Some(on) => &mut found.joints[on].row.link.inertia,
            None => &mut found.floating_base.get_or_insert_with(without).link.inertia,
        };
        let parts = [
            (&mut tensor.xx, x * x),
            (&mut tensor.yy, y * y),
            (&mut tensor.zz, z * z),
            (&mut tensor.xy, x * y),
            (&mut tensor.xz, x * z),
            (&mut tensor.yz, y * z),
        ];
        for (element, part) in parts {
            *element -= inertia * part;
        }
        let mut follows: Vec<(usize, f64)> = Vec::new();
        for &(joint, n) in turns {
            let followed = robot.joints[joint].coupling.as_ref().map_or(vec![(joint, 1.0)], |it| it.follows.clone());
            for (joint, ratio) in followed {
                match follows.iter_mut().find(|(other, _)| *other == joint) {
                    Some((_, sum)) => *sum += n * ratio,
                    None => follows.push((joint, n * ratio)),
                }
            }
        }
        follows.sort_by_key(|(joint, _)| *joint);
        // z of the placement is the axis
        let rpy = [0.0, x.hypot(y).atan2(z), y.atan2(x)].map(Angle::new);
        let zero = Angle::new(0.0);
        let spinning = Inertia { zz: inertia, ..Inertia::default() };
        found.joints.push(Joint {
            name: format!("rotor{index}"),
            row: Row {
                kind: JointKind::Revolute,
                dh: Dh { theta: zero, d: 0.0, a: 0.0, alpha: zero },
                link: Link { inertia: spinning, ..Link::default() },
            },
            branch: Some(FixedFrame { on: rotor.on, placement: Transform { xyz: [0.0; 3], rpy } }),
            written_inertia: (spinning, InertiaReference::Com),
            limits: Limits::default(),
            coupling: Some(Coupling { follows, offset: 0.0 }),
            motor: None,
            coulomb_width: None,
            coulomb_displacement: None,
        });
    }
    found
}

/// A state of all joints, for the scale of rounding.
fn of_all_joints(robot: &Robot, state: &State) -> State {
    let of_joints = |values: &[f64]| -> Vec<f64> {
        let mut all = vec![0.0; robot.joints.len()];
        for (joint, value) in robot.coordinates().zip(values) {
            all[joint] = *value;
        }
        all
    };
    State { tau: of_joints(&state.tau), ..state.with_joints([&state.q, &state.qd, &state.qdd].map(|x| of_joints(x))) }
}

/// The scale of a function, with the torques of rotors where it is one of torques.
fn scale_with_rotors(robot: &Robot, function: Function, state: &State) -> f64 {
    let free = Robot {
        drives: Vec::new(),
        joints: robot.joints.iter().cloned().map(|joint| Joint { coupling: None, ..joint }).collect(),
        ..robot.clone()
    };
    let of_links = scale(&free, function, &of_all_joints(robot, state));
    let fastest = state.qd.iter().chain(&state.qdd).fold(1.0_f64, |most, x| most.max(x.abs()));
    let mut of_rotors = 0.0;
    for (rotor, turns) in robot.spinning_rotors() {
        let spin: f64 = turns.iter().map(|(_, n)| n.abs()).sum();
        of_rotors += rotor.inertia * (1.0 + spin) * (1.0 + spin) * fastest * fastest;
    }
    if of_links > 0.0 { of_links + of_rotors } else { 0.0 }
}

#[test]
fn rotors_are_bodies_of_their_own() {
    for maker in Maker::ALL {
        let (robots_of, longest) = match maker {
            _ if shipped::is_exhaustive() => (150, 7),
            Maker::Runtime => (24, 6),
            Maker::Code(_) => (10, 4),
        };
        let mut worst = Worst::default();
        let mut seen = 0;
        for seed in 0..robots_of {
            let dof = 2 + usize::try_from(seed).expect("small") % (longest - 1);
            let shape = if seed % 3 == 0 { Shape::Parallel } else { Shape::Any };
            let robot = robot(seed, dof, shape, seed % 2 == 0);
            let bodies = Arm::new(&with_bodies(&robot), Maker::Runtime);
            let arm = Arm::new(&robot, maker);
            let state = State::random(seed, robot.dof());
            for function in Function::OF_TREES.into_iter().filter(|function| !function.is_of_every_link()) {
                let expected = bodies.numbers(function, &state.given());
                let magnification = if function == Function::ForwardDynamicsInContact {
                    let numbers = |function| bodies.numbers(function, &state.given());
                    let [mass, jacobians] = [Function::FloatingMassMatrix, Function::TipJacobians].map(numbers);
                    match contact_condition(&robot, &mass, &jacobians) {
                        number if number < 1e10 => number,
                        _ => continue,
                    }
                } else if function.inverts_mass() {
                    let mass = if function.is_of_floating_base() {
                        bodies.runtime.floating_mass_matrix(&state.q)
                    } else {
                        bodies.runtime.mass_matrix(&state.q)
                    };
                    match conditioning(&mass.expect("one per joint")) {
                        Some(it) if it.number < 1e10 => it.number,
                        _ => continue,
                    }
                } else {
                    1.0
                };
                if expected.iter().any(|x| !x.is_finite()) {
                    continue; // the centre of mass of a robot without mass
                }
                let found = arm.numbers(function, &state.given());
                let scale = scale_with_rotors(&robot, function, &state);
                let error = error_on_scale(&found, &expected, scale) / magnification;
                assert!(
                    error <= TOLERANCE,
                    "{maker}, robot {seed}, {function}: {error:e}\n{found:?}\n{expected:?}\n{:?}\n{:?}",
                    robot.drives,
                    robot.joints.iter().map(|joint| (joint.branch, &joint.coupling)).collect::<Vec<_>>()
                );
                worst.see(function.name(), error);
                seen += 1;
            }
        }
        assert!(seen > 15 * robots_of, "{seen} comparisons of {robots_of} robots");
        worst.at_most(TOLERANCE, &format!("rotors, {maker}"));
    }
}

/// The oracle knows the energy of a rotor and nothing of its moments; it has no rotors on a base that moves.
#[test]
fn rotors_obey_lagrange() {
    for maker in Maker::ALL {
        let robots_of = match maker {
            _ if shipped::is_exhaustive() => 40,
            Maker::Runtime => 4,
            Maker::Code(_) => 2,
        };
        let mut worst = Worst::default();
        for seed in 0..robots_of {
            let dof = 2 + usize::try_from(seed).expect("small") % 2;
            let shape = if seed % 4 == 3 { Shape::Parallel } else { Shape::Any };
            let robot = robot(seed + 100, dof, shape, false);
            let arm = Arm::new(&robot, maker);
            let state = State::random(seed, dof);
            let is_known = |function: &Function| {
                !function.inverts_mass()
                    && !function.takes(Argument::Base)
                    && !function.is_of_floating_base()
                    && *function != Function::JointWrenches
            };
            for function in Function::OF_TREES.into_iter().filter(is_known) {
                let expected = expected(&robot, function, &state);
                if expected.iter().any(|x| !x.is_finite()) {
                    continue;
                }
                let scale = scale_with_rotors(&robot, function, &state);
                let error = error_on_scale(&arm.numbers(function, &state.given()), &expected, scale);
                assert!(error <= TOLERANCE, "{maker}, robot {seed}, {function}: {error:e}\n{:?}", robot.drives);
                worst.see(function.name(), error);
            }
        }
        worst.at_most(TOLERANCE, &format!("energy of rotors, {maker}"));
    }
}

#[test]
fn code_of_robots_with_rotors_is_the_runtime() {
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        for seed in 0..if shipped::is_exhaustive() { 60 } else { 8 } {
            let dof = 2 + usize::try_from(seed).expect("small") % 3;
            let shape = if seed % 3 == 0 { Shape::Parallel } else { Shape::Any };
            compare_at_states(&Arm::new(&robot(seed + 200, dof, shape, seed % 2 == 1), maker), maker, &mut worst);
        }
        worst.at_most(TOLERANCE, &format!("rotors, {maker}"));
    }
}

/// What motors give is what the joints get: τ_m · N q̇ = q̇ · Nᵀ τ_m, and N⁻ᵀ undoes Nᵀ.
#[test]
fn speeds_and_torques_of_motors_are_maps_of_one_matrix() {
    let mut with_inverse = 0;
    for seed in 0..40 {
        let robot = robot(seed, 2 + usize::try_from(seed).expect("small") % 2, Shape::Any, seed % 2 == 0);
        let arm = Arm::new(&robot, Maker::Runtime).runtime;
        let mut rng = Rng::with_seed(seed);
        let mut random = |count: usize| (0..count).map(|_| 2.0 * rng.f64() - 1.0).collect::<Vec<f64>>();
        let (of_motors, qd) = (random(robot.drives.len()), random(robot.dof()));
        assert_eq!(arm.motor_count(), robot.drives.len());
        let speeds = arm.motor_speeds(&qd).expect("one per joint");
        let torques = arm.joint_torques(&of_motors).expect("one per motor");
        let power = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let [given, got] = [power(&of_motors, &speeds), power(&torques, &qd)];
        assert!((given - got).abs() <= 1e-13 * (1.0 + given.abs()), "{given} {got}");
        if let Some(back) = arm.motor_torques(&torques).expect("one per joint") {
            assert!(error_on_scale(&back, &of_motors, 1.0) < 1e-10, "{back:?} {of_motors:?}");
            with_inverse += 1;
        }
        assert!(arm.joint_torques(&vec![0.0; robot.drives.len() + 1]).is_err());
    }
    assert!(with_inverse > 3, "{with_inverse} robots have an inverse");
}

const LEG: &str = "
format: 2
name: leg
source: round numbers
convention: modified
gravity: [0, 0, -9.81]
joints:
  - name: abduction
    type: revolute
    dh: {alpha: pi/2, a: 0.19, theta: 0, d: 0}
    link: {mass: 0.5, com: [0.01, 0.04, 0.002], inertia: {xx: 4e-4, yy: 6e-4, zz: 5e-4, xy: 2e-5, xz: 1e-5, yz: 3e-5}}
  - name: hip
    type: revolute
    dh: {alpha: pi/2, a: 0.06, theta: pi/2, d: 0.01}
    link: {mass: 0.6, com: [0.02, 0.02, 0.01], inertia: {xx: 2e-3, yy: 2e-3, zz: 4e-4, xy: 3e-5, xz: 2e-5, yz: 1e-5}}
  - name: knee
    type: revolute
    dh: {alpha: 0, a: 0.21, theta: 0, d: 0}
    link: {mass: 0.1, com: [0.06, 0.001, 0.002], inertia: {xx: 1e-5, yy: 3e-4, zz: 3e-4, xy: 1e-6, xz: 1e-6, yz: 2e-6}}
motors:
  - {turns: {abduction: 6}, rotor: {axis: [0, -1, 0], inertia: 7.2e-5}}
  - {turns: {hip: 6}, rotor: {axis: [0, -1, 0], inertia: 7.2e-5}}
  - {turns: {knee: 9.33}, rotor: {axis: [0, 0, 1], inertia: 7.2e-5}}
";

/// A leg with a rotor for each joint about an axis that is parallel to that of the joint: the rotor on the base costs
/// nothing, the others a product and a sum.
#[test]
fn a_rotor_parallel_to_its_joint_costs_two_operations() {
    let (bare, _) = LEG.split_once("motors:").expect("the list stands last");
    let operations = |text: &str| {
        let reader = Reader::new("leg").trees().couplings();
        let robot = reader.read(text).unwrap_or_else(|report| panic!("{report}")).robot;
        let program = Compiler::new(&robot).compile(Function::InverseDynamics, Form::Reduced);
        program.expect("it compiles").operations().total()
    };
    assert_eq!(operations(LEG), operations(bare) + 4);
}
