//! An arm at a frame: the functions of the frame, compiled at run time.

use rne_machine::{CompiledArm, Form, Function};
use rne_model::Robot;
use rne_runtime::{DynArm, Wrench};

const YAML: &str = include_str!("../../../docs/desk_arm_frames.yaml");
const Q: [f64; 3] = [0.4, 0.7, -1.1];
const QD: [f64; 3] = [0.9, -0.5, 1.3];
const WRENCH: Wrench<f64> = Wrench { force: [2.0, -1.5, 4.0], moment: [0.3, 0.7, -0.2] };

fn near(found: impl IntoIterator<Item = f64>, expected: impl IntoIterator<Item = f64>) {
    let (found, expected): (Vec<f64>, Vec<f64>) = (found.into_iter().collect(), expected.into_iter().collect());
    assert_eq!(found.len(), expected.len());
    for (x, y) in found.iter().zip(&expected) {
        assert!((x - y).abs() < 1e-14 * (1.0 + y.abs()) * 4.0, "{found:?} {expected:?}");
    }
}

#[test]
fn every_frame_is_the_runtime() {
    let robot = Robot::from_yaml(YAML).unwrap();
    for form in Form::ALL {
        let arm = CompiledArm::from_yaml(YAML).unwrap().in_form(form);
        for frame in robot.frame_ids() {
            let at = arm.at_frame(robot.frame_name(frame)).unwrap();
            let runtime = DynArm::from_robot(&robot.clone().at_frame(frame));
            let (pose, expected) = (at.forward_kinematics(&Q).unwrap(), runtime.forward_kinematics(&Q).unwrap());
            near(pose.rotation.concat(), expected.rotation.concat());
            near(pose.translation, expected.translation);
            near(at.jacobian(&Q).unwrap().concat(), runtime.jacobian(&Q).unwrap().concat());
            near(
                at.jacobian_rate_times_velocity(&Q, &QD).unwrap(),
                runtime.jacobian_rate_times_velocity(&Q, &QD).unwrap(),
            );
            near(at.wrench_torques(&Q, &WRENCH).unwrap(), runtime.wrench_torques(&Q, &WRENCH).unwrap());
            near(at.jacobian_rate(&Q, &QD).unwrap().concat(), runtime.jacobian_rate(&Q, &QD).unwrap().concat());
            let (found, expected) = (at.jacobian_derivatives(&Q).unwrap(), runtime.jacobian_derivatives(&Q).unwrap());
            near(found.concat().concat(), expected.concat().concat());
            // other functions are those of the tip
            assert_eq!(at.mass_matrix(&Q).unwrap(), arm.mass_matrix(&Q).unwrap());
        }
    }
}

#[test]
fn a_frame_is_compiled_once() {
    let arm = CompiledArm::from_yaml(YAML).unwrap();
    let [one, other] = [(); 2].map(|()| arm.clone().at_frame("camera").unwrap());
    let place = |arm: &CompiledArm| std::ptr::from_ref(arm.function(Function::Jacobian).unwrap()).addr();
    assert_eq!(place(&one), place(&other));
    assert_ne!(place(&one), place(&arm));
    let message = arm.at_frame("tip").unwrap_err().to_string();
    assert!(message.contains("`camera`, `gripper`, `table`") && message.contains("`waist`"), "{message}");
}
