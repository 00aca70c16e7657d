use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "../robots/two.yaml")]
struct Two;

const ORDER: [usize; 2] = Two::order_with_others(["joint2", "gripper"]);

fn main() {
    let [tau, _] = Two.gravity_torques(&ORDER.map(|place| place as f64));
    println!("{tau}");
}
