//! Motor terms of a robot without motors.

use rne::Actuation;

#[derive(Actuation)]
#[robot(path = "robots/rod.yaml")]
struct Rod;

fn main() {
    let _ = Rod.actuator_torques(&[0.1], &[0.2]);
}
