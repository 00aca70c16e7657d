//! Prints which changes `rne watch` detects: friction and payloads of several sizes, added by computation to two public
//! logs and to simulated logs. It also prints the rate of false alarms.
//!
//! ```sh
//! cargo run --release -p rne-watch --example power
//! cargo run --release -p rne-watch --example power -- 30
//! ```
//!
//! The argument is the number of simulated arms. The default is 300, which takes some minutes.

#[path = "../tests/common/mod.rs"]
mod common;

use common::simulated::Simulated;
use common::{Fault, PUBLIC, baseline, changes, public, split, with};
use rne_identify::Structure;
use rne_logs::Motion;
use rne_watch::{Baseline, Cause, Changes};

/// Sizes of changes, as parts of a joint's Coulomb friction, or of a large payload.
const SIZES: [f64; 5] = [0.10, 0.15, 0.25, 0.50, 1.00];

/// Parts of a public log, from its beginning and from its end, that are used as the quiet log.
const SPLITS: [f64; 2] = [0.5, 0.6];

/// Motions that differ from that of the quiet log: factors of the amplitude and of the frequencies.
const MOTIONS: [[f64; 2]; 7] = [[0.1, 1.0], [0.3, 1.0], [1.0, 0.3], [1.0, 0.5], [0.5, 2.0], [1.0, 2.0], [2.0, 1.0]];

/// Gains of a channel of efforts: dead, with the opposite sign, with another unit or torque constant.
const GAINS: [f64; 4] = [0.0, -1.0, 0.5, 0.8];

/// Delays of all efforts, s.
const DELAYS: [f64; 2] = [0.01, 0.03];

/// Counts of logs with one kind and size of change.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    logs: u32,
    detected: u32,
    named: u32,
    inside: u32,
    several: u32,
}

impl Cell {
    fn take(&mut self, changes: &Changes, fault: Fault) {
        self.logs += 1;
        let Some(event) = changes.events.first() else { return };
        let (is_named, size) = match fault {
            Fault::Coulomb(joint, size) | Fault::Viscous(joint, size) => {
                (event.cause == Cause::Friction && event.joint == Some(joint), size)
            }
            Fault::Payload(mass) => (event.cause == Cause::Payload, mass),
            Fault::Delay(delay) => (event.parameter == "delay", delay),
            Fault::Gain(joint, gain) => (event.parameter == "gain" && event.joint == Some(joint), gain - 1.0),
        };
        let is_inside = is_named && (event.change() - size).abs() < event.half_interval;
        self.detected += 1;
        self.named += u32::from(is_named);
        self.inside += u32::from(is_inside && event.parameter != "viscous");
        self.several += u32::from(changes.events.len() > 1);
    }

    fn add(&mut self, other: Self) {
        self.logs += other.logs;
        self.detected += other.detected;
        self.named += other.named;
        self.inside += other.inside;
        self.several += other.several;
    }
}

/// A row of the table: a name, and a cell for each size.
type Row = (String, [Cell; SIZES.len()]);

fn print(rows: &[Row]) {
    println!(
        "{:<28}{}",
        "detected / named / inside",
        SIZES.map(|size| format!("{:>16}", format!("{:.0} %", 100.0 * size))).concat()
    );
    for (name, cells) in rows {
        let cell = |cell: &Cell| format!("{} / {} / {}", cell.detected, cell.named, cell.inside);
        let cells: Vec<String> = cells.iter().map(|of| format!("{:>16}", cell(of))).collect();
        println!("{name:<28}{}", cells.concat());
    }
}

/// Counts of logs in which nothing has changed, and of their alarms.
#[derive(Default)]
struct Quiet {
    logs: u32,
    alarms: u32,
    seconds: f64,
}

impl Quiet {
    fn take(&mut self, structure: &Structure, quiet: &Baseline, motion: &Motion) {
        self.logs += 1;
        self.alarms += u32::from(!changes(structure, quiet, motion).events.is_empty());
        self.seconds += motion.time.last().zip(motion.time.first()).map_or(0.0, |(last, first)| last - first);
    }

    fn print(&self, what: &str) {
        let hours = self.seconds / 3600.0;
        // without any alarm, the 95 % bound of their expected number is three
        let most = if self.alarms == 0 { 3.0 } else { f64::from(self.alarms) };
        let bound = if self.alarms == 0 { "at most " } else { "" };
        println!(
            "{what}: {} of {} logs have an event, in {hours:.2} h: {bound}{:.1} an hour",
            self.alarms,
            self.logs,
            most / hours
        );
    }
}

fn main() {
    let arms = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(300);
    let mut unchanged = Quiet::default();
    let mut several = Cell::default();
    for (name, cutoff) in PUBLIC {
        let (robot, motion) = public(name, cutoff);
        let structure = Baseline::structure(&robot, cutoff);
        let mut rows: Vec<Row> = robot.joints.iter().map(|joint| (joint.name.clone(), Default::default())).collect();
        let largest = if name == "ur10" { 5.0 } else { 2.0 };
        rows.push((format!("payload, of {largest} kg"), Default::default()));
        for fraction in SPLITS {
            for is_reversed in [false, true] {
                let [quiet, watched] = split(&motion, fraction, is_reversed);
                let quiet = baseline(&structure, &quiet);
                unchanged.take(&structure, &quiet, &watched);
                for (at, size) in SIZES.into_iter().enumerate() {
                    for (row, cells) in rows.iter_mut().enumerate() {
                        let fault = match quiet.scale.friction.get(row) {
                            Some(friction) => Fault::Coulomb(row, size * friction),
                            None => Fault::Payload(size * largest),
                        };
                        let log = with(&robot, &watched, fault, f64::NEG_INFINITY);
                        cells.1[at].take(&changes(&structure, &quiet, &log), fault);
                    }
                }
            }
        }
        println!("\n{name}: public log, {} logs for each number", 2 * SPLITS.len());
        print(&rows);
        rows.iter().flat_map(|(_, cells)| cells).for_each(|cell| several.add(*cell));
    }
    let mut quiet_logs = Quiet::default();
    let mut rows: Vec<Row> = vec![
        ("Coulomb friction".to_owned(), Default::default()),
        ("payload, of 5 or 2 kg".to_owned(), Default::default()),
    ];
    let mut delays = [Cell::default(); DELAYS.len()];
    let mut gains = [Cell::default(); GAINS.len()];
    let mut others: [Quiet; MOTIONS.len()] = Default::default();
    for seed in 0..arms {
        let arm = Simulated::new(seed);
        let quiet = baseline(&arm.structure, &arm.quiet);
        quiet_logs.take(&arm.structure, &quiet, &arm.watched);
        for (at, size) in SIZES.into_iter().enumerate() {
            let joint = usize::try_from(seed).unwrap_or_default() % arm.friction.len();
            let faults = [Fault::Coulomb(joint, size * arm.friction[joint]), Fault::Payload(size * arm.payload)];
            for (row, fault) in rows.iter_mut().zip(faults) {
                row.1[at].take(&changes(&arm.structure, &quiet, &arm.with(fault)), fault);
            }
        }
        for (cell, gain) in gains.iter_mut().zip(GAINS) {
            let fault = Fault::Gain(usize::try_from(seed).unwrap_or_default() % arm.friction.len(), gain);
            cell.take(&changes(&arm.structure, &quiet, &arm.with(fault)), fault);
        }
        for (cell, delay) in delays.iter_mut().zip(DELAYS) {
            let fault = Fault::Delay(delay);
            cell.take(&changes(&arm.structure, &quiet, &arm.with(fault)), fault);
        }
        for ([amplitude, frequency], other) in MOTIONS.into_iter().zip(&mut others) {
            other.take(&arm.structure, &quiet, &Simulated::moved(seed, amplitude, frequency).watched);
        }
    }
    println!("\nsimulated arms: {arms} logs for each number");
    print(&rows);
    for (gain, cell) in GAINS.into_iter().zip(&gains) {
        println!("gain of a channel {gain:<10}{} / {} / {}", cell.detected, cell.named, cell.inside);
        several.add(*cell);
    }
    for (delay, cell) in DELAYS.into_iter().zip(&delays) {
        println!("delay of {:<3} ms {:<13}{} / {} / {}", 1e3 * delay, "", cell.detected, cell.named, cell.inside);
        several.add(*cell);
    }
    rows.iter().flat_map(|(_, cells)| cells).for_each(|cell| several.add(*cell));
    println!();
    unchanged.print("unchanged parts of the public logs");
    quiet_logs.print("simulated quiet logs");
    for ([amplitude, frequency], quiet) in MOTIONS.into_iter().zip(others) {
        quiet.print(&format!("quiet, amplitude times {amplitude}, frequency times {frequency}"));
    }
    println!("more than one event for one cause: {} of {} logs", several.several, several.logs);
}
