//! HyQ stands on four feet: the torques that carry it, and the forces under its feet, now and when a knee gives way.

use std::array::from_fn;

use rne::{BaseMotion, CentreOfMass, ContactDynamics, FloatingBase, FloatingKinematics, FrameKinematics, Wrench};

#[derive(FloatingBase, FloatingKinematics, ContactDynamics, CentreOfMass, FrameKinematics)]
#[robot(path = "../docs/standing_hyq.yaml")]
struct Hyq; // the tips are the feet: left front, left hind, right front, right hind

/// The trunk is level: its axes are those of the world.
const LEVEL: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn main() {
    // hips level, knees bent; each leg is hip abduction, hip flexion, knee, rad
    let q = [0.0, 0.75, -1.5, 0.0, -0.75, 1.5, 0.0, 0.75, -1.5, 0.0, -0.75, 1.5];
    let (rest, omega) = ([0.0; 12], [0.0; 3]);

    // in the air, these carry the robot: the weight at the base, and the torques of the legs that hang
    let base = BaseMotion::fixed([0.0, 0.0, -9.81]);
    let hanging = Hyq.inverse_dynamics_of_floating_base(&q, &rest, &rest, &base, &[Wrench::default(); 4]);
    let weight = hanging.wrench.force[2]; // N

    // the feet share the weight by the lever rule, so that the centre of mass stays above them
    let [lf, lh, rf, _] = Hyq.frame_poses(&q).map(|foot| foot.translation);
    let [x, y, _] = Hyq.centre_of_mass(&q);
    let (front, left) = ((x - lh[0]) / (lf[0] - lh[0]), (y - rf[1]) / (lf[1] - rf[1]));
    let share = [front * left, (1.0 - front) * left, front * (1.0 - left), (1.0 - front) * (1.0 - left)];
    let jacobians = Hyq.tip_jacobians(&q, &LEVEL); // row 2 is z
    let carried = |joint: usize| (0..4).map(|foot| jacobians[foot][2][6 + joint] * share[foot] * weight).sum::<f64>();
    let tau: [f64; 12] = from_fn(|joint| hanging.tau[joint] - carried(joint)); // N m

    let standing = Hyq.forward_dynamics_in_contact(&q, &rest, &tau, &omega, &LEVEL);
    let forces = standing.wrenches_on_robot.map(|wrench| wrench.force); // N, on the robot, in world axes
    let sum: f64 = forces.iter().map(|force| force[2]).sum();
    println!("weight {weight:.3} N, under the feet {sum:.3} N: {forces:.1?}");
    let fastest = standing.accelerations.qdd.iter().fold(0.0_f64, |largest, qdd| largest.max(qdd.abs()));
    println!("the fastest joint accelerates with {fastest:.0e} rad/s²");

    // the knee of the right hind leg gives way
    let weak: [f64; 12] = from_fn(|joint| if joint == 11 { 0.0 } else { tau[joint] });
    let falling = Hyq.forward_dynamics_in_contact(&q, &rest, &weak, &omega, &LEVEL);
    let up = falling.accelerations.base.linear[2] - 9.81; // m/s²
    let forces = falling.wrenches_on_robot.map(|wrench| wrench.force[2]);
    println!("without a knee the trunk accelerates with {up:.2} m/s² upwards, under the feet {forces:.1?} N");
    assert!((sum - weight).abs() < 1e-6 * weight && fastest < 1e-4);
}
