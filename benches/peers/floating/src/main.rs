//! Times functions of floating bases: rne, dynibo and Pinocchio in one process, interleaved, at the same random states.
//!
//! ```text
//! floating-peers FOLDER PINOCCHIO.so ROUNDS
//! ```
//!
//! FOLDER has `hyq.urdf` and `g1.urdf`, which `rne export` writes of the robot files, and files of `prepare.py`. Each
//! program takes a state in its own vectors, which are made before. The program prints tables in Markdown. It ends with
//! status 1 if results differ by more than 1e-10 of the largest.

mod competitors;
mod state;

use std::process::ExitCode;
use std::time::Instant;

use competitors::{Competitor, Quantity};
use libloading::Library;
use rne_machine::CompiledArm;
use state::State;

/// `HyQ` on a floating base.
#[derive(Clone, Copy, Default, rne::FloatingBase, rne::CentroidalMomentum, rne::BatchFloatingInverseDynamics)]
#[robot(path = "../../../trees/hyq_floating.yaml", form = "reduced", allow_lints)]
struct Hyq;

/// Unitree's G1 on a floating base.
#[derive(Clone, Copy, Default, rne::FloatingBase, rne::CentroidalMomentum, rne::BatchFloatingInverseDynamics)]
#[robot(path = "../../../trees/g1_floating.yaml", form = "reduced", allow_lints)]
struct G1;

/// States of a robot.
const STATES: usize = 1024;
/// Calls between two looks at the clock, short enough that other programs disturb few samples.
const STRETCH: usize = 256;
/// Repetitions before the first that counts.
const WARM_UP: usize = 3;
/// The largest difference, over the largest number.
const TOLERANCE: f64 = 1e-10;

/// The required ratios. Each line has a quantity, whether one call computes many states, the competitor, and how many
/// times as fast as this competitor rne must be.
const REQUIRED: [(Quantity, bool, &str, f64); 5] = [
    (Quantity::InverseDynamics, false, "pin_rnea", 7.0),
    (Quantity::InverseDynamics, false, "dynibo_rnea", 3.5),
    (Quantity::InverseDynamics, true, "pin_rnea", 25.0),
    (Quantity::ForwardDynamics, false, "pin_aba", 4.0),
    (Quantity::MomentumMatrix, false, "pin_ccrba", 4.0),
];

/// A line of the tables: the median and the least time for a state, ns, and the deviation from rne.
struct Row {
    name: &'static str,
    quantity: Quantity,
    is_batch: bool,
    median: f64,
    least: f64,
    deviation: f64,
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// The largest difference of all states over the largest number; not finite if a number is not.
fn deviation(other: &mut Competitor<'_>, ours: &mut Competitor<'_>) -> f64 {
    let (mut worst, mut scale) = (0.0_f64, 0.0_f64);
    for index in 0..STATES {
        let (found, expected) = ((other.result)(index), (ours.result)(index));
        assert_eq!(found.len(), expected.len(), "{}: as many numbers", other.name);
        for (a, b) in found.iter().zip(&expected) {
            let difference = (a - b).abs();
            worst = if difference <= worst { worst } else { difference };
        }
        scale = scale.max(largest(&expected));
    }
    worst / scale
}

/// Checks all competitors of a robot, and times them in turn.
fn compare<R, const DOF: usize, const NV: usize>(name: &str, folder: &str, library: &Library, rounds: usize) -> Vec<Row>
where
    R: rne::BatchFloatingInverseDynamics<DOF, NV, 1> + rne::CentroidalMomentum<DOF, NV> + Default,
{
    let urdf = format!("{folder}/{name}.urdf");
    let file = format!("{}/../../trees/{name}_floating.yaml", env!("CARGO_MANIFEST_DIR"));
    let arm = CompiledArm::from_file(&file).unwrap_or_else(|error| panic!("{error}"));
    let joints: Vec<String> = arm.robot().joints.iter().map(|joint| joint.name.clone()).collect();
    let mut random = fastrand::Rng::with_seed(1);
    let states: Vec<State<DOF>> = (0..STATES).map(|_| State::random(&mut random)).collect();
    let mut competitors = competitors::ours::<R, DOF, NV>(&states);
    competitors.push(competitors::batch::<R, DOF, NV>(&states));
    competitors.extend(competitors::machine(&states, &arm));
    competitors.extend(competitors::dynibo(&urdf, &joints, &states));
    competitors.extend(competitors::pinocchio(library, [folder, &format!("{name}_floating")], &states));
    let (ours, others) = competitors.split_at_mut(Quantity::ALL.len());
    let mut deviations = vec![0.0; ours.len()];
    for other in &mut *others {
        let same = ours.iter_mut().find(|competitor| competitor.quantity == other.quantity);
        deviations.push(same.map_or(f64::NAN, |ours| deviation(other, ours)));
    }
    let mut samples = vec![Vec::new(); competitors.len()];
    for round in 0..WARM_UP + rounds {
        for (competitor, samples) in competitors.iter_mut().zip(&mut samples) {
            let stretch = if competitor.is_batch { STATES } else { STRETCH };
            for first in (0..STATES).step_by(stretch) {
                let start = Instant::now();
                (competitor.call)(first..first + stretch);
                let nanoseconds =
                    start.elapsed().as_secs_f64() * 1e9 / f64::from(u16::try_from(stretch).unwrap_or(u16::MAX));
                if round >= WARM_UP {
                    samples.push(nanoseconds);
                }
            }
        }
    }
    let rows = competitors.iter().zip(samples).zip(deviations).map(|((competitor, mut samples), deviation)| {
        samples.sort_by(f64::total_cmp);
        let &Competitor { name, quantity, is_batch, .. } = competitor;
        Row { name, quantity, is_batch, median: samples[samples.len() / 2], least: samples[0], deviation }
    });
    rows.collect()
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, library, rounds] = arguments.as_slice() else {
        eprintln!("usage: floating-peers FOLDER PINOCCHIO.so ROUNDS");
        return ExitCode::from(2);
    };
    let rounds = rounds.parse().unwrap_or(1);
    // SAFETY: a library of this folder, whose constructors are those of Pinocchio and its libraries.
    let library = unsafe { Library::new(library) }.unwrap_or_else(|error| panic!("{error}"));
    let robots = [
        ("hyq", compare::<Hyq, 12, 18>("hyq", folder, &library, rounds)),
        ("g1", compare::<G1, 29, 35>("g1", folder, &library, rounds)),
    ];
    let [(first, hyq), (second, g1)] = &robots;
    println!("| function | competitor | {first} | {second} | deviation |\n|---|---|---:|---:|---:|");
    for quantity in Quantity::ALL {
        for (a, b) in hyq.iter().zip(g1).filter(|(row, _)| row.quantity == quantity) {
            let calls = if a.is_batch { ", 1024 states" } else { "" };
            let [one, two] = [a, b].map(|row| format!("{:.0} ({:.0})", row.median, row.least));
            let deviation = a.deviation.max(b.deviation);
            println!("| {} | {}{calls} | {one} | {two} | {deviation:.1e} |", quantity.name(), a.name);
        }
    }
    println!("\n| function | calls | against | required | {first} | {second} |\n|---|---|---|---:|---:|---:|");
    for (quantity, is_batch, rival, required) in REQUIRED {
        let ratio = |rows: &[Row]| {
            let is_ours =
                |row: &&Row| row.name.starts_with("rne") && row.quantity == quantity && row.is_batch == is_batch;
            let median = |row: Option<&Row>| row.map_or(f64::NAN, |row| row.median);
            median(rows.iter().find(|row| row.name == rival)) / median(rows.iter().find(is_ours))
        };
        let told = [hyq, g1].map(|rows| {
            let ratio = ratio(rows);
            format!("{ratio:.2} {}", if ratio >= required { "reached" } else { "not reached" })
        });
        let calls = if is_batch { "batch" } else { "single" };
        println!("| {} | {calls} | {rival} | ≥ {required} | {} |", quantity.name(), told.join(" | "));
    }
    let agree = robots.iter().flat_map(|(_, rows)| rows).all(|row| row.deviation <= TOLERANCE);
    ExitCode::from(u8::from(!agree))
}
