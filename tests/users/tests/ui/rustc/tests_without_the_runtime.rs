use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "../robots/rod.yaml", tests)]
struct Rod;

fn main() {
    let _: [f64; 1] = Rod.gravity_torques(&[0.3]);
}
