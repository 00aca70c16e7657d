use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/rod.yaml", tests = true)]
struct Rod;

fn main() {}
