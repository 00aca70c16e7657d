//! Model-predictive control of a Panda: `cargo run --release --manifest-path examples/mpc/Cargo.toml [-- motion.csv]`
//!
//! The arm reaches for two points, one after the other, within the limits of its positions, velocities and torques. A
//! plan of 20 intervals is improved once for each sample, 50 times a second. The arm carries a load that the controller
//! does not know, and its sensors have noise; a momentum observer tells the controller of external torques. The file
//! has the columns t, off (m from the goal), and q1, qd1, tau1 and so on.

use std::fmt::Write as _;
use std::process::ExitCode;

use mpc::controller::{NODES, Spent};
use mpc::experiment::{GOALS, INTERVAL, LOAD, SAMPLES, Sample, beyond, run};
use mpc::model::DOF;

fn main() -> ExitCode {
    let samples = run();
    println!("Panda, {NODES} intervals of {INTERVAL} s, {LOAD} kg at the tip that the controller does not know\n");
    println!("  goal, m               from the goal after 0.5 s        1 s        2 s");
    for (goal, samples) in GOALS.iter().zip(samples.chunks(SAMPLES)) {
        let off = [SAMPLES / 4, SAMPLES / 2, SAMPLES].map(|at| format!("{:7.2} mm", samples[at - 1].off * 1e3));
        println!("  {:<34} {}", format!("{goal:?}"), off.join(" "));
    }
    let [position, velocity, torque] = beyond(&samples);
    println!("\n  beyond a limit at most: {position:.2} rad, {velocity:.2} rad/s, {torque:.2} N m");
    println!("\none real-time iteration, median of {}:", samples.len());
    row(&samples, "whole, ms", |it| it.whole.as_secs_f64() * 1e3);
    row(&samples, "accelerations and their derivatives at 21 nodes, us", |it| it.dynamics.as_secs_f64() * 1e6);
    row(&samples, "these, tips, Jacobians and gravity, us", |it| it.model.as_secs_f64() * 1e6);
    row(&samples, "iterations of the solver", |it| f64::from(it.iterations));
    if let Some(path) = std::env::args_os().nth(1)
        && let Err(error) = std::fs::write(&path, table(&samples))
    {
        eprintln!("{}: {error}", path.display());
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

/// The median of a number, and what 99 % of the samples are below.
fn row(samples: &[Sample], name: &str, of: fn(&Spent) -> f64) {
    let mut numbers: Vec<f64> = samples.iter().map(|sample| of(&sample.spent)).collect();
    numbers.sort_by(f64::total_cmp);
    let [middle, high] = [50, 99].map(|percent| numbers[numbers.len() * percent / 100]);
    println!("  {name:<52} {middle:8.2}   99 % below {high:.2}");
}

fn table(samples: &[Sample]) -> String {
    let mut table = String::from("t,off");
    for joint in 1..=DOF {
        let _ = write!(table, ",q{joint},qd{joint},tau{joint}");
    }
    table.push('\n');
    for Sample { time, state, tau, off, .. } in samples {
        let _ = write!(table, "{time:.3},{off}");
        for ((q, qd), tau) in state.q.iter().zip(&state.qd).zip(tau) {
            let _ = write!(table, ",{q},{qd},{tau}");
        }
        table.push('\n');
    }
    table
}
