use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(urdf = "robots/arm.urdf")]
struct Arm;

fn main() {
    let _: [f64; 3] = Arm.inverse_dynamics(&[0.0; 3], &[0.0; 3], &[0.0; 3]);
}
