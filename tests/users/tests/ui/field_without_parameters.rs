//! A field and the parameters of the robot file.

use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/rod.yaml")]
struct Arm {
    payload: f64,
}

fn main() {}
