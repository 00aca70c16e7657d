//! Batches of a robot with a run-time parameter.

use rne::{BatchInverseDynamics, InverseDynamics};

#[derive(InverseDynamics, BatchInverseDynamics)]
#[robot(path = "robots/loaded.yaml")]
struct Arm {
    payload: f64,
}

fn main() {}
