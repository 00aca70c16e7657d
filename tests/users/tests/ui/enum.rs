use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/rod.yaml")]
enum Rod {
    Short,
    Long,
}

fn main() {
    let tau: [f64; 1] = Rod::Short.inverse_dynamics(&[0.6], &[1.3], &[-0.7]);
    println!("{} {tau:?} {:?}", Rod::NAME, Rod::Long.gravity_torques(&[0.1_f32]));
}
