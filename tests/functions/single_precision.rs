//! f32: how far each function is from double precision, in both forms.

use std::fmt::Write;

use fastrand::Rng;
use rne::{BaseMotion, Numbers, Scalar, Wrench};
use rne_codegen::Function;
use rne_model::Robot;

use crate::arm::{Arm, Given, Maker, STEP, base_rotation};
use crate::case::largest;
use crate::check::ROOT;
use crate::golden::ROBOTS;
use crate::states;

const PAGE: &str = "docs/measured/accuracy.md";
const BEGIN: &str = "<!-- begin: measured functions, cargo test --test functions single -->\n";
const END: &str = "<!-- end -->\n";

/// The table of all functions; the page has those with an error above `SHOWN`.
const TABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/single_precision.txt");
const SHOWN: f64 = 5e-7;

const STATES: usize = 100;

/// Arguments of a function, each array after the other: all of them are rounded to single precision.
pub(crate) struct State {
    joints: [Vec<f32>; 4],
    vectors: [[f32; 3]; 11],
}

impl State {
    #[allow(clippy::cast_possible_truncation)] // rounding to f32 is what is measured
    pub(crate) fn random(robot: &Robot, rng: &mut Rng) -> Self {
        let mut between = |low: f64, high: f64| (low + (high - low) * rng.f64()) as f32;
        let limits = robot.joints.iter().map(|joint| joint.limits.position.unwrap_or((-3.1, 3.1)));
        let q = limits.map(|(low, high)| between(low.max(-3.1), high.min(3.1))).collect();
        let [qd, qdd, tau] =
            [2.0, 5.0, 50.0].map(|range| robot.joints.iter().map(|_| between(-range, range)).collect());
        let mut vectors = [(); 11].map(|()| [(); 3].map(|()| between(-10.0, 10.0)));
        // a payload is a body: with another one, the mass matrix may be singular
        let mut triple = |low, high| [(); 3].map(|()| between(low, high));
        let payload = [triple(0.1, 5.0), triple(-0.3, 0.3), triple(0.02, 0.04), triple(-0.005, 0.005)];
        vectors[7..].copy_from_slice(&payload);
        Self { joints: [q, qd, qdd, tau], vectors }
    }

    /// All numbers of a function, in a precision.
    pub(crate) fn ask<T: Scalar + Numbers<T>>(&self, arm: &Arm, function: Function, read: impl Fn(f32) -> T) -> Vec<T> {
        let [q, qd, qdd, tau] = self.joints.each_ref().map(|array| array.iter().map(|&x| read(x)).collect::<Vec<_>>());
        let [force, moment, omega, omega_dot, velocity, acceleration, gravity, ref payload @ ..] =
            self.vectors.map(|vector| vector.map(&read));
        let base = BaseMotion { omega, omega_dot, velocity, acceleration, gravity };
        let (wrench, payload) = (Wrench { force, moment }, states::payload(payload));
        arm.numbers(
            function,
            &Given {
                q: &q,
                qd: &qd,
                qdd: &qdd,
                tau: &tau,
                wrench,
                payload,
                base,
                base_rotation: base_rotation(),
                step: T::from_f64(STEP),
            },
        )
    }
}

/// The largest error that needs no words, as the compiler has it.
pub(crate) fn limit(function: Function) -> f64 {
    if function.inverts_mass() { 1e-2 } else { 1e-4 }
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
    let error = if error == 0.0 { 0.0 } else { error / scale };
    assert!(error <= limit(function), "{}, {function}: {error:e} is said nowhere", arm.robot.name);
    error
}

/// A function in a form: the errors of all robots, in their order.
struct Row {
    heading: String,
    errors: Vec<f64>,
}

impl Row {
    fn measured() -> impl Iterator<Item = Self> {
        // the base of these robots has no mass, so it has no forward dynamics
        let solvable = Function::OF_TREES
            .into_iter()
            .filter(|function| !(function.is_of_floating_base() && function.inverts_mass()));
        let rows = solvable.flat_map(|function| Maker::CODE.map(|maker| (function, maker)));
        rows.map(|(function, maker)| {
            let of = |name: &String| worst(Arm::from_file(&format!("robots/{name}.yaml"), maker), function);
            Self { heading: format!("{} | {maker}", function.name()), errors: ROBOTS.iter().map(of).collect() }
        })
    }

    fn median(&self) -> f64 {
        let mut errors = self.errors.clone();
        errors.sort_by(f64::total_cmp);
        errors[errors.len() / 2]
    }

    /// The robot whose error is the largest.
    fn worst(&self) -> (&'static str, f64) {
        let errors = ROBOTS.iter().map(String::as_str).zip(self.errors.iter().copied());
        errors.max_by(|(_, a), (_, b)| a.total_cmp(b)).expect("a robot")
    }
}

const HEADING: &str = "| function | form | median | largest | robot |\n|---|---|---:|---:|---|\n";

fn table(rows: &[Row]) -> String {
    rows.iter().fold(HEADING.to_owned(), |mut text, row| {
        let (robot, worst) = row.worst();
        let _ = writeln!(text, "| {} | {:.0e} | {worst:.0e} | {robot} |", row.heading, row.median());
        text
    })
}

/// The lines of the table that the page has.
fn shown(table: &str) -> String {
    let is_shown = |line: &&str| {
        let worst = line.split(" | ").nth(3).expect("five cells");
        worst.parse::<f64>().is_ok_and(|worst| worst > SHOWN)
    };
    HEADING.lines().chain(table[HEADING.len()..].lines().filter(is_shown)).flat_map(|line| [line, "\n"]).collect()
}

/// With `RNE_WRITE_DOCUMENTS` set, the table is written anew.
#[test]
fn single_precision_of_every_function_is_as_documented() {
    let rows: Vec<Row> = Row::measured().collect();
    let path = format!("{ROOT}/{PAGE}");
    let page = std::fs::read_to_string(&path).expect("the page");
    let (head, rest) = page.split_once(BEGIN).expect("the block of the table");
    let (on_page, tail) = rest.split_once(END).expect("its end");
    // not that of a sample
    if shipped::is_exhaustive() && std::env::var_os("RNE_WRITE_DOCUMENTS").is_some() {
        let table = table(&rows);
        std::fs::write(TABLE, &table).expect("a writable file");
        std::fs::write(&path, format!("{head}{BEGIN}{}{END}{tail}", shown(&table))).expect("a writable page");
        return;
    }
    let written = std::fs::read_to_string(TABLE).expect("the table");
    assert_eq!(on_page, shown(&written), "{PAGE}: RNE_EXHAUSTIVE=1 RNE_WRITE_DOCUMENTS=1 writes it anew");
    let written = written.strip_prefix(HEADING).expect("its heading");
    assert_eq!(rows.len(), written.lines().count(), "single_precision.txt");
    for (row, line) in rows.iter().zip(written.lines()) {
        let start = format!("| {} | ", row.heading);
        let cells = line
            .strip_prefix(&start)
            .unwrap_or_else(|| panic!("single_precision.txt: {line}, where {start} is measured"));
        let [median, worst, robot] =
            cells.trim_end_matches(" |").split(" | ").collect::<Vec<_>>().try_into().expect("three cells");
        let [median, worst]: [f64; 2] = [median, worst].map(|figure| figure.parse().expect("a figure"));
        let is_below = |measured: f64, figure: f64| {
            // they differ from machine to machine as far as sine and cosine do
            assert!(measured <= 3.0 * figure, "single_precision.txt: {line} has {figure:e}, measured {measured:e}");
        };
        is_below(row.worst().1, worst);
        // another robot may be the worst on another machine, where theirs are close
        if let Some(index) = ROBOTS.iter().position(|name| name == robot) {
            is_below(worst, row.errors[index]);
        }
        if shipped::is_exhaustive() {
            is_below(row.median(), median);
            is_below(median, row.median());
        }
    }
}
