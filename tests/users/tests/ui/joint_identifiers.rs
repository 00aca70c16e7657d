use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/one_identifier.yaml")]
struct Two;

const ORDER: [usize; 2] = Two::order(["knee-1", "knee 1"]);

fn main() {
    println!("{:?} {}", Two.gravity_torques(&[0.1; 2]), ORDER[TwoJoint::Knee1 as usize]);
}
