//! A field and the parameters of the robot file.

use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/loaded.yaml")]
struct Arm {
    payload: f64,
    colour: f64,
}

fn main() {}
