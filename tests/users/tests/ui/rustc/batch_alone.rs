//! The second derive without the first.
use rne::BatchInverseDynamics;

#[derive(BatchInverseDynamics)]
#[robot(path = "../robots/rod.yaml")]
struct Rod;

fn main() {
    let _ = Rod;
}
