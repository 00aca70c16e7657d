//! States that are arrays, given as rows of numbers.

use rne::compiled::{Arguments, Array, CompiledArm, Destination, Function};

fn main() {
    let many: Vec<[f64; 7]> = vec![[0.1; 7]; 10];
    let mut torques = vec![[0.0; 7]; 10];
    let arm = CompiledArm::from_file("panda.yaml").unwrap();
    let arguments = Arguments::new().q(Array::Rows(&many));
    arm.run(Function::GravityTorques, 10, &arguments, Destination::Rows(&mut torques)).unwrap();
}
