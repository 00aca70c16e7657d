use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(yaml = "
    format: 1
    name: rod
    source: lecture 38, one-link example
    convention: standard
    gravity: [9.81, 0, 0]
    joints:
      - type: revolute
        dh: {theta: 0, d: 0, a: 0.8, alpha: 0}
        link: {mass: 2.5 kg, com: [-0.4, 0, 0]}
")]
struct Rod;

fn main() {
    let tau: [f64; 1] = Rod.inverse_dynamics(&[0.6], &[1.3], &[-0.7]);
    println!("{} {tau:?} {:?}", Rod::NAME, Rod.gravity_torques(&[0.1_f32; Rod::DOF]));
}
