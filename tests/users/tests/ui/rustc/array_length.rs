use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "../robots/two.yaml")]
struct Two;

fn main() {
    let tau = Two.inverse_dynamics(&[0.6, 0.1], &[1.3, 0.2, 0.0], &[-0.7, 0.3]);
    println!("{tau:?}");
}
