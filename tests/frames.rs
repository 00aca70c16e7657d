//! Derived functions of named frames, against the runtime.

use rne::{AtFrame, DynArm, FrameKinematics, Kinematics, Pose, Wrench};

const YAML: &str = include_str!("../docs/desk_arm_frames.yaml");

#[derive(FrameKinematics, Kinematics)]
#[robot(path = "../docs/desk_arm_frames.yaml")]
struct Desk;

#[derive(FrameKinematics)]
#[robot(path = "../docs/desk_arm_frames.yaml", form = "reduced")]
struct Reduced;

#[derive(FrameKinematics)]
#[robot(builtin = "puma560")]
struct Puma;

const Q: [f64; 3] = [0.4, 0.7, -1.1];
const QD: [f64; 3] = [0.9, -0.5, 1.3];
const WRENCH: Wrench<f64> = Wrench { force: [2.0, -1.5, 4.0], moment: [0.3, 0.7, -0.2] };

fn near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-14 * (1.0 + expected.abs()) * 4.0, "{found} {expected}");
    }
}

fn numbers(pose: &Pose<f64>) -> Vec<f64> {
    [pose.rotation.as_flattened(), &pose.translation].concat()
}

fn same<const FRAME: usize>(arm: &impl AtFrame<3, FRAME>, name: &str) {
    let robot = rne::model::Robot::from_yaml(YAML).unwrap_or_else(|report| panic!("{report}"));
    let frame = robot.frame(name).expect("a name");
    let runtime = DynArm::from_robot(&robot.at_frame(frame));
    near(&numbers(&arm.pose_at_frame(&Q)), &numbers(&runtime.forward_kinematics(&Q).expect("lengths")));
    near(arm.jacobian_at_frame(&Q).as_flattened(), &runtime.jacobian(&Q).expect("lengths").concat());
    let rate = runtime.jacobian_rate_times_velocity(&Q, &QD).expect("lengths");
    near(&arm.jacobian_rate_times_velocity_at_frame(&Q, &QD), &rate);
    near(&arm.wrench_torques_at_frame(&Q, &WRENCH), &runtime.wrench_torques(&Q, &WRENCH).expect("lengths"));
    near(
        arm.jacobian_rate_at_frame(&Q, &QD).as_flattened(),
        &runtime.jacobian_rate(&Q, &QD).expect("lengths").concat(),
    );
    let derivatives = runtime.jacobian_derivatives(&Q).expect("lengths").concat().concat();
    near(arm.jacobian_derivatives_at_frame(&Q).as_flattened().as_flattened(), &derivatives);
}

macro_rules! every_frame {
    ($arm:expr, $type:ident: $($name:literal),*) => {
        $(same::<{ $type::frame($name) }>(&$arm, $name);)*
    };
}

#[test]
fn every_frame_is_the_runtime() {
    every_frame!(Desk, Desk: "camera", "gripper", "table", "waist", "shoulder", "elbow");
    every_frame!(Reduced, Reduced: "camera", "gripper", "table", "waist", "shoulder", "elbow");
}

#[test]
fn frames_have_names_and_poses_in_the_order_of_the_file() {
    assert_eq!(Desk::FRAME_NAMES, ["camera", "gripper", "table"]);
    let [camera, gripper, table] = Desk.frame_poses(&Q);
    assert_eq!(camera, Desk.pose_of::<{ Desk::frame("camera") }, _>(&Q));
    assert_eq!(gripper, Desk.pose_of::<{ Desk::frame("gripper") }, _>(&Q));
    assert_eq!(table, Desk.pose_of::<{ Desk::frame("table") }, _>(&Q));
    let jacobian = Desk.jacobian_of::<{ Desk::frame("table") }, _>(&Q);
    assert_eq!(jacobian, [[0.0; 3]; 6], "frame 0 does not move");
    let wrench = Desk.wrench_torques_of::<{ Desk::frame("camera") }, _>(&Q, &WRENCH);
    near(&wrench, &Desk.wrench_torques_at_frame_of_camera());
}

impl Desk {
    /// Jᵀ w by the Jacobian.
    fn wrench_torques_at_frame_of_camera(&self) -> [f64; 3] {
        const CAMERA: usize = Desk::frame("camera");
        let (pose, jacobian) = (self.pose_of::<CAMERA, _>(&Q), self.jacobian_of::<CAMERA, _>(&Q));
        let turned = |v: [f64; 3]| pose.rotation.map(|row| row.iter().zip(v).map(|(r, v)| r * v).sum::<f64>());
        let w = [turned(WRENCH.force), turned(WRENCH.moment)].concat();
        std::array::from_fn(|joint| jacobian.iter().zip(&w).map(|(row, w)| row[joint] * w).sum())
    }
}

#[test]
fn a_file_without_frames_has_its_link_frames() {
    let no_names: [&str; 0] = Puma::FRAME_NAMES;
    assert_eq!(no_names.len(), 0);
    let none: [Pose<f64>; 0] = Puma.frame_poses(&[0.0; 6]);
    assert_eq!(none.len(), 0);
    let q = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
    let elbow = Puma.pose_of::<{ Puma::frame("j3") }, _>(&q);
    assert!(elbow.translation.iter().any(|x: &f64| x.abs() > 0.1), "{elbow:?}");
}

#[test]
fn a_frame_is_a_place_on_its_link() {
    // R p + t of the link, which the file says: the camera is 50 mm above the end of the elbow's link
    let [_, _, elbow] = Desk.link_poses(&Q);
    let camera = Desk.pose_of::<{ Desk::frame("camera") }, _>(&Q);
    let expected: [f64; 3] = std::array::from_fn(|i| elbow.translation[i] + elbow.rotation[i][1] * 0.05);
    near(&camera.translation, &expected);
}
