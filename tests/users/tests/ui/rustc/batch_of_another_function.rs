//! A batch of mass matrices beside a derive of torques.
use rne::{BatchMassMatrix, InverseDynamics};

#[derive(InverseDynamics, BatchMassMatrix)]
#[robot(path = "../robots/rod.yaml")]
struct Rod;

fn main() {
    let _ = Rod;
}
