//! Two derives, one message.
use rne::{BatchInverseDynamics, InverseDynamics};

#[derive(InverseDynamics, BatchInverseDynamics)]
#[robot(path = "robots/nowhere.yaml")]
struct Arm;

fn main() {
    let mut tau = [0.0; 2];
    let _ = Arm.inverse_dynamics_batch([&[0.1; 2]], [&[0.2; 2]], [&[0.3; 2]], [&mut tau]);
}
