//! The ten-line example of the README.

use rne::InverseDynamics;

/// The robot of `robots/puma560.yaml`, unrolled at compile time.
#[derive(InverseDynamics)]
#[robot(path = "../robots/puma560.yaml")] // relative to this source file
pub struct Puma560;

fn main() {
    let q = [0.1, -0.4, 0.3, 1.2, -0.7, 0.5]; // rad
    let tau = Puma560.inverse_dynamics(&q, &[0.5; 6], &[1.0; 6]); // N m
    println!("{tau:.4?}");
}
