//! Derived functions of a tree, against the runtime.

use rne::{DynArm, ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, Kinematics, MassMatrix};

const YAML: &str = include_str!("../docs/tree.yaml");

#[derive(InverseDynamics, MassMatrix, ForwardDynamics, InverseDynamicsDerivatives, Kinematics)]
#[robot(path = "../docs/tree.yaml")]
struct Torso;

#[derive(InverseDynamics, MassMatrix, ForwardDynamics, InverseDynamicsDerivatives, Kinematics)]
#[robot(path = "../docs/tree.yaml", form = "reduced")]
struct Reduced;

const Q: [f64; 5] = [0.4, 0.7, 0.02, 0.03, -1.1];
const QD: [f64; 5] = [0.9, -0.5, 0.3, -0.2, 1.3];
const QDD: [f64; 5] = [-1.2, 2.0, 0.7, 0.4, -0.6];

fn near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-13 * scale, "{found} {expected}");
    }
}

/// Every function beside the runtime, and forward dynamics beside inverse dynamics.
macro_rules! is_the_runtime {
    ($arm:expr) => {{
        let runtime = DynArm::from_yaml(YAML).unwrap_or_else(|report| panic!("{report}"));
        let tau = $arm.inverse_dynamics(&Q, &QD, &QDD);
        near(&tau, &runtime.inverse_dynamics(&Q, &QD, &QDD).expect("lengths"));
        near(&$arm.forward_dynamics(&Q, &QD, &tau), &QDD);
        let mass_matrix = $arm.mass_matrix(&Q);
        near(mass_matrix.as_flattened(), &runtime.mass_matrix(&Q).expect("lengths").concat());
        assert_eq!(mass_matrix[1][4], 0.0, "the arms do not move each other");
        near($arm.jacobian(&Q).as_flattened(), &runtime.jacobian(&Q).expect("lengths").concat());
        // the derivative by the position of the left arm, by the central difference of two near states
        let step = 1e-6;
        let at = |sign: f64| $arm.inverse_dynamics(&[Q[0], Q[1] + sign * step, Q[2], Q[3], Q[4]], &QD, &QDD);
        let difference: Vec<f64> = at(1.0).iter().zip(at(-1.0)).map(|(a, b)| (a - b) / (2.0 * step)).collect();
        let by_position = $arm.inverse_dynamics_derivatives(&Q, &QD, &QDD).dq;
        for (row, difference) in by_position.iter().zip(difference) {
            assert!((row[1] - difference).abs() < 1e-7, "{} {difference}", row[1]);
        }
    }};
}

#[test]
fn both_forms_of_a_derived_tree_are_the_runtime() {
    is_the_runtime!(Torso);
    is_the_runtime!(Reduced);
}

/// A gripper whose second finger follows the first: arrays have no element for it.
mod gripper {
    use rne::{DynArm, ForwardDynamics, InverseDynamics, Kinematics, MassMatrix};

    use super::near;

    #[derive(InverseDynamics, MassMatrix, ForwardDynamics, Kinematics)]
    #[robot(path = "../docs/gripper.yaml")]
    struct Gripper;

    #[derive(InverseDynamics, MassMatrix, ForwardDynamics, Kinematics)]
    #[robot(path = "../docs/gripper.yaml", form = "reduced")]
    struct Reduced;

    #[test]
    fn both_forms_of_a_derived_robot_with_a_follower_are_the_runtime() {
        let runtime =
            DynArm::from_yaml(include_str!("../docs/gripper.yaml")).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!((runtime.dof(), Gripper::JOINT_NAMES), (3, ["shoulder", "elbow", "finger_a"]));
        let (q, qd, qdd) = ([0.4, 0.7, 0.02], [0.9, -0.5, 0.3], [-1.2, 2.0, 0.7]);
        let torques = runtime.inverse_dynamics(&q, &qd, &qdd).expect("lengths");
        near(&Gripper.inverse_dynamics(&q, &qd, &qdd), &torques);
        near(&Reduced.inverse_dynamics(&q, &qd, &qdd), &torques);
        near(&Gripper.forward_dynamics(&q, &qd, &Reduced.inverse_dynamics(&q, &qd, &qdd)), &qdd);
        near(Reduced.mass_matrix(&q).as_flattened(), &runtime.mass_matrix(&q).expect("lengths").concat());
        // closing the gripper moves both fingers of 0.1 kg
        assert!((Gripper.mass_matrix(&q)[2][2] - 0.2).abs() < 1e-15);
        assert_eq!(Gripper.link_poses(&q).len(), 3);
        near(&Gripper.inverse_dynamics_from_sin_cos(&q.map(f64::sin), &q.map(f64::cos), &q, &qd, &qdd), &torques);
    }
}

/// The WAM, two of whose motors turn with two joints each.
mod coupled_motors {
    use rne::{DynArm, InverseDynamics, MassMatrix};

    use super::near;

    #[derive(InverseDynamics, MassMatrix)]
    #[robot(path = "../robots/trees/wam7_coupled.yaml")]
    struct Wam;

    #[derive(InverseDynamics, MassMatrix)]
    #[robot(path = "../robots/trees/wam7_coupled.yaml", form = "reduced")]
    struct Reduced;

    #[test]
    fn both_forms_of_a_derived_robot_with_motors_are_the_runtime() {
        let runtime = DynArm::from_yaml(include_str!("../robots/trees/wam7_coupled.yaml"))
            .unwrap_or_else(|report| panic!("{report}"));
        let q = [0.4, 0.7, 0.2, -0.5, 1.0, 0.3, -0.8];
        let (qd, qdd) = (q.map(|x| 1.5 - x), q.map(|x| 3.0 * x));
        let torques = runtime.inverse_dynamics(&q, &qd, &qdd).expect("lengths");
        near(&Wam.inverse_dynamics(&q, &qd, &qdd), &torques);
        near(&Reduced.inverse_dynamics(&q, &qd, &qdd), &torques);
        near(Reduced.mass_matrix(&q).as_flattened(), &runtime.mass_matrix(&q).expect("lengths").concat());
    }

    #[test]
    fn motors_and_joints_are_mapped() {
        let runtime = DynArm::from_yaml(include_str!("../robots/trees/wam7_coupled.yaml"))
            .unwrap_or_else(|report| panic!("{report}"));
        let values: [f64; 7] = [0.4, 0.7, 0.2, -0.5, 1.0, 0.3, -0.8];
        assert_eq!(Wam::MOTOR_NAMES, ["m1", "m2", "m3", "m4", "m5", "m6", "m7"]);
        let speeds = Wam.motor_speeds(&values);
        assert_eq!(speeds.to_vec(), runtime.motor_speeds(&values).expect("lengths"));
        assert!((speeds[1] - (28.25 * 0.7 - 16.8155 * 0.2)).abs() < 1e-14);
        assert!((speeds[2] - (-28.25 * 0.7 - 16.8155 * 0.2)).abs() < 1e-14);
        let torques = Wam.joint_torques(&values);
        assert_eq!(torques.to_vec(), runtime.joint_torques(&values).expect("lengths"));
        // a differential: equal torques of motors 2 and 3 move joint 3 alone
        let equal = Wam.joint_torques(&[0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(equal[1] == 0.0 && equal[2] < -33.0, "{equal:?}");
        let back = Wam.motor_torques(&torques);
        assert_eq!(back.to_vec(), runtime.motor_torques(&torques).expect("lengths").expect("an inverse"));
        near(&back, &values);
        assert_eq!(Wam.motor_speeds(&[0.4_f32; 7])[0], -42.0 * 0.4_f32);
    }
}

/// Rotors beside bodies that turn: the Mini Cheetah, whose rotors the URDF has as bodies of their own.
mod exact_rotors {
    use std::fmt::Write as _;

    use rne::{DynArm, InverseDynamics, MassMatrix};

    use super::near;

    #[derive(InverseDynamics, MassMatrix)]
    #[robot(builtin = "mini_cheetah", form = "reduced")]
    struct Rotors;

    /// Each rotor as a row of the table, which follows its joint.
    fn as_bodies() -> String {
        let text = include_str!("../robots/trees/mini_cheetah.yaml");
        let (before, rest) = text.split_once("bodies:").expect("bodies");
        let (_, motors) = rest.split_once("motors:").expect("motors");
        let entries = motors.lines().filter_map(|line| line.trim().strip_prefix("- {name: "));
        let (mut rows, mut couplings) = (String::new(), String::from("couplings:\n"));
        for entry in entries {
            let (joint, rest) = entry.split_once("_motor, turns: {").expect("a motor");
            let (ratio, rest) = rest.split_once("}, rotor: {axis: ").expect("a rotor");
            let (axis, rest) = rest.split_once(", on: ").expect("an axis");
            let (on, _) = rest.split_once(',').expect("a link");
            // where the rotor stands in the link frame that carries it, its z axis along `axis`
            let (xyz, rpy) = match (axis, &joint[..1], &joint[1..2]) {
                ("[0, 0, 1]", _, side) => (if side == "r" { "0, 0, 0.062" } else { "0, 0, -0.062" }, "0, 0, 0"),
                ("[0, -1, 0]", ..) => ("0, -0.04, 0", "pi/2, 0, 0"),
                ("[0, 1, 0]", ..) => ("0, -0.04, 0", "-pi/2, 0, 0"),
                ("[1, 0, 0]", end, _) => {
                    (if end == "f" { "0.125, 0.049, 0" } else { "-0.125, 0.049, 0" }, "0, pi/2, 0")
                }
                other => panic!("{other:?}"),
            };
            let at = format!("{{xyz: [{xyz}], rpy: [{rpy}]}}");
            let _ = write!(
                rows,
                "  - {{name: {joint}_rotor, parent: {on}, at: {at}, type: revolute,\n     dh: {{theta: 0, d: 0, a: 0, \
                 alpha: 0}},\n     link: {{mass: 0.055, inertia: {{xx: 3.3e-5, yy: 3.3e-5, zz: 6.3e-5}}}}}}\n"
            );
            let _ = writeln!(couplings, "  - {{joint: {joint}_rotor, follows: {{{ratio}}}}}");
        }
        [before, &rows, &couplings].concat()
    }

    #[test]
    fn a_rotor_is_a_body_that_turns() {
        let bodies = DynArm::from_yaml(&as_bodies()).unwrap_or_else(|report| panic!("{report}"));
        let q: [f64; 12] = [-1.7, -1.4, -1.1, -0.8, -0.5, -0.2, 0.1, 0.4, 0.7, 1.0, 1.3, 1.6];
        let (qd, qdd) = (q.map(|x| 1.5 - x), q.map(|x| 3.0 * x + 0.2));
        let torques = bodies.inverse_dynamics(&q, &qd, &qdd).expect("lengths");
        near(&Rotors.inverse_dynamics(&q, &qd, &qdd), &torques);
        near(Rotors.mass_matrix(&q).as_flattened(), &bodies.mass_matrix(&q).expect("lengths").concat());
    }
}

/// A tree from a plain table, which needs no robot file, and what is no tree.
#[test]
fn branches_make_a_tree_of_a_plain_table() {
    let arm = rne::Arm::<5>::from_yaml(YAML).unwrap_or_else(|report| panic!("{report}"));
    let robot = rne_model::Reader::new("tree").trees().read(YAML).unwrap_or_else(|report| panic!("{report}")).robot;
    let branches = || std::array::from_fn(|joint| robot.joints[joint].branch);
    let plain = || rne::Arm::new(*arm.model());
    let tree = plain().on_tree(branches(), robot.tip_on).expect("a tree");
    assert_eq!(tree.inverse_dynamics(&Q, &QD, &QDD), arm.inverse_dynamics(&Q, &QD, &QDD));
    assert_ne!(plain().inverse_dynamics(&Q, &QD, &QDD), arm.inverse_dynamics(&Q, &QD, &QDD));
    let placement = rne_model::Transform::IDENTITY;
    for parent in [1, 2, 5] {
        let mut branches = branches();
        branches[1] = Some(rne_model::FixedFrame { on: Some(parent), placement });
        assert!(plain().on_tree(branches, None).is_none(), "row 1 on link {parent}");
    }
    assert!(plain().on_tree(branches(), Some(5)).is_none(), "the tip on a link that is not there");
}

/// A body is the mass of a link more, at a pose that does not move: here as a joint of the tree that stays at 0.
#[test]
fn a_body_of_a_tree_is_a_massive_link_that_does_not_move() {
    const DUAL_ARM: &str = include_str!("../docs/dual_arm.yaml");
    let reader = || rne_model::Reader::new("dual_arm").trees();
    let with_body = reader().read(DUAL_ARM).unwrap_or_else(|report| panic!("{report}")).robot;
    let (before, _) = DUAL_ARM.split_once("bodies:").expect("the list");
    let as_link = format!(
        "{before}  - {{name: camera, parent: waist, at: {{xyz: [0.1, 0, 0.45], rpy: [0, pi/2, 0]}}, type: revolute,\n\
         \x20   dh: {{theta: 0, d: 0, a: 0, alpha: 0}},\n\
         \x20   link: {{mass: 0.6, com: [0, 0, 0.02], inertia: {{xx: 8e-4, yy: 8e-4, zz: 3e-4}}}}}}\n"
    );
    let as_link = reader().read(&as_link).unwrap_or_else(|report| panic!("{report}")).robot;
    let [lumped, linked] = [&with_body, &as_link].map(DynArm::from_robot);
    let more = |x: &[f64]| [x, &[0.0]].concat();
    let expected = linked.inverse_dynamics(&more(&Q), &more(&QD), &more(&QDD)).expect("lengths");
    near(&lumped.inverse_dynamics(&Q, &QD, &QDD).expect("lengths"), &expected[..5]);
    let bare = DynArm::from_robot(&with_body.without_bodies(&["camera"]).expect("it is there"));
    let without = bare.inverse_dynamics(&Q, &QD, &QDD).expect("lengths");
    assert!((without[0] - expected[0]).abs() > 1e-3);
    // closed form: all of it turns about the vertical axis of the waist alone
    let (zeros, one) = ([0.0; 5], [1.0, 0.0, 0.0, 0.0, 0.0]);
    let inertia = |arm: &DynArm| -> f64 {
        let tau = |qdd| arm.inverse_dynamics(&zeros, &zeros, qdd).expect("lengths")[0];
        tau(&one) - tau(&zeros)
    };
    // turned by pi/2 about y, z of the camera points along x: centre at x = 0.12, and its xx is along the axis
    let expected = 8e-4 + 0.6 * 0.12 * 0.12;
    assert!((inertia(&lumped) - inertia(&bare) - expected).abs() < 1e-12);
}
