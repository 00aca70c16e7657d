use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "../robots/rod.yaml")]
struct Arm {
    m: String,
}

fn main() {}
