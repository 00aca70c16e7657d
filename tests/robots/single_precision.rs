//! f32: how far single precision is from double precision.

use fastrand::Rng;

use crate::shipped::{Shipped, Visitor, visit_all};
use crate::states::{self, State};

/// Largest error relative to the largest torque of the state.
const TOLERANCE: f64 = 2e-5;

struct SinglePrecision;

impl Visitor for SinglePrecision {
    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is what is measured
    fn visit<const DOF: usize, R: Shipped<DOF>>(&mut self, robot: &R) {
        let mut rng = Rng::with_seed(32);
        let mut worst = 0.0_f64;
        for _ in 0..10_000 {
            let State { q, qd, qdd, .. } = states::moderate::<DOF, R>(&mut rng);
            // the same state in both precisions
            let [q, qd, qdd] = [q, qd, qdd].map(|array| array.map(|value| value as f32));
            let single = robot.inverse_dynamics(&q, &qd, &qdd);
            let double = robot.inverse_dynamics(&q.map(f64::from), &qd.map(f64::from), &qdd.map(f64::from));
            let scale = double.iter().fold(0.0_f64, |scale, torque| scale.max(torque.abs()));
            for (single, double) in single.iter().zip(double) {
                worst = worst.max((f64::from(*single) - double).abs() / scale);
            }
        }
        println!("| {} | {worst:.1e} |", R::NAME);
        assert!(worst <= TOLERANCE, "{}: {worst}", R::NAME);
    }
}

#[test]
fn single_precision_is_close_to_double() {
    println!("| robot | worst error of f32, of max abs torque |\n|---|---|");
    visit_all(&mut SinglePrecision);
}
