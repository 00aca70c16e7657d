//! Positions that are hard on sine and cosine, and rates that are hard on rounding.

use std::f64::consts::FRAC_PI_4;

use fastrand::Rng;
use rne_model::Robot;

use crate::states::{self, State};

/// Positions near the end of the range of sine and cosine, and in it.
const LARGE: [f64; 4] = [99_950.0, -99_950.37, 31_415.926, -12_345.678];

/// Positions where a quadrant ends or the range does, and moderate ones; rates of any magnitude that has a square in
/// `float`.
pub(crate) fn states(robot: &Robot) -> Vec<State> {
    let mut special: Vec<f64> = vec![0.0, -0.0, 1e-30, -1e-12];
    // in single precision too, these are the last numbers of one quadrant and the first of the next
    for quarter in [-7.0, -3.0, -2.0, -1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 1001.0] {
        let bound: f64 = quarter * FRAC_PI_4;
        special.extend([bound, bound * (1.0 + 1e-7), bound * (1.0 - 1e-7), bound.next_up(), bound.next_down()]);
    }
    let mut rng = Rng::with_seed(99);
    let between = |rng: &mut Rng, range: f64| (2.0 * rng.f64() - 1.0) * range;
    let state = |index: usize| {
        let mut array = |range: f64| -> Vec<f64> { (0..robot.dof()).map(|_| between(&mut rng, range)).collect() };
        let mut joints = [3.2, 2.0, 5.0, 50.0].map(&mut array);
        match index % 4 {
            0 => joints[0] = vec![special[index / 4 % special.len()]; robot.dof()],
            1 => joints[0].fill_with(|| special[rng.usize(..special.len())]),
            // of one joint: the sum of the angles of parallel joints is to be in the range as well
            2 => joints[0][index % robot.dof()] = LARGE[rng.usize(..LARGE.len())],
            _ => {}
        }
        match index % 5 {
            0 => joints[1].fill(-0.0),
            1 => joints[1..3].iter_mut().flatten().for_each(|x| *x *= 10_f64.powf(between(&mut rng, 9.0))),
            _ => {}
        }
        let vectors = [(); 10].map(|()| [(); 3].map(|()| between(&mut rng, 10.0)));
        State { joints, vectors, rotation: states::rotation([(); 4].map(|()| between(&mut rng, 1.0))) }
    };
    (0..4 * special.len()).step_by(3).map(state).collect()
}
