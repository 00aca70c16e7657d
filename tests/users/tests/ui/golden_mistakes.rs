//! A golden file with a letter for a digit, and a line that is too short.

use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/measured.yaml", tests)]
struct Arm;

fn main() {
    assert_eq!(Arm::DOF, 1);
}
