//! A field and the parameters of the robot file.

use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/loaded.yaml")]
struct Arm {
    shift: f64,
}

fn main() {}
