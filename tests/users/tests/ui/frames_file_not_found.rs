//! The frames of a robot without a file: the calls are no mistakes of their own.
use rne::{FrameKinematics, InverseDynamics, Kinematics};

#[derive(InverseDynamics, Kinematics, FrameKinematics)]
#[robot(path = "robots/nowhere.yaml")]
struct Arm;

fn main() {
    let q = [0.1; 2];
    let _ = Arm.pose_of::<0, f64>(&q);
    let _ = Arm.jacobian_of::<{ Arm::frame("camera") }, _>(&q);
    let _ = (Arm.frame_poses(&q), Arm::FRAME_NAMES);
}
