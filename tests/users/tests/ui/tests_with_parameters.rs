//! Tests of a robot with a run-time parameter.

use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/loaded.yaml", tests)]
struct Arm {
    payload: f64,
}

fn main() {}
