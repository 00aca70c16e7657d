//! f32: how far each function is from double precision, in both forms.

use std::fmt::Write;

use fastrand::Rng;
use rne::{BaseMotion, Scalar, Wrench};
use rne_codegen::Function;
use rne_model::Robot;

use crate::arm::{Arm, Given, Maker};
use crate::case::largest;
use crate::check::ROOT;
use crate::golden::ROBOTS;
use crate::states;

const PAGE: &str = "docs/accuracy.md";
const BEGIN: &str = "<!-- begin: measured functions, cargo test --test functions single -->\n";
const END: &str = "<!-- end -->\n";

const STATES: usize = 100;

/// Arguments of a function, each array after the other: all of them are rounded to single precision.
struct State {
    joints: [Vec<f32>; 4],
    vectors: [[f32; 3]; 11],
}

impl State {
    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is what is measured
    fn random(robot: &Robot, rng: &mut Rng) -> Self {
        let mut between = |low: f64, high: f64| (low + (high - low) * rng.f64()) as f32;
        let limits = robot.joints.iter().map(|joint| joint.limits.position.unwrap_or((-3.1, 3.1)));
        let q = limits.map(|(low, high)| between(low.max(-3.1), high.min(3.1))).collect();
        let [qd, qdd, tau] =
            [2.0, 5.0, 50.0].map(|range| robot.joints.iter().map(|_| between(-range, range)).collect());
        Self { joints: [q, qd, qdd, tau], vectors: [(); 11].map(|()| [(); 3].map(|()| between(-10.0, 10.0))) }
    }

    /// All numbers of a function, in a precision.
    fn ask<T: Scalar>(&self, arm: &Arm, function: Function, read: impl Fn(f32) -> T) -> Vec<T> {
        let [q, qd, qdd, tau] = self.joints.each_ref().map(|array| array.iter().map(|&x| read(x)).collect::<Vec<_>>());
        let [force, moment, omega, omega_dot, velocity, acceleration, gravity, ref payload @ ..] =
            self.vectors.map(|vector| vector.map(&read));
        let base = BaseMotion { omega, omega_dot, velocity, acceleration, gravity };
        let (wrench, payload) = (Wrench { force, moment }, states::payload(payload));
        arm.numbers(function, &Given { q: &q, qd: &qd, qdd: &qdd, tau: &tau, wrench, payload, base })
    }
}

/// The largest error at any state, relative to the largest number at any state: what crosses zero there has no error of
/// its own.
fn worst(arm: &Arm, function: Function) -> f64 {
    let mut rng = Rng::with_seed(32);
    let (mut error, mut scale) = (0.0_f64, 0.0_f64);
    for _ in 0..STATES {
        let state = State::random(&arm.robot, &mut rng);
        let (single, double) = (state.ask(arm, function, |x| x), state.ask(arm, function, f64::from));
        for (single, double) in single.iter().zip(&double) {
            let difference = (f64::from(*single) - double).abs();
            assert!(difference.is_finite(), "{}, {function}: {single} for {double}", arm.robot.name);
            error = error.max(difference);
        }
        scale = scale.max(largest(&double));
    }
    if error == 0.0 { 0.0 } else { error / scale }
}

fn table() -> String {
    let mut text = String::new();
    let _ = writeln!(text, "| function | form | {} |", ROBOTS.join(" | "));
    let _ = writeln!(text, "|---|---|{}", "---:|".repeat(ROBOTS.len()));
    for (function, maker) in Function::ALL.into_iter().flat_map(|function| Maker::CODE.map(|maker| (function, maker))) {
        let cell =
            |name: &String| format!("{:.0e}", worst(Arm::from_file(&format!("robots/{name}.yaml"), maker), function));
        let _ = writeln!(
            text,
            "| {} | {maker} | {} |",
            function.name(),
            ROBOTS.iter().map(cell).collect::<Vec<_>>().join(" | ")
        );
    }
    text
}

/// With `RNE_WRITE_DOCUMENTS` set, the table is written anew.
#[test]
fn single_precision_of_every_function_is_as_documented() {
    let table = table();
    let path = format!("{ROOT}/{PAGE}");
    let page = std::fs::read_to_string(&path).expect("the page");
    let (head, rest) = page.split_once(BEGIN).expect("the block of the table");
    let (written, tail) = rest.split_once(END).expect("its end");
    if std::env::var_os("RNE_WRITE_DOCUMENTS").is_some() {
        std::fs::write(&path, format!("{head}{BEGIN}{table}{END}{tail}")).expect("a writable page");
        return;
    }
    assert_eq!(table.lines().count(), written.lines().count(), "{PAGE}");
    for (measured, written) in table.lines().zip(written.lines()) {
        for (cell, figure) in measured.split('|').zip(written.split('|')) {
            let Ok(measured) = cell.trim().parse::<f64>() else {
                assert_eq!(cell, figure, "{PAGE}");
                continue;
            };
            let figure: f64 = figure.trim().parse().expect("a figure");
            // they differ from machine to machine as far as sine and cosine do
            assert!(measured <= 3.0 * figure, "{PAGE}: {written} has {figure:e}, measured {measured:e}");
            assert!(figure <= 3.0 * measured, "{PAGE}: {written} has {figure:e}, measured {measured:e}");
        }
    }
}
