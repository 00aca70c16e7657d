//! The functions of the section Control of the README.

use rne::{FrameKinematics, InverseDynamics, Kinematics, Payload};

#[derive(InverseDynamics, Kinematics, FrameKinematics)]
#[robot(path = "../robots/puma560.yaml", form = "reduced")]
struct MyArm;

fn main() {
    let (q, qd, qdd) = ([0.1, -0.4, 0.3, 1.2, -0.7, 0.5], [0.5; 6], [1.0; 6]); // rad, rad/s, rad/s²
    let tool = Payload { mass: 1.5, com: [0.0, 0.0, 0.08], ..Payload::default() }; // kg, m

    let gravity = MyArm.gravity_torques(&q); // N m
    let tau = MyArm.inverse_dynamics_with_payload(&q, &qd, &qdd, &tool); // the payload is known at run time
    let jacobian = MyArm.jacobian(&q); // of the tip, in world axes
    let of_elbow = MyArm.jacobian_of::<{ MyArm::frame("j3") }, _>(&q); // of a link or a frame by name, as "camera"

    println!("{gravity:.4?}\n{tau:.4?}\n{jacobian:.4?}\n{of_elbow:.4?}");
}
