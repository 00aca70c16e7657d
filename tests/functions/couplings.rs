//! Couplings: every function of random trees with followers beside the same trees whose joints all move freely, taken
//! at the positions, rates and accelerations that the couplings give, and projected here: τ = Gᵀ τ', M = Gᵀ M' G. What
//! is projected is projected Newton-Euler by products of 4 × 4 matrices, no recursion.

use std::fmt::Write as _;

use fastrand::Rng;
use rne_codegen::{Compiler, Form, Function, Reason, Refusal};
use rne_model::{FixedFrame, Reader, Robot, Transform};

use crate::arm::{Arm, Maker};
use crate::check::{ROOT, Worst, error_on_scale};
use crate::equality::compare_within;
use crate::random_trees;
use crate::tree_functions::{State, expected, scale};

const TOLERANCE: f64 = 1e-12;

/// Ratios that merge with other angles, a decimal, and two that have more digits than a billionth.
const RATIOS: [f64; 7] = [1.0, -1.0, 2.0, -0.5, 1.13, std::f64::consts::FRAC_1_PI, -1.234_567_890_123_4];

/// Followers: the joint, what it follows with which ratios, and its offset.
pub(crate) type Followers = Vec<(usize, Vec<(usize, f64)>, f64)>;

/// Random followers of a robot with these joints; no joint follows a follower.
fn followers(seed: u64, dof: usize) -> Followers {
    let mut rng = Rng::with_seed(seed ^ 0xF0);
    let mut joints: Vec<usize> = (0..dof).collect();
    rng.shuffle(&mut joints);
    let count = 1 + rng.usize(0..dof.div_ceil(2).min(dof - 1));
    let (following, free) = joints.split_at(count);
    let of_joint = |&joint: &usize| {
        let mut followed = free.to_vec();
        rng.shuffle(&mut followed);
        followed.truncate(1 + rng.usize(0..2.min(free.len())));
        followed.sort_unstable();
        let offset = if rng.bool() { 0.0 } else { 2.0 * rng.f64() - 1.0 };
        (joint, followed.into_iter().map(|joint| (joint, RATIOS[rng.usize(0..RATIOS.len())])).collect(), offset)
    };
    following.iter().map(of_joint).collect()
}

/// A tree without motors at its followers, and the same with couplings.
pub(crate) fn robots(seed: u64, dof: usize) -> (Robot, Robot, Followers) {
    let followers = followers(seed, dof);
    // a follower has no motor
    let mut joint = None;
    let mut text = String::new();
    for line in random_trees::yaml(seed, dof).lines() {
        joint = line.strip_prefix("  - name: j").and_then(|index| index.parse().ok()).or(joint);
        let is_following = || followers.iter().any(|(follower, ..)| Some(*follower) == joint);
        if !(line.starts_with("    motor:") && is_following()) {
            let _ = writeln!(text, "{line}");
        }
    }
    let free = Reader::new("free").trees().read(&text).unwrap_or_else(|report| panic!("{report}")).robot;
    text.push_str("couplings:\n");
    for (joint, follows, offset) in &followers {
        let ratios: Vec<String> = follows.iter().map(|(followed, ratio)| format!("j{followed}: {ratio}")).collect();
        let _ = writeln!(text, "  - {{joint: j{joint}, follows: {{{}}}, offset: {offset}}}", ratios.join(", "));
    }
    let reader = Reader::new("coupled").trees().couplings();
    let coupled = reader.read(&text).unwrap_or_else(|report| panic!("{report}\n{text}")).robot;
    (free, coupled, followers)
}

/// G of the robot, by rows.
fn ratios(dof: usize, followers: &Followers) -> Vec<Vec<f64>> {
    let coordinates: Vec<usize> = (0..dof).filter(|joint| followers.iter().all(|(other, ..)| other != joint)).collect();
    let row = |joint: usize| {
        let follows = followers.iter().find(|(other, ..)| *other == joint).map(|(_, follows, _)| follows);
        let element = |&coordinate: &usize| match follows {
            None => f64::from(u8::from(coordinate == joint)),
            Some(follows) => {
                follows.iter().find(|(followed, _)| *followed == coordinate).map_or(0.0, |(_, ratio)| *ratio)
            }
        };
        coordinates.iter().map(element).collect()
    };
    (0..dof).map(row).collect()
}

fn times(matrix: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

fn transposed(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..matrix[0].len()).map(|column| matrix.iter().map(|row| row[column]).collect()).collect()
}

/// What a function of the free robot returns, projected.
fn projected(function: Function, ratios: &[Vec<f64>], is_coordinate: &[bool], numbers: Vec<f64>) -> Vec<f64> {
    let (dof, back) = (ratios.len(), transposed(ratios));
    let rows = || numbers.chunks(dof).map(|row| times(&back, row)).collect::<Vec<_>>();
    // Gᵀ (A G), column by column
    let matrix = |rows: &[Vec<f64>]| {
        transposed(&transposed(rows).iter().map(|column| times(&back, column)).collect::<Vec<_>>()).concat()
    };
    match function {
        Function::MassMatrix
        | Function::MassMatrixWithPayload
        | Function::JacobianDerivatives
        | Function::CoriolisMatrix
        | Function::InverseDynamicsDerivatives
        | Function::InverseDynamicsDerivativesWithPayload
        | Function::TorqueHessian
        | Function::InverseDynamicsDerivativesWithWrenches => rows().chunks(dof).flat_map(matrix).collect(),
        Function::Jacobian
        | Function::JacobianRate
        | Function::CentreOfMassJacobian
        | Function::MomentumAndRate
        | Function::MomentumAndRateWithPayload
        | Function::ActuatorTorques
        | Function::TorqueGradient
        | Function::WrenchTorques => rows().concat(),
        _ if function.returns_torques() => rows().concat(),
        Function::FloatingMassMatrix | Function::FloatingMassMatrixWithPayload => {
            // Gᵀ M G with six coordinates of the base
            let size = 6 + dof;
            let rows =
                numbers.chunks(size).map(|row| [&row[..6], &times(&back, &row[6..])].concat()).collect::<Vec<_>>();
            let columns = transposed(&rows);
            let columns = columns.iter().map(|column| [&column[..6], &times(&back, &column[6..])].concat());
            transposed(&columns.collect::<Vec<_>>()).concat()
        }
        Function::CentroidalMomentumMatrix => {
            let rows = numbers.chunks(numbers.len() / 6);
            rows.flat_map(|row| [&row[..6], &times(&back, &row[6..])].concat()).collect()
        }
        Function::TipJacobians => {
            let rows = numbers.chunks(6 + dof);
            rows.flat_map(|row| [&row[..6], &times(&back, &row[6..])].concat()).collect()
        }
        Function::InverseDynamicsOfFloatingBase
        | Function::FloatingInverseDynamicsWithPayload
        | Function::FloatingBias
        | Function::FloatingGravityTorques
        | Function::FloatingBiasTorquesWithPayload => {
            let (on_base, torques) = numbers.split_at(6);
            [on_base, &times(&back, torques)].concat()
        }
        Function::FloatingInverseDynamicsDerivatives => {
            // Gᵀ A G below the six rows of the base, and below those of the three columns by its angular velocity
            let (by_joints, by_omega) = numbers.split_at(2 * (6 + dof) * dof);
            let by_joints = by_joints.chunks((6 + dof) * dof).flat_map(|numbers| {
                let rows: Vec<_> = numbers.chunks(dof).map(|row| times(&back, row)).collect();
                [rows[..6].concat(), matrix(&rows[6..])].concat()
            });
            let (on_base, of_joints) = by_omega.split_at(18);
            let of_joints = matrix(&of_joints.chunks(3).map(<[f64]>::to_vec).collect::<Vec<_>>());
            by_joints.chain(on_base.iter().copied()).chain(of_joints).collect()
        }
        Function::LinkPoses | Function::JointWrenches => {
            // those of the joints that follow no other: no other function has numbers of links
            let per_joint = numbers.len() / dof;
            let of_joints = numbers.chunks(per_joint).zip(is_coordinate);
            of_joints.filter(|(_, is_coordinate)| **is_coordinate).flat_map(|(numbers, _)| numbers.to_vec()).collect()
        }
        _ => numbers,
    }
}

#[test]
fn every_function_of_a_robot_with_followers_is_that_of_the_free_robot_projected() {
    for maker in Maker::ALL {
        let (robots_of, longest) = match maker {
            _ if shipped::is_exhaustive() => (120, 6),
            Maker::Runtime => (12, 6),
            Maker::Code(_) => (5, 4),
        };
        let mut worst = Worst::default();
        let mut seen = 0;
        for seed in 0..robots_of {
            let dof = 2 + usize::try_from(seed).expect("small") % (longest - 1);
            let (free, coupled, followers) = robots(seed, dof);
            let (arm, ratios) = (Arm::new(&coupled, maker), ratios(dof, &followers));
            let own = State::random(seed, coupled.dof());
            let mut all = own.with_joints([&own.q, &own.qd, &own.qdd].map(|values| times(&ratios, values)));
            for (joint, _, offset) in &followers {
                all.q[*joint] += offset;
            }
            let is_coordinate: Vec<bool> = coupled.joints.iter().map(|joint| joint.coupling.is_none()).collect();
            all.tau = vec![0.0; dof];
            for (joint, tau) in coupled.coordinates().zip(&own.tau) {
                all.tau[joint] = *tau;
            }
            // what is solved with the mass matrix is no projection
            let is_projected = |function: &Function| !function.is_of_every_link() && !function.inverts_mass();
            for function in Function::OF_TREES.into_iter().filter(is_projected) {
                let mut all = all.clone();
                if matches!(function, Function::TorqueGradient | Function::TorqueHessian) {
                    // λᵀ Gᵀ τ
                    all.tau = times(&ratios, &own.tau);
                }
                let expected = expected(&free, function, &all);
                if expected.iter().any(|x| !x.is_finite()) {
                    continue; // the centre of mass of a robot without mass
                }
                let expected = projected(function, &ratios, &is_coordinate, expected);
                let found = arm.numbers(function, &own.given());
                let error = error_on_scale(&found, &expected, scale(&free, function, &all));
                assert!(error <= TOLERANCE, "{maker}, robot {seed}, {function}: {error:e}\n{followers:?}");
                worst.see(function.name(), error);
                seen += 1;
            }
        }
        assert!(seen > 17 * robots_of);
        worst.at_most(TOLERANCE, &format!("couplings, {maker}"));
    }
}

#[test]
fn code_of_robots_with_followers_is_the_runtime() {
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        for seed in 0..if shipped::is_exhaustive() { 60 } else { 8 } {
            let dof = 2 + usize::try_from(seed).expect("small") % 3;
            compare_within(TOLERANCE, &Arm::new(&robots(seed, dof).1, maker), maker, &mut worst);
        }
        worst.at_most(TOLERANCE, &format!("couplings, {maker}"));
    }
}

/// A revolute joint that follows a slide; its offset is a coordinate of the centre of mass, too.
fn winch(ratio: &str) -> Robot {
    let yaml = "
format: 2
name: winch
source: own
convention: modified
gravity: [0, 0, -9.81]
joints:
  - name: slide
    type: prismatic
    dh: {theta: 0, d: 0, a: 0.2, alpha: 0}
    link: {mass: 2, com: [0.1, 0, 0.3], inertia: {xx: 0.5, yy: 0.8, zz: 0.8}}
  - name: drum
    type: revolute
    dh: {theta: 0, d: 0, a: 0.2, alpha: 0.3}
    link: {mass: 2, com: [0.1, 0.1, 0.3], inertia: {xx: 0.5, yy: 0.8, zz: 0.8}}
couplings:
  - {joint: drum, follows: {slide: RATIO}, offset: 0.3}
";
    Reader::new("winch").trees().couplings().read(&yaml.replace("RATIO", ratio)).expect("it is right").robot
}

/// The angle of a joint that follows a slide is a length of the slide too, where its ratio is 1.
#[test]
fn an_angle_may_be_a_length() {
    let robot = winch("1");
    for maker in Maker::CODE {
        let mut worst = Worst::default();
        compare_within(TOLERANCE, &Arm::by_no_choice(&robot, maker), maker, &mut worst);
        worst.at_most(TOLERANCE, &format!("a length as an angle, {maker}"));
    }
}

/// The function with numbers of every link is refused by name; every other one has a form that is proved, also where
/// the angle of a revolute joint is the length of a joint that slides.
#[test]
fn functions_of_every_link_are_refused_and_the_others_are_proved() {
    let winches = ["1", "5", "-0.37", "pi/7"].map(winch);
    for robot in (0..6).map(|seed| robots(seed, 4).1).chain(winches) {
        let compiler = Compiler::new(&robot);
        for function in Function::OF_TREES {
            match compiler.compile(function, Form::Reduced) {
                Err(error) => {
                    assert!(function.is_of_every_link(), "{function}: {error}");
                    assert!(error.to_string().contains("follows other joints"), "{error}");
                }
                Ok(program) => {
                    assert!(!function.is_of_every_link(), "{function}");
                    let differs = |refusal: &Refusal| matches!(refusal.reason, Reason::Error(_));
                    assert!(!program.refusals.iter().any(differs), "{function}: {:?}", program.refusals);
                    assert_eq!(program.argument_arrays()[0].elements.len(), robot.dof(), "{function}");
                }
            }
        }
    }
}

/// The two ends of a parallelogram are one point at every position of the coordinates, and have the axis of the cut
/// joint in common: the couplings are those of the closed loop. So G is the null space of the constraint, and Gᵀ τ' are
/// the torques.
#[test]
fn a_parallelogram_stays_closed() {
    let text = std::fs::read_to_string(format!("{ROOT}/docs/palletiser.yaml")).expect("the file is there");
    let placed =
        |on: usize, xyz: [f64; 3]| FixedFrame { on: Some(on), placement: Transform { xyz, ..Transform::IDENTITY } };
    let ends = [placed(5, [0.8, 0.0, 0.0]), placed(2, [0.0, -0.3, 0.0])];
    for dependent in ["[j3, j8]", "[j2, j8]", "[j7, j8]", "[j3, j7]"] {
        let text = text.replace("[j3, j8]", dependent);
        let reader = Reader::new("palletiser.yaml").trees().couplings();
        let robot = reader.read(&text).unwrap_or_else(|report| panic!("{report}")).robot;
        let arm = Arm::new(&robot, Maker::Runtime).runtime;
        let mut rng = Rng::with_seed(7);
        for _ in 0..20 {
            let q: Vec<f64> = (0..robot.dof()).map(|_| 6.0 * rng.f64() - 3.0).collect();
            let poses =
                ends.map(|end| arm.clone().at_frame(end).expect("its link").forward_kinematics(&q).expect("lengths"));
            let [one, other] = poses;
            for axis in 0..3 {
                assert!(
                    (one.translation[axis] - other.translation[axis]).abs() < 1e-14,
                    "{dependent} {one:?} {other:?}"
                );
                assert!((one.rotation[axis][2] - other.rotation[axis][2]).abs() < 1e-14, "{dependent}");
            }
        }
    }
}

/// A tree whose axis 7 is opposite to axis 2, with joints 3 and 8 that follow; joint 3 follows joint 2 with `ratio`.
/// With -1, links 2 and 8 always turn alike, and so do links 3 and 7.
fn tree_of_opposite_sides(ratio: &str) -> Robot {
    let link = "mass: 2, com: [0.1, -0.2, 0.3], inertia: {xx: 0.5, yy: 0.6, zz: 0.7, xy: 0.05, xz: -0.06, yz: 0.07}";
    let joint = |name: &str, row: &str| format!("{{name: {name}, type: revolute, {row}, link: {{{link}}}}},");
    let joints = [
        joint("j1", "dh: {alpha: 0.3, a: 0, theta: 0, d: 0}"),
        joint("j2", "dh: {alpha: -pi/2, a: 0.2, theta: 0, d: 0}"),
        joint("j3", "dh: {alpha: 0, a: 0.7, theta: 0, d: 0}"),
        joint("j4", "dh: {alpha: -pi/2, a: 0.15, theta: 0, d: 0.8}"),
        joint("j7", "parent: j1, dh: {gamma: 0, b: 0.1, alpha: pi/2, a: 0.2, theta: 0.5, d: 0.3}"),
        joint("j8", "dh: {alpha: pi, a: 0.3, theta: -0.2, d: 0}"),
    ];
    let text = format!(
        "{{format: 2, name: sides, source: own, convention: modified, gravity: [0, 0, -9.81], tool: {{on: j4}},
        joints: [{}], couplings: [{{joint: j3, follows: {{j7: -1, j2: {ratio}}}, offset: 0.3}},
        {{joint: j8, follows: {{j7: 1, j2: 1}}, offset: -0.7}}]}}",
        joints.concat()
    );
    let read = Reader::new("sides.yaml").trees().couplings().read(&text);
    read.unwrap_or_else(|report| panic!("{report}")).robot
}

/// Second moments of links that turn alike are those of one link, and the torques stay what they are; links that do
/// not turn alike keep theirs, and take more operations.
#[test]
fn a_tree_whose_links_turn_alike_is_the_runtime() {
    let torques = |robot: &Robot| {
        let maker = Maker::Code(Form::Reduced);
        let arm = Arm::new(robot, maker);
        let mut worst = Worst::default();
        compare_within(TOLERANCE, &arm, maker, &mut worst);
        worst.at_most(TOLERANCE, "links that turn alike");
        arm.program(Function::InverseDynamics).operations().total()
    };
    let [alike, different] = ["-1", "-0.9"].map(|ratio| torques(&tree_of_opposite_sides(ratio)));
    assert!(alike + 20 < different, "{alike} {different}");
}

/// The SR400 of Khalil and Kleinfinger with links of which no number is zero: its parallelogram, by its plan file.
#[test]
fn the_tree_of_the_sr400_takes_517_operations() {
    let maker = Maker::Code(Form::Reduced);
    let arm = Arm::from_file("benches/trees/sr400.yaml", maker);
    let mut worst = Worst::default();
    compare_within(TOLERANCE, arm, maker, &mut worst);
    worst.at_most(TOLERANCE, "SR400");
    let operations = arm.program(Function::InverseDynamics).operations().total();
    assert!(operations <= 517, "{operations}");
}
