//! Lints are warnings, so that `deny(warnings)` makes errors of them; two derives say each once.
#![deny(warnings)]

use rne::{InverseDynamics, MassMatrix};

#[derive(InverseDynamics, MassMatrix)]
#[robot(path = "robots/lints.yaml")]
struct Arm;

fn main() {
    let _: [f64; 3] = Arm.inverse_dynamics(&[0.0; 3], &[0.0; 3], &[0.0; 3]);
    let _ = Arm.mass_matrix(&[0.0_f32; 3]);
}
