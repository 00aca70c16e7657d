//! An ankle that two rods drive: the torques of its two motors, and how they map to pitch and roll of the foot.

use rne::ClosedLoops;

#[derive(ClosedLoops)]
#[robot(path = "../benches/trees/loops/g1_ankle.yaml", form = "reduced", allow_lints)]
struct Ankle; // q: motor_left, motor_right; the dependent joints: pitch, roll and those of the rods

fn main() {
    let (q, qd, qdd): ([f64; 2], [f64; 2], [f64; 2]) = ([0.15, -0.1], [1.2, -0.8], [3.0, 5.0]); // rad, rad/s, rad/s²

    // the positions of the dependent joints, from a guess; the residual says whether the loops are closed
    let closed = Ankle.close(&q, &[0.0; Ankle::PASSIVE]);
    let left = closed.residual.iter().fold(0.0_f64, |largest, left| largest.max(left.abs()));
    println!("pitch {:.4} rad, roll {:.4} rad; {left:.0e} m are left", closed.passive[0], closed.passive[1]);
    assert!(left < 1e-12, "the rods do not reach");
    let passive = closed.passive;

    // the motors' torques for a motion
    let tau = Ankle.inverse_dynamics_of_loops(&q, &passive, &qd, &qdd);
    println!("motors: {:.3} and {:.3} N m", tau[0], tau[1]);

    // G, which maps the rates of the motors to those of pitch and roll; its transpose maps a torque about pitch to
    // torques of the motors
    let map = Ankle.loop_map(&q, &passive);
    let [pitch, roll] = [0, 1].map(|joint| map[joint][0] * qd[0] + map[joint][1] * qd[1]);
    println!("the foot turns with {pitch:.3} rad/s in pitch and {roll:.3} rad/s in roll");
    println!("10 N m about pitch ask {:.2} and {:.2} N m of the motors", 10.0 * map[0][0], 10.0 * map[0][1]);

    // these torques cause this motion
    let found = Ankle.forward_dynamics_of_loops(&q, &passive, &qd, &tau);
    assert!(found.iter().zip(&qdd).all(|(found, given)| (found - given).abs() < 1e-9), "{found:?}");
}
