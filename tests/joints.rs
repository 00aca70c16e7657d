//! The names of the joints in a derived type: their order in other programs, and their places in arrays.

use rne::{InverseDynamics, JointOrderError, joint_order};

#[derive(InverseDynamics)]
#[robot(builtin = "puma560")]
struct Puma560;

#[derive(InverseDynamics)]
#[robot(path = "../docs/tree.yaml")]
struct Tree;

#[derive(InverseDynamics)]
#[robot(path = "../docs/gripper.yaml")]
struct Gripper;

/// Alphabetic from behind, as no table is.
const THEIRS: [&str; 6] = ["j6", "j5", "j4", "j3", "j2", "j1"];
const ORDER: [usize; 6] = Puma560::order(THEIRS);
const WITH_OTHERS: [usize; 6] = Puma560::order_with_others(["j4", "left", "j2", "j6", "left", "j1", "j3", "j5"]);

#[test]
fn an_order_is_the_places_in_the_list() {
    assert_eq!(Puma560::JOINTS, Puma560::JOINT_NAMES);
    assert_eq!(ORDER, [5, 4, 3, 2, 1, 0]);
    assert_eq!(WITH_OTHERS, [5, 2, 6, 0, 7, 3]);
    assert_eq!(Puma560::order(Puma560::JOINTS), [0, 1, 2, 3, 4, 5]);
    assert_eq!(ORDER.map(|place| THEIRS[place]), Puma560::JOINTS);
}

/// Torques for a caller with another order, by the names alone.
#[test]
fn arrays_of_another_order_give_the_same_torques() {
    let q = [0.3, -0.8, 0.5, 1.1, -0.4, 0.9];
    let mut theirs = q;
    theirs.reverse();
    let tau: [f64; 6] = Puma560.gravity_torques(&ORDER.map(|place| theirs[place]));
    assert_eq!(tau, Puma560.gravity_torques(&q));
    let mut written = [0.0; 6];
    for (place, tau) in ORDER.into_iter().zip(tau) {
        written[place] = tau;
    }
    written.reverse();
    assert_eq!(written, tau);
}

#[test]
fn a_variant_is_the_place_of_its_joint() {
    let joints = [Puma560Joint::J1, Puma560Joint::J2, Puma560Joint::J3, Puma560Joint::J4, Puma560Joint::J5];
    assert_eq!(joints.map(|joint| joint as usize), [0, 1, 2, 3, 4]);
    assert_eq!(Puma560::JOINTS[Puma560Joint::J6 as usize], "j6");
    assert_eq!(Tree::JOINTS[TreeJoint::FingerA as usize], "finger_a");
}

/// Names that are known at run time only, such as those of a message.
#[test]
fn names_at_run_time_give_an_error() {
    let mut names = THEIRS.to_vec();
    assert_eq!(joint_order(&Puma560::JOINTS, &names, false), Ok(ORDER));
    names[2] = "wrist";
    assert_eq!(joint_order(&Puma560::JOINTS, &names, false), Err(JointOrderError::Unknown("wrist")));
    assert_eq!(joint_order(&Puma560::JOINTS, &names, true), Err(JointOrderError::Missing("j4")));
}

/// A joint that follows another one is no coordinate, and the message says so.
#[test]
fn a_follower_in_the_list_is_named_as_one() {
    const ALL: [&str; 4] = ["finger_b", "shoulder", "elbow", "finger_a"];
    const ORDER: [usize; 3] = Gripper::order_with_others(ALL);
    assert_eq!(ORDER, [1, 2, 3]);
    let message = |names: [&'static str; 3]| {
        let stopped = std::panic::catch_unwind(|| Gripper::order(names)).expect_err("an error");
        stopped.downcast_ref::<String>().cloned().unwrap_or_default()
    };
    assert_eq!(
        message(["shoulder", "elbow", "finger_b"]),
        "`finger_b` follows `finger_a`, so q has no element for it; leave it out, or call `order_with_others`"
    );
    let unknown = message(["shoulder", "elbow", "finger_c"]);
    assert!(unknown.starts_with("`finger_c` in the list is not a joint of the robot"), "{unknown}");
}
