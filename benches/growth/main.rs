//! What grows with the number of joints: operations, expansion, compile time, code size.
//!
//! ```sh
//! cargo xtask growth           # 1, 2, 5, 10, 20, 30, 40 and 50 joints; some minutes
//! cargo xtask growth 1 5 10    # these only
//! ```
//!
//! Random chains in which nothing folds: no number is zero, no angle right. For each form a table, with the increment
//! per joint beside each column: where it stays the same, the growth is linear.
//!
//! - operations: products and sums of `inverse_dynamics`
//! - expansion: from the text of the robot file to the four programs and their text, in this example's profile. Cargo
//!   compiles macros without optimization in all profiles, so `cargo run` without `--release` measures what a build
//!   does.
//! - dev, release: `cargo build` of a crate that derives the chain and calls `inverse_dynamics`, after a change,
//!   expansion included; its dependencies are built already
//! - code: bytes of instructions in the object file of that crate, release profile
//!
//! ```sh
//! cargo xtask growth --robot benches/trees/g1.yaml    # what each function of a robot file costs a release build
//! ```
//!
//! A row for each derive: its `cargo build --release` as above, with calls of its functions, and code. The derives
//! come in the form `reduced`, with the plan file beside the robot file.
//!
//! Times are processor time where the system is Linux, since a machine may be shared, else time of the clock. `fails`:
//! the compiler gave up.

mod chain;
mod functions;
mod time;
mod user;

use std::fmt::Write;
use std::time::Instant;

use rne_codegen::{Compiler, Form, Function};
use rne_model::Robot;

const JOINTS: [usize; 8] = [1, 2, 5, 10, 20, 30, 40, 50];
/// The fastest of so many tries counts: the machine may be shared.
const TRIES: usize = 2;

/// One chain in one form.
struct Sample {
    joints: usize,
    /// Operations, milliseconds of the expansion, seconds of the two builds, bytes of code.
    values: [f64; COLUMNS.len()],
}

/// Titles and decimals.
const COLUMNS: [(&str, usize); 5] =
    [("operations", 0), ("expansion, ms", 1), ("dev, s", 2), ("release, s", 2), ("code, bytes", 0)];

fn main() {
    if std::env::args().nth(1).is_some_and(|word| word == "--robot") {
        return std::env::args().skip(2).for_each(|file| functions::print(&file));
    }
    let given: Result<Vec<usize>, _> = std::env::args().skip(1).map(|word| word.parse()).collect();
    let joints = match given {
        Ok(given) if given.is_empty() => JOINTS.to_vec(),
        Ok(given) if !given.contains(&0) => given,
        _ => {
            eprintln!("usage: growth [JOINTS]...\n\nJOINTS: numbers of joints, 1 or more each; by default {JOINTS:?}");
            std::process::exit(2);
        }
    };
    for form in [Form::SevenSteps, Form::Reduced] {
        println!("{}", header(form));
        let mut samples: Vec<Sample> = Vec::new();
        for &joints in &joints {
            let sample = Sample { joints, values: measure(joints, form) };
            println!("{}", row(&sample, samples.last()));
            samples.push(sample);
        }
        println!("\n{}\n", fit(&samples));
    }
}

#[allow(clippy::cast_precision_loss)] // counts are small
fn measure(joints: usize, form: Form) -> [f64; COLUMNS.len()] {
    let yaml = chain::yaml(joints);
    let expansion = fastest(|| {
        operations(&yaml, form);
    });
    let user = user::Crate::new(&yaml, joints, form);
    let [dev, release] = ["dev", "release"].map(|profile| {
        let mut is_built = true;
        let seconds = fastest(|| is_built &= user.build(profile));
        if is_built { seconds } else { f64::NAN }
    });
    let code = if release.is_nan() { f64::NAN } else { user.code_size() as f64 };
    [operations(&yaml, form) as f64, expansion * 1e3, dev, release, code]
}

/// What the derive does; the operations of `inverse_dynamics`.
fn operations(yaml: &str, form: Form) -> usize {
    let robot = Robot::from_yaml(yaml).unwrap_or_else(|report| panic!("{report}"));
    let compiler = Compiler::new(&robot);
    let programs =
        Function::TORQUES.map(|function| compiler.compile(function, form).unwrap_or_else(|error| panic!("{error}")));
    std::hint::black_box(rne_emit::rust_file(&robot, &programs));
    programs[0].operations().total()
}

/// Seconds.
fn fastest(mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    let mut best = f64::INFINITY;
    for _ in 0..TRIES {
        best = best.min(time::of(start, &mut work).1);
    }
    best
}

fn header(form: Form) -> String {
    let titles = COLUMNS.map(|(title, _)| title).join(" | per joint | ");
    format!("| {form}: joints | {titles} | per joint |\n|---:|{}", "---:|---:|".repeat(COLUMNS.len()))
}

#[allow(clippy::cast_precision_loss)]
fn row(sample: &Sample, before: Option<&Sample>) -> String {
    let mut text = format!("| {} |", sample.joints);
    for (column, (_, decimals)) in COLUMNS.iter().enumerate() {
        let value = sample.values[column];
        let increment = before.map_or_else(String::new, |before| {
            let increment = (value - before.values[column]) / (sample.joints as f64 - before.joints as f64);
            number(increment, if *decimals > 0 { decimals + 1 } else { 1 })
        });
        let _ = write!(text, " {} | {increment} |", number(value, *decimals));
    }
    text
}

fn number(value: f64, decimals: usize) -> String {
    if value.is_nan() { String::from("fails") } else { format!("{value:.decimals$}") }
}

/// The straight line through the samples from five joints on, by least squares, and how far they are from it.
#[allow(clippy::cast_precision_loss)]
fn fit(samples: &[Sample]) -> String {
    let long: Vec<&Sample> = samples.iter().filter(|sample| sample.joints >= 5).collect();
    if long.len() < 3 {
        return String::from("A line needs three chains of five joints or more.");
    }
    let lines = COLUMNS.iter().enumerate().map(|(column, (title, _))| {
        let points = long.iter().map(|sample| (sample.joints as f64, sample.values[column]));
        let points: Vec<(f64, f64)> = points.filter(|point| !point.1.is_nan()).collect();
        let count = points.len() as f64;
        let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
        let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
        let slope = covariance / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>();
        let constant = y - slope * x;
        let off = points.iter().map(|point| ((constant + slope * point.0) / point.1 - 1.0).abs()).fold(0.0, f64::max);
        let sign = if constant < 0.0 { '-' } else { '+' };
        format!("- {title}: {slope:.3} n {sign} {:.2}, at most {:.1} % off", constant.abs(), off * 100.0)
    });
    lines.collect::<Vec<_>>().join("\n")
}
