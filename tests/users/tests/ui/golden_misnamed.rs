//! A golden file that the tests would not find: two letters of its name are swapped. A derive says so, once.
#![deny(warnings)]

use rne::{InverseDynamics, MassMatrix};

#[derive(MassMatrix, InverseDynamics)]
#[robot(path = "robots/recorded.yaml", tests)]
struct Arm;

#[derive(InverseDynamics)]
#[robot(path = "robots/recorded.yaml", tests, allow_lints)]
struct Known;

#[derive(InverseDynamics)]
#[robot(path = "robots/recorded.yaml")]
struct Untested;

fn main() {
    assert_eq!((Arm::DOF, Known::DOF, Untested::DOF), (1, 1, 1));
    let _ = Arm.mass_matrix(&[0.0_f32]);
}
