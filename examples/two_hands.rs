//! Torques of a torso whose left hand pushes: the wrenches at two tips, by their names.

use rne::{TipWrenches, Wrench};

#[derive(TipWrenches)]
#[robot(path = "../docs/dual_arm.yaml")]
struct Dual; // gets the enum DualTip: a variant for each tip

fn main() {
    let (q, qd, qdd) = ([0.0, 0.3, 0.6, 0.3, 0.6], [0.0; 5], [0.0; 5]); // rad, rad/s, rad/s²

    let mut w = [Wrench::default(); 2]; // both hands are free
    w[DualTip::LeftHand as usize].force = [10.0, 0.0, 0.0]; // N, by the robot on its environment, in tip axes
    let tau = Dual.inverse_dynamics_with_wrenches(&q, &qd, &qdd, &w); // N m

    println!("{tau:.4?}");
}
