//! `rne identify --csv`: measured, predicted and residual torques, state by state.

use std::f64::consts::{LN_2, TAU};
use std::fs;
use std::path::Path;

use crate::call::{ROOT, fails, folder, rne};

const LOG: &str = "docs/desk_arm_log.csv";
const ARM: &str = "docs/desk_arm.yaml";
const IDENTIFIED: &str = "docs/desk_arm_identified.yaml";
const JOINTS: [&str; 3] = ["waist", "shoulder", "elbow"];

/// A table of text, by columns.
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn of(text: &str) -> Self {
        let mut lines = text.lines();
        let header = lines.next().expect("a header").split(',').map(str::to_owned).collect();
        let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        Self { header, rows: lines.map(row).collect() }
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let at = self.header.iter().position(|column| column == name);
        let at = at.unwrap_or_else(|| panic!("no {name} in {:?}", self.header));
        self.rows.iter().map(|row| row[at]).collect()
    }
}

fn rms(numbers: &[f64]) -> f64 {
    #[allow(clippy::cast_precision_loss)] // a few hundred
    let count = numbers.len() as f64;
    (numbers.iter().map(|number| number * number).sum::<f64>() / count).sqrt()
}

/// Predicted torques are those of `rne eval` and the file's friction, and both sides pass the low-pass that
/// docs/control/identify.md gives: a Gaussian that ends after four deviations, and lets half the power pass at the
/// cut-off.
#[test]
fn torques_are_those_of_the_arm() {
    let folder = folder("residuals");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let (csv, motion) = (path("residuals.csv"), path("motion.csv"));
    let called = rne(&["identify", IDENTIFIED, LOG, "--judge", "--cutoff", "1.5", "--csv", &csv]);
    assert!(called.status == 0 && called.err.contains("residuals.csv, 400 states"), "{called:?}");
    let found = Table::of(&fs::read_to_string(&csv).expect("a table"));
    let of = |joint: &str| ["measured", "predicted", "residual"].map(|column| format!("{joint}.{column}"));
    assert_eq!(found.header.join(","), format!("t,{},held_out", JOINTS.map(of).concat().join(",")));
    // the log's own filter is four times as wide, and `rne log` leaves out the ends
    assert_eq!(rne(&["log", LOG, "--robot", ARM, "--cutoff", "6", "-o", &motion]).status, 0);
    let states = Table::of(&fs::read_to_string(&motion).expect("a motion"));
    let model = Table::of(&rne(&["eval", IDENTIFIED, "--function", "inverse_dynamics", "--states", &motion]).out);
    let time = states.column("t");
    let width = LN_2.sqrt() / (TAU * 1.5);
    let smooth = |numbers: &[f64], at: f64| {
        let near = time.iter().zip(numbers).filter(|(time, _)| (*time - at).abs() <= 4.0 * width);
        let weights = near.map(|(time, number)| ((-0.5 * ((time - at) / width).powi(2)).exp(), number));
        let (sum, all) = weights.fold((0.0, 0.0), |(sum, all), (weight, x)| (sum + weight * x, all + weight));
        sum / all
    };
    // viscous, Coulomb forward and backward, width, from the file
    let friction = [
        [0.404_090_67, 0.502_334_74, -0.497_987_61, 0.025],
        [0.583_294_11, 0.844_337_91, -0.772_607_4, 0.025],
        [0.204_390_7, 0.304_228_5, -0.293_173_87, 0.012],
    ];
    let times = found.column("t");
    let mut compared = 0;
    for (at, joint) in JOINTS.iter().enumerate() {
        let [measured, predicted, residual] = of(joint).map(|name| found.column(&name));
        let (speeds, torques) = (states.column(&format!("qd{}", at + 1)), states.column(&format!("tau{}", at + 1)));
        let [viscous, forward, backward, width_of_sign] = friction[at];
        let own: Vec<f64> = (speeds.iter().zip(model.column(&format!("tau{}", at + 1))))
            .map(|(speed, torque)| {
                let sign = speed / speed.hypot(width_of_sign);
                torque + viscous * speed + 0.5 * (forward - backward) * sign + 0.5 * (forward + backward)
            })
            .collect();
        let inner = time[0] + 4.0 * width..time[time.len() - 1] - 4.0 * width;
        for (row, instant) in times.iter().enumerate() {
            assert!((residual[row] - (measured[row] - predicted[row])).abs() < 1e-12, "{joint} at {instant}");
            if inner.contains(instant) {
                compared += 1;
                let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
                assert!(near(measured[row], smooth(&torques, *instant)), "{joint} at {instant}");
                assert!(near(predicted[row], smooth(&own, *instant)), "{joint} at {instant}");
            }
        }
    }
    assert!(compared > 3 * 200, "{compared}");
    assert!(found.column("held_out").iter().all(|held_out| *held_out == 0.0));
}

/// The held-out states are marked, and the residuals are those of the errors that are printed.
#[test]
fn held_out_states_are_marked() {
    let folder = folder("residuals_held_out");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let csv = path("residuals.csv");
    let reply = rne(&["identify", ARM, LOG, "--hold-out", "0.3", "--csv", &csv, "--json"]);
    let reply: serde_json::Value = serde_json::from_str(&reply.out).expect("JSON");
    let found = Table::of(&fs::read_to_string(&csv).expect("a table"));
    let (times, held_out) = (found.column("t"), found.column("held_out"));
    assert_eq!(times.len(), 400);
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    let from = reply["held_out"]["from"].as_f64().expect("a time");
    assert!(times.iter().zip(&held_out).all(|(time, held_out)| (*held_out == 1.0) == (*time >= from)));
    assert_eq!(held_out.iter().filter(|held_out| **held_out == 1.0).count(), 120);
    // an error is of the states about which the whole low-pass finds samples
    let low_pass = reply["cutoff"].as_f64().expect("a cut-off");
    let reach = 4.0 * LN_2.sqrt() / (TAU * low_pass);
    for (part, key) in [(0.0, "fitted"), (1.0, "held_out")] {
        let of_part: Vec<usize> = (0..400).filter(|row| held_out[*row] == part).collect();
        let (first, last) = (times[of_part[0]], times[of_part[of_part.len() - 1]]);
        let is_inner = |row: &&usize| times[**row] >= first + reach && times[**row] <= last - reach;
        for (at, joint) in JOINTS.iter().enumerate() {
            let residual = found.column(&format!("{joint}.residual"));
            let inner: Vec<f64> = of_part.iter().filter(is_inner).map(|row| residual[*row]).collect();
            let said = reply["joints"][at][key]["residual"].as_f64().unwrap_or_else(|| panic!("{key} of {reply}"));
            assert!((rms(&inner) - said).abs() < 1e-3 * said, "{joint}, {key}: {} and {said}", rms(&inner));
        }
    }
}

#[test]
fn a_table_needs_a_place_of_its_own() {
    let folder = folder("residuals_places");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let call = |more: &[&'static str], csv: &str| {
        let call = ["identify", IDENTIFIED, LOG, "--judge", "--csv"].map(str::to_owned).to_vec();
        let more = more.iter().map(|word| (*word).to_owned());
        call.into_iter().chain([csv.to_owned()]).chain(more).collect::<Vec<_>>()
    };
    let refused = |arguments: &[String], said: &str| {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        fails(2, &arguments, &[said]);
    };
    refused(&call(&[], "-"), "--csv needs the name of a file, such as residuals.csv");
    refused(&call(&[], &path("x.svg")), "name it");
    refused(&call(&["--force"], LOG), "is also the file that rne reads");
    let csv = path("residuals.csv");
    let made: Vec<String> = call(&[], &csv);
    let made: Vec<&str> = made.iter().map(String::as_str).collect();
    assert_eq!(rne(&made).status, 0);
    refused(&call(&[], &csv), "--force");
    assert_eq!(rne(&[&made[..], &["--force"]].concat()).status, 0);
    fails(
        2,
        &["identify", ARM, LOG, "-o", &path("x.yaml"), "--csv", &path("x.yaml")],
        &["both the table and the robot"],
    );
    assert!(!Path::new(ROOT).join("residuals.csv").exists());
}
