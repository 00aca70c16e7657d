use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/wrong_graph.yaml", form = "reduced")]
struct Rod;

fn main() {
    let tau: [f64; 1] = Rod.inverse_dynamics(&[0.6], &[1.3], &[-0.7]);
    println!("{} {tau:?} {:?}", Rod::NAME, Rod.gravity_torques(&[0.1_f32; Rod::DOF]));
}
