use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(builtin = "puma")]
struct Puma;

fn main() {
    let tau = Puma.inverse_dynamics(&[0.0; 6], &[0.0; 6], &[0.0; 6]);
    println!("{tau:?}");
}
