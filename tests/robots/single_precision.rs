//! f32: how far single precision is from double precision.

use std::fmt::Write;

use fastrand::Rng;

use crate::shipped::seven_steps::visit_all;
use crate::shipped::{Shipped, Visitor};
use crate::states::{self, State};

/// Largest error relative to the largest torque of the state.
const TOLERANCE: f64 = 2e-5;

/// Writes the page.
const WRITE: &str = "RNE_EXHAUSTIVE=1 RNE_WRITE_DOCUMENTS=1 cargo test --test robots close_to_double";

/// The page with the measured figures.
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/measured/accuracy.md");

/// The head of the table, which is the last thing on the page.
const HEADER: &str = "| robot | worst error of f32 |\n";

/// (robot, worst error relative to the largest torque of the state).
#[derive(Default)]
pub(crate) struct SinglePrecision {
    pub(crate) worst: Vec<(&'static str, f64)>,
}

impl Visitor for SinglePrecision {
    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is what is measured
    fn visit<const DOF: usize, R: Shipped<DOF>>(&mut self, robot: &R) {
        let mut rng = Rng::with_seed(32);
        let mut worst = 0.0_f64;
        for _ in 0..states::count() {
            let State { q, qd, qdd, .. } = states::moderate::<DOF, R>(&mut rng);
            // the same state in both precisions
            let [q, qd, qdd] = [q, qd, qdd].map(|array| array.map(|value| value as f32));
            let single = robot.inverse_dynamics(&q, &qd, &qdd);
            let double = robot.inverse_dynamics(&q.map(f64::from), &qd.map(f64::from), &qdd.map(f64::from));
            let scale = double.iter().fold(0.0_f64, |scale, torque| scale.max(torque.abs()));
            for (single, double) in single.iter().zip(double) {
                let error = (f64::from(*single) - double).abs();
                // `f64::max` drops what is not a number, and there is no ratio to zero
                assert!(error.is_finite(), "{}: {single} for {double}", R::NAME);
                worst = worst.max(if error == 0.0 { 0.0 } else { error / scale });
            }
        }
        assert!(worst <= TOLERANCE, "{}: {worst}", R::NAME);
        self.worst.push((R::NAME, worst));
    }
}

/// The figures of the page, which may differ from machine to machine as far as their sine and cosine do.
fn documented(page: &str, robot: &str) -> f64 {
    let table = page.split_once(HEADER).map_or("", |(_, table)| table);
    let row = table.lines().find_map(|line| line.strip_prefix(&format!("| {robot} | ")));
    let figure = row.and_then(|rest| rest.trim_end_matches(" |").parse().ok());
    figure.unwrap_or_else(|| panic!("{robot} is missing in {PAGE}: {WRITE}"))
}

#[test]
fn single_precision_is_close_to_double() {
    let mut measured = SinglePrecision::default();
    visit_all(&mut measured);
    let mut table = format!("{HEADER}|---|---|\n");
    for (robot, worst) in &measured.worst {
        let _ = writeln!(table, "| {robot} | {worst:.1e} |");
    }
    println!("{table}");
    let page = std::fs::read_to_string(PAGE).expect("the page");
    // not those of a sample
    if shipped::is_exhaustive() && std::env::var_os("RNE_WRITE_DOCUMENTS").is_some() {
        let (head, _) = page.split_once(HEADER).expect("a table, the last thing on the page");
        std::fs::write(PAGE, format!("{head}{table}")).expect("a writable page");
        return;
    }
    for (robot, worst) in measured.worst {
        let ratio = worst / documented(&page, robot);
        // the worst of a sample may be anywhere below the worst of all states
        let least = if shipped::is_exhaustive() { 0.5 } else { 0.0 };
        assert!((least..=2.0).contains(&ratio), "{robot}: {worst:.1e} is not what {PAGE} says");
    }
}
