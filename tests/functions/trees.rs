//! Trees: every function of random ones beside projected Newton-Euler by products of 4 × 4 matrices, and beside the
//! runtime; the same tree by rows in another order.

use std::fmt::Write as _;

use fastrand::Rng;
use nalgebra::{Matrix3, Vector3};
use rne::{BaseMotion, Payload, Wrench};
use rne_codegen::{Algorithm, Compiler, Form, Function, Reason, Refusal};
use rne_model::{Convention, Reader, Robot};

use crate::arm::{Arm, Given, Maker};
use crate::case::payload;
use crate::check::{Worst, error_on_scale, flat};
use crate::equality::compare_at_states;
use crate::robots;
use crate::tree_oracle as oracle;
use crate::tree_oracle::Motion;

const TOLERANCE: f64 = 1e-12;

pub(crate) fn robot(yaml: &str) -> Robot {
    Reader::new("tree").trees().read(yaml).unwrap_or_else(|report| panic!("{report}\n{yaml}")).robot
}

/// A random robot file made a tree: any earlier row is a parent, and some rows begin at a placement.
fn tree(seed: u64, dof: usize) -> String {
    let mut rng = Rng::with_seed(seed);
    let yaml = robots::yaml(seed, dof).replace("format: 1", "format: 2");
    let is_modified = yaml.contains("convention: modified");
    let base = "base: {xyz: [0.3, -0.7, 1.1], rpy: [0.4, -1.2, 2.5]}";
    let (mut text, mut index) = (String::new(), 0);
    for line in yaml.lines() {
        if line == "joints:" {
            text.push_str(base);
            text.push('\n');
            if !yaml.contains("\ntool:") {
                let _ = writeln!(text, "tool: {{on: j{}}}", rng.usize(0..dof));
            }
        }
        let mut any = |scale: f64| (2.0 * rng.f64() - 1.0) * scale;
        let at = format!(
            "at: {{xyz: [{}, {}, {}], rpy: [{}, {}, {}]}}",
            any(0.5),
            any(0.5),
            any(0.5),
            any(3.0),
            any(3.0),
            any(3.0)
        );
        let (gamma, b) = (any(3.0), any(0.5));
        let place = rng.usize(0..4);
        if let Some(kind) = line.strip_prefix("  - type: ") {
            let _ = writeln!(text, "  - name: j{index}\n    type: {kind}");
            match rng.usize(0..3) {
                0 => {}
                1 => text.push_str("    parent: base\n"),
                _ if index == 0 => {}
                _ => {
                    let _ = writeln!(text, "    parent: j{}", rng.usize(0..index));
                }
            }
            if place == 0 {
                let _ = writeln!(text, "    {at}");
            }
            index += 1;
        } else if let (Some(row), true, 1) = (line.strip_prefix("    dh: {"), is_modified, place) {
            // the draw of this line, not that of its joint: a joint with `at` has no gamma
            let has_at =
                text.lines().rev().take_while(|line| !line.starts_with("  - ")).any(|line| line.contains("at: {"));
            let before = if has_at { String::new() } else { format!("gamma: {gamma}, b: {b}, ") };
            let _ = writeln!(text, "    dh: {{{before}{row}");
        } else if let Some(tool) = line.strip_prefix("tool: {") {
            let _ = writeln!(text, "tool: {{on: j{}, {tool}", rng.usize(0..dof));
        } else {
            text.push_str(line);
            text.push('\n');
        }
    }
    text
}

struct State {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    tau: Vec<f64>,
    wrench: Wrench<f64>,
    payload: Payload<f64>,
    base: BaseMotion<f64>,
}

impl State {
    fn random(seed: u64, dof: usize) -> Self {
        let mut rng = Rng::with_seed(seed);
        let mut array = |scale: f64| -> Vec<f64> { (0..dof).map(|_| (2.0 * rng.f64() - 1.0) * scale).collect() };
        let (q, qd, qdd, tau) = (array(3.0), array(2.0), array(5.0), array(20.0));
        let mut triple = || [(); 3].map(|()| (2.0 * rng.f64() - 1.0) * 10.0);
        let wrench = Wrench { force: triple(), moment: triple() };
        let [omega, omega_dot, velocity, acceleration, gravity] = [(); 5].map(|()| triple());
        let base = BaseMotion { omega, omega_dot, velocity, acceleration, gravity };
        Self { q, qd, qdd, tau, wrench, payload: payload(&mut rng), base }
    }

    fn given(&self) -> Given<'_, f64> {
        let Self { q, qd, qdd, tau, wrench, payload, base } = self;
        Given { q, qd, qdd, tau, wrench: *wrench, payload: *payload, base: *base }
    }
}

fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

fn times(matrix: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

fn rows(columns: &[[Vector3<f64>; 2]]) -> Vec<f64> {
    (0..6).flat_map(|row| columns.iter().map(move |parts| parts[row / 3][row % 3])).collect()
}

fn pose((rotation, translation): (Matrix3<f64>, Vector3<f64>)) -> Vec<f64> {
    [rotation.transpose().as_slice(), translation.as_slice()].concat()
}

/// What a function returns, without a recursion; `None` where the oracle says it by a property instead.
fn expected(robot: &Robot, function: Function, state: &State) -> Option<Vec<f64>> {
    let State { q, qd, qdd, tau, wrench, payload, base } = state;
    let zeros = vec![0.0; q.len()];
    let fixed = BaseMotion::fixed(robot.gravity);
    let torques = |qd: &[f64], qdd: &[f64], base, payload| {
        oracle::torques(robot, &Motion { joints: [q, qd, qdd], base }, payload)
    };
    let loaded = Some(payload);
    let world = oracle::parts(&oracle::placement_of_base(robot));
    let still = Motion { joints: [q, &zeros, &zeros], base: BaseMotion::fixed([0.0; 3]) };
    let in_world = |(r, p): (Matrix3<f64>, Vector3<f64>)| (world.0 * r, world.0 * p + world.1);
    let tip = robot.tip();
    let of_tip = || oracle::jacobian(robot, &tip, q, &Vector3::zeros());
    let of_wrench = || -> Vec<f64> {
        let (r, _) = oracle::parts(&oracle::frame(robot, &tip, &still)[0]);
        let (force, moment) = (r * Vector3::from(wrench.force), r * Vector3::from(wrench.moment));
        of_tip().iter().map(|[v, w]| v.dot(&force) + w.dot(&moment)).collect()
    };
    Some(match function {
        Function::InverseDynamics | Function::InverseDynamicsFromSinCos => torques(qd, qdd, fixed, None),
        Function::InverseDynamicsWithWrench => sum(&torques(qd, qdd, fixed, None), &of_wrench()),
        Function::InverseDynamicsWithPayload => torques(qd, qdd, fixed, loaded),
        Function::InverseDynamicsOnMovingBase => torques(qd, qdd, *base, None),
        Function::GravityTorques => torques(&zeros, &zeros, fixed, None),
        Function::GravityTorquesWithPayload => torques(&zeros, &zeros, fixed, loaded),
        Function::BiasTorques => torques(qd, &zeros, fixed, None),
        Function::BiasTorquesWithPayload => torques(qd, &zeros, fixed, loaded),
        Function::MassMatrix => flat(oracle::mass_matrix(robot, q, None)),
        Function::MassMatrixWithPayload => flat(oracle::mass_matrix(robot, q, loaded)),
        Function::ForwardKinematics => pose(in_world(oracle::parts(&oracle::frame(robot, &tip, &still)[0]))),
        Function::LinkPoses => (0..q.len())
            .flat_map(|index| pose(in_world(oracle::parts(&oracle::link_pose(robot, index, &still)))))
            .collect(),
        Function::Jacobian => rows(&of_tip().iter().map(|it| it.map(|part| world.0 * part)).collect::<Vec<_>>()),
        Function::JacobianRateTimesVelocity => {
            let motion = Motion { joints: [q, qd, &zeros], ..still };
            let [_, parts] = oracle::rates(&oracle::frame(robot, &tip, &motion), &Vector3::zeros());
            parts.iter().flat_map(|part| (world.0 * part).as_slice().to_vec()).collect()
        }
        Function::WrenchTorques => of_wrench(),
        Function::KineticEnergy => {
            let momentum = times(&oracle::mass_matrix(robot, q, None), qd);
            vec![momentum.iter().zip(qd).map(|(a, b)| a * b).sum::<f64>() / 2.0]
        }
        Function::PotentialEnergy => vec![-Vector3::from(robot.gravity).dot(&oracle::first_moment(robot, q).1)],
        Function::CentreOfMass => {
            let (mass, moment) = oracle::first_moment(robot, q);
            (world.0 * (moment / mass) + world.1).as_slice().to_vec()
        }
        Function::CentreOfMassJacobian => {
            let mass = oracle::first_moment(robot, q).0;
            let columns: Vec<_> =
                oracle::first_moment_rates(robot, q).iter().map(|column| world.0 * (column / mass)).collect();
            (0..3).flat_map(|row| columns.iter().map(move |column| column[row]).collect::<Vec<_>>()).collect()
        }
        Function::JointWrenches => {
            let needed = oracle::needed(robot, &Motion { joints: [q, qd, qdd], base: fixed }, None);
            let carries = |joint: usize, mut link: usize| loop {
                if link == joint {
                    return true;
                }
                match robot.parent(link) {
                    Some(parent) => link = parent,
                    None => return false,
                }
            };
            let of_joint = |joint: usize| {
                let (r, point) = oracle::joint_frame(robot, joint, &still);
                let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
                for (_, it) in needed.iter().enumerate().filter(|(link, _)| carries(joint, *link)) {
                    force += it.force;
                    moment += it.moment + (it.centre - point).cross(&it.force);
                }
                [r.tr_mul(&force), r.tr_mul(&moment)].iter().flat_map(|it| it.as_slice().to_vec()).collect::<Vec<_>>()
            };
            (0..q.len()).flat_map(of_joint).collect()
        }
        Function::MomentumAndRate | Function::MomentumAndRateWithPayload => {
            let of = if function == Function::MomentumAndRate { None } else { loaded };
            let momentum = times(&oracle::mass_matrix(robot, q, of), qd);
            // ṗ = τ - g + Cᵀ q̇, where (Cᵀ q̇)_j is half of the derivative of q̇ · M q̇ by q_j: by its bilinear parts
            let half = oracle::kinetic_energy_by_position(robot, q, qd, of);
            let gravity = torques(&zeros, &zeros, fixed, of);
            let rate: Vec<f64> = (0..q.len()).map(|j| tau[j] + half[j] - gravity[j]).collect();
            [momentum, rate].concat()
        }
        _ => return None,
    })
}

/// Scale of rounding: numbers of a function that vanish are sums of larger parts.
fn scale(robot: &Robot, function: Function, state: &State) -> f64 {
    let needed = oracle::needed(
        robot,
        &Motion { joints: [&state.q, &state.qd, &state.qdd], base: state.base },
        Some(&state.payload),
    );
    let largest =
        needed.iter().map(|it| it.force.norm() * (1.0 + it.centre.norm()) + it.moment.norm()).fold(0.0, f64::max);
    match function {
        Function::PotentialEnergy => largest,
        // centripetal, one metre from an axis
        Function::JacobianRateTimesVelocity => state.qd.iter().map(|qd| qd * qd).fold(0.0, f64::max),
        _ if function.returns_torques() => largest,
        _ => 0.0,
    }
}

#[test]
fn every_function_of_a_tree_is_projected_newton_euler() {
    for maker in Maker::ALL {
        // the oracle multiplies matrices for every pair of joints, so long trees are for an exhaustive run
        let (trees, longest) = match maker {
            Maker::Runtime if shipped::is_exhaustive() => (300, 12),
            Maker::Runtime => (10, 6),
            Maker::Code(_) if shipped::is_exhaustive() => (20, 6),
            Maker::Code(_) => (3, 4),
        };
        let mut worst = Worst::default();
        let mut seen = 0;
        for seed in 0..trees {
            let dof = 2 + usize::try_from(seed).expect("small") % (longest - 1);
            let robot = robot(&tree(seed, dof));
            let arm = Arm::new(&robot, maker);
            let state = State::random(seed, dof);
            for function in Function::ALL {
                let Some(expected) = expected(&robot, function, &state) else { continue };
                if expected.iter().any(|x| !x.is_finite()) {
                    continue; // the centre of mass of a robot without mass
                }
                let found = arm.numbers(function, &state.given());
                let error = error_on_scale(&found, &expected, scale(&robot, function, &state));
                assert!(error <= TOLERANCE, "{maker}, tree {seed}, {function}: {error:e}");
                worst.see(function.name(), error);
                seen += 1;
            }
        }
        assert!(seen > 20 * trees);
        worst.at_most(TOLERANCE, &format!("trees, {maker}"));
    }
}

/// The regressor column by column: the part of one link in the torques.
#[test]
fn each_link_has_its_part_in_the_torques() {
    for maker in Maker::ALL {
        for seed in 0..if maker == Maker::Runtime { 30 } else { 4 } {
            let dof = 2 + usize::try_from(seed).expect("small") % 4;
            let robot = robot(&tree(seed, dof));
            let arm = Arm::new(&robot, maker);
            let state = State::random(seed, dof);
            let State { q, qd, qdd, .. } = &state;
            let motion = Motion { joints: [q, qd, qdd], base: BaseMotion::fixed(robot.gravity) };
            let parts = oracle::torque_parts(&robot, &motion, None);
            let matrix = arm.regressor(q, qd, qdd);
            let parameters = arm.runtime.inertial_parameters();
            for (joint, row) in matrix.iter().enumerate() {
                let found: Vec<f64> =
                    (0..dof).map(|link| (0..10).map(|k| row[10 * link + k] * parameters[link][k]).sum()).collect();
                let expected: Vec<f64> = parts.iter().map(|part| part[joint]).collect();
                let error = error_on_scale(&found, &expected, scale(&robot, Function::InverseDynamics, &state));
                assert!(error <= TOLERANCE, "{maker}, tree {seed}, joint {joint}: {error:e}");
            }
        }
    }
}

#[test]
fn code_of_trees_is_the_runtime() {
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        for seed in 0..8 {
            let dof = 2 + usize::try_from(seed).expect("small") % 3;
            compare_at_states(&Arm::new(&robot(&tree(seed, dof)), maker), maker, &mut worst);
        }
        worst.at_most(TOLERANCE, &format!("trees, {maker}"));
    }
}

/// The first of four legs on a base, each with the first axis in another direction: a quadruped whose trunk is held.
fn legs(count: usize) -> Robot {
    let places = [("lf", "pi/2", 0.3), ("rf", "-pi/2", 0.3), ("lh", "pi/2", -0.3), ("rh", "-pi/2", -0.3)];
    let mut yaml = "{format: 2, name: quadruped, source: own, convention: modified, gravity: [0, 0, -9.81], \
                    tool: {on: lf3}, joints: ["
        .to_owned();
    for (name, gamma, d) in places.into_iter().take(count) {
        let hip = format!("gamma: {gamma}, b: 0.1, alpha: pi/2, a: 0.2, theta: 0, d: {d}");
        let _ =
            write!(yaml,
            "{{name: {name}1, parent: base, type: revolute, dh: {{{hip}}}, link: {{mass: 2, com: [0.01, 0.02, 0.15],
               inertia: {{xx: 0.05, yy: 0.055, zz: 0.006, xy: 0.001, xz: -0.002, yz: 0.003}}}}}},
             {{name: {name}2, type: revolute, dh: {{alpha: pi/2, a: 0.08, theta: 0, d: 0}}, link: {{mass: 2.5,
               com: [0.15, -0.03, 0.02], inertia: {{xx: 0.004, yy: 0.027, zz: 0.028, xy: -0.003}}}}}},
             {{name: {name}3, type: revolute, dh: {{alpha: 0, a: 0.35, theta: 0, d: 0}}, link: {{mass: 0.9,
               com: [0.12, 0.01, 0], inertia: {{xx: 0.001, yy: 0.013, zz: 0.013, xy: 0.0002}}}}}}, "
        );
    }
    yaml.push_str("]}");
    robot(&yaml)
}

/// Every function that has a reduced recursion is written by it on trees, and costs less than the seven steps.
#[test]
fn trees_have_the_reduced_recursion() {
    for robot in [legs(4), robot(&tree(1, 4)), robot(&tree(2, 5)), robot(&tree(3, 6))] {
        let compiler = Compiler::new(&robot);
        let mut seen = 0;
        for function in Function::ALL.into_iter().filter(|function| Algorithm::is_planned(*function)) {
            let [plain, reduced] = [Form::SevenSteps, Form::Reduced].map(|form| compiler.compile(function, form));
            let (plain, reduced) = (plain.expect("a program"), reduced.expect("a program"));
            if matches!(reduced.refusals[..], [Refusal { reason: Reason::DividesByZero, .. }]) {
                continue; // links without mass behind a joint
            }
            assert!(reduced.refusals.is_empty(), "{} {function}: {:?}", robot.name, reduced.refusals);
            assert!(reduced.proof.is_some(), "{} {function}", robot.name);
            let [plain, reduced] = [plain, reduced].map(|program| program.operations().total());
            assert!(reduced < plain, "{} {function}: {reduced} of {plain}", robot.name);
            seen += 1;
        }
        assert!(seen > 10, "{}: {seen} functions", robot.name);
    }
}

/// A joint does not move the links of another branch: no element of M between them is computed, and none of its factors
/// fills. So four legs take four times the operations of one.
#[test]
fn zeros_of_branches_are_not_computed() {
    for function in [Function::MassMatrix, Function::ForwardDynamics, Function::InverseMassMatrix] {
        for form in Form::ALL {
            let [one, four] = [1, 4].map(|count| {
                let program = Compiler::new(&legs(count)).compile(function, form).expect("a program");
                program.operations().total()
            });
            assert!(four <= 4 * one, "{form} {function}: {four} for four legs, {one} for one");
        }
    }
}

/// Rows in another order, each still below its parent: the same torques by name.
#[test]
fn the_order_of_rows_changes_no_torque() {
    for seed in 0..40 {
        let dof = 3 + usize::try_from(seed).expect("small") % 8;
        let robot = robot(&tree(seed, dof));
        let state = State::random(seed, dof);
        // any joint whose parent stands already is next
        let (mut rng, mut order) = (Rng::with_seed(seed), Vec::new());
        while order.len() < dof {
            let next = rng.usize(0..dof);
            if !order.contains(&next) && robot.parent(next).is_none_or(|parent| order.contains(&parent)) {
                order.push(next);
            }
        }
        let place = |joint: usize| order.iter().position(|other| *other == joint).expect("all are in it");
        let mut other = robot.clone();
        other.tip_on = robot.tip().on.map(place);
        other.joints = order.iter().map(|&joint| robot.joints[joint].clone()).collect();
        for (joint, &old) in other.joints.iter_mut().zip(&order) {
            let placement = robot.joints[old].branch.map_or(rne_model::Transform::IDENTITY, |branch| branch.placement);
            joint.branch = Some(rne_model::FixedFrame { on: robot.parent(old).map(place), placement });
        }
        let ordered = |values: &[f64]| -> Vec<f64> { order.iter().map(|&joint| values[joint]).collect() };
        let (q, qd, qdd) = (ordered(&state.q), ordered(&state.qd), ordered(&state.qdd));
        let [arm, other] = [&robot, &other].map(|robot| Arm::new(robot, Maker::Runtime));
        let expected = ordered(&arm.inverse_dynamics_with_wrench(&state.q, &state.qd, &state.qdd, &state.wrench));
        let found = other.inverse_dynamics_with_wrench(&q, &qd, &qdd, &state.wrench);
        let error = error_on_scale(&found, &expected, scale(&robot, Function::InverseDynamics, &state));
        assert!(error <= TOLERANCE, "tree {seed}: {error:e}");
    }
}

/// Placements: `gamma` and `b` of a modified row are an `at`.
#[test]
fn gamma_and_b_are_a_placement() {
    let file = |row: &str, at: &str| {
        robot(&format!(
            "{{format: 2, name: x, source: own, convention: modified, gravity: [0, 0, -9.81], tool: {{on: c}}, joints: [
            {{name: a, type: revolute, dh: {{theta: 0.1, d: 0.2, a: 0.3, alpha: 0.4}}, link: {{mass: 1}}}},
            {{name: b, type: revolute, dh: {{theta: 0.1, d: 0.2, a: 0.3, alpha: 0.4}}, link: {{mass: 1}}}},
            {{name: c, parent: a, {at} type: prismatic, dh: {{{row} theta: 0.5, d: 0.6, a: 0.7, alpha: 0.8}},
              link: {{mass: 2}}}}]}}"
        ))
    };
    let by_row = file("gamma: pi/3, b: 0.25,", "");
    assert_eq!(by_row, file("", "at: {xyz: [0, 0, 0.25], rpy: [0, 0, pi/3]},"));
    assert_eq!((by_row.convention, by_row.parent(2)), (Convention::Modified, Some(0)));
}
