//! Model-predictive control of a Panda: `cargo run --release --manifest-path examples/mpc/Cargo.toml [-- FILE …]`
//!
//! The arm reaches for two points, one after the other, within the limits of its positions, velocities and torques. A
//! plan of 20 intervals is improved once for each sample, 50 times a second. The arm carries a load that the controller
//! does not know, and its sensors have noise; a momentum observer tells the controller of external torques. The motion
//! runs twice: with a plan by Euler's semi-implicit method, and by that of Runge and Kutta.
//!
//! A FILE that ends in .csv gets the first motion: the columns t, off (m from the goal), whole and model (s
//! that an iteration took), goal1 and so on. A
//! FILE that ends in .svg gets a picture of it.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use mpc::controller::{NODES, Spent};
use mpc::experiment::{GOALS, INTERVAL, LOAD, SAMPLES, Sample, beyond, model_error, run};
use mpc::model::{DOF, Method};
use mpc::picture::picture;

/// A function that returns a time of an iteration, such as that of the whole call.
type Part = fn(&Spent) -> f64;

fn main() -> ExitCode {
    let methods = [("semi-implicit Euler", Method::Euler), ("Runge-Kutta, 4 slopes", Method::RungeKutta)];
    let motions = methods.map(|(_, method)| run(method));
    println!("Panda, {NODES} intervals of {INTERVAL} s, {LOAD} kg at the tip that the controller does not know\n");
    print!("{:<52}", "");
    for (name, _) in &methods {
        print!("{name:>24}");
    }
    println!("\nclosed loop");
    for (index, goal) in GOALS.iter().enumerate() {
        for (after, at) in [("0.5 s", SAMPLES / 4), ("1 s", SAMPLES / 2), ("2 s", SAMPLES)] {
            let off = |samples: &[Sample]| 1e3 * samples[index * SAMPLES + at - 1].off;
            row(&format!("tip from {goal:?} after {after}, mm"), &motions, off);
        }
    }
    for (part, name) in ["position, rad", "velocity, rad/s", "torque, N m"].into_iter().enumerate() {
        row(&format!("beyond a limit at most: {name}"), &motions, |samples| beyond(samples)[part]);
    }
    println!("model");
    let errors = methods.map(|(_, method)| 1e6 * model_error(method, &motions[0]));
    println!("  {:<50}{:>24.4}{:>24.4}", "error of an interval at most, urad", errors[0], errors[1]);
    println!("one real-time iteration, median (99 % are below)");
    let times: [(&str, Part); 4] = [
        ("whole, ms", |it| it.whole.as_secs_f64() * 1e3),
        ("intervals and their derivatives at 21 nodes, ms", |it| it.dynamics.as_secs_f64() * 1e3),
        ("these, tips, Jacobians and gravity, ms", |it| it.model.as_secs_f64() * 1e3),
        ("iterations of the solver", |it| f64::from(it.iterations)),
    ];
    for (name, of) in times {
        let cells = motions.each_ref().map(|samples| middle(samples, of));
        println!("  {name:<50}{:>24}{:>24}", cells[0], cells[1]);
    }
    for path in std::env::args_os().skip(1).map(PathBuf::from) {
        let text = match path.extension().and_then(|extension| extension.to_str()) {
            Some("csv") => table(&motions[0]),
            Some("svg") => picture(&motions[0]),
            _ => {
                eprintln!("{}: name a file that ends in .csv or .svg", path.display());
                return ExitCode::FAILURE;
            }
        };
        if let Err(error) = std::fs::write(&path, text) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// Prints a line with one number for each of the two motions.
fn row(name: &str, motions: &[Vec<Sample>; 2], of: impl Fn(&[Sample]) -> f64) {
    println!("  {name:<50}{:>24.2}{:>24.2}", of(&motions[0]), of(&motions[1]));
}

/// Returns the median of a time and, in brackets, its 99th percentile.
fn middle(samples: &[Sample], of: fn(&Spent) -> f64) -> String {
    let mut numbers: Vec<f64> = samples.iter().map(|sample| of(&sample.spent)).collect();
    numbers.sort_by(f64::total_cmp);
    let [middle, high] = [50, 99].map(|percent| numbers[numbers.len() * percent / 100]);
    format!("{middle:.3} ({high:.3})")
}

/// Returns the motion as CSV, with the inputs and outputs of the controller. `casadi_mpc.py` plans again from the same
/// inputs.
fn table(samples: &[Sample]) -> String {
    let mut table = String::from("t,off,whole,model,goal1,goal2,goal3");
    for joint in 1..=DOF {
        let names = ["q", "qd", "tau", "measured_q", "measured_qd", "external"];
        for name in names {
            let _ = write!(table, ",{name}{joint}");
        }
    }
    table.push('\n');
    for Sample { time, state, tau, off, spent, measured, external, reference: [x, y, z], .. } in samples {
        let (whole, model) = (spent.whole.as_secs_f64(), spent.model.as_secs_f64());
        let _ = write!(table, "{time:.3},{off},{whole},{model},{x},{y},{z}");
        for joint in 0..DOF {
            for numbers in [&state.q, &state.qd, tau, &measured.q, &measured.qd, external] {
                let _ = write!(table, ",{}", numbers[joint]);
            }
        }
        table.push('\n');
    }
    table
}
