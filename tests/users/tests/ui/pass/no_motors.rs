//! Motor terms of a robot without motors: zero, as those of a joint without one.

use rne::Actuation;

#[derive(Actuation)]
#[robot(path = "../robots/rod.yaml")]
struct Rod;

fn main() {
    assert_eq!(Rod.actuator_torques(&[0.1], &[0.2]), [0.0]);
    assert_eq!(Rod.actuator_torques_smooth(&[0.1], &[0.2], 0.1), [0.0]);
}
