use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/rod.yaml", allow_lints = true)]
struct Rod;

fn main() {}
