//! Slips of trees and grippers that were made by hand: lists in another order, a wrench in other axes, a follower that
//! moves the other way. The diagnosis names each first.

use fastrand::Rng;
use rne_diagnose::{Diagnosis, Observation, Slip, diagnose};
use rne_model::{Reader, Robot};
use rne_runtime::{DynArm, Wrench};

fn robot(text: &str) -> Robot {
    let read = Reader::new("robot").trees().couplings().read(text);
    read.unwrap_or_else(|report| panic!("{report}")).robot
}

fn shipped(name: &str) -> Robot {
    robot(rne_robots::find(name).unwrap_or_else(|| panic!("{name}")).yaml)
}

fn gripper() -> &'static str {
    include_str!("../../../docs/gripper.yaml")
}

/// A state with a wrench at the tip; its torques are still 0.
fn state(rng: &mut Rng, dof: usize) -> Observation {
    let mut numbers = |count: usize, size: f64| (0..count).map(|_| (2.0 * rng.f64() - 1.0) * size).collect::<Vec<_>>();
    let (q, qd, qdd, w) = (numbers(dof, 1.5), numbers(dof, 2.0), numbers(dof, 5.0), numbers(6, 20.0));
    let wrench = Some(Wrench { force: [w[0], w[1], w[2]], moment: [w[3], w[4], w[5]] });
    Observation { q, qd, qdd, wrench, tau: vec![0.0; dof], resolution: vec![5e-8; dof] }
}

/// The slips of the first explanation of two states, with the torques that `other` computes.
fn first(robot: &Robot, other: impl Fn(&Observation) -> Vec<f64>) -> Vec<Slip> {
    let mut rng = Rng::with_seed(7);
    let seen = [(); 2].map(|()| {
        let at = state(&mut rng, robot.dof());
        Observation { tau: other(&at), ..at }
    });
    match diagnose(robot, &seen).unwrap() {
        Diagnosis::Explained(all) => all[0].slips.clone(),
        found => panic!("{}: {found:?}", robot.name),
    }
}

/// Torques of a tool that lists the coordinates in another order: `place[i]` is the place of coordinate i in its lists.
fn in_order(robot: &Robot, at: &Observation, place: &[usize]) -> Vec<f64> {
    let read = |list: &[f64]| place.iter().map(|&place| list[place]).collect::<Vec<f64>>();
    let arm = DynArm::from_robot(robot);
    let right =
        arm.inverse_dynamics_with_wrench(&read(&at.q), &read(&at.qd), &read(&at.qdd), &at.wrench.unwrap()).unwrap();
    let mut listed = vec![0.0; right.len()];
    place.iter().zip(right).for_each(|(&place, torque)| listed[place] = torque);
    listed
}

#[test]
fn lists_in_another_order_are_named() {
    let hyq = shipped("hyq");
    let names: Vec<&str> = hyq.joints.iter().map(|joint| joint.name.as_str()).collect();
    let leg = |name: &str| names.iter().position(|joint| joint.starts_with(name)).unwrap_or_else(|| panic!("{name}"));
    // the rows are leg by leg; breadth first all first joints come first, then all second ones
    let by_level: Vec<usize> = (0..12).map(|row| row % 3 * 4 + row / 3).collect();
    assert_eq!(first(&hyq, |at| in_order(&hyq, at, &by_level)), [Slip::JointsByLevel]);
    let (left, right) = (leg("lf"), leg("rf"));
    let mut exchanged: Vec<usize> = (0..12).collect();
    (0..3).for_each(|at| exchanged.swap(left + at, right + at));
    let slip = Slip::BranchesExchanged(left.min(right), left.max(right));
    assert_eq!(first(&hyq, |at| in_order(&hyq, at, &exchanged)), [slip]);
    assert!(slip.says(&hyq).contains(names[left]) && slip.says(&hyq).contains(names[right]), "{}", slip.says(&hyq));
    // the lists of /joint_states of a UR are in the order of the alphabet: elbow, lift, pan
    let named = rne_robots::find("ur5").unwrap().yaml;
    let mut ur5 = robot(named);
    let of_ros = ["shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"];
    ur5.joints.iter_mut().zip(of_ros).for_each(|(joint, name)| name.clone_into(&mut joint.name));
    assert_eq!(first(&ur5, |at| in_order(&ur5, at, &[2, 1, 0, 3, 4, 5])), [Slip::JointsByName]);
    assert_eq!(first(&ur5, |at| in_order(&ur5, at, &[5, 4, 3, 2, 1, 0])), [Slip::JointsFromTheTip]);
    let swapped = Slip::JointsExchanged(1, 3);
    assert_eq!(first(&ur5, |at| in_order(&ur5, at, &[0, 3, 2, 1, 4, 5])), [swapped]);
    assert_eq!(swapped.says(&ur5), "the joints shoulder_lift and wrist_1 are exchanged in all lists");
}

/// The force F and the moment N of the other tool are in world axes; those at the tip are Rᵀ F and Rᵀ N, with the
/// rotation R of the tip in the world, and about the origin of the world N is less by p × F.
#[test]
fn a_wrench_in_other_axes_is_named() {
    let mut puma = shipped("puma560");
    puma.base.rpy = [0.3, -0.2, 1.0].map(rne_model::Angle::new);
    for robot in [puma, shipped("baxter"), robot(gripper())] {
        let arm = DynArm::from_robot(&robot);
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let torques = |at: &Observation, about_world: bool| {
            let (pose, Wrench { force, mut moment }) = (arm.forward_kinematics(&at.q).unwrap(), at.wrench.unwrap());
            if about_world {
                let lever = cross(pose.translation, force);
                (0..3).for_each(|axis| moment[axis] -= lever[axis]);
            }
            let tip = |v: [f64; 3]| {
                [0, 1, 2].map(|axis| (0..3).map(|row: usize| pose.rotation[row][axis] * v[row]).sum::<f64>())
            };
            let wrench = Wrench { force: tip(force), moment: tip(moment) };
            arm.inverse_dynamics_with_wrench(&at.q, &at.qd, &at.qdd, &wrench).unwrap()
        };
        assert_eq!(first(&robot, |at| torques(at, false)), [Slip::WrenchInWorld], "{}", robot.name);
        assert_eq!(first(&robot, |at| torques(at, true)), [Slip::WrenchAboutWorld], "{}", robot.name);
    }
}

/// A base that is turned: the axes of frame 0 are not those of the world. The same tip without the base has them.
#[test]
fn a_wrench_in_the_axes_of_frame_0_is_named() {
    let mut puma = shipped("puma560");
    let level = DynArm::from_robot(&puma);
    puma.base.rpy = [0.3, -0.2, 1.0].map(rne_model::Angle::new);
    let other = |at: &Observation| {
        let (pose, Wrench { force, moment }) = (level.forward_kinematics(&at.q).unwrap(), at.wrench.unwrap());
        let tip =
            |v: [f64; 3]| [0, 1, 2].map(|axis| (0..3).map(|row: usize| pose.rotation[row][axis] * v[row]).sum::<f64>());
        let wrench = Wrench { force: tip(force), moment: tip(moment) };
        level.inverse_dynamics_with_wrench(&at.q, &at.qd, &at.qdd, &wrench).unwrap()
    };
    assert_eq!(first(&puma, other), [Slip::WrenchInBase]);
}

#[test]
fn a_follower_with_the_other_sign_is_named() {
    let file = robot(gripper());
    let wrong = gripper().replace("follows: {finger_a: 1}", "follows: {finger_a: -1}");
    assert_ne!(wrong, gripper());
    let arm = DynArm::from_robot(&robot(&wrong));
    let other =
        |at: &Observation| arm.inverse_dynamics_with_wrench(&at.q, &at.qd, &at.qdd, &at.wrench.unwrap()).unwrap();
    let slip = Slip::FollowerReversed(3);
    assert_eq!(first(&file, other), [slip]);
    assert_eq!(slip.says(&file), "the joint finger_b follows finger_a with the other sign");
    assert_eq!(slip.right(&file), "`follows: {finger_a: 1}`");
    // of the dependent joints of a loop, too
    let palletiser = robot(include_str!("../../../docs/palletiser.yaml"));
    for joint in palletiser.joints.iter().enumerate().filter(|(_, joint)| joint.coupling.is_some()).map(|(at, _)| at) {
        let mut wrong = palletiser.clone();
        let coupling = wrong.joints[joint].coupling.as_mut().unwrap();
        coupling.follows.iter_mut().for_each(|(_, ratio)| *ratio = -*ratio);
        let arm = DynArm::from_robot(&wrong);
        let other =
            |at: &Observation| arm.inverse_dynamics_with_wrench(&at.q, &at.qd, &at.qdd, &at.wrench.unwrap()).unwrap();
        assert_eq!(first(&palletiser, other), [Slip::FollowerReversed(joint)]);
    }
}

#[test]
fn every_slip_has_words() {
    for file in rne_robots::all() {
        let robot = robot(file.yaml);
        for slip in Slip::candidates(&robot) {
            let words = [slip.says(&robot), slip.right(&robot)];
            assert!(words.iter().all(|words| !words.is_empty()), "{}: {slip:?}", file.name);
        }
    }
}
