//! A field and the parameters of the robot file.

use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/loaded.yaml")]
struct Arm {
    tilt: f64,
}

fn main() {}
