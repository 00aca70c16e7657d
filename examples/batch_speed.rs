//! Nanoseconds per state of a batch, on every vector unit of this processor.
//!
//! `cargo run --release --example batch_speed`
#![allow(clippy::cast_precision_loss)] // a few hundred states

use std::hint::black_box;
use std::time::Instant;

use fastrand::Rng;
use rne::{BatchInverseDynamics, BatchScalar, InverseDynamics, VectorUnit};

#[derive(InverseDynamics, BatchInverseDynamics)]
#[robot(path = "../robots/puma560.yaml", form = "reduced")]
struct Puma560;

#[derive(InverseDynamics, BatchInverseDynamics)]
#[robot(path = "../robots/panda.yaml", form = "reduced")]
struct Panda;

/// Number of states of a batch; they fit in the first-level cache of most processors.
const STATES: usize = 512;

fn main() {
    println!("{:<10} {:<6} {:<8} {:>9}", "robot", "number", "unit", "ns/state");
    table::<f64, 6>("puma560", "f64", &Puma560);
    table::<f32, 6>("puma560", "f32", &Puma560);
    table::<f64, 7>("panda", "f64", &Panda);
    table::<f32, 7>("panda", "f32", &Panda);
}

fn table<T: BatchScalar, const DOF: usize>(robot_name: &str, number: &str, robot: &impl BatchInverseDynamics<DOF>) {
    let mut rng = Rng::with_seed(1);
    let inputs = [(); 3].map(|()| [(); DOF].map(|()| [(); STATES].map(|()| T::from_f64(6.0 * rng.f64() - 3.0))));
    let [q, qd, qdd] = inputs.each_ref().map(|arrays| arrays.each_ref().map(|numbers| &numbers[..]));
    let mut tau = [[T::zero(); STATES]; DOF];

    let one_by_one = fastest(|| {
        for state in 0..STATES {
            let [q, qd, qdd] = [q, qd, qdd].map(|input| input.map(|numbers| numbers[state]));
            for (tau, torque) in tau.iter_mut().zip(robot.inverse_dynamics(&q, &qd, &qdd)) {
                tau[state] = torque;
            }
        }
    });
    println!("{robot_name:<10} {number:<6} {:<8} {one_by_one:>9.2}", "single");
    for unit in VectorUnit::all() {
        let time = fastest(|| {
            let tau = tau.each_mut().map(|torques| &mut torques[..]);
            black_box(robot.inverse_dynamics_batch_on(unit, q, qd, qdd, tau)).expect("equal lengths");
        });
        println!("{robot_name:<10} {number:<6} {unit:<8} {time:>9.2}");
    }
}

/// Runs a function many times and returns the shortest time, in nanoseconds per state.
fn fastest(mut run: impl FnMut()) -> f64 {
    let times = (0..2000).map(|_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min) * 1e9 / STATES as f64
}
