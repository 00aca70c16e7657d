//! Computes the torques of a trajectory of any length, from a CSV file to a CSV file, and measures the time.
//!
//! `cargo run --release --example trajectory -- --help`
#![allow(clippy::cast_precision_loss)] // fewer than 2⁵² states

use std::error::Error;
use std::fmt::Write;
use std::fs::{File, remove_file};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use std::{array, env};

use indicatif::{ProgressBar, ProgressStyle};
use rne::{BatchInverseDynamics, InverseDynamics, VectorUnit};

#[derive(InverseDynamics, BatchInverseDynamics)]
#[robot(path = "../robots/puma560.yaml", form = "reduced")]
struct Puma560;

const HELP: &str = "\
Torques of the PUMA 560 along a trajectory.

usage: trajectory [TRAJECTORY.csv [TORQUES.csv]]

TRAJECTORY.csv  columns q1 .. q6 (rad), qd1 .. qd6 (rad/s), qdd1 .. qdd6 (rad/s²) in any order, one state per line;
                without it, a million states are written to a temporary file and read from there
TORQUES.csv     columns tau1 .. tau6 (N m); without it, a new file in the folder of temporary files";

/// The numbers of one joint, one per state.
type Column = Vec<f64>;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    if arguments.len() > 2 || arguments.iter().any(|argument| argument.starts_with('-')) {
        println!("{HELP}");
        return if matches!(arguments[0].as_str(), "--help" | "-h") { Ok(()) } else { Err("no such arguments".into()) };
    }
    // names of files of this process, so that no other file is overwritten
    let temporary = |name: &str| env::temp_dir().join(format!("rne-{}-{name}", std::process::id()));
    let (given, output) = (arguments.first().map(PathBuf::from), arguments.get(1).map(PathBuf::from));
    let input = given.clone().unwrap_or_else(|| temporary("trajectory.csv"));
    let output = output.unwrap_or_else(|| temporary("torques.csv"));

    if given.is_some() && input.canonicalize().ok() == output.canonicalize().ok() {
        return Err("the torques need a file of their own".into());
    }
    if given.is_none() {
        generate(&input, 1_000_000)?;
    }
    let start = Instant::now();
    let trajectory = read(&input).map_err(|error| format!("{}: {error}", input.display()))?;
    let states = trajectory[0][0].len();
    report("reading", states, start.elapsed());

    let mut tau: [Column; Puma560::DOF] = array::from_fn(|_| vec![0.0; states]);
    let start = Instant::now();
    let [q, qd, qdd] = trajectory.each_ref().map(|columns| columns.each_ref().map(Vec::as_slice));
    Puma560.inverse_dynamics_batch(q, qd, qdd, tau.each_mut().map(Vec::as_mut_slice))?;
    report("dynamics", states, start.elapsed());

    let start = Instant::now();
    write(&output, &tau).map_err(|error| format!("{}: {error}", output.display()))?;
    report("writing", states, start.elapsed());

    println!("vector unit: {}; torques: {}", VectorUnit::widest(), output.display());
    if given.is_none() {
        remove_file(input)?;
    }
    Ok(())
}

fn report(what: &str, states: usize, time: Duration) {
    let (states, seconds) = (states as f64, time.as_secs_f64());
    println!("{what:<9} {states} states in {:8.1} ms: {:10.0} states/s", seconds * 1e3, states / seconds);
}

/// Reads positions, velocities and accelerations from the columns with their names.
fn read(path: &Path) -> Result<[[Column; Puma560::DOF]; 3], Box<dyn Error>> {
    let file = File::open(path)?;
    let bar = progress("reading", file.metadata()?.len());
    let mut reader = csv::Reader::from_reader(bar.wrap_read(file));
    let header = reader.headers()?.clone();
    let mut columns = Vec::new();
    for name in names(["q", "qd", "qdd"]) {
        let found = header.iter().position(|column| column.trim() == name);
        columns.push(found.ok_or_else(|| format!("there is no column `{name}`"))?);
    }
    let mut trajectory: [[Column; Puma560::DOF]; 3] = Default::default();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record)? {
        for (numbers, column) in trajectory.as_flattened_mut().iter_mut().zip(&columns) {
            let text = record[*column].trim();
            let line = || record.position().map_or(0, csv::Position::line);
            numbers.push(text.parse().map_err(|_| format!("line {}: `{text}` is no number", line()))?);
        }
    }
    bar.finish_and_clear();
    Ok(trajectory)
}

fn write(path: &Path, tau: &[Column; Puma560::DOF]) -> Result<(), Box<dyn Error>> {
    let states = tau[0].len();
    let bar = progress("writing", states as u64);
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record(names(["tau"]))?;
    let mut text = String::new();
    for state in 0..states {
        for torques in tau {
            text.clear();
            write!(text, "{}", torques[state])?;
            writer.write_field(&text)?;
        }
        writer.write_record(None::<&[u8]>)?;
        if state % 10_000 == 0 {
            bar.set_position(state as u64);
        }
    }
    writer.flush()?;
    bar.finish_and_clear();
    Ok(())
}

/// Writes a trajectory of sines, sampled at 1 kHz.
fn generate(path: &Path, states: u32) -> Result<(), Box<dyn Error>> {
    let bar = progress("generating", states.into());
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record(names(["q", "qd", "qdd"]))?;
    for state in 0..states {
        let time = f64::from(state) * 1e-3;
        let rates: [f64; Puma560::DOF] = array::from_fn(|joint| 1.0 + 0.3 * joint as f64);
        let motion = [
            rates.map(|rate| (rate * time).sin()),
            rates.map(|rate| rate * (rate * time).cos()),
            rates.map(|rate| -rate * rate * (rate * time).sin()),
        ];
        writer.write_record(motion.as_flattened().iter().map(|number| format!("{number:.6}")))?;
        if state % 10_000 == 0 {
            bar.set_position(state.into());
        }
    }
    writer.flush()?;
    bar.finish_and_clear();
    Ok(())
}

/// Returns names of columns: `q1`, `q2` and so on.
fn names<const N: usize>(quantities: [&str; N]) -> Vec<String> {
    quantities.iter().flat_map(|name| (1..=Puma560::DOF).map(move |joint| format!("{name}{joint}"))).collect()
}

/// Creates a progress bar, which is shown on a terminal only.
fn progress(what: &'static str, length: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:<10} {wide_bar} {percent:>3} % {eta:>4}");
    ProgressBar::new(length).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())).with_message(what)
}
